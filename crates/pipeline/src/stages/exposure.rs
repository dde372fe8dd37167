//! What moves while a picture is exposed: the scene in equal stretches of the exposure, so short that nothing moves far in one.
//!
//! With a rolling shutter the exposure of the picture goes from that of the upper row to that of the lower one, and the rows whose own moments
//! are in one stretch are a band: their geometry layers show the scene in its middle.

use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{Body, CameraView, Scene};

/// A stretch of an exposure is so short that nothing moves farther in it, in pixels.
const STRETCH_PX: f64 = 1.5;
/// A stretch that is a band of rows is shorter, since its border shows by how much things moved: pixels.
const BAND_PX: f64 = 0.5;
/// The most stretches of an exposure, and with a rolling shutter; the most triangles of the scenes of all.
const STRETCHES: usize = 32;
const BANDS: usize = 63;
const TRIANGLES: usize = 6_000_000;
/// Things count as at least so far from the camera, metres.
const NEAREST_M: f64 = 0.1;
/// Pieces of an exposure in which the way of things is measured.
const PIECES: usize = 8;

/// Equal stretches of the exposure of a picture around a moment, in the order of time.
pub(super) struct Stretches {
    /// The moment of the frame, seconds.
    now_s: f64,
    /// Time of all stretches.
    span_s: f64,
    count: usize,
    /// With a rolling shutter: the first row of each band, and the stretch whose middle it shows.
    pub bands: Vec<(u32, usize)>,
    /// How far something moves in a stretch at most, pixels.
    pub step_px: f64,
}

impl Stretches {
    /// The stretches of the exposure of a view; `None` if nothing moves in it.
    pub fn of(scene: &Scene, view: &CameraView<'_>, now_s: f64) -> Option<Self> {
        let shutter = view.camera().shutter?;
        let rolls = shutter.readout_s > 0.0;
        let span_s = shutter.exposure_s + shutter.readout_s;
        let way_px = way_px(scene, view, now_s, span_s);
        if way_px == 0.0 {
            return None;
        }
        let triangles: usize = scene.parts.iter().map(|part| scene.meshes[part.mesh as usize].triangles.len()).sum();
        let (stretch_px, most) = if rolls { (BAND_PX, BANDS) } else { (STRETCH_PX, STRETCHES) };
        let wanted = ((way_px / stretch_px).ceil() as usize).clamp(2, (TRIANGLES / triangles.max(1)).clamp(2, most));
        // The middle row shows the frame's own moment, which is the middle of a stretch.
        let count = if rolls { wanted / 2 * 2 + 1 } else { wanted };
        let bands = if rolls { bands(view, count) } else { Vec::new() };
        Some(Self { now_s, span_s, count, bands, step_px: way_px / count as f64 })
    }

    /// The middle of a stretch, seconds.
    pub fn time_s(&self, stretch: usize) -> f64 {
        if 2 * stretch + 1 == self.count {
            return self.now_s;
        }
        self.now_s + self.span_s * ((stretch as f64 + 0.5) / self.count as f64 - 0.5)
    }

    /// The scene in the middle of each.
    pub fn scenes(&self, scene: &Scene) -> Vec<Scene> {
        (0..self.count).map(|stretch| scene.at(self.time_s(stretch))).collect()
    }
}

/// The first row of each band of rows and the moment of the scene that its geometry shows: one band at the frame's moment, unless something
/// moves past a rolling shutter.
pub(super) fn moments(scene: &Scene, view: &CameraView<'_>, now_s: f64) -> Vec<(u32, f64)> {
    let rolls = view.camera().shutter.is_some_and(|shutter| shutter.readout_s > 0.0);
    let stretches = if rolls { Stretches::of(scene, view, now_s) } else { None };
    let times = |stretches: Stretches| stretches.bands.iter().map(|&(row, stretch)| (row, stretches.time_s(stretch))).collect();
    stretches.map_or_else(|| vec![(0, now_s)], times)
}

/// The first row of each band, and its stretch.
fn bands(view: &CameraView<'_>, count: usize) -> Vec<(u32, usize)> {
    let mut bands: Vec<(u32, usize)> = Vec::new();
    for row in 0..view.camera().size()[1] {
        let share = f64::from(view.exposure_share(f64::from(row) + 0.5, 0.5));
        let stretch = ((share * count as f64) as usize).min(count - 1);
        if bands.last().is_none_or(|(_, last)| *last != stretch) {
            bands.push((row, stretch));
        }
    }
    bands
}

/// The longest way of a corner of a part's box as the camera sees it in a time around a moment, in pixels of the middle of the picture.
fn way_px(scene: &Scene, view: &CameraView<'_>, now_s: f64, span_s: f64) -> f64 {
    if span_s == 0.0 {
        return 0.0;
    }
    let [width, height] = view.camera().size().map(f64::from);
    let pixel_angle = f64::from(view.pixel_angle(0.5 * width, 0.5 * height));
    let times_s: Vec<f64> = (0..=PIECES).map(|piece| now_s + span_s * (piece as f64 / PIECES as f64 - 0.5)).collect();
    let moments: Vec<_> = times_s.iter().map(|&time_s| scene.world_from_rest(time_s)).collect();
    let seen = |pair: &[DVec3]| pair[0].distance(pair[1]) / pair[0].distance(view.pose().position).max(NEAREST_M);
    let mut longest = 0.0f64;
    for body in scene.bodies.iter().zip(0..).filter(|(body, _)| body.motion.shape_at(now_s).is_some()) {
        let ways = vertex_ways(scene, body, (&times_s, &moments));
        longest = ways.iter().map(|way| way.windows(2).map(seen).sum()).fold(longest, f64::max);
    }
    for (body, id) in scene.bodies.iter().zip(0..) {
        for ends in body.parts.iter().map(|&part| scene.part_bounds(part)) {
            for corner in 0..8 {
                let p = DVec3::from_array([0, 1, 2].map(|axis| ends[corner >> axis & 1][axis]));
                let way: Vec<DVec3> = moments.iter().map(|maps: &Vec<DAffine3>| maps[id].transform_point3(p)).collect();
                longest = longest.max(way.windows(2).map(seen).sum());
            }
        }
    }
    longest / pixel_angle
}

/// The ways of the vertices of a part that deforms, world, by moment.
fn vertex_ways(scene: &Scene, (body, id): (&Body, usize), (times_s, moments): (&[f64], &[Vec<DAffine3>])) -> Vec<Vec<DVec3>> {
    let Some(&part) = body.parts.first() else { return Vec::new() };
    let mut ways: Vec<Vec<DVec3>> = Vec::new();
    for (&time_s, maps) in times_s.iter().zip(moments) {
        let Some(shape) = body.motion.shape_at(time_s) else { return Vec::new() };
        let placed = maps[id] * scene.parts[part as usize].world_from_mesh;
        ways.resize(shape.positions.len(), Vec::new());
        ways.iter_mut().zip(&shape.positions).for_each(|(way, p)| way.push(placed.transform_point3(p.as_dvec3())));
    }
    ways
}
