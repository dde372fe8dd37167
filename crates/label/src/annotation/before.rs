//! Whether an edit can be done in the state that it meets.

use super::edit::{Edit, numbers};
use super::steps::Steps;

/// The state before an edit, against which it is checked.
pub struct Before<'a> {
    /// Number of pieces.
    pub pieces: usize,
    /// The piece of every face.
    pub piece_of_face: &'a [u32],
    /// Edits that can be undone, and that can be redone.
    pub steps: &'a Steps,
}

impl Edit {
    /// Checks that an edit of the log can be done.
    ///
    /// # Errors
    /// The problem.
    pub fn check(&self, before: &Before<'_>) -> Result<(), String> {
        match self {
            Self::Undo | Self::UndoOf { .. } => before.steps.undone_by(self).map(drop),
            Self::Redo | Self::RedoOf { .. } => before.steps.redone_by(self).and_then(|at| before.steps.redone(at).check(before)),
            Self::Label { pieces, semantic, instance, .. } => {
                let fits = semantic.len() == pieces.len() && instance.len() == pieces.len();
                let known = pieces.iter().all(|&piece| (piece as usize) < before.pieces);
                if fits && known { Ok(()) } else { Err("the labels do not fit the pieces".into()) }
            }
            Self::Split { piece, names, faces, .. } => {
                let known = (*piece as usize) < before.pieces && names.len() == faces.len();
                let of_face = before.piece_of_face;
                let its_own = |runs: &Vec<[u32; 2]>| {
                    numbers(runs, of_face.len()).is_some_and(|faces| faces.iter().all(|&face| of_face[face as usize] == *piece))
                };
                if known && faces.iter().all(its_own) { Ok(()) } else { Err("the faces are not of the piece that is split".into()) }
            }
        }
    }
}
