//! The page that shows all previews of a scene, for a browser; no scripts.

use super::svg::escaped;
use std::fmt::Write;

/// A trajectory on the page.
pub(super) struct Section {
    /// Name of the camera.
    pub camera: String,
    /// One line about it.
    pub about: String,
    /// The pictures, in order.
    pub pictures: Vec<Shown>,
}

/// A picture on the page.
pub(super) struct Shown {
    /// Its file, beside the page.
    pub file: String,
    /// The same as SVG, beside the page, if there is one.
    pub svg: Option<String>,
    /// What it shows.
    pub caption: String,
}

const STYLE: &str = "\
:root { color-scheme: light dark; --paper: #f6f6f4; --ink: #22232a; --soft: #666a72; --line: #d8d9dc; }
@media (prefers-color-scheme: dark) { :root { --paper: #17181b; --ink: #e8e8e4; --soft: #a0a4ac; --line: #34363c; } }
body { margin: 0 auto; max-width: 1320px; padding: 2rem 1.25rem 4rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, \"Helvetica Neue\", Arial, sans-serif; }
h1 { font-size: 1.9rem; margin: 0 0 .25rem; }
h2 { font-size: 1.35rem; margin: 3rem 0 .25rem; padding-top: 1.25rem; border-top: 1px solid var(--line); }
p, figcaption, nav { color: var(--soft); margin: .25rem 0; }
nav a { margin-right: 1rem; }
a { color: inherit; }
figure { margin: 1.25rem 0 2rem; }
figure img { display: block; width: 100%; height: auto; background: #fff; border: 1px solid var(--line); border-radius: 6px; }
figcaption { padding-top: .4rem; font-size: .9rem; }
";

/// The page of a scene.
pub(super) fn page(scene: &str, about: &str, sections: &[Section]) -> String {
    let scene = escaped(scene);
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<title>{scene}: planned trajectories</title>\n<style>\n{STYLE}</style>\n</head>\n\
         <body>\n<h1>{scene}</h1>\n<p>{}</p>\n",
        escaped(about)
    );
    if sections.len() > 1 {
        html.push_str("<nav>");
        for section in sections {
            let camera = escaped(&section.camera);
            let _ = write!(html, "<a href=\"#{camera}\">{camera}</a>");
        }
        html.push_str("</nav>\n");
    }
    sections.iter().for_each(|section| put_section(&mut html, section));
    html.push_str("</body>\n</html>\n");
    html
}

fn put_section(html: &mut String, section: &Section) {
    let camera = escaped(&section.camera);
    let _ = write!(html, "<h2 id=\"{camera}\">{camera}</h2>\n<p>{}</p>\n", escaped(&section.about));
    for Shown { file, svg, caption } in &section.pictures {
        let (file, caption) = (escaped(file), escaped(caption));
        let scaled = svg.as_ref().map_or(String::new(), |svg| format!(" (<a href=\"{}\">SVG</a>)", escaped(svg)));
        let _ = writeln!(
            html,
            "<figure><a href=\"{file}\"><img src=\"{file}\" alt=\"{caption}\" loading=\"lazy\"></a>\
             <figcaption>{caption}{scaled}</figcaption></figure>"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_relative_and_names_are_escaped() {
        let picture = Shown { file: "cam_00_plan.png".into(), svg: Some("cam_00_plan.svg".into()), caption: "Plan <a>".into() };
        let section = |camera: &str, pictures| Section { camera: camera.into(), about: "2 frames".into(), pictures };
        let html = page("room & hall", "", &[section("cam_00", vec![picture]), section("cam_01", vec![])]);
        for part in [
            "<title>room &amp; hall: planned trajectories</title>",
            "<a href=\"#cam_01\">cam_01</a>",
            "<h2 id=\"cam_00\">",
            "<img src=\"cam_00_plan.png\" alt=\"Plan &lt;a&gt;\"",
            "(<a href=\"cam_00_plan.svg\">SVG</a>)",
        ] {
            assert!(html.contains(part), "{part} is not in {html}");
        }
        assert!(!html.contains("<script") && !html.contains("://"));
    }
}
