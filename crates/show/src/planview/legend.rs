//! Lettering around a chart: title, scale, axes, and the meaning of each sign.

use super::chart::{Chart, round_below};
use super::cut::Look;
use super::marks::{INK, MUTED, WALL, WALL_PX, draw_target, note, score_opacity, significant, start_mark, time_color, times_color};
use super::relief::{FREE, FREE_OVER_VOID, NEAR, OCCUPIED, UNKNOWN, UNKNOWN_HATCH};
use super::subject::Subject;
use crate::drawing::{Anchor, Drawing, Ink, Point, Text};

const LETTERS: f32 = 10.5;
const LINE: f32 = 27.0;
/// Width of the signs before their meanings.
const SIGN: f32 = 44.0;

/// Scene, camera and what the page shows.
pub(super) fn header(page: &mut Drawing, [x, y]: Point, subject: &Subject<'_>, title: &str) {
    let frames = subject.trajectory.poses.len();
    let fov = subject.camera.projection.fov_x_rad(std::f64::consts::TAU).to_degrees();
    let words = format!("{}  ·  {}", subject.planned.scene, subject.trajectory.name);
    page.write(Text { at: [x, y + 24.0], words, height: 23.0, bold: true, anchor: Anchor::Start, ink: INK, halo: None });
    let frames = if frames == 1 { "1 frame".into() } else { format!("{frames} frames") };
    page.text([x, y + 58.0], format!("{title}  ·  {frames}  ·  {fov:.0}° wide"), 13.0, MUTED);
}

/// A bar of a round length at the lower left of the chart, below it.
pub(super) fn scale_bar(page: &mut Drawing, chart: &Chart) {
    let [left, top, width, height] = chart.place.map(|v| v as f32);
    let length_m = round_below(0.3 * f64::from(width) / chart.scale);
    let pixels = (length_m * chart.scale) as f32;
    let (x, y) = (left, top + height + 18.0);
    for (i, ink) in [INK, Ink::solid([255; 3]), INK, Ink::solid([255; 3])].into_iter().enumerate() {
        page.bar([x + 0.25 * pixels * i as f32, y, 0.25 * pixels, 7.0], ink);
    }
    let frame = [[x, y], [x + pixels, y], [x + pixels, y + 7.0], [x, y + 7.0], [x, y]];
    page.line(&frame, 1.2, INK);
    let words = if length_m >= 1.0 { format!("{length_m:.0} m") } else { format!("{:.0} cm", 100.0 * length_m) };
    page.text([x + pixels + 12.0, y + 9.0], words, LETTERS, INK);
}

/// Arrows along the axes above the right end of the chart.
pub(super) fn axes(page: &mut Drawing, chart: &Chart) {
    const LENGTH: f32 = 44.0;
    let [left, top, width, _] = chart.place.map(|v| v as f32);
    let (x, y) = (left + width - LENGTH - 20.0, top - 22.0);
    let [right, up] = chart.cut.look.axis_names();
    for (tip, barbs, name, at) in [
        ([x + LENGTH, y], [[x + LENGTH - 9.0, y - 5.0], [x + LENGTH - 9.0, y + 5.0]], right, [x + LENGTH + 12.0, y + 4.0]),
        ([x, y - LENGTH], [[x - 5.0, y - LENGTH + 9.0], [x + 5.0, y - LENGTH + 9.0]], up, [x, y - LENGTH - 11.0]),
    ] {
        page.line(&[[x, y], tip], 2.0, INK);
        page.area(&[tip, barbs[0], barbs[1]], INK);
        page.line(&[tip, barbs[0], barbs[1], tip], 1.0, INK);
        page.write(Text { at, words: name.into(), height: 11.0, bold: true, anchor: Anchor::Middle, ink: INK, halo: None });
    }
}

/// The column of signs and numbers beside the chart.
pub(super) fn column(page: &mut Drawing, [x, y]: Point, subject: &Subject<'_>, chart: &Chart) {
    let mut y = time_bar(page, [x, y], subject);
    y = score_steps(page, [x, y], subject);
    y = signs(page, [x, y], chart);
    numbers(page, [x, y], subject);
}

/// The column beside a chart of surface points: `most` is how often the point that is seen most often is seen.
pub(super) fn coverage_column(page: &mut Drawing, [x, mut y]: Point, subject: &Subject<'_>, most: u32) {
    heading(page, [x, y], "seen in so many frames");
    y += 30.0;
    let steps = [0, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
    for times in steps.into_iter().filter(|times| *times <= most) {
        page.disc([x + 17.0, y + 5.0], 6.0, Ink::solid(times_color(times, most)));
        let words = if times == 0 { "none".into() } else { times.to_string() };
        page.text([x + SIGN, y + 10.0], words, LETTERS, INK);
        y += LINE;
    }
    y += 18.0;
    heading(page, [x, y], "of all such surfaces");
    y += 34.0;
    let total = subject.points.len().max(1) as f64;
    for least in [1, 2, 5, 10] {
        let share = subject.points.iter().filter(|point| point.times >= least).count() as f64 / total;
        let times = if least == 1 { "seen at all".into() } else { format!("{least} times or more") };
        note(page, [x, y], times);
        page.text([x + 152.0, y], format!("{:.1} %", 100.0 * share), LETTERS - 0.5, INK);
        y += 23.0;
    }
}

fn heading(page: &mut Drawing, [x, y]: Point, words: &str) {
    page.write(Text { at: [x, y + 10.0], words: words.into(), height: LETTERS, bold: true, anchor: Anchor::Start, ink: INK, halo: None });
}

fn time_bar(page: &mut Drawing, [x, y]: Point, subject: &Subject<'_>) -> f32 {
    const STEPS: usize = 60;
    heading(page, [x, y], "frame");
    for i in 0..STEPS {
        let color = time_color(i as f64 / (STEPS - 1) as f64);
        page.bar([x + 4.0 * i as f32, y + 22.0, 4.5, 14.0], Ink::solid(color));
    }
    let poses = &subject.trajectory.poses;
    let [first, last] = [poses.first(), poses.last()].map(|pose| pose.map_or(0, |p| p.frame).to_string());
    page.text([x, y + 54.0], first, LETTERS, INK);
    page.write(Text { at: [x + 240.0, y + 54.0], words: last, height: LETTERS, bold: false, anchor: Anchor::End, ink: INK, halo: None });
    y + 84.0
}

/// Frusta of five scores up to the greatest.
fn score_steps(page: &mut Drawing, [x, y]: Point, subject: &Subject<'_>) -> f32 {
    let greatest = subject.measures.iter().map(|m| m.score).fold(0.0, f64::max);
    heading(page, [x, y], "view, denser: higher score");
    for i in 0..5 {
        let share = f64::from(i) / 4.0;
        let (left, color) = (x + 48.0 * i as f32, time_color(0.35));
        let wedge = [[left, y + 38.0], [left + 38.0, y + 24.0], [left + 38.0, y + 52.0]];
        page.area(&wedge, Ink::veil(color, score_opacity(share)));
        page.line(&[wedge[0], wedge[1], wedge[2], wedge[0]], 0.9, Ink::veil(color, score_opacity(share) + 0.25));
    }
    page.text([x, y + 72.0], "0", LETTERS, INK);
    let words = significant(greatest);
    page.write(Text { at: [x + 228.0, y + 72.0], words, height: LETTERS, bold: false, anchor: Anchor::End, ink: INK, halo: None });
    y + 100.0
}

fn signs(page: &mut Drawing, [x, mut y]: Point, chart: &Chart) -> f32 {
    let behind = if chart.cut.look == Look::Down { "below" } else { "behind" };
    let color = time_color(0.35);
    let mut row = |page: &mut Drawing, draw: &dyn Fn(&mut Drawing, Point), meaning: &str| {
        draw(page, [x + 17.0, y + 5.0]);
        page.text([x + SIGN, y + 10.0], meaning, LETTERS, INK);
        y += LINE;
    };
    let swatch = |color: [u8; 3]| {
        move |page: &mut Drawing, [cx, cy]: Point| {
            page.bar([cx - 17.0, cy - 9.0, 34.0, 18.0], Ink::solid(color));
            page.line(&corners([cx - 17.0, cy - 9.0, 34.0, 18.0]), 0.8, Ink::solid([170, 172, 176]));
        }
    };
    row(
        page,
        &|page, at| {
            page.disc(at, 5.0, Ink::solid(color));
        },
        "camera, with its frame",
    );
    row(page, &|page, at| draw_target(page, at, color, 1.0), "look-at target");
    row(page, &|page, at| start_mark(page, at), "start camera");
    row(
        page,
        &|page, [cx, cy]| page.line(&[[cx - 16.0, cy], [cx + 16.0, cy]], WALL_PX, WALL),
        &format!("surface cut at {}", chart.cut.name()),
    );
    row(page, &swatch(FREE), "free space");
    row(page, &swatch(NEAR), &format!("free, surface close {behind}"));
    row(page, &swatch(FREE_OVER_VOID), &format!("free, nothing {behind}"));
    row(page, &swatch(OCCUPIED), "voxel with a surface");
    row(
        page,
        &|page, at| {
            swatch(UNKNOWN)(page, at);
            let hatch = |i: f32| vec![[at[0] - 17.0 + i, at[1] + 9.0], [at[0] + 1.0 + i, at[1] - 9.0]];
            page.lines([0.0, 8.0, 16.0].map(hatch).to_vec(), 1.0, Ink::solid(UNKNOWN_HATCH));
        },
        "unknown",
    );
    y + 18.0
}

fn corners([x, y, w, h]: [f32; 4]) -> [Point; 5] {
    [[x, y], [x + w, y], [x + w, y + h], [x, y + h], [x, y]]
}

fn numbers(page: &mut Drawing, [x, mut y]: Point, subject: &Subject<'_>) {
    let of = |value: fn(&super::measure::FrameMeasures) -> f64| subject.measures.iter().map(value);
    let range = |low: f64, high: f64, digits: usize, unit: &str| format!("{low:.digits$} to {high:.digits$}{unit}");
    let span = |value: fn(&super::measure::FrameMeasures) -> f64| {
        (of(value).fold(f64::INFINITY, f64::min), of(value).fold(f64::NEG_INFINITY, f64::max))
    };
    let way_m: f64 = subject.measures.iter().filter_map(|m| m.step_m).sum();
    let seen = subject.points.iter().filter(|point| point.times > 0).count() as f64 / subject.points.len().max(1) as f64;
    let (height, clearance, roll) = (span(|m| m.height_m), span(|m| m.clearance_m), span(|m| m.roll_deg));
    heading(page, [x, y], "this trajectory");
    y += 34.0;
    for (name, value) in [
        ("way", format!("{way_m:.1} m")),
        ("above floor", range(height.0, height.1, 2, " m")),
        ("clearance", format!("{:.2} m or more", clearance.0)),
        ("surfaces", format!("{:.0} % seen", 100.0 * seen)),
        ("roll", range(roll.0, roll.1, 1, "°")),
    ] {
        if !subject.measures.is_empty() {
            note(page, [x, y], name.into());
            page.text([x + 116.0, y], value, LETTERS - 0.5, INK);
            y += 23.0;
        }
    }
}
