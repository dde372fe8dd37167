//! What moves while the shutter is open: the scene in equal stretches of the exposure, so short that nothing moves far in one.

use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{Body, CameraView, Scene};

/// A stretch of an exposure is so short that nothing moves farther in it, in pixels.
const STRETCH_PX: f64 = 1.5;
/// The most stretches of an exposure, and the most triangles of the scenes of all.
const STRETCHES: usize = 32;
const TRIANGLES: usize = 6_000_000;
/// Things count as at least so far from the camera, metres.
const NEAREST_M: f64 = 0.1;
/// Pieces of an exposure in which the way of things is measured.
const PIECES: usize = 8;

/// The scene in the middle of equal stretches of an exposure around a moment.
pub(super) fn stretches(scene: &Scene, view: &CameraView<'_>, now: f64) -> Vec<Scene> {
    let exposure_s = view.camera().shutter.map_or(0.0, |shutter| shutter.exposure_s);
    let way_px = way_px(scene, view, now, exposure_s);
    if way_px == 0.0 {
        return Vec::new();
    }
    let triangles: usize = scene.parts.iter().map(|part| scene.meshes[part.mesh as usize].triangles.len()).sum();
    let most = (TRIANGLES / triangles.max(1)).clamp(2, STRETCHES);
    let count = ((way_px / STRETCH_PX).ceil() as usize).clamp(2, most);
    (0..count).map(|stretch| scene.at(now + exposure_s * ((stretch as f64 + 0.5) / count as f64 - 0.5))).collect()
}

/// The longest way of a corner of a part's box as the camera sees it during an exposure, in pixels of the middle of the picture.
fn way_px(scene: &Scene, view: &CameraView<'_>, now: f64, exposure_s: f64) -> f64 {
    if exposure_s == 0.0 {
        return 0.0;
    }
    let [width, height] = view.camera().size().map(f64::from);
    let pixel_angle = f64::from(view.pixel_angle(0.5 * width, 0.5 * height));
    let times_s: Vec<f64> = (0..=PIECES).map(|piece| now + exposure_s * (piece as f64 / PIECES as f64 - 0.5)).collect();
    let moments: Vec<_> = times_s.iter().map(|&time_s| scene.world_from_rest(time_s)).collect();
    let seen = |pair: &[DVec3]| pair[0].distance(pair[1]) / pair[0].distance(view.pose().position).max(NEAREST_M);
    let mut longest = 0.0f64;
    for body in scene.bodies.iter().zip(0..).filter(|(body, _)| body.motion.shape_at(now).is_some()) {
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
