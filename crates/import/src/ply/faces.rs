//! The faces of a PLY file, kept until its vertices are known, and the triangles that come of them.

use super::header::Problem;
use crate::polygon;
use enfilade_geometry::Mesh;
use enfilade_math::{Vec2, Vec3};
use std::collections::HashMap;

/// Polygons by the indices of their corners.
#[derive(Default)]
pub(super) struct Faces {
    corners: Vec<u32>,
    /// Texture coordinates of the corners, where the faces have them.
    uvs: Vec<Vec2>,
    /// Number of the face in the file, and where its corners end.
    ends: Vec<(u64, usize)>,
    /// Face and index of the first corner that cannot be one.
    bad: Option<(u64, f64)>,
}

impl Faces {
    /// Adds a polygon, with two coordinates for each of its corners or with none.
    pub(super) fn push(&mut self, number: u64, polygon: &[f64], uvs: Option<&[f64]>) {
        for &index in polygon {
            if !(0.0..f64::from(u32::MAX)).contains(&index) {
                self.bad = self.bad.or(Some((number, index)));
            }
            self.corners.push(index as u32);
        }
        if let Some(uvs) = uvs {
            let uv = |i: usize| uvs.get(2 * i).zip(uvs.get(2 * i + 1)).map_or(Vec2::NAN, |(u, v)| Vec2::new(*u as f32, *v as f32));
            self.uvs.extend((0..polygon.len()).map(uv));
        }
        self.ends.push((number, self.corners.len()));
    }

    /// Adds the triangles of a strip; a negative index ends it and begins another.
    pub(super) fn push_strip(&mut self, number: u64, strip: &[f64]) {
        for run in strip.split(|index| *index < 0.0) {
            for (i, t) in run.windows(3).enumerate().filter(|(_, t)| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) {
                let [a, b] = if i % 2 == 0 { [t[0], t[1]] } else { [t[1], t[0]] };
                self.push(number, &[a, b, t[2]], None);
            }
        }
    }

    /// Cuts the polygons into the triangles of `mesh`. Vertices are split where corners have texture coordinates of their own.
    pub(super) fn cut_into(self, mesh: &mut Mesh) -> Result<(), Problem> {
        let vertices = mesh.positions.len();
        let outside = |number: u64, index: f64| {
            let problem = format!("it refers to vertex {index}, but there are {vertices}, counted from 0; export the file again");
            (format!("face {number}"), problem)
        };
        if let Some((number, index)) = self.bad {
            return Err(outside(number, index));
        }
        let mut first = 0;
        for &(number, end) in &self.ends {
            let found = self.corners[first..end].iter().find(|&&index| index as usize >= vertices);
            if let Some(&index) = found {
                return Err(outside(number, f64::from(index)));
            }
            first = end;
        }
        let has_uvs = !self.uvs.is_empty() && self.uvs.len() == self.corners.len();
        let corners = if has_uvs && mesh.uvs.is_empty() { self.split(mesh) } else { self.corners };
        first = 0;
        for (_, end) in self.ends {
            let face = &corners[first..end];
            let points: Vec<Vec3> = face.iter().map(|&i| mesh.positions[i as usize]).collect();
            mesh.triangles.extend(polygon::triangulate(&points).into_iter().map(|t| t.map(|i| face[i])));
            first = end;
        }
        Ok(())
    }

    /// Gives the mesh a vertex for each pair of vertex and texture coordinates, and returns the corners by these.
    fn split(&self, mesh: &mut Mesh) -> Vec<u32> {
        let old = std::mem::take(mesh);
        let mut known: HashMap<(u32, [u32; 2]), u32> = HashMap::new();
        let pairs = self.corners.iter().zip(&self.uvs);
        let corners = pairs.map(|(&vertex, uv)| {
            *known.entry((vertex, [uv.x.to_bits(), uv.y.to_bits()])).or_insert_with(|| {
                mesh.positions.push(old.positions[vertex as usize]);
                mesh.normals.extend(old.normals.get(vertex as usize));
                mesh.uvs.push(*uv);
                (mesh.positions.len() - 1) as u32
            })
        });
        corners.collect()
    }
}
