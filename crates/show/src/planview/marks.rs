//! The signs and colours that charts and their legends share.

use crate::drawing::{Drawing, Ink, Point};
use crate::palette::viridis;
use std::f64::consts::TAU;

pub(super) const PAPER: [u8; 3] = [255; 3];
pub(super) const WALL: Ink = Ink::solid([26, 27, 30]);
pub(super) const WALL_PX: f32 = 2.6;
pub(super) const START: [u8; 3] = [200, 30, 70];
pub(super) const INK: Ink = Ink::solid([34, 35, 40]);
pub(super) const MUTED: Ink = Ink::solid([104, 107, 114]);

/// The colour of how often a point is seen: red for never, then viridis by the logarithm of the number of frames.
pub(super) fn times_color(times: u32, most: u32) -> [u8; 3] {
    if times == 0 { START } else { time_color(f64::from(times).ln() / f64::from(most.max(2)).ln()) }
}

/// The colour of time: viridis without its brightest end, which does not show on a light ground.
pub(super) fn time_color(place: f64) -> [u8; 3] {
    viridis(0.93 * place)
}

/// Opacity of a frustum by its score over the greatest one.
pub(super) fn score_opacity(share: f64) -> f32 {
    (0.04 + 0.36 * share.clamp(0.0, 1.0)) as f32
}

/// A cross.
pub(super) fn draw_target(page: &mut Drawing, [x, y]: Point, color: [u8; 3], opacity: f32) {
    const ARM: f32 = 3.6;
    let arms = vec![vec![[x - ARM, y - ARM], [x + ARM, y + ARM]], vec![[x - ARM, y + ARM], [x + ARM, y - ARM]]];
    page.lines(arms.clone(), 3.2, Ink::veil([255; 3], 0.7 * opacity));
    page.lines(arms, 1.4, Ink::veil(color, opacity));
}

/// A dashed line.
pub(super) fn dashes(from: Point, to: Point) -> Vec<Vec<Point>> {
    const DASH: f32 = 5.0;
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    let at = |s: f32| [0, 1].map(|c| from[c] + (to[c] - from[c]) * (s / length).min(1.0));
    (0..(length / (2.0 * DASH)).ceil() as usize).map(|i| 2.0 * DASH * i as f32).map(|s| vec![at(s), at(s + DASH)]).collect()
}

/// A ring with a gap for the mark inside it.
pub(super) fn start_mark(page: &mut Drawing, [x, y]: Point) {
    let ring = |radius: f32| -> Vec<Point> {
        (0..=48).map(|i| (f64::from(i) / 48.0 * TAU) as f32).map(|a| [x + radius * a.cos(), y + radius * a.sin()]).collect()
    };
    page.line(&ring(10.0), 4.6, Ink::veil([255; 3], 0.85));
    page.line(&ring(10.0), 2.2, Ink::solid(START));
}

/// A small note in the legend's colour.
pub(super) fn note(page: &mut Drawing, at: Point, words: String) {
    page.text(at, words, 9.5, MUTED);
}

/// Three digits that count, or all before the point.
pub(super) fn significant(value: f64) -> String {
    let digits = (2.0 - value.abs().max(1e-3).log10().floor()).clamp(0.0, 5.0) as usize;
    format!("{value:.digits$}")
}
