//! Polygon meshes (`Mesh`): faces with holes and both orientations, split into triangles with the values of their corners.

use super::primvar::{Primvar, Sizes};
use super::stage::Prim;
use crate::assembly::{Assembly, origin_of, positions_from};
use crate::mesh::add_smooth_normals;
use crate::polygon::triangulate;
use enfilade_geometry::Mesh;
use enfilade_math::{DVec3, Vec2, Vec3};
use std::collections::HashMap;

/// Cutting a larger polygon into triangles could take hours.
const MAX_CORNERS: usize = 4096;

/// A mesh prim's points and faces, checked.
pub(super) struct Polygons {
    points: Vec<Vec3>,
    /// The point from which the points count.
    pub origin: DVec3,
    /// Point of each corner.
    corners: Vec<u32>,
    /// First corner and number of corners of each face.
    faces: Vec<(usize, usize)>,
    left_handed: bool,
    /// True for the faces that `holeIndices` leaves out.
    holes: Vec<bool>,
    /// The attribute of the normals, and their values.
    normals: Option<(&'static str, Primvar<3>)>,
    /// True for subdivision surfaces, whose cage this is.
    pub smooth: bool,
}

/// What a vertex of a mesh was made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Number of the point.
    pub point: u32,
    /// Number of the stated normal; 0 without any.
    pub normal: u32,
}

impl Polygons {
    /// The mesh of a prim of type `Mesh`.
    ///
    /// # Errors
    /// The attribute, and what is wrong with it, when counts and indices do not fit each other.
    pub(super) fn read(prim: &Prim, a: &mut Assembly) -> Result<Self, (&'static str, String)> {
        let numbers = |name: &str, width: usize| prim.value(name).and_then(|v| v.as_numbers(width)).unwrap_or(&[]);
        let points: Vec<DVec3> = numbers("points", 3).as_chunks::<3>().0.iter().map(|p| DVec3::from_array(*p)).collect();
        let origin = origin_of(points.iter().copied(), a.meters_per_unit());
        let points = positions_from(origin, &points);
        let (counts, indices) = (numbers("faceVertexCounts", 1), numbers("faceVertexIndices", 1));
        let mut faces = Vec::with_capacity(counts.len());
        let mut next = 0usize;
        for count in counts {
            if !(*count >= 0.0 && *count <= indices.len() as f64) {
                return Err(("faceVertexCounts", format!("found a face of {count} corners, but there are {}", indices.len())));
            }
            if *count as usize > MAX_CORNERS {
                return Err(("faceVertexCounts", format!("found a face of {count} corners, expected at most {MAX_CORNERS}")));
            }
            faces.push((next, *count as usize));
            next += *count as usize;
        }
        if next != indices.len() {
            let problem = format!("the faces have {next} corners, but faceVertexIndices has {}", indices.len());
            return Err(("faceVertexCounts", problem));
        }
        if let Some(index) = indices.iter().find(|i| !(0.0..points.len() as f64).contains(*i)) {
            return Err(("faceVertexIndices", format!("found point {index}, but there are {}", points.len())));
        }
        let corners: Vec<u32> = indices.iter().map(|i| *i as u32).collect();
        let mut holes = vec![false; faces.len()];
        for face in numbers("holeIndices", 1) {
            if let Some(hole) = holes.get_mut(*face as usize) {
                *hole = true;
            }
        }
        let sizes = Sizes { faces: faces.len(), points: points.len(), corners: corners.len() };
        let mut stated = |attribute| Primvar::read(prim, attribute, "vertex", sizes, a).map(|normals| (attribute, normals));
        let normals = stated("primvars:normals").or_else(|| stated("normals"));
        Ok(Self {
            points,
            origin,
            corners,
            faces,
            left_handed: prim.text("orientation") == Some("leftHanded"),
            holes,
            normals,
            smooth: prim.text("subdivisionScheme").unwrap_or("catmullClark") != "none",
        })
    }

    /// Numbers of faces, points and corners.
    pub(super) fn sizes(&self) -> Sizes {
        Sizes { faces: self.faces.len(), points: self.points.len(), corners: self.corners.len() }
    }

    /// The attribute that states the normals.
    pub(super) fn normals_attribute(&self) -> Option<&'static str> {
        self.normals.as_ref().map(|(attribute, _)| *attribute)
    }

    /// Mesh of some of the faces as triangles, with texture coordinates. Where points of one place have several normals or coordinates,
    /// they become several vertices. Besides, what each vertex was made of.
    pub(super) fn mesh(&self, faces: impl Iterator<Item = usize>, uvs: Option<&Primvar<2>>) -> (Mesh, Vec<Corner>) {
        let (mut mesh, mut made_of) = (Mesh::default(), Vec::new());
        let normals = self.normals.as_ref().map(|(_, normals)| normals);
        let mut vertices: HashMap<[u32; 3], u32> = HashMap::new();
        let mut outline = Vec::new();
        for face in faces.filter(|f| !self.holes.get(*f).copied().unwrap_or(true)) {
            let (first, count) = self.faces[face];
            outline.clear();
            outline.extend((first..first + count).map(|c| self.points[self.corners[c] as usize]));
            let mut vertex = |corner: usize| {
                let point = self.corners[corner];
                let normal = normals.map_or(0, |n| n.element(face, point as usize, corner));
                let uv = uvs.map_or(0, |u| u.element(face, point as usize, corner));
                *vertices.entry([point, normal, uv]).or_insert_with(|| {
                    mesh.positions.push(self.points[point as usize]);
                    made_of.push(Corner { point, normal });
                    if let Some(normals) = normals {
                        mesh.normals.push(Vec3::from_array(normals.get(normal).map(|c| c as f32)));
                    }
                    if let Some(uvs) = uvs {
                        mesh.uvs.push(Vec2::from_array(uvs.get(uv).map(|c| c as f32)));
                    }
                    (mesh.positions.len() - 1) as u32
                })
            };
            for [a, b, c] in triangulate(&outline) {
                let [a, b, c] = [a, b, c].map(|i| vertex(first + i));
                mesh.triangles.push(if self.left_handed { [a, c, b] } else { [a, b, c] });
            }
        }
        if self.smooth && self.normals.is_none() {
            add_smooth_normals(&mut mesh);
        }
        (mesh, made_of)
    }
}
