//! The content of an OBJ file as written, and the meshes of its groups.

use crate::assembly::origin_of;
use crate::polygon;
use enfilade_geometry::Mesh;
use enfilade_math::{DVec3, Vec2, Vec3};
use std::collections::HashMap;
use std::ops::Range;

/// Marks a corner without a texture coordinate or normal.
pub(super) const NONE: u32 = u32::MAX;

/// The content of an OBJ file.
#[derive(Default)]
pub(crate) struct ObjFile {
    pub(super) positions: Vec<DVec3>,
    /// The point from which the positions of meshes count.
    pub(crate) origin: DVec3,
    pub(super) uvs: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    /// Colours of the vertices up to the last that has one.
    pub(super) colors: Vec<Option<Vec3>>,
    /// Faces by object, group and material, in order of first appearance.
    pub(crate) groups: Vec<Group>,
    /// Names of material libraries, each the whole rest of its line.
    pub(crate) libraries: Vec<String>,
    /// Notes on what was ignored, each kind once.
    pub(crate) notes: Vec<String>,
}

/// Faces of one group (or object) that share a material.
pub(crate) struct Group {
    /// Number of the object; each `o` begins one, also of a name that occurred before.
    pub(crate) object: usize,
    /// Name of the object, if an `o` precedes it.
    pub(crate) object_name: Option<String>,
    /// Name of the object or group, whichever was set last; the first of several groups.
    pub(crate) name: Option<String>,
    /// Names of the groups around it, from the inside.
    pub(super) around: Vec<String>,
    /// Name of the material.
    pub(crate) material: Option<String>,
    /// Corner indices of all faces, and where each face begins.
    pub(super) corners: Vec<[u32; 3]>,
    pub(super) faces: Vec<Face>,
}

/// One polygon.
pub(super) struct Face {
    /// First corner of the face.
    pub(super) first: u32,
    pub(super) line: u32,
    /// Smoothing group of the face; 0 is none.
    pub(super) smoothing: u32,
}

impl ObjFile {
    /// Makes the positions of meshes relative to a point nearby, if those of the file are far from the origin of its coordinates.
    pub(crate) fn settle(&mut self, meters_per_unit: f64) {
        self.origin = origin_of(self.positions.iter().copied(), meters_per_unit);
    }

    /// A position as meshes have it.
    pub(super) fn position(&self, index: u32) -> Vec3 {
        (self.positions[index as usize] - self.origin).as_vec3()
    }

    /// The mean colour of a group's corners, 0 … 1 as they are written; `None` where none has a colour.
    pub(crate) fn mean_color(&self, group: &Group) -> Option<Vec3> {
        let colors = group.corners.iter().filter_map(|corner| *self.colors.get(corner[0] as usize)?);
        let (sum, count) = colors.fold((Vec3::ZERO, 0u32), |(sum, count), color| (sum + color, count + 1));
        (count > 0).then(|| (sum / count as f32).clamp(Vec3::ZERO, Vec3::ONE))
    }

    /// The mesh of some groups, in positions from [`Self::origin`]. Vertices are shared by corners with the same indices, polygons are cut
    /// into triangles. Normals and texture coordinates are there when any corner has one; corners without one get zero (which is replaced later).
    pub(crate) fn mesh<'g>(&self, groups: impl Iterator<Item = &'g Group> + Clone) -> Mesh {
        let any = |k: usize| groups.clone().any(|g| g.corners.iter().any(|c| c[k] != NONE));
        let (with_uvs, with_normals) = (any(1), any(2));
        let mut mesh = Mesh::default();
        let mut known: HashMap<[u32; 3], u32> = HashMap::new();
        let mut polygon: Vec<u32> = Vec::new();
        let mut points: Vec<Vec3> = Vec::new();
        for group in groups {
            for face in 0..group.faces.len() {
                polygon.clear();
                for &corner in group.corners_of(face) {
                    polygon.push(*known.entry(corner).or_insert_with(|| {
                        mesh.positions.push(self.position(corner[0]));
                        if with_uvs {
                            mesh.uvs.push(self.uvs.get(corner[1] as usize).copied().unwrap_or_default());
                        }
                        if with_normals {
                            mesh.normals.push(self.normals.get(corner[2] as usize).copied().unwrap_or_default());
                        }
                        (mesh.positions.len() - 1) as u32
                    }));
                }
                if let [a, b, c] = polygon[..] {
                    mesh.triangles.push([a, b, c]);
                } else {
                    points.clear();
                    points.extend(polygon.iter().map(|&i| mesh.positions[i as usize]));
                    mesh.triangles.extend(polygon::triangulate(&points).into_iter().map(|t| t.map(|i| polygon[i])));
                }
            }
        }
        mesh
    }
}

impl Group {
    pub(super) fn corners_of(&self, face: usize) -> &[[u32; 3]] {
        &self.corners[self.range_of(face)]
    }

    /// The range of a face's corners.
    pub(super) fn range_of(&self, face: usize) -> Range<usize> {
        let end = self.faces.get(face + 1).map_or(self.corners.len(), |f| f.first as usize);
        self.faces[face].first as usize..end
    }
}
