//! Coincident surfaces: which of them a ray meets depends on rounding.

use enfilade_geometry::{Bvh, Hit};
use enfilade_math::{Distribution1, Ray, Rng, Vec3, warp};
use enfilade_parallel::{flat_map_up_to, map};
use enfilade_scene::{PartId, WorldMesh};
use std::collections::BTreeMap;

/// Points on the scene's surfaces, spread by area.
const POINTS: usize = 16_384;
/// Surfaces coincide when they are nearer than this, metres, ...
const NEAR_M: f32 = 5e-5;
/// ... and the cosine between their normals is at least this.
const PARALLEL: f32 = 0.9999;
/// Distance from a point at which rays begin, metres.
const FROM_M: f32 = 1e-3;
/// Fewer points than these of two parts are chance: corners and edges.
const LEAST_POINTS: usize = 4;

/// Two parts, or one and itself, whose surfaces coincide.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlap {
    /// In rising order.
    pub parts: [PartId; 2],
    /// The area they have in common, square metres, to some ten percent where it is more than a hundredth of all.
    pub area_m2: f64,
}

/// The overlaps of a scene, the largest first.
pub(super) fn overlaps(world: &WorldMesh, bvh: &Bvh) -> Vec<Overlap> {
    let area = |[a, b, c]: &[Vec3; 3]| 0.5 * (*b - *a).cross(*c - *a).length();
    let areas: Vec<f32> = map(&world.corners, area);
    let Some(by_area) = Distribution1::new(&areas) else { return Vec::new() };
    let total_m2: f64 = areas.iter().map(|a| f64::from(*a)).sum();
    let found = flat_map_up_to(POINTS, |k| overlap_at(world, bvh, &by_area, &mut Rng::new(k as u64)));
    let mut counts: BTreeMap<[PartId; 2], usize> = BTreeMap::new();
    found.into_iter().for_each(|parts| *counts.entry(parts).or_default() += 1);
    let often = counts.into_iter().filter(|(_, count)| *count >= LEAST_POINTS);
    // Points on either of the two surfaces were counted.
    let overlap = |(parts, count): ([PartId; 2], usize)| Overlap { parts, area_m2: 0.5 * total_m2 * count as f64 / POINTS as f64 };
    let mut overlaps: Vec<Overlap> = often.map(overlap).collect();
    overlaps.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
    overlaps
}

/// The two parts at a random point, if another surface than its own is there that is not the same face once more.
fn overlap_at(world: &WorldMesh, bvh: &Bvh, by_area: &Distribution1, rng: &mut Rng) -> Option<[PartId; 2]> {
    let own = by_area.sample(rng.next_f32()).0;
    let [a, b, c] = world.corners[own];
    let normal = (b - a).cross(c - a).try_normalize()?;
    let at = warp::triangle([rng.next_f32(), rng.next_f32()]);
    let p = a + (b - a) * at.x + (c - a) * at.y;
    let ray = Ray { t_min: FROM_M - NEAR_M, t_max: FROM_M + NEAR_M, ..Ray::new(p + normal * FROM_M, -normal) };
    let is_other = |hit: &Hit| {
        let other = hit.triangle as usize;
        other != own && is_parallel(world.corners[other], normal) && !is_neighbour(world, own, other)
    };
    let other = bvh.closest_filtered(&ray, is_other)?.triangle as usize;
    let mut parts = [own, other].map(|i| world.sources[i].part);
    parts.sort_unstable();
    Some(parts)
}

fn is_parallel([a, b, c]: [Vec3; 3], normal: Vec3) -> bool {
    (b - a).cross(c - a).normalize_or_zero().dot(normal).abs() > PARALLEL
}

/// Neighbours in a plane share an edge, and doubled faces all corners.
fn is_neighbour(world: &WorldMesh, i: usize, j: usize) -> bool {
    let near = |p: &Vec3| world.corners[j].iter().any(|q| p.distance_squared(*q) < 1e-10);
    world.corners[i].iter().filter(|p| near(p)).count() > 1
}
