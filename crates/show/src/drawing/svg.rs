//! A page as an SVG file: the same shapes, with real text and at any size.

use super::{Anchor, Drawing, Ink, Point, Shape, Text};
use crate::picture::png;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::fmt::Write;

/// Height of capitals over the font size of usual sans-serif fonts.
const CAPITAL_HEIGHT: f32 = 0.72;

/// Colours of paper and inks where a browser shows dark pages.
pub(crate) struct Dark<'a> {
    pub paper: [u8; 3],
    /// Colours and what they become; others stay.
    pub inks: &'a [([u8; 3], [u8; 3])],
}

/// The page's file. Pictures are embedded as PNG, so that it can be shown by itself.
pub(crate) fn svg(drawing: &Drawing) -> String {
    written(drawing, "")
}

/// A drawing as [`svg`], with other colours where the browser shows dark pages.
pub(crate) fn themed_svg(drawing: &Drawing, dark: &Dark) -> String {
    let inks = dark.inks.iter().map(|&(light, dark)| {
        let (light, dark) = (hex(light), hex(dark));
        format!("[fill=\"{light}\"]{{fill:{dark}}}[stroke=\"{light}\"]{{stroke:{dark}}}")
    });
    let rules: String = inks.collect();
    // The paper is the only rectangle.
    written(drawing, &format!("<style>@media (prefers-color-scheme:dark){{rect{{fill:{}}}{rules}}}</style>\n", hex(dark.paper)))
}

fn written(drawing: &Drawing, style: &str) -> String {
    let (w, h) = (drawing.width, drawing.height);
    let mut file = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" \
         font-family=\"Helvetica, Arial, sans-serif\">\n{style}<rect width=\"100%\" height=\"100%\" fill=\"{}\"/>\n",
        hex(drawing.paper)
    );
    drawing.shapes.iter().for_each(|shape| put(&mut file, shape));
    file.push_str("</svg>\n");
    file
}

/// `text` with the characters replaced that mean something in XML and HTML.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn put(file: &mut String, shape: &Shape) {
    // Writing to a string cannot fail.
    let _ = match shape {
        Shape::Area { outline, ink } => writeln!(file, "<path d=\"{}Z\" {}/>", path([outline]), filled(*ink)),
        Shape::Lines { runs, width, ink } => {
            writeln!(file, "<path d=\"{}\" {} stroke-width=\"{width:.2}\"/>", path(runs), stroked(*ink))
        }
        Shape::Disc { center: [x, y], radius, ink } => {
            writeln!(file, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" {}/>", filled(*ink))
        }
        Shape::Text(text) => put_text(file, text),
        Shape::Picture { at: [x, y], picture } => {
            let (w, h) = (picture.width(), picture.height());
            let data = STANDARD.encode(png(picture, None));
            writeln!(file, "<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" href=\"data:image/png;base64,{data}\"/>")
        }
    };
}

fn put_text(file: &mut String, text: &Text) -> std::fmt::Result {
    let [x, y] = text.at;
    let anchor = match text.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    write!(file, "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{:.1}\" text-anchor=\"{anchor}\" ", text.height / CAPITAL_HEIGHT)?;
    if text.bold {
        write!(file, "font-weight=\"bold\" ")?;
    }
    if let Some(halo) = text.halo {
        write!(file, "paint-order=\"stroke\" stroke-width=\"{:.1}\" {} ", 0.6 * text.height, joined(halo))?;
    }
    writeln!(file, "{}>{}</text>", filled(text.ink), escaped(&text.words))
}

fn path<'a>(runs: impl IntoIterator<Item = &'a Vec<Point>>) -> String {
    let mut data = String::new();
    for run in runs {
        for (i, [x, y]) in run.iter().enumerate() {
            let _ = write!(data, "{}{x:.1} {y:.1}", if i == 0 { 'M' } else { 'L' });
        }
        if run.len() == 1 {
            data.push_str("h0");
        }
    }
    data
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn filled(ink: Ink) -> String {
    format!("fill=\"{}\"{}", hex(ink.color), opacity(ink, "fill"))
}

fn joined(ink: Ink) -> String {
    format!("stroke=\"{}\"{} stroke-linejoin=\"round\"", hex(ink.color), opacity(ink, "stroke"))
}

fn stroked(ink: Ink) -> String {
    format!("fill=\"none\" stroke-linecap=\"round\" {}", joined(ink))
}

fn opacity(ink: Ink, of: &str) -> String {
    if ink.opacity < 1.0 { format!(" {of}-opacity=\"{:.2}\"", ink.opacity) } else { String::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Picture;

    #[test]
    fn every_shape_becomes_an_element() {
        let mut page = Drawing::new(80, 60, [255; 3]);
        page.bar([1.0, 2.0, 3.0, 4.0], Ink::solid([255, 0, 16]));
        page.lines(vec![vec![[0.0, 0.0], [5.0, 5.0]], vec![[7.0, 7.0]]], 1.5, Ink::veil([0; 3], 0.25));
        page.disc([9.0, 9.0], 2.0, Ink::solid([1, 2, 3]));
        page.text([4.0, 30.0], "a < b & c", 10.0, Ink::solid([0; 3]));
        page.picture([0.0, 0.0], Picture::from_pixel(1, 1, image::Rgba([0; 4])));
        let file = svg(&page);
        for part in [
            "viewBox=\"0 0 80 60\"",
            "<path d=\"M1.0 2.0L4.0 2.0L4.0 6.0L1.0 6.0Z\" fill=\"#ff0010\"/>",
            "d=\"M0.0 0.0L5.0 5.0M7.0 7.0h0\" fill=\"none\" stroke-linecap=\"round\" stroke=\"#000000\" stroke-opacity=\"0.25\"",
            "<circle cx=\"9.0\" cy=\"9.0\" r=\"2.0\" fill=\"#010203\"/>",
            ">a &lt; b &amp; c</text>",
            "href=\"data:image/png;base64,iVBORw0KGgo",
        ] {
            assert!(file.contains(part), "{part} is not in {file}");
        }
        assert!(file.ends_with("</svg>\n"));
    }

    #[test]
    fn dark_pages_change_paper_and_inks_and_nothing_else_of_the_file() {
        let mut page = Drawing::new(8, 6, [255; 3]);
        page.text([4.0, 3.0], "t", 10.0, Ink::solid([1, 2, 3]));
        let themed = themed_svg(&page, &Dark { paper: [31, 32, 36], inks: &[([1, 2, 3], [240; 3])] });
        let style = "<style>@media (prefers-color-scheme:dark){rect{fill:#1f2024}\
                     [fill=\"#010203\"]{fill:#f0f0f0}[stroke=\"#010203\"]{stroke:#f0f0f0}}</style>\n";
        assert_eq!(themed.replacen(style, "", 1), svg(&page));
        assert!(themed.contains(style), "{themed}");
    }
}
