//! Coincident surfaces that can be seen: which of them a ray meets depends on rounding.

use enfilade_geometry::{Bvh, Hit};
use enfilade_math::{Bounds3, Distribution1, Ray, Rng, Vec3, warp};
use enfilade_parallel::{flat_map_up_to, map};
use enfilade_scene::{PartId, WorldMesh};
use std::cell::Cell;
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
    let bounds = bounds_of_parts(world);
    let found = flat_map_up_to(POINTS, |k| overlap_at(world, bvh, &bounds, &by_area, &mut Rng::new(k as u64)));
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
fn overlap_at(world: &WorldMesh, bvh: &Bvh, bounds: &[Bounds3], by_area: &Distribution1, rng: &mut Rng) -> Option<[PartId; 2]> {
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
    if [normal, -normal].iter().all(|side| is_hidden(world, bvh, bounds, p, *side, parts)) {
        return None;
    }
    parts.sort_unstable();
    Some(parts)
}

/// Bounds of every part.
fn bounds_of_parts(world: &WorldMesh) -> Vec<Bounds3> {
    let mut bounds = vec![Bounds3::EMPTY; world.sources.last().map_or(0, |source| source.part as usize + 1)];
    for (corners, source) in world.corners.iter().zip(&world.sources) {
        let part = &mut bounds[source.part as usize];
        *part = corners.iter().fold(*part, |bounds, corner| bounds.include(*corner));
    }
    bounds
}

/// Whether a place cannot be seen from one of its sides: there is the inside of one of the two parts, or nothing more of the scene, as below
/// a cupboard on the floor. A part that surrounds the other may be a room, whose inside is seen.
fn is_hidden(world: &WorldMesh, bvh: &Bvh, bounds: &[Bounds3], p: Vec3, side: Vec3, [one, other]: [PartId; 2]) -> bool {
    let (meets, windings) = (Cell::new(false), [Cell::new(0), Cell::new(0)]);
    let count = |hit: &Hit| {
        meets.set(true);
        let [a, b, c] = world.corners[hit.triangle as usize];
        let is_back = (b - a).cross(c - a).dot(side) > 0.0;
        for (part, winding) in [one, other].iter().zip(&windings) {
            let is_of_part = world.sources[hit.triangle as usize].part == *part;
            winding.set(winding.get() + i32::from(is_of_part) * if is_back { 1 } else { -1 });
        }
        false
    };
    // No hit is taken, so all are counted.
    bvh.closest_filtered(&Ray::new(p + side * FROM_M, side), count);
    let surrounds = |part: PartId, inner: PartId| {
        let (outer, inner) = (bounds[part as usize], bounds[inner as usize]);
        outer.contains(inner.min) && outer.contains(inner.max)
    };
    let is_inside = |part: PartId, inner: PartId, winding: i32| winding > 0 && !surrounds(part, inner);
    !meets.get() || is_inside(one, other, windings[0].get()) || is_inside(other, one, windings[1].get())
}

fn is_parallel([a, b, c]: [Vec3; 3], normal: Vec3) -> bool {
    (b - a).cross(c - a).normalize_or_zero().dot(normal).abs() > PARALLEL
}

/// Neighbours in a plane share an edge, and doubled faces all corners.
fn is_neighbour(world: &WorldMesh, i: usize, j: usize) -> bool {
    let near = |p: &Vec3| world.corners[j].iter().any(|q| p.distance_squared(*q) < 1e-10);
    world.corners[i].iter().filter(|p| near(p)).count() > 1
}
