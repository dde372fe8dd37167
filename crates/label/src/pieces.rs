//! Parts that people cut into pieces: which piece a pixel shows, and the scene with its pieces as parts.
//!
//! The renderer only knows parts, so `render_entity_id` gives the part that a pixel shows. Where that part was cut, the point in `position`
//! determines the face, and with it the piece: the point lies on the face, up to rounding.

use super::{JoinError, join};
use enfilade_dataset::{DatasetError, MeshFiles};
use enfilade_frame::Values;
use enfilade_geometry::{Mesh, NearestTriangle};
use enfilade_math::{DVec3, Vec3};
use enfilade_scene::{Labels, PartId, Scene};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The parts of a scene that were cut into pieces. Pieces are numbered like objects: what is left of part `i` is piece `i`, others follow.
pub struct Pieces {
    parts: BTreeMap<PartId, PiecedPart>,
    /// Names of the pieces beyond the parts, and the part of each.
    pieces: Vec<PartId>,
}

struct PiecedPart {
    /// The piece of every triangle.
    piece_of: Vec<u32>,
    faces: NearestTriangle,
}

impl Pieces {
    /// The pieces in the mesh folder; `None` if nothing was cut.
    ///
    /// # Errors
    /// When a file is damaged, or is about another version of the scene.
    pub fn read(files: &MeshFiles, scene: &Scene) -> Result<Option<Self>, DatasetError> {
        let pieces = files.read_pieces()?;
        if pieces.is_empty() {
            return Ok(None);
        }
        let piece_of_face = files.read_objects_of_faces()?;
        let (mut parts, mut first) = (BTreeMap::new(), 0);
        let whole = scene.parts.len();
        let belongs =
            |piece: u32, part: usize| piece as usize == part || pieces.get((piece as usize).wrapping_sub(whole)) == Some(&(part as u32));
        let other = || DatasetError::Hdf5 {
            path: files.file("mesh_faces_oi.hdf5"),
            problem: "it is about another version of the scene; run the label stage again".into(),
        };
        for (part, placed) in scene.parts.iter().enumerate() {
            let count = scene.meshes[placed.mesh as usize].triangles.len();
            let piece_of = piece_of_face.get(first..first + count).ok_or_else(other)?;
            if !piece_of.iter().all(|&piece| belongs(piece, part)) {
                return Err(other());
            }
            if piece_of.iter().any(|&piece| piece as usize != part) {
                let corners: Vec<[Vec3; 3]> = (0..count).map(|triangle| scene.world_corners(placed, triangle)).collect();
                parts.insert(part as PartId, PiecedPart { piece_of: piece_of.to_vec(), faces: NearestTriangle::new(&corners) });
            }
            first += count;
        }
        if first == piece_of_face.len() { Ok(Some(Self { parts, pieces })) } else { Err(other()) }
    }

    /// Number of pieces beyond the parts.
    pub fn count(&self) -> usize {
        self.pieces.len()
    }

    /// For hashing: the piece of every triangle of every part that was cut.
    pub fn pieces_of_faces(&self) -> impl Iterator<Item = (PartId, &[u32])> {
        self.parts.iter().map(|(&part, cut)| (part, cut.piece_of.as_slice()))
    }

    /// Classes and instances of pixels as by [`join`], where `positions` (world, metres) distinguishes the pieces of parts. `labels`
    /// has one row per piece.
    ///
    /// # Errors
    /// As [`join`].
    pub fn join(&self, entity_ids: &[i16], positions: &Values, labels: &Labels) -> Result<(Vec<i16>, Vec<i16>), JoinError> {
        let (mut semantic, mut instance) = join(entity_ids, labels)?;
        let wanted = semantic.par_iter_mut().zip(&mut instance).zip(entity_ids).enumerate();
        wanted.for_each(|(pixel, ((semantic, instance), &id))| {
            let Some(cut) = u32::try_from(i32::from(id) - 1).ok().and_then(|part| self.parts.get(&part)) else { return };
            let at = DVec3::new(positions.get(3 * pixel), positions.get(3 * pixel + 1), positions.get(3 * pixel + 2));
            let piece = cut.faces.nearest(at).map(|(face, _)| cut.piece_of[face as usize] as usize);
            if let Some(label) = piece.and_then(|piece| labels.parts.get(piece)) {
                (*semantic, *instance) = (label.semantic, label.instance);
            }
        });
        Ok((semantic, instance))
    }

    /// The scene with every piece as a part of its own, in the order of pieces: what boxes are made of.
    pub fn scene_of_pieces(&self, scene: &Scene) -> Scene {
        let mut pieces = scene.clone();
        for (number, &part) in self.pieces.iter().enumerate() {
            let mut piece = scene.parts[part as usize].clone();
            piece.name = format!("{}~{number}", piece.name);
            let id = pieces.parts.len() as PartId;
            pieces.parts.push(piece);
            // A piece moves with the part that it was cut from.
            if let Some(body) = pieces.bodies.iter_mut().find(|body| body.parts.contains(&part)) {
                body.parts.push(id);
            }
        }
        let of_part = |number: usize| match number.checked_sub(scene.parts.len()) {
            None => number as PartId,
            Some(beyond) => self.pieces[beyond],
        };
        for number in 0..pieces.parts.len() {
            let Some(cut) = self.parts.get(&of_part(number)) else { continue };
            let mesh = &scene.meshes[pieces.parts[number].mesh as usize];
            let kept = mesh.triangles.iter().zip(&cut.piece_of).filter(|(_, piece)| **piece as usize == number);
            let mesh = Mesh { triangles: kept.map(|(triangle, _)| *triangle).collect(), ..Mesh::clone(mesh) };
            pieces.parts[number].mesh = pieces.meshes.len() as u32;
            pieces.meshes.push(mesh.into());
        }
        pieces
    }
}
