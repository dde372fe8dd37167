//! Meshes that a placement flattens, such as sheets with a scale of zero along their normal.

use super::Assembly;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3};
use std::collections::HashMap;

/// Triangles that may be kept of all flattened parts together: each part needs a mesh of its own.
const MAX_TRIANGLES: usize = 1 << 22;

/// A triangle's doubled area below this share of its longest edge's square is none.
const NO_AREA: f64 = 1e-9;

impl Assembly<'_> {
    /// The triangles of a mesh that keep an area under a placement that flattens it, as a mesh without normals, and the placement of
    /// that. `None` where there are none, or too many in the scene.
    pub(super) fn flattened(&mut self, mesh: u32, world_from_mesh: DAffine3) -> Option<(u32, DAffine3)> {
        let mesh = &self.scene.meshes[mesh as usize];
        let left = MAX_TRIANGLES - self.flattened;
        if mesh.triangles.len() > left || !world_from_mesh.is_finite() {
            return None;
        }
        let flat = flat(mesh, world_from_mesh).filter(|flat| flat.validate().is_ok())?;
        self.flattened += flat.triangles.len();
        self.scene.meshes.push(flat.into());
        Some(((self.scene.meshes.len() - 1) as u32, DAffine3::from_translation(world_from_mesh.translation)))
    }
}

/// The triangles that keep an area, turned and scaled but not moved.
fn flat(mesh: &Mesh, world_from_mesh: DAffine3) -> Option<Mesh> {
    let at = |index: u32| world_from_mesh.transform_vector3(mesh.positions[index as usize].as_dvec3());
    let has_area = |triangle: &&[u32; 3]| {
        let [a, b, c] = triangle.map(at);
        let (ab, bc, ca): (DVec3, DVec3, DVec3) = (b - a, c - b, a - c);
        let longest = ab.length_squared().max(bc.length_squared()).max(ca.length_squared());
        ab.cross(ca).length() > NO_AREA * longest
    };
    let (mut flat, mut known) = (Mesh::default(), HashMap::new());
    for triangle in mesh.triangles.iter().filter(has_area) {
        flat.triangles.push(triangle.map(|index| {
            *known.entry(index).or_insert_with(|| {
                flat.positions.push(at(index).as_vec3());
                flat.uvs.extend(mesh.uvs.get(index as usize));
                (flat.positions.len() - 1) as u32
            })
        }));
    }
    (!flat.triangles.is_empty()).then_some(flat)
}
