//! The report card as a page for a browser: verdicts, failures, scenes, gates with the worst frames, pairs of frames, laws.
//!
//! However large the dataset, the page shows the worst of it; `verify.json` beside it has all.

use crate::page::{contents, page};
use enfilade_dataset::{Dataset, DatasetError, Layout, counted, write_changed};
use enfilade_frame::Pass;
use enfilade_math::quantile;
use enfilade_verify::frame_gates::Gate;
use enfilade_verify::{Excuse, FrameValues, GateResult, LawResult, PairValues, VerifyReport, number, write_report_json};
use maud::{Markup, html};
use std::collections::{BTreeMap, BTreeSet};

/// Frames, and pairs of frames, that are shown: the worst ones.
const SHOWN_FRAMES: usize = 24;
const SHOWN_PAIRS: usize = 12;

/// Stores the report beside the data, as `verify.json` and `verify.html`. Files that are so already are not touched.
///
/// # Errors
/// When a file cannot be written.
pub fn write_report(dataset: &Dataset, report: &VerifyReport) -> Result<(), DatasetError> {
    write_report_json(dataset, report)?;
    write_changed(&dataset.layout().verify_page(), &report_page(dataset, report))
}

/// The page. Links are relative to the dataset's folder, and lead to previews that are there.
pub fn report_page(dataset: &Dataset, report: &VerifyReport) -> String {
    let links = Links::new(dataset);
    let failed: Vec<&LawResult> = report.failures().collect();
    let mut sections = vec!["scenes", "gates", "frames", "neighbours", "laws"];
    if !failed.is_empty() {
        sections.insert(0, "failures");
    }
    if !report.excused.is_empty() {
        sections.push("release");
    }
    let body = html! {
        p.verdict .(verdict(report.passed)) { (capital(&report.verdict())) "." }
        p.verdict .(if report.rejected().next().is_some() { "warn" } else { "good" }) { (capital(&report.gate_verdict())) "." }
        @for note in &report.notes { p { (capital(note)) "." } }
        (contents(sections.iter().copied()))
        @if !failed.is_empty() {
            h2 id="failures" { "Laws that fail" }
            @for law in failed { (failure(law, &links)) }
        }
        h2 id="scenes" { "Scenes" }
        (scenes(report))
        h2 id="gates" { "Gates" }
        p { "What those who train on such data ask of a frame. docs/verify.md has the exact definitions." }
        (gates(report, &links))
        h2 id="frames" { "Frames" }
        (frames(report, &links))
        h2 id="neighbours" { "Neighbouring frames" }
        (neighbours(report, &links))
        h2 id="laws" { "Laws" }
        (laws(report, &links))
        @if !report.excused.is_empty() {
            h2 id="release" { "Hypersim's release" }
            p { "Laws that it is not held to, and defects of it that its makers know of." }
            (excused(report, &links))
        }
    };
    let about =
        html! { "What " code { "enfilade verify" } " found in this dataset; " a href="verify.json" { "verify.json" } " has every value." };
    page("Report card", &about, &body)
}

fn verdict(good: bool) -> &'static str {
    if good { "good" } else { "bad" }
}

/// With a capital at the beginning.
fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or(String::new(), |first| first.to_uppercase().chain(chars).collect())
}

fn percent(share: f64) -> String {
    match 100.0 * share {
        p if p == 0.0 || p >= 9.95 => format!("{p:.0} %"),
        p if p < 0.1 => "< 0.1 %".into(),
        p => format!("{p:.1} %"),
    }
}

/// A value with its unit; shares as percentages.
fn in_unit(value: Option<f64>, unit: &str) -> String {
    match (value, unit) {
        (Some(share), "share") => percent(share),
        (value, "") => number(value),
        (value, unit) => format!("{} {unit}", number(value)),
    }
}

/// Paths of pictures relative to the page.
struct Links<'a> {
    dataset: &'a Dataset,
}

impl<'a> Links<'a> {
    fn new(dataset: &'a Dataset) -> Self {
        Self { dataset }
    }

    /// The tone-mapped picture of a frame, if it is there.
    fn picture(&self, scene: &str, camera: &str, frame: u32) -> Option<String> {
        let layout: &Layout = self.dataset.layout();
        let path = layout.preview(scene, camera, frame, Pass::Final, "tonemap.jpg");
        let relative = path.strip_prefix(layout.root()).ok()?;
        let parts: Vec<&str> = relative.iter().filter_map(|part| part.to_str()).collect();
        path.is_file().then(|| parts.join("/"))
    }

    /// A place as text, its beginning linked to the frame that it names.
    fn place(&self, place: &str) -> Markup {
        let (name, rest) = place.split_at(frame_name_length(place).unwrap_or(0));
        let mut parts = name.split('/');
        let numbers = |frame: &str| frame.strip_prefix("frame.").and_then(|n| n.parse().ok());
        let picture = match (parts.next(), parts.next(), parts.next().and_then(numbers)) {
            (Some(scene), Some(camera), Some(frame)) => self.picture(scene, camera, frame),
            _ => None,
        };
        match picture {
            Some(picture) => html! { a href=(picture) { (name) } (rest) },
            None => html! { (place) },
        }
    }
}

/// Length of the prefix `scene/camera/frame.IIII` of a place.
fn frame_name_length(place: &str) -> Option<usize> {
    let word = place.find(char::is_whitespace).unwrap_or(place.len());
    let start = place[..word].find("/frame.")? + "/frame.".len();
    let digits = place[start..].bytes().take_while(u8::is_ascii_digit).count();
    (digits > 0).then_some(start + digits)
}

fn failure(law: &LawResult, links: &Links<'_>) -> Markup {
    html! {
        h3.bad { (capital(&law.statement)) }
        p { "Found " (number(law.worst)) " " (law.unit) ", allowed " (number(Some(law.bound))) ". " }
        @if !law.place.is_empty() { p { "At " (links.place(&law.place)) } }
        p { "It may mean: " (law.meaning) "." }
    }
}

/// The median of the values that there are.
fn median<'a>(frames: &[&'a FrameValues], value: impl Fn(&'a FrameValues) -> Option<f64>) -> Option<f64> {
    quantile(&mut frames.iter().filter_map(|frame| value(frame)).collect::<Vec<_>>(), 0.5)
}

fn scenes(report: &VerifyReport) -> Markup {
    let mut by_scene: BTreeMap<&str, Vec<&FrameValues>> = BTreeMap::new();
    report.frame_values.iter().for_each(|frame| by_scene.entry(&frame.scene).or_default().push(frame));
    let share = |value: Option<f64>| value.map_or("-".to_string(), percent);
    let overlap = |scene: &str| {
        quantile(&mut report.pairs.iter().filter(|pair| pair.scene == scene).filter_map(|pair| pair.overlap).collect::<Vec<_>>(), 0.5)
    };
    html! {
        p { "Medians over the frames of each scene, but for counts." }
        div.scroll { table {
            tr {
                th { "scene" }
                th { "color" }
                @for head in ["frames", "rejected", "noise", "samples", "tone map", "clipped", "black", "invalid", "labelled", "parts", "overlap"] {
                    th.number { (head) }
                }
            }
            @for (scene, frames) in by_scene {
                @let rejected = frames.iter().filter(|frame| frame.rejected_by().next().is_some()).count();
                tr {
                    td { (scene) }
                    td { (colors(&frames)) }
                    td.number { (frames.len()) }
                    td.number .(if rejected > 0 { "warn" } else { "" }) { (rejected) }
                    td.number { (share(median(&frames, |f| f.noise))) }
                    td.number { (median(&frames, |f| f.samples).map_or("-".into(), |n| number(Some(n)))) }
                    td.number { (median(&frames, |f| f.tone_map_scale).map_or("-".into(), |n| number(Some(n)))) }
                    td.number { (share(median(&frames, |f| f.clipped_share))) }
                    td.number { (share(median(&frames, |f| f.black_share))) }
                    td.number { (share(median(&frames, |f| f.gates.get(&Gate::InvalidShare).copied().flatten()))) }
                    td.number { (share(median(&frames, |f| f.labelled_share))) }
                    td.number { (share(median(&frames, |f| f.labelled_parts_share))) }
                    td.number { (share(overlap(scene))) }
                }
            }
        } }
    }
}

/// The kind of `color` in the frames of a scene, in words.
fn colors(frames: &[&FrameValues]) -> String {
    let kinds: BTreeSet<&str> = frames.iter().filter_map(|frame| frame.color.as_deref()).collect();
    if kinds.is_empty() { "-".into() } else { kinds.into_iter().collect::<Vec<_>>().join("; ") }
}

fn gates(report: &VerifyReport, links: &Links<'_>) -> Markup {
    let limit = |gate: &GateResult| format!("{} {}", gate.limit.words(), in_unit(Some(gate.bound), &gate.unit));
    html! {
        div.scroll { table {
            tr { th { "gate" } th { "what is measured" } th { "limit" } th.number { "rejected" } th.number { "worst" } th { "where" } th { "whose" } }
            @for gate in &report.gates {
                tr {
                    td { (gate.gate.spec().name) }
                    td { (gate.measure) }
                    td { (limit(gate)) }
                    td.number .(if gate.rejected > 0 { "warn" } else { "good" }) { (gate.rejected) " of " (gate.measured) }
                    td.number { (in_unit(gate.worst, &gate.unit)) }
                    td { (links.place(&gate.place)) }
                    td { (gate.gate.spec().source) }
                }
            }
        } }
    }
}

/// The rejected frames, those that most gates reject first.
fn frames(report: &VerifyReport, links: &Links<'_>) -> Markup {
    let mut worst: Vec<&FrameValues> = report.rejected().collect();
    worst.sort_by_key(|frame| std::cmp::Reverse(frame.rejected_by().count()));
    let all = worst.len();
    worst.truncate(SHOWN_FRAMES);
    let about = match all {
        0 => "No gate rejects a frame.".to_string(),
        n if n > SHOWN_FRAMES => format!("{n} are rejected, here are {SHOWN_FRAMES} of them; verify.json has the others."),
        n => format!("{} rejected.", if n == 1 { "1 is".into() } else { format!("{n} are") }),
    };
    html! {
        p { (about) }
        div.grid.small { @for frame in worst { (rejected_frame(frame, links)) } }
    }
}

fn rejected_frame(frame: &FrameValues, links: &Links<'_>) -> Markup {
    let reason = |gate: Gate| {
        let spec = gate.spec();
        format!("{} {}", spec.name, in_unit(frame.gates.get(&gate).copied().flatten(), spec.unit))
    };
    let reasons: Vec<String> = frame.rejected_by().map(reason).collect();
    html! {
        figure {
            @if let Some(picture) = links.picture(&frame.scene, &frame.camera, frame.frame) {
                a href=(picture) { img src=(picture) alt=(frame.place()) loading="lazy"; }
            }
            figcaption { (frame.place()) ": " span.warn { (reasons.join(", ")) } }
        }
    }
}

/// The pairs that disagree most, then those that overlap least.
fn neighbours(report: &VerifyReport, links: &Links<'_>) -> Markup {
    let mut worst: Vec<&PairValues> = report.pairs.iter().collect();
    let rank = |pair: &PairValues| (pair.worst_share(), 1.0 - pair.overlap.unwrap_or(1.0));
    worst.sort_by(|a, b| {
        let (a, b) = (rank(a), rank(b));
        b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1))
    });
    worst.truncate(SHOWN_PAIRS);
    let mut overlaps: Vec<f64> = report.pairs.iter().filter_map(|pair| pair.overlap).collect();
    let overlap = quantile(&mut overlaps, 0.5)
        .map_or(String::new(), |m| format!(" In the median a frame sees {} of what its neighbour sees.", percent(m)));
    let place = |(camera, frame): &(String, u32), scene: &str| format!("{scene}/{camera}/frame.{frame:04}");
    html! {
        p {
            (capital(&counted(report.pairs.len(), "pair"))) " of frames were compared: the next of a trajectory, and the two of a stereo rig." (overlap)
            @if report.pairs.len() > SHOWN_PAIRS { " Here are those that disagree most." }
        }
        div.scroll { table {
            tr {
                th { "frame" } th { "and" } th.number { "overlap" }
                @for head in ["compared", "looked through", "other part", "other reflectance"] { th.number { (head) } }
            }
            @for pair in worst {
                tr {
                    td { (links.place(&place(&pair.first, &pair.scene))) }
                    td { (format!("{}/frame.{:04}", pair.second.0, pair.second.1)) }
                    td.number { (pair.overlap.map_or("-".into(), percent)) }
                    td.number { (pair.distance.pixels) }
                    td.number { (pair.distance.disagree) }
                    td.number { (pair.ids.disagree) }
                    td.number { (pair.reflectance.disagree) " of " (pair.reflectance.pixels) }
                }
            }
        } }
    }
}

/// The violations of Hypersim's release that do not count.
fn excused(report: &VerifyReport, links: &Links<'_>) -> Markup {
    let kind = |excuse: Excuse| if excuse == Excuse::KnownDefect { "known defect" } else { "not applicable" };
    html! {
        table {
            tr { th { "" } th { "law" } th { "worst" } th { "where" } th { "why it does not count" } }
            @for e in &report.excused {
                tr {
                    td { (kind(e.excuse)) }
                    td { (e.statement) }
                    td { @if !e.place.is_empty() { (number(e.worst)) } }
                    td { (links.place(&e.place)) }
                    td { (e.reason) }
                }
            }
        }
    }
}

fn laws(report: &VerifyReport, links: &Links<'_>) -> Markup {
    html! {
        div.scroll { table {
            tr { th { "" } th { "law" } th.number { "worst" } th.number { "bound" } th { "unit" } th.number { "checks" } th { "where" } }
            @for law in &report.laws {
                tr {
                    td.(verdict(law.holds)) { (if law.holds { "holds" } else { "fails" }) }
                    td { (law.statement) }
                    td.number { (number(law.worst)) }
                    td.number { (number(Some(law.bound))) }
                    td { (law.unit) }
                    td.number { (law.checks) }
                    // If no violation was found, there is no place to show.
                    td { @if law.worst != Some(0.0) { (links.place(&law.place)) } }
                }
            }
        } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_dataset::write_bytes;
    use enfilade_testroom as testroom;

    fn verified(dataset: &Dataset) -> VerifyReport {
        let report = enfilade_verify::verify_scene(dataset, "room", &enfilade_scene::Quiet).unwrap();
        enfilade_verify::join_reports(dataset, vec![report])
    }

    #[test]
    fn names_of_frames_are_found_in_places() {
        assert_eq!(frame_name_length("room/cam_00/frame.0003 pixel (1, 2)"), Some(22));
        assert_eq!(frame_name_length("room/cam_00/frame.0003"), Some(22));
        assert_eq!(frame_name_length("room/cam_00/frame.0003: not there"), Some(22));
        assert_eq!(frame_name_length("room: no frame"), None);
        assert_eq!(frame_name_length("/frame."), None);
    }

    #[test]
    fn shares_are_told_in_two_digits() {
        assert_eq!([0.0, 0.0001, 0.0123, 0.5, 1.0].map(percent), ["0 %", "< 0.1 %", "1.2 %", "50 %", "100 %"]);
    }

    #[test]
    fn the_page_tells_failures_first_and_links_to_pictures_that_are_there() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let picture = dataset.layout().preview("room", "cam_00", 0, Pass::Final, "tonemap.jpg");
        write_bytes(&picture, b"picture").unwrap();
        let mut report = verified(&dataset);
        let good = report_page(&dataset, &report);
        assert!(good.contains("laws hold over 2 frames of 1 scene") && !good.contains("Laws that fail"), "{good}");
        let law = report.laws.iter_mut().find(|law| law.law == enfilade_verify::Law::Roll).unwrap();
        (law.holds, law.worst, law.place) = (false, Some(7.0), "room/cam_00/frame.0000".into());
        let bad = report_page(&dataset, &report);
        let link = "<a href=\"scenes/room/images/scene_cam_00_final_preview/frame.0000.tonemap.jpg\">room/cam_00/frame.0000</a>";
        assert!(bad.contains("Laws that fail") && bad.contains(link), "{bad}");
        assert!(bad.find("Laws that fail").unwrap() < bad.find("id=\"scenes\"").unwrap());
        assert!(!bad.contains("frame.0001.tonemap") && !bad.contains("<script") && !bad.contains("://"), "{bad}");
    }

    #[test]
    fn a_page_of_thousands_of_frames_shows_the_worst() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let mut report = verified(&dataset);
        let mut frame = report.frame_values[0].clone();
        frame.gates.insert(Gate::DepthRange, Some(0.1));
        report.frame_values = (0..3000).map(|number| FrameValues { frame: number, ..frame.clone() }).collect();
        report.frame_values[2999].gates.insert(Gate::Shading, Some(-1.0));
        let page = report_page(&dataset, &report);
        assert!(page.len() < 100_000, "{}", page.len());
        assert!(page.contains("3000 are rejected, here are 24 of them") && page.contains("frame.2999"));
    }
}
