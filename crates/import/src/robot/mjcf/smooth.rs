//! Normals of meshes whose files have none: smooth across edges of small angles, as MuJoCo shows them.

use enfilade_geometry::Mesh;
use enfilade_math::Vec3;
use std::collections::HashMap;

/// Cosine of the greatest angle between faces that look like one (MuJoCo's).
const ALIKE: f32 = 0.8;
/// Vertices of more faces are the middle of a fan, whose faces keep their own normals.
const MOST_FACES: usize = 256;

/// The mesh with normals: at each corner the mean of the faces around its vertex that are alike, weighted by their areas.
pub(super) fn smoothed(mesh: Mesh) -> Mesh {
    if !mesh.normals.is_empty() || mesh.validate().is_err() {
        return mesh;
    }
    let corners = |face: &[u32; 3]| face.map(|corner| mesh.positions[corner as usize]);
    // Twice the area long.
    let crosses: Vec<Vec3> = mesh.triangles.iter().map(corners).map(|[a, b, c]| (b - a).cross(c - a)).collect();
    let mut around: Vec<Vec<u32>> = vec![Vec::new(); mesh.positions.len()];
    for (face, number) in mesh.triangles.iter().zip(0..) {
        face.iter().for_each(|&corner| around[corner as usize].push(number));
    }
    let mut smooth = Mesh::default();
    let mut known: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
    for (face, cross) in mesh.triangles.iter().zip(&crosses) {
        let own = cross.normalize_or_zero();
        let corner = |vertex: &u32| {
            let faces = &around[*vertex as usize];
            let alike = faces.iter().map(|&face| crosses[face as usize]).filter(|other| own.dot(*other) >= ALIKE * other.length());
            let sum: Vec3 = if faces.len() > MOST_FACES { own } else { alike.sum() };
            let normal = sum.try_normalize().unwrap_or(if own == Vec3::ZERO { Vec3::Z } else { own });
            *known.entry((*vertex, normal.to_array().map(f32::to_bits))).or_insert_with(|| {
                smooth.positions.push(mesh.positions[*vertex as usize]);
                smooth.normals.push(normal);
                smooth.uvs.extend(mesh.uvs.get(*vertex as usize));
                smooth.positions.len() as u32 - 1
            })
        };
        let [a, b, c] = face;
        let triangle = [a, b, c].map(corner);
        smooth.triangles.push(triangle);
    }
    smooth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_angles_are_smoothed_and_edges_stay() {
        // Two squares that meet at an angle of 0.3 rad, and a third that stands upright on the second.
        let (sin, cos) = 0.3f32.sin_cos();
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0 + cos, 0.0, sin], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0 + cos, 1.0, sin]];
        let upright = [[1.0 + cos, 0.0, 1.0 + sin], [1.0 + cos, 1.0, 1.0 + sin]];
        let positions = points.into_iter().chain(upright).map(Vec3::from).collect();
        let triangles = vec![[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 6, 7], [2, 7, 5]];
        let mesh = smoothed(Mesh { positions, triangles, ..Mesh::default() });
        assert_eq!(mesh.validate(), Ok(()));
        let normal = |face: usize, corner: usize| mesh.normals[mesh.triangles[face][corner] as usize];
        // The outer edges have the normals of their squares; the shared one is between both.
        assert!(normal(0, 0).distance(Vec3::Z) < 1e-6 && normal(4, 0).distance(Vec3::NEG_X) < 1e-6);
        let mid = normal(3, 0);
        assert!(mid.x < 0.0 && mid.x > -sin && normal(0, 1) == mid);
        assert!(normal(2, 1).distance(Vec3::new(-sin, 0.0, cos)) < 1e-6);
    }
}
