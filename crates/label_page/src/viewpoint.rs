//! A place from which pieces are seen well: not within a wall, not below the floor, not behind other things.
//!
//! Places in several directions and distances are tried, and rays measure how much of the pieces each sees: points of their faces, weighted
//! by how squarely they face the place.

use super::action::{Context, Refusal};
use super::camera::CameraRequest;
use super::stroke::VisibleScene;
use enfilade_geometry::Bvh;
use enfilade_math::{Bounds3, Ray, Vec3};
use enfilade_serve::area_m2;
use std::collections::HashSet;

/// Points of the pieces that are looked for from each place.
const POINTS: usize = 64;
/// Heights of the directions that are tried, degrees above the horizontal.
const PITCHES_DEG: [f32; 4] = [20.0, 45.0, 70.0, -30.0];
/// Turns from the camera's own direction, degrees.
const TURNS_DEG: [f32; 6] = [0.0, 60.0, -60.0, 120.0, -120.0, 180.0];
/// Distances that are tried, as shares of the one at which the pieces fill a good part of the picture.
const NEARER: [f32; 4] = [1.0, 0.7, 0.45, 0.3];
/// Ratio of the distance at which a ball fills a good part of the picture to the distance at which it fills all of it.
const ROOM: f32 = 1.4;
/// Smaller pieces are looked at as if they had this radius, metres.
const SMALLEST_M: f32 = 0.15;
/// Bonuses added to the share that is seen: for being inside, with something above and below, and for looking the same way as before.
const INSIDE: f32 = 0.2;
const SAME_WAY: f32 = 0.1;

/// A place for the camera, and the point to look at, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    pub from: Vec3,
    pub to: Vec3,
}

/// The pieces to look at.
struct Target<'a> {
    scene: VisibleScene<'a>,
    pieces: &'a HashSet<u32>,
    /// Points of their faces, with unit normals.
    points: Vec<(Vec3, Vec3)>,
    centre: Vec3,
    radius: f32,
    /// Surfaces outside of this box hide nothing.
    clip: Option<Bounds3>,
}

impl Context<'_> {
    /// From where these pieces are seen well by a camera that is turned as this one is; `None` for pieces without faces.
    ///
    /// # Errors
    /// When the camera or a piece number is wrong.
    pub fn viewpoint(&self, camera: &CameraRequest, pieces: &[u32], hidden: &[u32]) -> Result<Option<Viewpoint>, Refusal> {
        let camera = camera.check().map_err(Refusal::request)?;
        self.check_pieces("pieces", pieces)?;
        self.check_pieces("hidden", hidden)?;
        let pieces: HashSet<u32> = pieces.iter().copied().collect();
        let hidden: HashSet<u32> = hidden.iter().copied().filter(|piece| !pieces.contains(piece)).collect();
        let scene = VisibleScene { bvh: self.bvh, piece_of_face: self.pieces.of_face(), hidden: &hidden };
        let Some(target) = Target::new(self, scene, &pieces, camera.clip) else { return Ok(None) };
        let distance = ROOM * target.radius / camera.half_angle().sin();
        let own = -camera.ray(0.5 * f64::from(camera.width), 0.5 * f64::from(camera.height)).direction;
        let places: Vec<(f32, Vec3)> =
            backs(own).into_iter().flat_map(|back| NEARER.map(|share| (share, target.centre + share * distance * back))).collect();
        let worth = |&(share, from): &(f32, Vec3)| {
            let same_way = 0.5 + 0.5 * (from - target.centre).normalize().dot(own);
            target.seen_from(from) * (0.7 + 0.3 * share) + SAME_WAY * same_way + if is_inside(self.bvh, from) { INSIDE } else { 0.0 }
        };
        let worths: Vec<f32> = enfilade_parallel::map(&places, worth);
        let best = (0..places.len()).max_by(|&a, &b| worths[a].total_cmp(&worths[b]).then(b.cmp(&a)));
        Ok(best.map(|i| Viewpoint { from: places[i].1, to: target.centre }))
    }
}

impl<'a> Target<'a> {
    fn new(context: &Context<'_>, scene: VisibleScene<'a>, pieces: &'a HashSet<u32>, clip: Option<Bounds3>) -> Option<Self> {
        let corners = &context.pieces.scene().corners;
        let mut numbers: Vec<u32> = pieces.iter().copied().collect();
        numbers.sort_unstable();
        let faces: Vec<&[Vec3; 3]> =
            numbers.iter().flat_map(|&piece| &context.pieces.list()[piece as usize].faces).map(|&face| &corners[face as usize]).collect();
        let bounds = Bounds3::from_points(faces.iter().copied().flatten().copied());
        let total: f64 = faces.iter().map(|face| area_m2(face)).sum();
        let (mut points, mut before) = (Vec::new(), 0.0);
        for &[a, b, c] in faces {
            let (first, after) = (points.len(), before + area_m2(&[a, b, c]));
            let last = ((after / total) * POINTS as f64).round() as usize;
            let normal = (b - a).cross(c - a).normalize_or_zero();
            // Points of one face lie along a line from its middle to a corner.
            points.extend(
                (first..last).map(|i| ((a + b + c) / 3.0).lerp(a, 0.6 * (i - first) as f32 / POINTS as f32)).map(|point| (point, normal)),
            );
            before = after;
        }
        let radius = (0.5 * bounds.extent().length()).max(SMALLEST_M);
        (!points.is_empty()).then(|| Self { scene, pieces, points, centre: bounds.center(), radius, clip })
    }

    /// Visibility of the pieces from a place: the mean over the points of the cosine at which they face it, 0 for hidden ones.
    fn seen_from(&self, from: Vec3) -> f32 {
        let worth = |&(point, normal): &(Vec3, Vec3)| {
            let direction = (point - from).normalize_or_zero();
            let hit = self.scene.first(&Ray::new(from, direction), self.clip.as_ref());
            let seen = hit.is_some_and(|hit| {
                self.pieces.contains(&self.scene.piece_of_face[hit.triangle as usize]) && hit.t > 0.9 * from.distance(point)
            });
            if seen { normal.dot(direction).abs() } else { 0.0 }
        };
        self.points.iter().map(worth).sum::<f32>() / self.points.len() as f32
    }
}

/// Unit vectors from the target to the camera, starting with the camera's own.
fn backs(own: Vec3) -> Vec<Vec3> {
    let turn = if own.x.hypot(own.y) > 1e-3 { own.y.atan2(own.x) } else { -std::f32::consts::FRAC_PI_2 };
    let at = |by: f32, pitch: f32| {
        let ((sin, cos), (up, flat)) = ((turn + by.to_radians()).sin_cos(), pitch.to_radians().sin_cos());
        Vec3::new(cos * flat, sin * flat, up)
    };
    let others = TURNS_DEG.into_iter().flat_map(|by| PITCHES_DEG.map(|pitch| at(by, pitch)));
    std::iter::once(own).chain(others).collect()
}

/// True with something above and below.
fn is_inside(bvh: &Bvh, place: Vec3) -> bool {
    [Vec3::Z, Vec3::NEG_Z].into_iter().all(|direction| bvh.closest(&Ray::new(place, direction)).is_some())
}
