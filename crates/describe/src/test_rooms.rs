//! Bodies for tests.

use crate::body::Body;
use enfilade_label::boxes::upright_box;
use enfilade_math::{DVec3, Vec3};

/// The faces of a box, as corners counted by their bits x, y, z.
const FACES: [[usize; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

/// The triangles of a box between two corners, facing out.
pub fn box_corners(min: DVec3, max: DVec3) -> Vec<[Vec3; 3]> {
    let corner = |i: usize| DVec3::new([min, max][i & 1].x, [min, max][i >> 1 & 1].y, [min, max][i >> 2].z).as_vec3();
    FACES.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]].map(|t| t.map(corner))).collect()
}

/// A body of triangles.
pub fn body(instance: i16, semantic: i16, corners: Vec<[Vec3; 3]>) -> Body {
    let points: Vec<DVec3> = corners.iter().flatten().map(|p| p.as_dvec3()).collect();
    Body::new((instance, semantic), upright_box(&points).unwrap(), corners)
}

/// A box as a body.
pub fn boxed(instance: i16, semantic: i16, min: DVec3, max: DVec3) -> Body {
    body(instance, semantic, box_corners(min, max))
}
