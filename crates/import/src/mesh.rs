//! Operations on meshes that several importers need: repairs, smooth normals, fronts that agree with normals, areas.

use crate::polygon::triangle_area;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Vec2, Vec3};

/// Squared length below which a vertex normal has no usable direction.
const SHORT_NORMAL: f32 = 1e-12;

/// Normalizes normals, replaces unusable ones by the mean of the adjoining faces, and unusable texture coordinates by zero.
/// Returns what was done, for the report; nothing when all was well.
pub(crate) fn repair(mesh: &mut Mesh) -> Vec<String> {
    let mut notes = Vec::new();
    let in_range = mesh.triangles.iter().flatten().all(|&i| (i as usize) < mesh.positions.len());
    if mesh.normals.len() == mesh.positions.len() && in_range {
        let unusable = |n: &Vec3| !n.is_finite() || n.length_squared() < SHORT_NORMAL;
        let bad = mesh.normals.iter().filter(|n| unusable(n)).count();
        if bad > 0 {
            let faces = face_normals_at_vertices(mesh);
            mesh.normals.iter_mut().zip(faces).filter(|(n, _)| unusable(n)).for_each(|(n, f)| *n = f);
            notes.push(format!("{bad} of {} vertex normals were zero or not finite and were replaced by the faces'", mesh.normals.len()));
        }
        mesh.normals.iter_mut().for_each(|n| *n = n.normalize_or(Vec3::Z));
    }
    let bad = mesh.uvs.iter().filter(|uv| !uv.is_finite()).count();
    if bad > 0 {
        mesh.uvs.iter_mut().filter(|uv| !uv.is_finite()).for_each(|uv| *uv = Vec2::ZERO);
        notes.push(format!("{bad} of {} texture coordinates were not finite and were replaced by zero", mesh.uvs.len()));
    }
    notes
}

/// Gives a mesh smooth normals: at each vertex the mean of the adjoining faces, weighted by their angle there.
pub(crate) fn add_smooth_normals(mesh: &mut Mesh) {
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    for triangle in mesh.triangles.iter().filter(|t| t.iter().all(|&i| (i as usize) < mesh.positions.len())) {
        let p = triangle.map(|i| mesh.positions[i as usize]);
        let face = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
        for k in 0..3 {
            let (a, b) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            let angle = a.normalize_or_zero().dot(b.normalize_or_zero()).clamp(-1.0, 1.0).acos();
            sums[triangle[k] as usize] += face * angle;
        }
    }
    mesh.normals = sums.into_iter().map(|n| n.normalize_or(Vec3::Z)).collect();
}

/// Turns triangles round whose vertex normals point to their back.
pub(crate) fn turn_faces_to_normals(mesh: &mut Mesh) {
    if mesh.normals.len() != mesh.positions.len() {
        return;
    }
    for triangle in mesh.triangles.iter_mut().filter(|t| t.iter().all(|&i| (i as usize) < mesh.positions.len())) {
        let p = triangle.map(|i| mesh.positions[i as usize]);
        let normal: Vec3 = triangle.iter().map(|&i| mesh.normals[i as usize]).sum();
        if (p[1] - p[0]).cross(p[2] - p[0]).dot(normal) < 0.0 {
            triangle.swap(1, 2);
        }
    }
}

/// The area of a mesh under a placement, square units of what it is placed in.
pub(crate) fn area(mesh: &Mesh, placement: DAffine3) -> f64 {
    let corners = (0..mesh.triangles.len()).map(|t| mesh.corners(t).map(|p| placement.transform_point3(p.as_dvec3())));
    corners.map(triangle_area).sum()
}

/// An affine map of texture coordinates with v downward, for coordinates with v upward: F·M·F with F (u, v) → (u, 1 − v).
pub(crate) fn flip_v_of_transform([[a, b, c], [d, e, f]]: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
    [[a, -b, b + c], [-d, e, 1.0 - e - f]]
}

/// The area-weighted mean normal of the faces around each vertex; +z where there are none with an area.
fn face_normals_at_vertices(mesh: &Mesh) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    for t in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(t);
        let normal = (b - a).cross(c - a);
        if normal.is_finite() {
            mesh.triangles[t].iter().for_each(|&i| sums[i as usize] += normal);
        }
    }
    sums.into_iter().map(|n| n.normalize_or(Vec3::Z)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unusable_normals_and_uvs_are_replaced_and_counted() {
        let mut mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: vec![Vec3::ZERO, Vec3::new(f32::NAN, 0.0, 1.0), Vec3::X * 3.0],
            uvs: vec![Vec2::new(f32::INFINITY, 0.0), Vec2::ONE, Vec2::ONE],
            triangles: vec![[0, 1, 2]],
        };
        let notes = repair(&mut mesh);
        assert_eq!(mesh.normals, vec![Vec3::Z, Vec3::Z, Vec3::X]);
        assert_eq!(mesh.uvs[0], Vec2::ZERO);
        assert_eq!(notes.len(), 2);
        assert!(notes[0].starts_with("2 of 3 vertex normals"), "{notes:?}");
        assert!(repair(&mut mesh).is_empty());
    }
}
