//! The look of the pages that we write for browsers: one style, light and dark, without scripts and without anything from elsewhere.

use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = "\
:root { color-scheme: light dark; --paper: #f6f6f4; --card: #fff; --ink: #22232a; --soft: #62666e; --line: #d8d9dc;
  --good: #1a7a3c; --warn: #8f5b00; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --paper: #17181b; --card: #1f2024; --ink: #e8e8e4; --soft: #a0a4ac; --line: #34363c;
  --good: #62c687; --warn: #e0a94a; --bad: #f2857d; } }
body { margin: 0 auto; max-width: 1320px; padding: 2rem 1.25rem 4rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, \"Helvetica Neue\", Arial, sans-serif; }
h1 { font-size: 1.9rem; margin: 0 0 .25rem; }
h2 { font-size: 1.35rem; margin: 3rem 0 .25rem; padding-top: 1.25rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.05rem; margin: 1.75rem 0 .25rem; }
p, figcaption, nav { color: var(--soft); margin: .25rem 0; }
nav a { margin-right: 1rem; }
a { color: inherit; }
figure { margin: 1.25rem 0 2rem; }
figure img { display: block; width: 100%; height: auto; background: var(--card); border: 1px solid var(--line); border-radius: 6px; }
figcaption { padding-top: .4rem; font-size: .9rem; overflow-wrap: anywhere; }
.grid { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(26rem, 100%), 1fr)); gap: 0 1.5rem; }
.grid.small { grid-template-columns: repeat(auto-fill, minmax(11rem, 1fr)); gap: 0 1rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; margin: 1rem 0; font-size: .92rem; font-variant-numeric: tabular-nums; }
th, td { padding: .4rem .75rem .4rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); }
th { color: var(--soft); font-weight: 600; }
.number { text-align: right; white-space: nowrap; }
th.number { white-space: normal; vertical-align: bottom; }
.good { color: var(--good); } .warn { color: var(--warn); } .bad { color: var(--bad); }
.verdict { font-size: 1.15rem; font-weight: 600; }
";

/// A whole page: a heading, a line about it, and the body.
pub fn page(title: &str, about: &Markup, body: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (title) }
                p { (about) }
                (body)
            }
        }
    }
    .into_string()
}

/// A picture with its caption, that opens in full where it is clicked. Paths are relative to the page.
pub fn figure(file: &str, svg: Option<&str>, caption: &str) -> Markup {
    html! {
        figure {
            a href=(file) { img src=(file) alt=(caption) loading="lazy"; }
            figcaption {
                (caption)
                @if let Some(svg) = svg { " (" a href=(svg) { "SVG" } ")" }
            }
        }
    }
}

/// Links to parts of the page, by their `id`, which is their name too.
pub fn contents<'a>(ids: impl IntoIterator<Item = &'a str>) -> Markup {
    html! {
        nav { @for id in ids { a href={ "#" (id) } { (id) } } }
    }
}
