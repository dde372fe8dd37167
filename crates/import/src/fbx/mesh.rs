//! The faces of one material of a mesh to triangles.

use crate::assembly::origin_of;
use enfilade_geometry::Mesh;
use enfilade_math::{DVec3, Vec2, Vec3};
use std::collections::HashMap;
use ufbx::MeshPart;

/// The point from which positions of a mesh count: its own origin, or one near what is far from that.
pub(super) fn origin(mesh: &ufbx::Mesh, meters_per_unit: f64) -> DVec3 {
    origin_of(mesh.skinned_position.values.iter().map(dvec3), meters_per_unit)
}

/// The triangles of `part` with texture coordinates of set `uv_set`. Vertices are shared by corners that agree in everything.
/// Faces that are holes are left out. Positions count from `origin`.
pub(super) fn of_part(mesh: &ufbx::Mesh, part: &MeshPart, uv_set: usize, origin: DVec3) -> Mesh {
    let uvs = mesh.uv_sets.get(uv_set).map(|set| &set.vertex_uv).filter(|uv| uv.exists);
    let (positions, normals) = (&mesh.skinned_position, &mesh.skinned_normal);
    let mut built = Mesh::default();
    let mut known: HashMap<[u32; 3], u32> = HashMap::new();
    let mut corners = Vec::new();
    let at = |indices: &[u32], corner: u32| indices.get(corner as usize).copied().unwrap_or(u32::MAX);
    for &face_index in &part.face_indices {
        let hole = mesh.face_hole.get(face_index as usize).copied().unwrap_or(false);
        let Some(&face) = mesh.faces.get(face_index as usize).filter(|f| f.num_indices >= 3 && !hole) else { continue };
        let count = ufbx::triangulate_face_vec(&mut corners, mesh, face) as usize;
        for triangle in corners[..corners.len().min(count * 3)].as_chunks::<3>().0 {
            built.triangles.push(triangle.map(|corner| {
                let key = [
                    at(&positions.indices, corner),
                    if normals.exists { at(&normals.indices, corner) } else { 0 },
                    uvs.map_or(0, |uv| at(&uv.indices, corner)),
                ];
                *known.entry(key).or_insert_with(|| {
                    let [p, n, t] = key.map(|i| i as usize);
                    // An index to nothing becomes a position that is not finite, which is an error with the mesh's name.
                    built.positions.push(positions.values.get(p).map_or(Vec3::NAN, |v| (dvec3(v) - origin).as_vec3()));
                    if normals.exists {
                        built.normals.push(normals.values.get(n).map_or(Vec3::ZERO, |v| dvec3(v).as_vec3()));
                    }
                    if let Some(uv) = uvs {
                        built.uvs.push(uv.values.get(t).map_or(Vec2::ZERO, |v| Vec2::new(v.x as f32, v.y as f32)));
                    }
                    (built.positions.len() - 1) as u32
                })
            }));
        }
    }
    built
}

fn dvec3(v: &ufbx::Vec3) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}
