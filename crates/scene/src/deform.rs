//! Shapes of meshes that deform: skins that bend, morphs, what is stretched.

use enfilade_geometry::Mesh;
use enfilade_math::Vec3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The vertices of a mesh at a moment, in the mesh's own space; their number, texture coordinates and triangles are the mesh's.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// Positions.
    pub positions: Vec<Vec3>,
    /// Unit shading normals; none for meshes that have none.
    pub normals: Vec<Vec3>,
}

impl Shape {
    /// The shape that a mesh has.
    pub fn of(mesh: &Mesh) -> Self {
        Self { positions: mesh.positions.clone(), normals: mesh.normals.clone() }
    }

    /// The mesh in this shape.
    #[must_use]
    pub fn on(&self, mesh: &Mesh) -> Mesh {
        Mesh { positions: self.positions.clone(), normals: self.normals.clone(), uvs: mesh.uvs.clone(), triangles: mesh.triangles.clone() }
    }

    /// The shape between this one and another of as many vertices: each goes straight, and normals keep their length.
    #[must_use]
    pub fn between(&self, other: &Self, share: f64) -> Self {
        let positions = self.positions.iter().zip(&other.positions);
        let normals = self.normals.iter().zip(&other.normals);
        Self {
            positions: positions.map(|(a, b)| a.as_dvec3().lerp(b.as_dvec3(), share).as_vec3()).collect(),
            normals: normals.map(|(a, b)| a.lerp(*b, share as f32).try_normalize().unwrap_or(*a)).collect(),
        }
    }

    /// What is wrong with it as a shape of a mesh, if anything.
    pub(crate) fn problem(&self, mesh: &Mesh) -> Option<String> {
        for (what, found, expected) in
            [("positions", self.positions.len(), mesh.positions.len()), ("normals", self.normals.len(), mesh.normals.len())]
        {
            if found != expected {
                return Some(format!("{found} {what}, but its mesh has {expected}"));
            }
        }
        let bad = self.positions.iter().chain(&self.normals).position(|v| !v.is_finite())?;
        Some(format!("vertex {} that is not finite", bad % self.positions.len()))
    }
}

/// The shape at a share of the way from one to the next.
pub(crate) fn mixed(shapes: &[Arc<Shape>], (before, after, share): (usize, usize, f64)) -> Arc<Shape> {
    if before == after || share == 0.0 { shapes[before].clone() } else { shapes[before].between(&shapes[after], share).into() }
}
