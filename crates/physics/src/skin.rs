//! The surface of what is fixed, as convex slabs behind its triangles: exact, where pieces of the volume are only as fine as voxels.

use enfilade_compose::Solid;
use enfilade_math::DVec3;

/// Thickness of a slab, metres, where what is behind the surface is thick enough.
const THICK_M: f64 = 0.02;
/// Share of the way to the next surface behind that a slab takes.
const SHARE: f64 = 0.45;
/// Where a triangle is probed for its thickness: weights of its corners.
const PROBES: [[f64; 3]; 4] = [[1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0], [0.9, 0.05, 0.05], [0.05, 0.9, 0.05], [0.05, 0.05, 0.9]];

/// A slab behind each triangle.
pub(crate) fn slabs(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Solid> {
    let corners: Vec<[DVec3; 3]> = triangles.iter().map(|t| t.map(|corner| points[corner as usize])).collect();
    corners.iter().filter_map(|triangle| slab(triangle, &corners)).collect()
}

fn slab(triangle: &[DVec3; 3], all: &[[DVec3; 3]]) -> Option<Solid> {
    let [a, b, c] = *triangle;
    let normal = (b - a).cross(c - a).try_normalize()?;
    let behind = |weights: &[f64; 3]| {
        let from = a * weights[0] + b * weights[1] + c * weights[2];
        all.iter().filter_map(|other| distance(from, -normal, other)).fold(f64::INFINITY, f64::min)
    };
    let way = PROBES.iter().map(behind).fold(f64::INFINITY, f64::min);
    let thick = THICK_M.min(SHARE * way);
    Solid::around(&[a, b, c, a - normal * thick, b - normal * thick, c - normal * thick])
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
