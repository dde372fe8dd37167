//! The page that shows all previews of a scene, for a browser.

use crate::page::{contents, figure, page};
use maud::html;

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
    /// File of the picture, beside the page.
    pub file: String,
    /// File of the picture as SVG, beside the page, if there is one.
    pub svg: Option<String>,
    /// Caption.
    pub caption: String,
}

/// The page of a scene.
pub(super) fn plan_page(scene: &str, about: &str, sections: &[Section]) -> String {
    let body = html! {
        @if sections.len() > 1 { (contents(sections.iter().map(|section| section.camera.as_str()))) }
        @for Section { camera, about, pictures } in sections {
            h2 id=(camera) { (camera) }
            p { (about) }
            @for Shown { file, svg, caption } in pictures { (figure(file, svg.as_deref(), caption)) }
        }
    };
    page(&format!("{scene}: planned trajectories"), &html! { (about) }, &body)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_relative_and_names_are_escaped() {
        let picture = Shown { file: "cam_00_plan.png".into(), svg: Some("cam_00_plan.svg".into()), caption: "Plan <a>".into() };
        let section = |camera: &str, pictures| Section { camera: camera.into(), about: "2 frames".into(), pictures };
        let html = plan_page("room & hall", "", &[section("cam_00", vec![picture]), section("cam_01", vec![])]);
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
