//! The surface of what is fixed, as convex slabs behind its faces: exact, where pieces of the volume are only as fine as voxels.

use enfilade_compose::Solid;
use enfilade_geometry::DisjointSets;
use enfilade_math::DVec3;
use std::collections::BTreeMap;

/// Thickness of a slab, metres, where what is behind the surface is thick enough.
const THICK_M: f64 = 0.02;
/// Share of the way to the next surface behind that a slab takes.
const SHARE: f64 = 0.45;
/// Share of its area with which a level surface looks up.
const LEVEL: f64 = 0.95;
/// What the cosine between neighbours in one plane lacks, how far their corners may be off it, metres, and how much smaller than its hull a
/// convex face may be.
const SAME_WAY: f64 = 1e-8;
const FLAT_M: f64 = 1e-5;
const SAME_AREA: f64 = 1e-4;
/// Where a triangle is probed for its thickness: weights of its corners.
const PROBES: [[f64; 3]; 4] = [[1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0], [0.9, 0.05, 0.05], [0.05, 0.9, 0.05], [0.05, 0.05, 0.9]];

/// A slab behind each face: behind triangles in one plane that form a convex polygon, and behind each one of the others.
pub(crate) fn slabs(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Solid> {
    let corners: Vec<[DVec3; 3]> = triangles.iter().map(|t| t.map(|corner| points[corner as usize])).collect();
    let regions = in_planes(triangles, &corners).into_iter();
    let faces = regions.flat_map(|region| {
        let whole = is_convex(&region, &corners);
        if whole { vec![region] } else { region.into_iter().map(|triangle| vec![triangle]).collect() }
    });
    let slab = |face: Vec<usize>| {
        let normal = area(&corners[face[0]]).try_normalize()?;
        let thick = face.iter().map(|triangle| thickness(&corners[*triangle], normal, &corners)).fold(THICK_M, f64::min);
        let front = face.iter().flat_map(|triangle| corners[*triangle]);
        Solid::around(&front.flat_map(|corner| [corner, corner - normal * thick]).collect::<Vec<_>>())
    };
    faces.filter_map(slab).collect()
}

/// What is level, looks up and is open below, such as the boards of a floor, as a solid with a thickness.
pub(crate) fn ground(points: &[DVec3], triangles: &[[u32; 3]]) -> Option<Solid> {
    let areas = || triangles.iter().map(|t| area(&t.map(|corner| points[corner as usize])));
    let looks_up = areas().sum::<DVec3>().z > LEVEL * areas().map(DVec3::length).sum::<f64>();
    let deep = |p: &DVec3| [*p, *p - DVec3::Z * THICK_M];
    looks_up.then(|| Solid::around(&points.iter().flat_map(deep).collect::<Vec<_>>())).flatten()
}

/// Triangles that hang together by edges and look the same way, in the order of their first.
fn in_planes(triangles: &[[u32; 3]], corners: &[[DVec3; 3]]) -> Vec<Vec<usize>> {
    let normals: Vec<DVec3> = corners.iter().map(|triangle| area(triangle).normalize_or_zero()).collect();
    let mut edges: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for ([a, b, c], number) in triangles.iter().zip(0..) {
        [[a, b], [b, c], [c, a]].iter().for_each(|[from, to]| edges.entry([**from.min(to), **from.max(to)]).or_default().push(number));
    }
    let mut sets = DisjointSets::new(triangles.len());
    for at in edges.values() {
        for other in at[1..].iter().filter(|other| normals[at[0]].dot(normals[**other]) > 1.0 - SAME_WAY) {
            sets.unite(at[0] as u32, *other as u32);
        }
    }
    let mut regions: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    (0..triangles.len()).for_each(|triangle| regions.entry(sets.root(triangle as u32)).or_default().push(triangle));
    regions.into_values().collect()
}

/// Whether triangles in a plane fill the hull of their corners, and are in a plane after all.
fn is_convex(region: &[usize], corners: &[[DVec3; 3]]) -> bool {
    let normal = area(&corners[region[0]]).normalize_or_zero();
    let points: Vec<DVec3> = region.iter().flat_map(|triangle| corners[*triangle]).collect();
    let flat = points.iter().all(|point| (*point - points[0]).dot(normal).abs() < FLAT_M);
    let filled: f64 = region.iter().map(|triangle| area(&corners[*triangle]).length() / 2.0).sum();
    let prism = || Solid::around(&points.iter().flat_map(|p| [*p, *p + normal * THICK_M]).collect::<Vec<_>>());
    flat && prism().is_some_and(|solid| solid.volume_m3() <= filled * THICK_M * (1.0 + SAME_AREA))
}

/// Twice the area of a triangle along its normal.
fn area([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (*b - *a).cross(*c - *a)
}

/// How thick the slab behind a triangle may be, metres.
fn thickness([a, b, c]: &[DVec3; 3], normal: DVec3, all: &[[DVec3; 3]]) -> f64 {
    let behind = |weights: &[f64; 3]| {
        let from = *a * weights[0] + *b * weights[1] + *c * weights[2];
        all.iter().filter_map(|other| distance(from, -normal, other)).fold(f64::INFINITY, f64::min)
    };
    SHARE * PROBES.iter().map(behind).fold(f64::INFINITY, f64::min)
}

/// The distance at which a ray meets a triangle, farther than a hair (Möller and Trumbore 1997).
fn distance(from: DVec3, direction: DVec3, [a, b, c]: &[DVec3; 3]) -> Option<f64> {
    let (ab, ac) = (*b - *a, *c - *a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    if determinant.abs() < 1e-12 {
        return None;
    }
    let offset = (from - *a) / determinant;
    let (u, up) = (offset.dot(across), offset.cross(ab));
    let v = direction.dot(up);
    let t = ac.dot(up);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 1e-6).then_some(t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slabs_lie_behind_the_surface_and_do_not_come_out_on_the_other_side() {
        let z = |z: f64| [DVec3::new(0.0, 0.0, z), DVec3::new(1.0, 0.0, z), DVec3::new(0.0, 1.0, z)];
        let points = [z(0.01), z(0.0)].concat();
        let found = slabs(&points, &[[0, 1, 2], [3, 5, 4]]);
        assert_eq!(found.len(), 2);
        let extent = |solid: &Solid| solid.corners.iter().fold((1.0f64, 0.0f64), |(low, high), p| (low.min(p.z), high.max(p.z)));
        assert!(extent(&found[0]).0 > 0.005 && (extent(&found[0]).1 - 0.01).abs() < 1e-12);
        assert!(extent(&found[1]).1 < 0.005 && extent(&found[1]).0.abs() < 1e-12);
        let alone = slabs(&points[..3], &[[0, 1, 2]]);
        assert!((extent(&alone[0]).0 - (0.01 - THICK_M)).abs() < 1e-12);
    }
}
