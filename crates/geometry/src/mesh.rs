//! Indexed triangle meshes: positions, optional normals and texture coordinates, and the checks that the rest relies on.

use enfilade_math::{Bounds3, Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// An indexed triangle mesh in its own space.
///
/// `normals` and `uvs` are per vertex and either empty or as long as `positions`. Counter-clockwise triangles face outward.
///
/// ```
/// use enfilade_geometry::Mesh;
/// use enfilade_math::{Vec2, Vec3};
///
/// let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from);
/// let mut mesh = Mesh {
///     positions: square.map(|uv| uv.extend(0.0)).to_vec(),
///     uvs: square.to_vec(),
///     triangles: vec![[0, 1, 2], [0, 2, 3]],
///     ..Mesh::default()
/// };
/// assert_eq!(mesh.validate(), Ok(()));
/// assert_eq!(mesh.bounds().extent(), Vec3::new(1.0, 1.0, 0.0));
///
/// mesh.triangles[1][2] = 4;
/// assert_eq!(mesh.validate().unwrap_err().to_string(), "triangle 1 refers to vertex 4, but there are 4 vertices, counted from 0");
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Unit shading normals; empty means flat shading.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, v upward (OBJ's convention: (0,0) is the lower left corner of the image); empty means none.
    pub uvs: Vec<Vec2>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// Why a mesh is not usable as it is.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// No triangles at all.
    #[error("the mesh has no triangles; remove it or export it with faces")]
    Empty,
    /// An index beyond the vertices.
    #[error("triangle {triangle} refers to vertex {index}, but there are {vertices} vertices, counted from 0")]
    IndexOutOfRange {
        /// Index of the triangle.
        triangle: usize,
        /// The index found.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A coordinate that is NaN or infinite.
    #[error("vertex {vertex} has a {attribute} that is not finite: {value}; clean the mesh in the program that made it")]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
        /// "position", "normal" or "texture coordinate".
        attribute: &'static str,
        /// The value as text.
        value: String,
    },
    /// An attribute array of the wrong length.
    #[error("{found} {attribute}s for {expected} vertices; expected one per vertex or none")]
    Length {
        /// "normal" or "texture coordinate".
        attribute: &'static str,
        /// Number found.
        found: usize,
        /// Number of vertices.
        expected: usize,
    },
}

impl Mesh {
    /// Checks every invariant that the rest of the workspace relies on.
    ///
    /// # Errors
    /// The first [`MeshError`] found.
    pub fn validate(&self) -> Result<(), MeshError> {
        let vertices = self.positions.len();
        if self.triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        for (attribute, found) in [("normal", self.normals.len()), ("texture coordinate", self.uvs.len())] {
            if found != 0 && found != vertices {
                return Err(MeshError::Length { attribute, found, expected: vertices });
            }
        }
        for (triangle, indices) in self.triangles.iter().enumerate() {
            if let Some(&index) = indices.iter().find(|&&i| i as usize >= vertices) {
                return Err(MeshError::IndexOutOfRange { triangle, index, vertices });
            }
        }
        let not_finite = |vertex, attribute, value| Err(MeshError::NotFinite { vertex, attribute, value });
        if let Some((i, p)) = self.positions.iter().enumerate().find(|(_, p)| !p.is_finite()) {
            return not_finite(i, "position", p.to_string());
        }
        if let Some((i, n)) = self.normals.iter().enumerate().find(|(_, n)| !n.is_finite()) {
            return not_finite(i, "normal", n.to_string());
        }
        if let Some((i, uv)) = self.uvs.iter().enumerate().find(|(_, uv)| !uv.is_finite()) {
            return not_finite(i, "texture coordinate", uv.to_string());
        }
        Ok(())
    }

    /// The corners of triangle `index`.
    #[inline]
    pub fn corners(&self, index: usize) -> [Vec3; 3] {
        self.triangles[index].map(|i| self.positions[i as usize])
    }

    /// The smallest axis-aligned box around all vertices.
    pub fn bounds(&self) -> Bounds3 {
        Bounds3::from_points(self.positions.iter().copied())
    }

    /// Appends another mesh. Attributes that only one of both has are filled: normals from the faces, uvs with zero.
    pub fn append(&mut self, other: &Self) {
        if self.triangles.is_empty() {
            *self = other.clone();
            return;
        }
        let mut other = other.clone();
        if self.normals.is_empty() != other.normals.is_empty() {
            self.fill_flat_normals();
            other.fill_flat_normals();
        }
        if self.uvs.is_empty() != other.uvs.is_empty() {
            self.uvs.resize(self.positions.len(), Vec2::ZERO);
            other.uvs.resize(other.positions.len(), Vec2::ZERO);
        }
        let base = self.positions.len() as u32;
        self.positions.extend(other.positions);
        self.normals.extend(other.normals);
        self.uvs.extend(other.uvs);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + base)));
    }

    /// Gives every triangle its own vertices with the face normal, when there are no normals.
    fn fill_flat_normals(&mut self) {
        if !self.normals.is_empty() {
            return;
        }
        let corners: Vec<[u32; 3]> = self.triangles.clone();
        let pick = |i: u32| i as usize;
        let mut flat = Self::default();
        for t in corners {
            let p = t.map(|i| self.positions[pick(i)]);
            let n = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or(Vec3::Z);
            let base = flat.positions.len() as u32;
            flat.positions.extend(p);
            flat.normals.extend([n; 3]);
            if !self.uvs.is_empty() {
                flat.uvs.extend(t.map(|i| self.uvs[pick(i)]));
            }
            flat.triangles.push([base, base + 1, base + 2]);
        }
        *self = flat;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Mesh {
        Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() }
    }

    #[test]
    fn bad_meshes_are_named() {
        assert_eq!(Mesh::default().validate(), Err(MeshError::Empty));
        let mut m = triangle();
        m.triangles[0][1] = 7;
        assert_eq!(m.validate(), Err(MeshError::IndexOutOfRange { triangle: 0, index: 7, vertices: 3 }));
        let mut m = triangle();
        m.positions[2].y = f32::NAN;
        assert!(m.validate().unwrap_err().to_string().starts_with("vertex 2 has a position that is not finite"));
        let mut m = triangle();
        m.uvs.push(Vec2::ZERO);
        assert!(matches!(m.validate(), Err(MeshError::Length { found: 1, expected: 3, .. })));
        assert_eq!(triangle().validate(), Ok(()));
    }

    #[test]
    fn appending_keeps_attributes_in_step() {
        let mut m = triangle();
        let mut smooth = triangle();
        smooth.normals = vec![Vec3::Z; 3];
        m.append(&smooth);
        assert_eq!((m.validate(), m.triangles.len(), m.normals.len()), (Ok(()), 2, 6));
    }
}
