//! Convex pieces of a mesh, for the simulation.
//!
//! The decomposition is V-HACD (Mamou and Ghorbel, "A simple and efficient approach for 3D mesh approximate convex decomposition", ICIP 2009)
//! of the library `parry3d`. A piece is the hull of the triangles in it, so the pieces contain the whole surface; only hollows finer than
//! a voxel are filled.

use enfilade_math::DVec3;
use rapier3d_f64::parry::transformation::vhacd::{VHACD, VHACDParameters};
use rapier3d_f64::parry::transformation::voxelization::FillMode;

/// Most pieces of a model.
const MOST_PIECES: u32 = 32;
/// Voxels along the longest side.
const RESOLUTION: u32 = 64;
/// Volume by which a piece may differ from its hull, as a share of the whole.
const CONCAVITY: f64 = 0.01;
/// A point farther than this outside a triangle's plane, as a share of the longest side, shows that a mesh is not convex.
const HOLLOW: f64 = 1e-3;
/// Directions in which a hull with more corners keeps its farthest ones. A sphere loses 0.2 % of its radius.
const DIRECTIONS: usize = 1000;
/// A mesh that is thinner than this share of its length is one piece.
const FLAT: f64 = 1e-3;

/// Corners of the convex pieces of a mesh.
pub fn pieces(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Vec<DVec3>> {
    let corners = farthest(points, DIRECTIONS);
    if is_convex(points, triangles, &corners) {
        return vec![corners];
    }
    let found: Vec<Vec<DVec3>> = cut(points, triangles, RESOLUTION).into_iter().map(|part| farthest(&part, DIRECTIONS)).collect();
    if found.is_empty() { vec![corners] } else { found }
}

/// Points of the parts of a mesh that is not convex, whose hulls are its pieces; `resolution` is the number of voxels along its longest side.
pub fn cut(points: &[DVec3], triangles: &[[u32; 3]], resolution: u32) -> Vec<Vec<DVec3>> {
    let (low, high) = bounds(points);
    let parameters = VHACDParameters {
        resolution,
        concavity: CONCAVITY,
        max_convex_hulls: MOST_PIECES,
        fill_mode: FillMode::FloodFill { detect_cavities: false },
        ..VHACDParameters::default()
    };
    // In units of its own length: the library's tolerances are absolute.
    let (middle, unit) = ((low + high) / 2.0, (high - low).max_element());
    let scaled: Vec<_> = points.iter().map(|p| crate::shapes::vector((p - middle) / unit)).collect();
    let decomposition = VHACD::decompose(&parameters, &scaled, triangles, true);
    let parts = decomposition.compute_primitive_intersections(&scaled, triangles);
    let back = |part: Vec<_>| -> Vec<DVec3> { part.into_iter().map(|p| crate::shapes::ours(p) * unit + middle).collect() };
    parts.into_iter().map(back).filter(|part| part.len() >= 4).collect()
}

/// Whether a mesh is flat, or no corner of its hull is in front of any triangle.
pub fn is_convex(points: &[DVec3], triangles: &[[u32; 3]], corners: &[DVec3]) -> bool {
    let (low, high) = bounds(points);
    let extent = high - low;
    let tolerance = HOLLOW * extent.max_element();
    let behind = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| points[corner as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        corners.iter().all(|corner| normal.dot(*corner - a) <= tolerance)
    };
    extent.min_element() < FLAT * extent.max_element() || triangles.len() < 4 || triangles.iter().all(behind)
}

/// Least and greatest coordinates.
pub fn bounds(points: &[DVec3]) -> (DVec3, DVec3) {
    points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)))
}

/// The points that are farthest in one of some directions, or all if there are no more.
pub fn farthest(points: &[DVec3], directions: usize) -> Vec<DVec3> {
    if points.len() <= directions {
        return points.to_vec();
    }
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let mut farthest: Vec<usize> = (0..directions)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f64 / directions as f64;
            let (sin, cos) = (golden * i as f64).sin_cos();
            let direction = DVec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z);
            (0..points.len()).max_by(|a, b| points[*a].dot(direction).total_cmp(&points[*b].dot(direction))).unwrap_or(0)
        })
        .collect();
    farthest.sort_unstable();
    farthest.dedup();
    farthest.into_iter().map(|i| points[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(low: DVec3, high: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let corner = |i: usize| DVec3::new([low.x, high.x][i & 1], [low.y, high.y][i >> 1 & 1], [low.z, high.z][i >> 2]);
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        ((0..8).map(corner).collect(), triangles)
    }

    #[test]
    fn a_block_is_one_piece_with_its_corners() {
        let (points, triangles) = block(DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.02, 0.05, 0.1));
        let found = pieces(&points, &triangles);
        assert_eq!(found.len(), 1);
        let (low, high) = bounds(&found[0]);
        assert!(low.distance(DVec3::new(1.0, 0.0, 0.0)) < 1e-9 && high.distance(DVec3::new(1.02, 0.05, 0.1)) < 1e-9, "{low} {high}");
    }

    /// Two blocks that form an L: the hull of both would fill the notch.
    #[test]
    fn the_notch_of_an_l_stays_open() {
        let (mut points, mut triangles) = block(DVec3::ZERO, DVec3::new(0.3, 0.1, 0.1));
        let (more, faces) = block(DVec3::new(0.0, 0.0, 0.1), DVec3::new(0.1, 0.1, 0.3));
        triangles.extend(faces.iter().map(|face| face.map(|i| i + 8)));
        points.extend(more);
        let found = pieces(&points, &triangles);
        let holds = |p: DVec3| {
            found.iter().any(|piece| {
                let (low, high) = bounds(piece);
                p.cmpge(low).all() && p.cmple(high).all()
            })
        };
        assert!(holds(DVec3::new(0.25, 0.05, 0.05)) && holds(DVec3::new(0.05, 0.05, 0.25)));
        assert!(!holds(DVec3::new(0.25, 0.05, 0.25)));
        assert!(found.len() < 8, "{} pieces", found.len());
    }

    #[test]
    fn many_points_become_few_and_stay_within() {
        let sphere: Vec<DVec3> = (0..5000)
            .map(|i| {
                let z = 1.0 - (2 * i + 1) as f64 / 5000.0;
                let (sin, cos) = (2.4 * f64::from(i)).sin_cos();
                DVec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z)
            })
            .collect();
        let kept = farthest(&sphere, DIRECTIONS);
        assert!(kept.len() <= DIRECTIONS && kept.len() > DIRECTIONS / 2, "{}", kept.len());
    }
}
