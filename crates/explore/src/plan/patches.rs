//! Points spread evenly over all surfaces: each represents the same area of its part, however that is cut into triangles.

use enfilade_math::{DVec3, Rng};
use enfilade_scene::{PartId, WorldMesh};

/// Small parts get this many points all the same.
const MIN_PER_PART: usize = 8;

/// A point of a surface, and the area that it represents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    pub p_world: DVec3,
    pub normal: DVec3,
    pub part: PartId,
    pub area_m2: f64,
}

/// About `samples` patches, those of a part together, in the order of parts. Parts without area have none.
///
/// The points of a part are a systematic sample: evenly spaced along the running sum of its triangles' areas.
pub(super) fn patches(world: &WorldMesh, samples: usize) -> Vec<Patch> {
    let areas: Vec<f64> = world.corners.iter().map(|corners| area_m2(corners.map(|p| p.as_dvec3()))).collect();
    let total: f64 = areas.iter().sum();
    let mut patches = Vec::new();
    let mut first = 0;
    while first < areas.len() {
        let part = world.sources[first].part;
        let end = first + world.sources[first..].iter().take_while(|source| source.part == part).count();
        let area: f64 = areas[first..end].iter().sum();
        if area > 0.0 {
            let n = ((samples as f64 * area / total).round() as usize).max(MIN_PER_PART);
            spread(world, part, first, &areas[first..end], area / n as f64, &mut patches);
        }
        first = end;
    }
    patches
}

/// Adds a patch for every `each_m2` of the triangles from `first` on.
fn spread(world: &WorldMesh, part: PartId, first: usize, areas: &[f64], each_m2: f64, patches: &mut Vec<Patch>) {
    let mut rng = Rng::new(u64::from(part));
    let mut next = each_m2 * rng.next_f64();
    let mut sum = 0.0;
    for (i, area) in areas.iter().enumerate() {
        sum += area;
        let [a, b, c] = world.corners[first + i].map(|p| p.as_dvec3());
        while next < sum {
            let (u, v) = (rng.next_f64(), rng.next_f64());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let normal = (b - a).cross(c - a).normalize_or_zero();
            patches.push(Patch { p_world: a + u * (b - a) + v * (c - a), normal, part, area_m2: each_m2 });
            next += each_m2;
        }
    }
}

fn area_m2([a, b, c]: [DVec3; 3]) -> f64 {
    let area = 0.5 * (b - a).cross(c - a).length();
    if area.is_finite() { area } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testroom::{Room, cuboid};
    use enfilade_math::Vec3;

    /// Cuts every triangle into four, `times` over.
    fn refined(corners: Vec<[Vec3; 3]>, times: u32) -> Vec<[Vec3; 3]> {
        (0..times).fold(corners, |corners, _| {
            let quarters = |[a, b, c]: [Vec3; 3]| {
                let [ab, bc, ca] = [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)];
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            };
            corners.into_iter().flat_map(quarters).collect()
        })
    }

    #[test]
    fn patches_do_not_depend_on_the_cut_into_triangles() {
        let (min, max) = (DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5));
        let count = |times| {
            let room = Room::from_corners(refined(cuboid(min, max, true), times));
            let patches = patches(&room.world, 4000);
            let area: f64 = patches.iter().map(|p| p.area_m2).sum();
            assert!((area - 59.0).abs() < 0.1, "{area}");
            [0, 1, 2].map(|axis| patches.iter().filter(|p| p.normal[axis].abs() > 0.9).count() as f64 / patches.len() as f64)
        };
        for times in [0, 3] {
            for (found, expected) in count(times).into_iter().zip([15.0, 20.0, 24.0]) {
                assert!((found - expected / 59.0).abs() < 2e-3, "{found} of the area, {expected} of 59 m2");
            }
        }
    }
}
