//! The page that lists which views were rejected and why.

use crate::page::{contents, figure, page};
use enfilade_dataset::ViewVerdict;
use enfilade_verify::view_gates::{GateConfig, VIEW_GATES, ViewGate, ViewMeasures};
use maud::{Markup, html};

/// A judged view.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// Name of the camera.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
    /// The measures.
    pub measures: ViewMeasures,
    /// The worst fault.
    pub fault: Option<ViewGate>,
    /// The verdict: a view with a fault is rejected or reported.
    pub verdict: ViewVerdict,
    /// The picture of a view with a fault, relative to the page.
    pub thumbnail: Option<String>,
}

impl Judged {
    /// "blocked: 0.93 (at most 0.5)"; `None` for a view that passes.
    pub fn reason(&self, config: &GateConfig) -> Option<String> {
        let gate = self.fault?;
        let side = if gate == ViewGate::DepthRange { "at least" } else { "at most" };
        Some(format!("{}: {:.3} ({side} {})", gate.spec().name, self.measures.value(gate), config.limit(gate)))
    }
}

/// The page of a scene, with views in the order of cameras and frames.
pub fn gates_page(scene: &str, config: &GateConfig, views: &[Judged]) -> String {
    let with = |verdict| views.iter().filter(|view| view.verdict == verdict).count();
    let (rejected, reported) = (with(ViewVerdict::Rejected), with(ViewVerdict::Reported));
    let faulty = rejected + reported;
    let mut cameras: Vec<&str> = views.iter().filter(|view| view.fault.is_some()).map(|view| view.camera.as_str()).collect();
    cameras.dedup();
    let body = html! {
        p.verdict.good[faulty == 0].warn[faulty > 0] {
            (rejected) " of " (views.len()) " views rejected"
            @if reported > 0 { ", " (reported) " reported, but rendered all the same" }
        }
        (table(config, views))
        @if cameras.len() > 1 { (contents(cameras.iter().copied())) }
        @for camera in cameras {
            h2 id=(camera) { (camera) }
            div class="grid small" {
                @for view in views.iter().filter(|view| view.camera == camera) {
                    @if let (Some(reason), Some(file)) = (view.reason(config), &view.thumbnail) {
                        (figure(file, None, &caption(view, &reason)))
                    }
                }
            }
        }
    };
    let about = html! {
        "Views as they were judged before rendering, by their geometry alone. Surfaces have the colours of their normals and darken with "
        "distance; red is the back of things, and the chessboard is where there is nothing. The numbers of every view stand in "
        code { "cam_XX/metadata_view_gates.csv" } "."
    };
    page(&format!("{scene}: gates of views"), &about, &body)
}

fn caption(view: &Judged, reason: &str) -> String {
    let rendered = if view.verdict == ViewVerdict::Reported { " (rendered)" } else { "" };
    format!("frame {:04} — {reason}{rendered}", view.frame)
}

fn table(config: &GateConfig, views: &[Judged]) -> Markup {
    html! {
        div.scroll {
            table {
                thead { tr { th { "Gate" } th { "The camera or view …" } th { "Measured" } th { "Key of [gate]" } th.number { "Limit" } th.number { "Views" } } }
                tbody {
                    @for spec in &VIEW_GATES {
                        @let found = views.iter().filter(|view| view.fault == Some(spec.gate)).count();
                        tr {
                            td { (spec.name) } td { (spec.meaning) } td { (spec.measure) } td { code { (spec.key) } }
                            td.number { (config.limit(spec.gate)) } td.number.warn[found > 0] { (found) }
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejected_views_are_shown_with_reasons_and_the_others_counted() {
        let measures = ViewMeasures {
            void_share: 0.0,
            enclosed_share: 0.1,
            open_share: 0.0,
            back_face_share: 0.0,
            near_share: 0.93,
            depth_range_m: 3.0,
            plane_share: 0.4,
            invalid_share: 0.0,
        };
        let view = |frame, fault: Option<ViewGate>| Judged {
            camera: "cam_00".into(),
            frame,
            measures,
            fault,
            verdict: match frame {
                0 => ViewVerdict::Passed,
                3 => ViewVerdict::Reported,
                _ => ViewVerdict::Rejected,
            },
            thumbnail: fault.map(|_| format!("cam_00/rejected/frame.{frame:04}.jpg")),
        };
        let views = [view(0, None), view(3, Some(ViewGate::Blocked)), view(7, Some(ViewGate::Blocked))];
        let html = gates_page("hall & room", &GateConfig::default(), &views);
        for part in [
            "hall &amp; room: gates of views",
            "1 of 3 views rejected, 1 reported, but rendered all the same",
            "frame 0003 — blocked: 0.930 (at most 0.5) (rendered)",
            "frame 0007 — blocked: 0.930 (at most 0.5)",
            "src=\"cam_00/rejected/frame.0007.jpg\"",
        ] {
            assert!(html.contains(part), "{part} is not in {html}");
        }
        assert!(!html.contains("frame 0000"));
    }
}
