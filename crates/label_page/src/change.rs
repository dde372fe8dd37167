//! What an edit changed, as sent to every page that shows the scene.

use super::pieces::{Piece, Pieces};
use super::scene::NO_MATERIAL;
use serde::Serialize;
use std::collections::BTreeMap;

/// A change, as it is sent to pages.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Change {
    /// The revision after it.
    pub revision: u64,
    /// The client that requested it.
    pub client: String,
    /// The name of the person who requested it.
    pub who: Option<String>,
    /// Of an undo or redo: the name of the person whose edit that was.
    pub of: Option<String>,
    /// For people.
    pub description: String,
    /// Pieces with other labels than before.
    pub pieces: Vec<u32>,
    /// The pieces' classes now.
    pub semantic: Vec<i16>,
    /// The pieces' instances now.
    pub instance: Vec<i16>,
    /// Pieces that were not there before.
    pub added: Vec<PieceRow>,
    /// Faces that belong to another piece than before, and to which.
    pub moved_faces: (Vec<u32>, Vec<u32>),
    /// Pieces with other faces than before.
    pub resized: Vec<PieceRow>,
    /// Pieces that no longer exist: those with the last numbers.
    pub removed: Vec<u32>,
    /// True when there is something to undo.
    pub can_undo: bool,
    /// True when there is something to do again.
    pub can_redo: bool,
    /// The edit that undo would revert.
    pub undo_description: Option<String>,
    /// The edit that redo would repeat.
    pub redo_description: Option<String>,
    /// What each person can undo and redo; under the empty name, who has done nothing yet.
    pub people: BTreeMap<String, Own>,
    /// The first instance number that was never given out.
    pub next_instance: i32,
}

/// What somebody can undo and redo, described.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Own {
    /// The edit that undo would revert.
    pub undo: Option<String>,
    /// The edit that redo would repeat.
    pub redo: Option<String>,
}

/// The revision of a session, and what can be undone and redone.
#[derive(Clone, Debug)]
pub struct Standing {
    /// Number of edits ever made, undone ones and undoing included.
    pub revision: u64,
    /// The last edits of all.
    pub all: Own,
    /// The last edits of each person, by name.
    pub people: BTreeMap<String, Own>,
    /// The first instance number that was never given out.
    pub next_instance: i32,
}

/// Everything about a piece.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PieceRow {
    piece: u32,
    name: String,
    parent: u32,
    material: String,
    faces: usize,
    area_m2: f64,
    min: [f32; 3],
    max: [f32; 3],
    geometry_key: u32,
    semantic: i16,
    instance: i16,
}

impl PieceRow {
    fn new(pieces: &Pieces, number: u32) -> Self {
        let Piece { name, part, label, faces, measure } = &pieces.list()[number as usize];
        Self {
            piece: number,
            name: name.clone(),
            parent: *part,
            material: material_name(pieces, measure.material).into(),
            faces: faces.len(),
            area_m2: measure.area_m2,
            min: measure.min,
            max: measure.max,
            geometry_key: measure.geometry_key,
            semantic: label.semantic,
            instance: label.instance,
        }
    }
}

/// The name of a material; empty for none.
pub fn material_name(pieces: &Pieces, material: u32) -> &str {
    if material == NO_MATERIAL { "" } else { &pieces.scene().materials[material as usize] }
}

impl Change {
    /// Labels of pieces, as they are now.
    pub fn labels(pieces: &Pieces, which: &[u32]) -> Self {
        let label = |&piece: &u32| pieces.list()[piece as usize].label;
        Self {
            pieces: which.to_vec(),
            semantic: which.iter().map(|piece| label(piece).semantic).collect(),
            instance: which.iter().map(|piece| label(piece).instance).collect(),
            ..Self::default()
        }
    }

    /// The last `count` pieces were taken out of `piece`.
    pub fn split(pieces: &Pieces, piece: u32, count: usize) -> Self {
        let numbers = (pieces.list().len() - count) as u32..pieces.list().len() as u32;
        let faces = |number: u32| pieces.list()[number as usize].faces.iter().map(move |&face| (face, number));
        Self {
            added: numbers.clone().map(|number| PieceRow::new(pieces, number)).collect(),
            moved_faces: numbers.flat_map(faces).unzip(),
            resized: vec![PieceRow::new(pieces, piece)],
            ..Self::default()
        }
    }

    /// The `count` pieces from `first` on became part of `piece` again, with the faces `moved`.
    pub fn join(pieces: &Pieces, piece: u32, first: u32, count: usize, moved: Vec<u32>) -> Self {
        let to = vec![piece; moved.len()];
        let removed = (first..first + count as u32).collect();
        Self { moved_faces: (moved, to), resized: vec![PieceRow::new(pieces, piece)], removed, ..Self::default() }
    }

    /// Adds what was done, by whom, and the state of the session after it.
    #[must_use]
    pub fn told(mut self, now: &Standing, client: &str, who: Option<String>, description: String) -> Self {
        self.description = description;
        (self.client, self.who) = (client.into(), who);
        self.revision = now.revision;
        (self.undo_description, self.redo_description) = (now.all.undo.clone(), now.all.redo.clone());
        self.can_undo = self.undo_description.is_some();
        self.can_redo = self.redo_description.is_some();
        self.people.clone_from(&now.people);
        self.next_instance = now.next_instance;
        self
    }
}
