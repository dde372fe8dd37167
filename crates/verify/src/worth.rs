//! Whether a scene's frames are worth having at all: that light reaches them, and that most of the planned views are among them.

use super::card::Card;
use super::frame_values::FrameValues;
use super::law::Law;
use std::collections::BTreeMap;

/// Mean luminance of what is seen below which a frame is black, W/(sr m²), where 1 is about a thousand candela: what phones still show by
/// night is a hundred times brighter, and files in units of their own mostly are far brighter too.
const BLACK: f64 = 1e-5;

/// Share of the frames that are black, of those that have colour.
pub(super) fn check_light(scene: &str, values: &[FrameValues], card: &mut Card) {
    let means: Vec<(&FrameValues, f64)> = values.iter().filter_map(|frame| Some((frame, frame.mean_luminance?))).collect();
    let black: Vec<&FrameValues> = means.iter().filter(|(_, mean)| *mean < BLACK).map(|(frame, _)| *frame).collect();
    let place = || match black.first() {
        None => scene.to_string(),
        Some(first) => format!("{scene}: {} of {} frames, first {}", black.len(), means.len(), first.place()),
    };
    card.observe(Law::Lit, black.len() as f64 / means.len().max(1) as f64, place);
}

/// Share of the planned views that gates have rejected; `rejected` counts them by gate.
pub(super) fn check_views(scene: &str, planned: usize, rejected: &BTreeMap<String, usize>, card: &mut Card) {
    let count: usize = rejected.values().sum();
    let tally = || rejected.iter().map(|(gate, n)| format!("{n} {gate}")).collect::<Vec<_>>().join(", ");
    card.observe(Law::Worthwhile, count as f64 / planned.max(1) as f64, || match count {
        0 => scene.to_string(),
        _ => format!("{scene}: {count} of {planned} views: {}", tally()),
    });
}
