//! The pieces of a scene: what is labelled. At first each part is a piece; splitting a piece appends more.

use super::scene::{AnnotatedScene, NO_MATERIAL};
use super::shape::{KnownShapes, ShapeInvariants};
use enfilade_math::{Bounds3, Vec3};
use enfilade_scene::PartLabel;
use enfilade_serve::area_m2;
use std::collections::HashSet;
use std::sync::Arc;

/// A part, or a piece of one that was split.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Unique within the scene.
    pub name: String,
    /// The part it is, or belongs to.
    pub part: u32,
    /// Class and instance of the piece.
    pub label: PartLabel,
    /// Faces of the piece, ascending.
    pub faces: Vec<u32>,
    /// Area, bounds and material of the piece.
    pub measure: Measure,
}

/// Values computed from the faces of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measure {
    /// Square metres.
    pub area_m2: f64,
    /// Lower corner of the bounds, metres; zero for a piece without faces.
    pub min: [f32; 3],
    /// Upper corner of the bounds, metres.
    pub max: [f32; 3],
    /// The material of its first face, [`NO_MATERIAL`] without one.
    pub material: u32,
    /// Equal for pieces of the same geometry, at any position.
    pub geometry_key: u32,
}

/// All pieces of a scene, and which of them every face belongs to.
pub struct Pieces {
    scene: Arc<AnnotatedScene>,
    list: Vec<Piece>,
    of_face: Vec<u32>,
    names: HashSet<String>,
    shapes: KnownShapes,
}

impl Pieces {
    /// One piece per part, with the labels that the parts begin with.
    pub fn new(scene: Arc<AnnotatedScene>, labels: &[PartLabel]) -> Self {
        let mut faces = vec![Vec::new(); scene.parts.len()];
        scene.part_of_face.iter().enumerate().for_each(|(face, &part)| faces[part as usize].push(face as u32));
        let mut shapes = KnownShapes::default();
        let piece = |(part, faces): (usize, Vec<u32>)| Piece {
            name: scene.parts[part].clone(),
            part: part as u32,
            label: labels.get(part).copied().unwrap_or(PartLabel::NONE),
            measure: measure(&scene, &faces, &mut shapes),
            faces,
        };
        let list: Vec<Piece> = faces.into_iter().enumerate().map(piece).collect();
        let names = scene.parts.iter().cloned().collect();
        Self { of_face: scene.part_of_face.clone(), list, names, shapes, scene }
    }

    /// All pieces, in order.
    pub fn list(&self) -> &[Piece] {
        &self.list
    }

    /// The piece of every face.
    pub fn of_face(&self) -> &[u32] {
        &self.of_face
    }

    /// The scene that they are pieces of.
    pub fn scene(&self) -> &Arc<AnnotatedScene> {
        &self.scene
    }

    /// Names for `count` more pieces of a part: the first free ones of `NAME~2`, `NAME~3`, ….
    pub fn new_names(&self, part: u32, count: usize) -> Vec<String> {
        let name = &self.scene.parts[part as usize];
        let free = (2u64..).map(|number| format!("{name}~{number}")).filter(|name| !self.names.contains(name));
        free.take(count).collect()
    }

    /// Labels a piece.
    pub fn set_label(&mut self, piece: u32, label: PartLabel) {
        self.list[piece as usize].label = label;
    }

    /// Takes `groups` of faces out of a piece; each becomes a piece of its own at the end of the list, labelled alike.
    pub fn split(&mut self, piece: u32, names: &[String], groups: &[Vec<u32>]) {
        let (part, label) = (self.list[piece as usize].part, self.list[piece as usize].label);
        for (name, faces) in names.iter().zip(groups) {
            faces.iter().for_each(|&face| self.of_face[face as usize] = self.list.len() as u32);
            self.names.insert(name.clone());
            let measure = measure(&self.scene, faces, &mut self.shapes);
            self.list.push(Piece { name: name.clone(), part, label, faces: faces.clone(), measure });
        }
        let of_face = &self.of_face;
        let kept: Vec<u32> = self.list[piece as usize].faces.iter().copied().filter(|&face| of_face[face as usize] == piece).collect();
        self.set_faces(piece, kept);
    }

    /// Undoes a split: the last `count` pieces become part of `piece` again.
    pub fn join(&mut self, piece: u32, count: usize) {
        let mut faces = std::mem::take(&mut self.list[piece as usize].faces);
        for removed in self.list.split_off(self.list.len() - count) {
            removed.faces.iter().for_each(|&face| self.of_face[face as usize] = piece);
            self.names.remove(&removed.name);
            faces.extend(removed.faces);
        }
        faces.sort_unstable();
        self.set_faces(piece, faces);
    }

    fn set_faces(&mut self, piece: u32, faces: Vec<u32>) {
        let measure = measure(&self.scene, &faces, &mut self.shapes);
        let piece = &mut self.list[piece as usize];
        (piece.faces, piece.measure) = (faces, measure);
    }
}

fn measure(scene: &AnnotatedScene, faces: &[u32], shapes: &mut KnownShapes) -> Measure {
    let corners = || faces.iter().map(|&face| &scene.corners[face as usize]);
    let bounds = Bounds3::from_points(corners().flatten().copied());
    let bounds = if faces.is_empty() { Bounds3 { min: Vec3::ZERO, max: Vec3::ZERO } } else { bounds };
    Measure {
        area_m2: corners().map(area_m2).sum(),
        min: bounds.min.to_array(),
        max: bounds.max.to_array(),
        material: faces.first().map_or(NO_MATERIAL, |&face| scene.material_of_face[face as usize]),
        geometry_key: shapes.key(ShapeInvariants::of(corners())),
    }
}
