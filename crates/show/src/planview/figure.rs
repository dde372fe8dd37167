//! A trajectory on a chart: surfaces that the plane cuts, the path of the camera, its frusta and targets.

use super::chart::Chart;
use super::coverage::SurfacePoint;
use super::cut::{Cut, Look, joined};
use super::legend;
use super::marks::{INK, PAPER, START, WALL, WALL_PX, dashes, draw_target, score_opacity, start_mark, time_color, times_color};
use super::planned::Planned;
use super::relief::relief;
use super::subject::Subject;
use crate::drawing::{Anchor, Drawing, Ink, Point, Text};
use enfilade_math::DVec3;
use enfilade_math::quantile;
use enfilade_scene::{Camera, Pose};

/// Width of the pages, pixels.
const WIDTH: u32 = 1600;
const MARGIN: u32 = 40;
const HEADER: u32 = 92;
/// Between the chart and its legend.
const GUTTER: u32 = 36;
const LEGEND: u32 = 276;
/// Least and greatest height of a chart.
const CHART_HEIGHT: [u32; 2] = [620, 1150];
const FOOTER: u32 = 40;
/// Free space is drawn with this much around it, metres.
const SURROUNDINGS_M: f64 = 0.35;
/// Interval of poses at which one is numbered and joined to its target.
const NUMBERED: usize = 10;

const WHITE: Ink = Ink::solid([255; 3]);

/// The page that shows `subject` cut by the chart's plane. `title` names the kind of drawing.
pub(super) fn figure(subject: &Subject<'_>, cut: Cut, title: &str) -> Drawing {
    let (mut page, chart) = ground(subject, cut, &format!("{title} at"));
    draw_way(&mut page, subject, &chart);
    draw_starts(&mut page, subject.planned, &chart);
    draw_numbers(&mut page, subject, &chart);
    legend::column(&mut page, legend_place(&chart), subject, &chart);
    page
}

/// A page with its title, and the chart of space and surfaces on it.
fn ground(subject: &Subject<'_>, cut: Cut, title: &str) -> (Drawing, Chart) {
    let width = WIDTH - 2 * MARGIN - GUTTER - LEGEND;
    let chart = Chart::fit(cut, shown_box(subject), [MARGIN, MARGIN + HEADER], width, CHART_HEIGHT);
    let [left, top, _, height] = chart.place;
    let mut page = Drawing::new(WIDTH, top + height + FOOTER + MARGIN, PAPER);
    legend::header(&mut page, [MARGIN as f32, MARGIN as f32], subject, &format!("{title} {}", cut.name()));
    page.picture([left as f32, top as f32], relief(subject.planned, &chart));
    draw_surfaces(&mut page, subject.planned, &chart);
    legend::scale_bar(&mut page, &chart);
    legend::axes(&mut page, &chart);
    (page, chart)
}

fn legend_place(chart: &Chart) -> Point {
    let [left, top, width, _] = chart.place;
    [(left + width + GUTTER) as f32, top as f32]
}

/// The page that shows which surfaces behind the plane are seen, and how often.
pub(super) fn coverage_figure(subject: &Subject<'_>, cut: Cut) -> Drawing {
    let (mut page, chart) = ground(subject, cut, "Coverage up to");
    let most = subject.points.iter().map(|point| point.times).max().unwrap_or(0);
    let mut behind: Vec<&SurfacePoint> = subject.points.iter().filter(|point| cut.height_over(point.p_world) <= 0.0).collect();
    behind.sort_by(|a, b| cut.height_over(a.p_world).total_cmp(&cut.height_over(b.p_world)));
    for point in behind {
        let place = chart.to_page(point.p_world);
        if chart.holds(place) {
            page.disc(place, 2.0, Ink::solid(times_color(point.times, most)));
        }
    }
    legend::coverage_column(&mut page, legend_place(&chart), subject, most);
    page
}

/// Free space within the scene, and all of the trajectory, with some surroundings.
fn shown_box(subject: &Subject<'_>) -> (DVec3, DVec3) {
    let bounds = subject.planned.world.bounds;
    let (scene_min, scene_max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let (low, high) = subject.planned.free_bounds().unwrap_or((scene_min, scene_max));
    let points = subject.trajectory.poses.iter().flat_map(|pose| [pose.position, pose.look_at]);
    let inside = (low.max(scene_min), high.min(scene_max));
    let (min, max) = points.fold(inside, |(min, max), p| (min.min(p), max.max(p)));
    (min - DVec3::splat(SURROUNDINGS_M), max + DVec3::splat(SURROUNDINGS_M))
}

fn draw_surfaces(page: &mut Drawing, planned: &Planned<'_>, chart: &Chart) {
    let runs = joined(&chart.cut.lines(planned.world));
    let inside = |run: Vec<DVec3>| clipped(chart, run.into_iter().map(|p| chart.to_page(p)).collect());
    page.lines(runs.into_iter().flat_map(inside).collect(), WALL_PX, WALL);
}

/// The pieces of a run that are in the chart. A segment across the border is cut at it (Liang & Barsky 1984).
fn clipped(chart: &Chart, run: Vec<Point>) -> Vec<Vec<Point>> {
    let [left, top, width, height] = chart.place.map(|v| v as f32);
    let (low, high) = ([left, top], [left + width, top + height]);
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    for pair in run.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let (mut from, mut to) = (0.0f32, 1.0f32);
        for axis in 0..2 {
            let d = b[axis] - a[axis];
            let (mut enter, mut leave) = ((low[axis] - a[axis]) / d, (high[axis] - a[axis]) / d);
            if d < 0.0 {
                (enter, leave) = (leave, enter);
            }
            if d == 0.0 {
                let within = (low[axis]..=high[axis]).contains(&a[axis]);
                (enter, leave) = if within { (0.0, 1.0) } else { (1.0, 0.0) };
            }
            (from, to) = (from.max(enter), to.min(leave));
        }
        if from >= to {
            continue;
        }
        let at = |t: f32| {
            if t == 0.0 {
                a
            } else if t == 1.0 {
                b
            } else {
                [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
            }
        };
        match pieces.last_mut().filter(|piece| piece.last() == Some(&at(from))) {
            Some(piece) => piece.push(at(to)),
            None => pieces.push(vec![at(from), at(to)]),
        }
    }
    pieces
}

fn draw_way(page: &mut Drawing, subject: &Subject<'_>, chart: &Chart) {
    let poses = &subject.trajectory.poses;
    let greatest = subject.measures.iter().map(|m| m.score).fold(f64::MIN_POSITIVE, f64::max);
    let colors: Vec<[u8; 3]> = (0..poses.len()).map(|i| time_color(i as f64 / (poses.len().max(2) - 1) as f64)).collect();
    let length_m = frustum_length_m(chart, poses);
    for (i, pose) in poses.iter().enumerate() {
        let share = subject.measures[i].score / greatest;
        draw_frustum(page, chart, subject.camera, pose, length_m, colors[i], score_opacity(share));
    }
    let numbered = |i: usize| i.is_multiple_of(NUMBERED);
    for (i, pose) in poses.iter().enumerate().filter(|(i, _)| numbered(*i)) {
        let (from, to) = (chart.to_page(pose.position), chart.to_page(pose.look_at));
        page.lines(dashes(from, to), 1.0, Ink::veil(colors[i], 0.9));
    }
    for (i, pose) in poses.iter().enumerate() {
        draw_target(page, chart.to_page(pose.look_at), colors[i], if numbered(i) { 1.0 } else { 0.7 });
    }
    for (i, pair) in poses.windows(2).enumerate() {
        let ends = [pair[0].position, pair[1].position].map(|p| chart.to_page(p));
        page.line(&ends, 1.1, Ink::veil(colors[i], 0.6));
    }
    for (i, pose) in poses.iter().enumerate() {
        let center = chart.to_page(pose.position);
        let radius = if numbered(i) { 5.0 } else { 3.0 };
        page.disc(center, radius + 1.1, WHITE);
        page.disc(center, radius, Ink::solid(colors[i]));
    }
}

/// The number of every tenth frame beside its camera.
fn draw_numbers(page: &mut Drawing, subject: &Subject<'_>, chart: &Chart) {
    for pose in subject.trajectory.poses.iter().step_by(NUMBERED) {
        let [x, y] = chart.to_page(pose.position);
        // Beside the dot, away from the view, so that the number does not cover the frustum.
        let [right, up, _] = chart.cut.look.axes();
        let behind = pose.world_from_camera.z_axis;
        let d = enfilade_math::DVec2::new(behind.dot(right), -behind.dot(up)).normalize_or(enfilade_math::DVec2::X);
        let at = [x + 21.0 * d.x as f32, y + 19.0 * d.y as f32 + 5.0];
        page.write(Text {
            at,
            words: pose.frame.to_string(),
            height: 10.0,
            bold: true,
            anchor: Anchor::Middle,
            ink: INK,
            halo: Some(WHITE),
        });
    }
}

/// Metres. Longer where poses are farther from each other, within bounds that can be seen and leave the chart to be seen.
fn frustum_length_m(chart: &Chart, poses: &[Pose]) -> f64 {
    let nearest = |pose: &Pose| {
        let others = poses.iter().filter(|other| other.frame != pose.frame);
        others.map(|other| other.position.distance(pose.position)).fold(f64::INFINITY, f64::min)
    };
    let mut spacing: Vec<f64> = poses.iter().map(nearest).collect();
    let spacing_m = quantile(&mut spacing, 0.5).unwrap_or(f64::INFINITY);
    let chart_m = f64::from(chart.place[2]) / chart.scale;
    (1.4 * spacing_m).clamp(0.022 * chart_m, 0.045 * chart_m)
}

/// The ends of the field of view at `depth_m` before a pose: the middles of the image's left and right border, or in a section of
/// its upper and lower one. `None` for cameras that see too much for it.
fn field_of_view(camera: &Camera, pose: &Pose, look: Look, depth_m: f64) -> Option<[DVec3; 2]> {
    let [w, h] = camera.size().map(f64::from);
    let ends = if look == Look::Down { [(0.0, 0.5 * h), (w, 0.5 * h)] } else { [(0.5 * w, 0.0), (0.5 * w, h)] };
    let at = |(x, y)| {
        let ray = camera.projection.ray(x, y).filter(|ray| ray.z < -0.2 * ray.length())?;
        Some(pose.position + pose.world_from_camera * (ray * (depth_m / -ray.z)))
    };
    Some([at(ends[0])?, at(ends[1])?])
}

fn draw_frustum(page: &mut Drawing, chart: &Chart, camera: &Camera, pose: &Pose, length_m: f64, color: [u8; 3], opacity: f32) {
    let apex = chart.to_page(pose.position);
    let edge = Ink::veil(color, (opacity + 0.25).min(1.0));
    let Some(ends) = field_of_view(camera, pose, chart.cut.look, length_m) else {
        // All around: a disc, and a hand that points forward.
        let ahead = chart.to_page(pose.position - length_m * pose.world_from_camera.z_axis);
        page.disc(apex, (length_m * chart.scale) as f32, Ink::veil(color, 0.4 * opacity));
        return page.line(&[apex, ahead], 1.0, edge);
    };
    let [left, right] = ends.map(|p| chart.to_page(p));
    page.area(&[apex, left, right], Ink::veil(color, opacity));
    page.line(&[apex, left, right, apex], 0.9, edge);
}

fn draw_starts(page: &mut Drawing, planned: &Planned<'_>, chart: &Chart) {
    for start in planned.starts {
        let center = chart.to_page(start.position);
        if !chart.holds(center) {
            continue;
        }
        start_mark(page, center);
        let words =
            crate::sheet::lettering::fit(&start.name, crate::sheet::lettering::Style { height: 9.5, weight: 0.115, color: [0; 3] }, 150.0);
        // On the side where there is room for it.
        let [left, _, width, _] = chart.place.map(|v| v as f32);
        let (aside, anchor) = if center[0] < left + width - 170.0 { (15.0, Anchor::Start) } else { (-15.0, Anchor::End) };
        let at = [center[0] + aside, center[1] - 11.0];
        page.write(Text { at, words, height: 9.5, bold: true, anchor, ink: Ink::solid(START), halo: Some(WHITE) });
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::with_planned;
    use super::*;
    use crate::drawing::{Shape, svg};
    use crate::planview::measure::FrameMeasures;
    use enfilade_scene::Trajectory;
    use enfilade_scene::{Intrinsics, Projection};

    #[test]
    fn a_single_pose_has_its_frustum() {
        with_planned(|planned| {
            let (camera, trajectory) = &planned.filmed[0];
            let one = Trajectory { name: "cam_00".into(), poses: trajectory.poses[..1].to_vec() };
            let measures = [FrameMeasures { score: 1.0, ..FrameMeasures::default() }];
            let subject = Subject { planned, camera, trajectory: &one, measures: &measures, points: &[], report: None };
            let mut page = figure(&subject, Cut { look: Look::Down, through: one.poses[0].position }, "Plan");
            // Their bytes as text may be anything.
            page.shapes.retain(|shape| !matches!(shape, Shape::Picture { .. }));
            assert!(!svg(&page).contains("NaN"));
        });
    }

    #[test]
    fn frusta_span_the_field_of_view() {
        let camera: Camera = Intrinsics::from_fov_x(640, 480, std::f64::consts::FRAC_PI_2).into();
        let pose = Pose::look_at(0, DVec3::new(1.0, 2.0, 1.5), DVec3::new(3.0, 2.0, 1.5), DVec3::Z).unwrap();
        // 90 degrees wide: 2 m to either side at 2 m; 3/4 of that up and down. Image right is −y when looking along +x.
        let across = [DVec3::new(3.0, 4.0, 1.5), DVec3::new(3.0, 0.0, 1.5)];
        let upright = [DVec3::new(3.0, 2.0, 3.0), DVec3::new(3.0, 2.0, 0.0)];
        for (look, expected) in [(Look::Down, across), (Look::AlongY, upright), (Look::AgainstX, upright)] {
            let found = field_of_view(&camera, &pose, look, 2.0).unwrap();
            assert!((0..2).all(|i| found[i].distance(expected[i]) < 1e-9), "{look:?}: {found:?}");
        }
        let around: Camera = Projection::Equirectangular { width: 64, height: 32 }.into();
        assert_eq!(field_of_view(&around, &pose, Look::Down, 2.0), None);
    }

    #[test]
    fn lines_end_at_the_border_of_the_chart() {
        let cut = Cut { look: Look::Down, through: DVec3::ZERO };
        let chart = Chart::fit(cut, (DVec3::ZERO, DVec3::ONE), [10, 10], 100, [100, 100]);
        let across = clipped(&chart, vec![[0.0, 50.0], [60.0, 50.0], [60.0, 200.0], [200.0, 200.0]]);
        assert_eq!(across, [vec![[10.0, 50.0], [60.0, 50.0], [60.0, 110.0]]]);
        assert!(clipped(&chart, vec![[0.0, 0.0], [0.0, 300.0]]).is_empty());
        let twice = clipped(&chart, vec![[60.0, 60.0], [300.0, 60.0], [300.0, 90.0], [60.0, 90.0]]);
        assert_eq!(twice.len(), 2);
    }
}
