//! The upward direction by what things rest on, for files that state neither names nor cameras.
//!
//! Things are connected surfaces that are no slab of the shell. Nearly all rest on a floor or on each other, and few are beside something:
//! so they are supported along one direction, which is down. Alone, this is no proof: the pieces of things that a file stores apart may lean
//! on each other.

use crate::intake::seen::Look;
use enfilade_geometry::DisjointSets;
use enfilade_math::{Bounds3, DVec3, Ray, Vec3};
use std::collections::HashMap;

/// Triangles up to which surfaces are connected: the search is for small files, since large ones have names.
const MAX_TRIANGLES: usize = 2_000_000;
/// Least number of things, least share of them that is supported along the downward direction, and largest share along the supposed one.
const THINGS: usize = 3;
const RESTING: f64 = 0.75;
const FLOATING: f64 = 0.25;
/// Gap below a thing that rests, over the longest extent of the scene.
const GAP: f32 = 0.005;
/// Extent of a thing along its height over the scene's: thinner ones may be pictures on a wall. Slabs of the shell exceed the second along
/// two axes.
const THICK: f32 = 0.1;
const SLAB: f32 = 0.7;

/// The direction along an axis, other than z, that is upward by what most things rest on, if hardly any rest along z.
pub(super) fn upward(look: &Look, axis: usize) -> Option<DVec3> {
    let size = look.world.bounds.extent();
    if look.world.corners.len() > MAX_TRIANGLES {
        return None;
    }
    let (of_triangle, bounds) = connected(&look.world.corners);
    let is_slab = |bounds: &Bounds3| (0..3).filter(|&axis| bounds.extent()[axis] >= SLAB * size[axis]).count() > 1;
    let things: Vec<usize> = (0..bounds.len()).filter(|&thing| !is_slab(&bounds[thing])).collect();
    let found = [Vec3::AXES[axis], -Vec3::AXES[axis]].into_iter().find(|&up| {
        let tall: Vec<usize> = things.iter().copied().filter(|&i| height(&bounds[i], up) >= THICK * size.dot(up.abs())).collect();
        let share = |up: Vec3| tall.iter().filter(|&&i| rests(look, &of_triangle, &bounds[i], i, up)).count() as f64 / tall.len() as f64;
        tall.len() >= THINGS && share(up) >= RESTING && share(Vec3::Z) <= FLOATING
    });
    found.map(Vec3::as_dvec3)
}

fn height(bounds: &Bounds3, up: Vec3) -> f32 {
    bounds.extent().dot(up.abs())
}

/// Whether something is right below the middle of a thing's lower side.
fn rests(look: &Look, of_triangle: &[usize], bounds: &Bounds3, thing: usize, up: Vec3) -> bool {
    let gap = GAP * look.world.bounds.extent().max_element();
    let lowest = 0.5 * (bounds.min + bounds.max) - up * (0.5 * height(bounds, up));
    let ray = Ray { t_max: 2.0 * gap, ..Ray::new(lowest + up * gap, -up) };
    look.bvh.occluded_filtered(&ray, |hit| of_triangle[hit.triangle as usize] != thing)
}

/// The connected surface of every triangle, by common corners, and the bounds of each surface.
fn connected(corners: &[[Vec3; 3]]) -> (Vec<usize>, Vec<Bounds3>) {
    let mut first: HashMap<[u32; 3], u32> = HashMap::new();
    let mut sets = DisjointSets::new(corners.len());
    for (triangle, points) in (0..).zip(corners) {
        for point in points {
            // Zero has two signs.
            let other = *first.entry((*point + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(triangle);
            sets.unite(triangle, other);
        }
    }
    let mut numbers: HashMap<u32, usize> = HashMap::new();
    let mut bounds: Vec<Bounds3> = Vec::new();
    let of_triangle = (0..corners.len()).map(|triangle| {
        let number = *numbers.entry(sets.root(triangle as u32)).or_insert(bounds.len());
        bounds.resize(bounds.len().max(number + 1), Bounds3::EMPTY);
        bounds[number] = corners[triangle].iter().fold(bounds[number], |all, &p| all.include(p));
        number
    });
    (of_triangle.collect(), bounds)
}
