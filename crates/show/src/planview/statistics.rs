//! The page of statistics: how often each value occurs over the frames, and in which frame.

use super::chart::round_below;
use super::coverage::{SurfacePoint, seen_so_far};
use super::legend::header;
use super::look::Sight;
use super::marks::{INK, MUTED};
use super::marks::{PAPER, time_color};
use super::measure::FrameMeasures;
use super::subject::Subject;
use crate::drawing::{Anchor, Drawing, Ink, Point, Text};
use enfilade_math::quantile;

const WIDTH: u32 = 1600;
const MARGIN: f32 = 40.0;
const HEADER: f32 = 92.0;
const COLUMNS: usize = 3;
const PANEL: [f32; 2] = [490.0, 312.0];
const GAP: f32 = 25.0;
/// Heights within a panel: title, histogram, and the values frame by frame.
const TITLE: f32 = 34.0;
const HISTOGRAM: f32 = 148.0;
const SERIES: f32 = 58.0;
/// Bins of a histogram, about.
const BINS: f64 = 24.0;
/// Least width of an axis, in bins.
const LEAST_BINS: f64 = 10.0;
const BAR: Ink = Ink::solid([74, 118, 168]);
const GRID: Ink = Ink::solid([226, 228, 232]);
const MEDIAN: Ink = Ink::solid([200, 30, 70]);
const PUBLISHED: Ink = Ink::solid([222, 120, 20]);

/// Edge of a bin of [`HYPERSIM_DISTANCE`], metres.
const DISTANCE_BIN_M: f64 = 0.5;

/// Share of the valid pixels of all images of Hypersim by distance, in bins of 0.5 m from 0 to 20 m; 6 % are beyond. From the
/// image statistics that the toolkit publishes (`metadata_depth_hist_linear`, 59.9 billion pixels).
const HYPERSIM_DISTANCE: [f64; 40] = [
    0.0092, 0.0230, 0.0372, 0.0514, 0.0619, 0.0683, 0.0718, 0.0717, 0.0685, 0.0630, 0.0557, 0.0490, 0.0421, 0.0357, 0.0306, 0.0263, 0.0225,
    0.0194, 0.0165, 0.0141, 0.0122, 0.0105, 0.0092, 0.0082, 0.0073, 0.0065, 0.0059, 0.0053, 0.0048, 0.0044, 0.0040, 0.0036, 0.0032, 0.0030,
    0.0028, 0.0026, 0.0023, 0.0022, 0.0021, 0.0020,
];

/// The quantity of one panel.
struct Quantity {
    name: &'static str,
    unit: &'static str,
    /// The least width of a bin, so that rounding noise is not spread out.
    finest: f64,
    /// Values are never below this.
    low: f64,
    value: fn(&FrameMeasures) -> Option<f64>,
}

const fn quantity(name: &'static str, unit: &'static str, finest: f64, low: f64, value: fn(&FrameMeasures) -> Option<f64>) -> Quantity {
    Quantity { name, unit, finest, low, value }
}

const QUANTITIES: [Quantity; 9] = [
    quantity("height above the floor", "m", 0.01, f64::NEG_INFINITY, |m| Some(m.height_m)),
    quantity("roll", "°", 0.25, f64::NEG_INFINITY, |m| Some(m.roll_deg)),
    quantity("pitch", "°", 1.0, f64::NEG_INFINITY, |m| Some(m.pitch_deg)),
    quantity("step", "m", 0.02, 0.0, |m| m.step_m),
    quantity("turn", "°", 1.0, 0.0, |m| m.turn_deg),
    quantity("clearance", "m", 0.02, 0.0, |m| Some(m.clearance_m)),
    quantity("overlap", "", 0.02, 0.0, |m| m.overlap),
    quantity("void share", "", 0.005, 0.0, |m| Some(m.void_share)),
    quantity("score", "", 1e-3, 0.0, |m| Some(m.score)),
];

/// How far the pixels of views see.
pub(super) struct Distances {
    /// Counts by the bins of [`HYPERSIM_DISTANCE`].
    counts: [u64; HYPERSIM_DISTANCE.len()],
    /// All pixels, including those beyond the last bin.
    total: u64,
}

impl Default for Distances {
    fn default() -> Self {
        Self { counts: [0; HYPERSIM_DISTANCE.len()], total: 0 }
    }
}

impl Distances {
    /// Counts the pixels of a view that see a surface.
    pub fn add(&mut self, sight: &Sight) {
        for seen in sight.pixels.iter().flatten() {
            self.total += 1;
            if let Some(count) = self.counts.get_mut((seen.distance_m / DISTANCE_BIN_M) as usize) {
                *count += 1;
            }
        }
    }
}

/// The page for `subject`; `distances` are of the surfaces that its poses see.
pub(super) fn statistics(subject: &Subject<'_>, distances: &Distances) -> Drawing {
    let rows = (QUANTITIES.len() + 3).div_ceil(COLUMNS);
    let height = 2.0 * MARGIN + HEADER + rows as f32 * PANEL[1] + (rows - 1) as f32 * GAP;
    let mut page = Drawing::new(WIDTH, height as u32, PAPER);
    header(&mut page, [MARGIN, MARGIN], subject, "statistics over its frames");
    let place = |i: usize| [MARGIN + (i % COLUMNS) as f32 * (PANEL[0] + GAP), MARGIN + HEADER + (i / COLUMNS) as f32 * (PANEL[1] + GAP)];
    for (i, quantity) in QUANTITIES.iter().enumerate() {
        panel(&mut page, place(i), quantity, subject.measures);
    }
    seen_panel(&mut page, place(QUANTITIES.len()), subject);
    times_panel(&mut page, place(QUANTITIES.len() + 1), subject.points);
    distance_panel(&mut page, place(QUANTITIES.len() + 2), distances);
    page
}

/// Bins of equal width over some values.
#[derive(Clone, Debug, PartialEq)]
struct Histogram {
    low: f64,
    bin: f64,
    counts: Vec<usize>,
}

impl Histogram {
    /// About [`BINS`] bins of a round width, at least `finest`, that begin at a multiple of it.
    fn of(values: &[f64], finest: f64) -> Self {
        let (min, max) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)));
        let bin = round_below((max - min) / BINS * 1.999).max(finest);
        let low = (min / bin).floor() * bin;
        let bins = ((max - low) / bin).floor() as usize + 1;
        let mut counts = vec![0; bins];
        values.iter().for_each(|v| counts[(((v - low) / bin) as usize).min(bins - 1)] += 1);
        Self { low, bin, counts }
    }

    fn high(&self) -> f64 {
        self.low + self.bin * self.counts.len() as f64
    }
}

/// A horizontal axis on the page.
#[derive(Clone, Copy)]
struct Axis {
    left: f32,
    width: f32,
    low: f64,
    high: f64,
}

impl Axis {
    fn at(self, value: f64) -> f32 {
        self.left + self.width * ((value - self.low) / (self.high - self.low)) as f32
    }

    /// Ticks with their numbers below `y`, and lines up to `top`.
    fn draw(self, page: &mut Drawing, top: f32, y: f32, unit: &str) {
        let step = round_below((self.high - self.low) / 3.0);
        let digits = (-step.log10().floor()).max(0.0) as usize;
        let mut tick = (self.low / step).ceil() * step;
        while tick <= self.high + 1e-9 * step {
            let x = self.at(tick);
            page.line(&[[x, top], [x, y]], 1.0, GRID);
            // A zero that was reached by subtraction has no sign.
            let shown = if tick.abs() < 1e-9 * step { 0.0 } else { tick };
            let words = format!("{shown:.digits$}{}{unit}", if unit == "m" { " " } else { "" });
            page.write(Text { at: [x, y + 18.0], words, height: 9.5, bold: false, anchor: Anchor::Middle, ink: MUTED, halo: None });
            tick += step;
        }
    }
}

fn panel(page: &mut Drawing, [x, y]: Point, quantity: &Quantity, measures: &[FrameMeasures]) {
    let values: Vec<f64> = measures.iter().filter_map(quantity.value).filter(|v| v.is_finite()).collect();
    let Some(median) = quantile(&mut values.clone(), 0.5) else {
        return title(page, [x, y], quantity.name, "no values");
    };
    let (min, max) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)));
    title(page, [x, y], quantity.name, &summary(quantity, [min, median, max]));
    let histogram = Histogram::of(&values, quantity.finest);
    let margin = 0.02 * (histogram.high() - histogram.low);
    let high = (histogram.high() + margin).max(histogram.low + LEAST_BINS * histogram.bin);
    let axis = Axis { left: x, width: PANEL[0], low: (histogram.low - margin).max(quantity.low), high };
    let base = y + TITLE + HISTOGRAM;
    axis.draw(page, y + TITLE, base, quantity.unit);
    let most = histogram.counts.iter().copied().max().unwrap_or(1).max(1) as f32;
    for (i, &count) in histogram.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        let [from, to] = [i, i + 1].map(|i| axis.at(histogram.low + histogram.bin * i as f64));
        let height = (HISTOGRAM - 8.0) * count as f32 / most;
        page.bar([from + 0.75, base - height, (to - from - 1.5).max(0.5), height], BAR);
    }
    page.line(&[[x, base], [x + PANEL[0], base]], 1.2, MUTED);
    let words = if most == 1.0 { "1 frame".into() } else { format!("{most:.0} frames") };
    page.write(Text { at: [x + PANEL[0], y + TITLE], words, height: 8.5, bold: false, anchor: Anchor::End, ink: MUTED, halo: None });
    page.line(&[[axis.at(median), y + TITLE], [axis.at(median), base]], 1.8, MEDIAN);
    series(page, [x, base + 36.0], quantity, measures, [axis.low, axis.high]);
}

fn title(page: &mut Drawing, [x, y]: Point, name: &str, detail: &str) {
    page.write(Text { at: [x, y + 14.0], words: name.into(), height: 12.0, bold: true, anchor: Anchor::Start, ink: INK, halo: None });
    let at = [x + PANEL[0], y + 14.0];
    page.write(Text { at, words: detail.into(), height: 9.5, bold: false, anchor: Anchor::End, ink: MUTED, halo: None });
}

fn summary(quantity: &Quantity, [min, median, max]: [f64; 3]) -> String {
    let digits = if max.abs() >= 100.0 {
        0
    } else if quantity.unit == "°" {
        1
    } else {
        2
    };
    format!("median {median:.digits$}   {min:.digits$} to {max:.digits$} {}", quantity.unit)
}

/// A dot per frame in the colour of its time; values upward.
fn series(page: &mut Drawing, [x, y]: Point, quantity: &Quantity, measures: &[FrameMeasures], [low, high]: [f64; 2]) {
    page.bar([x, y, PANEL[0], SERIES], Ink::solid([247, 248, 250]));
    let last = (measures.len().max(2) - 1) as f32;
    let ends = [(measures.first(), x, Anchor::Start), (measures.last(), x + PANEL[0], Anchor::End)];
    for (m, at, anchor) in ends.into_iter().filter_map(|(m, at, anchor)| Some((m?, at, anchor))) {
        let words = format!("frame {}", m.frame);
        page.write(Text { at: [at, y + SERIES + 15.0], words, height: 8.5, bold: false, anchor, ink: MUTED, halo: None });
    }
    for (i, value) in measures.iter().enumerate().filter_map(|(i, m)| Some((i, (quantity.value)(m)?))).filter(|(_, v)| v.is_finite()) {
        let up = ((value - low) / (high - low)) as f32;
        let place = i as f32 / last;
        page.disc(
            [x + 6.0 + place * (PANEL[0] - 12.0), y + SERIES - 4.0 - up * (SERIES - 8.0)],
            2.4,
            Ink::solid(time_color(f64::from(place))),
        );
    }
}

/// The share of the surfaces that the frames up to each one have seen.
fn seen_panel(page: &mut Drawing, [x, y]: Point, subject: &Subject<'_>) {
    const LEVELS: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
    let frames = subject.trajectory.poses.len();
    let shares = seen_so_far(subject.points, frames);
    let detail = shares.last().map_or(String::new(), |last| format!("{:.1} % by the last frame", 100.0 * last));
    title(page, [x, y], "surfaces seen so far", &detail);
    let base = y + TITLE + HISTOGRAM + SERIES;
    let axis = Axis { left: x, width: PANEL[0], low: 0.0, high: frames.max(2) as f64 - 1.0 };
    axis.draw(page, y + TITLE, base, "");
    let level = |share: f64| base - (HISTOGRAM + SERIES) * share as f32;
    page.lines(LEVELS.map(|share| vec![[x, level(share)], [x + PANEL[0], level(share)]]).to_vec(), 1.0, GRID);
    let curve: Vec<Point> = shares.iter().enumerate().map(|(i, share)| [axis.at(i as f64), level(*share)]).collect();
    page.line(&curve, 2.4, BAR);
    for share in LEVELS {
        let (at, words) = ([x + 4.0, level(share) + 14.0], format!("{:.0} %", 100.0 * share));
        let halo = Some(Ink::veil(PAPER, 0.8));
        page.write(Text { at, words, height: 8.5, bold: false, anchor: Anchor::Start, ink: MUTED, halo });
    }
    page.line(&[[x, base], [x + PANEL[0], base]], 1.2, MUTED);
}

/// The share of the surfaces by the number of frames that see them.
fn times_panel(page: &mut Drawing, [x, y]: Point, points: &[SurfacePoint]) {
    const CLASSES: [(&str, u32); 8] =
        [("never", 0), ("1", 1), ("2", 2), ("3-5", 5), ("6-10", 10), ("11-20", 20), ("21-50", 50), ("more", u32::MAX)];
    title(page, [x, y], "surfaces by frames that see them", "");
    let base = y + TITLE + HISTOGRAM + SERIES;
    let mut counts = [0usize; CLASSES.len()];
    for point in points {
        let class = CLASSES.iter().position(|(_, most)| point.times <= *most).unwrap_or(CLASSES.len() - 1);
        counts[class] += 1;
    }
    let shares = counts.map(|count| count as f64 / points.len().max(1) as f64);
    let top = shares.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let step = PANEL[0] / CLASSES.len() as f32;
    for (i, ((name, _), share)) in CLASSES.into_iter().zip(shares).enumerate() {
        let (left, middle) = (x + step * i as f32, x + step * (i as f32 + 0.5));
        let height = (HISTOGRAM + SERIES - 24.0) * (share / top) as f32;
        page.bar([left + 4.0, base - height, step - 8.0, height], if i == 0 { MEDIAN } else { BAR });
        let label = |words: String, y: f32| Text {
            at: [middle, y],
            words,
            height: 9.0,
            bold: false,
            anchor: Anchor::Middle,
            ink: MUTED,
            halo: None,
        };
        page.write(label(format!("{:.1} %", 100.0 * share), base - height - 7.0));
        page.write(label(name.into(), base + 18.0));
    }
    page.line(&[[x, base], [x + PANEL[0], base]], 1.2, MUTED);
}

/// How far the pixels see, with the outline of all of Hypersim.
fn distance_panel(page: &mut Drawing, [x, y]: Point, distances: &Distances) {
    const SHOWN: usize = 30;
    let shares = distances.counts.map(|count| count as f64 / distances.total.max(1) as f64);
    let top = shares.iter().chain(&HYPERSIM_DISTANCE).copied().fold(f64::MIN_POSITIVE, f64::max);
    title(page, [x, y], "distance of what the pixels see", "");
    let axis = Axis { left: x, width: PANEL[0], low: 0.0, high: DISTANCE_BIN_M * SHOWN as f64 };
    let base = y + TITLE + HISTOGRAM;
    axis.draw(page, y + TITLE, base, "m");
    let height = |share: f64| (HISTOGRAM - 8.0) * (share / top) as f32;
    let mut outline = Vec::new();
    for i in 0..SHOWN {
        let [from, to] = [i, i + 1].map(|i| axis.at(DISTANCE_BIN_M * i as f64));
        page.bar([from + 0.75, base - height(shares[i]), to - from - 1.5, height(shares[i])], BAR);
        let level = base - height(HYPERSIM_DISTANCE[i]);
        outline.extend([[from, level], [to, level]]);
    }
    page.line(&outline, 1.8, PUBLISHED);
    page.line(&[[x, base], [x + PANEL[0], base]], 1.2, MUTED);
    for (row, (ink, words)) in
        [(BAR, "this trajectory, share of the pixels"), (PUBLISHED, "all images of Hypersim")].into_iter().enumerate()
    {
        let at = base + 52.0 + 26.0 * row as f32;
        page.line(&[[x + 2.0, at - 4.0], [x + 24.0, at - 4.0]], 5.0, ink);
        page.text([x + 36.0, at], words, 10.0, INK);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_is_in_its_bin() {
        let values: Vec<f64> = (0..100).map(|i| 1.2 + 0.005 * f64::from(i)).collect();
        let histogram = Histogram::of(&values, 0.01);
        assert_eq!(histogram.counts.iter().sum::<usize>(), 100);
        assert!((10..=60).contains(&histogram.counts.len()), "{histogram:?}");
        assert!(histogram.low <= 1.2 && histogram.high() >= 1.695);
        assert_eq!(Histogram::of(&[0.0; 7], 0.05), Histogram { low: 0.0, bin: 0.05, counts: vec![7] });
    }

    #[test]
    fn the_published_shares_and_what_lies_beyond_are_all_pixels() {
        let shown: f64 = HYPERSIM_DISTANCE.iter().sum();
        assert!((shown + 0.06 - 1.0).abs() < 2e-3, "{shown}");
    }
}
