//! Doing the edits of a log again, without the geometry that the page shows with them.

use super::before::Before;
use super::edit::{Edit, numbers};
use super::labelled::Annotation;
use super::log_lines::{Entry, Header};
use super::steps::{Step, Steps};
use enfilade_scene::{Labels, PartId, PartLabel};

/// An annotation on its way through its edits.
pub(super) struct Replay {
    labels: Vec<PartLabel>,
    /// Pieces beyond the parts: name and part.
    pieces: Vec<(String, PartId)>,
    piece_of_face: Vec<u32>,
    next_instance: i32,
    steps: Steps,
}

impl Replay {
    /// Begins with the labels of the first line. `part_of_face` has the part of every face.
    pub fn new(header: &Header, part_of_face: Vec<PartId>) -> Self {
        let initial = header.initial_semantic.iter().zip(&header.initial_instance);
        let labels: Vec<PartLabel> = initial.map(|(&semantic, &instance)| PartLabel { semantic, instance }).collect();
        let next_instance = labels.iter().map(|label| i32::from(label.instance)).max().unwrap_or(0).max(0) + 1;
        Self { labels, pieces: Vec::new(), piece_of_face: part_of_face, next_instance, steps: Steps::default() }
    }

    /// Does an edit.
    ///
    /// # Errors
    /// Why it cannot be done; then nothing has changed.
    pub fn perform(&mut self, entry: Entry) -> Result<(), String> {
        let Entry { revision, time, who, edit, .. } = entry;
        edit.check(&Before { pieces: self.labels.len(), piece_of_face: &self.piece_of_face, steps: &self.steps })?;
        match edit {
            Edit::Undo | Edit::UndoOf { .. } => {
                if let Some(step) = self.steps.undo(&edit, who, revision).cloned() {
                    self.revert(&step);
                }
            }
            Edit::Redo | Edit::RedoOf { .. } => {
                if let Some(step) = self.steps.redo(&edit) {
                    self.apply(Step { revision, time, ..step });
                }
            }
            edit => self.apply(Step::new(edit, revision, time, who)),
        }
        Ok(())
    }

    fn apply(&mut self, mut step: Step) {
        step.first_new = self.labels.len() as u32;
        step.before.clear();
        match &step.edit {
            Edit::Label { pieces, semantic, instance, next_instance, .. } => {
                self.next_instance = self.next_instance.max(*next_instance);
                for ((&piece, &semantic), &instance) in pieces.iter().zip(semantic).zip(instance) {
                    step.before.push(std::mem::replace(&mut self.labels[piece as usize], PartLabel { semantic, instance }));
                }
            }
            Edit::Split { piece, names, faces, .. } => {
                let whole = self.labels.len() - self.pieces.len();
                let part = (*piece as usize).checked_sub(whole).map_or(*piece, |beyond| self.pieces[beyond].1);
                for (name, runs) in names.iter().zip(faces) {
                    self.give(runs, self.labels.len() as u32);
                    self.pieces.push((name.clone(), part));
                    self.labels.push(self.labels[*piece as usize]);
                }
            }
            _ => {}
        }
        self.steps.push(step);
    }

    fn revert(&mut self, step: &Step) {
        match &step.edit {
            Edit::Label { pieces, .. } => {
                // A piece may be named twice: what it was at first counts.
                pieces.iter().zip(&step.before).rev().for_each(|(&piece, &label)| self.labels[piece as usize] = label);
            }
            Edit::Split { piece, names, faces, .. } => {
                faces.iter().for_each(|runs| self.give(runs, *piece));
                self.labels.truncate(self.labels.len() - names.len());
                self.pieces.truncate(self.pieces.len() - names.len());
            }
            _ => {}
        }
    }

    /// Gives faces to a piece.
    fn give(&mut self, runs: &[[u32; 2]], piece: u32) {
        let faces = numbers(runs, self.piece_of_face.len()).unwrap_or_default();
        faces.into_iter().for_each(|face| self.piece_of_face[face as usize] = piece);
    }

    /// The result.
    pub fn into_annotation(self) -> Annotation {
        let Self { labels, pieces, piece_of_face, next_instance, .. } = self;
        Annotation { labels: Labels { parts: labels }, pieces, piece_of_face, instances: next_instance.max(1) as usize - 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::super::FORMAT;
    use super::*;

    fn replay() -> Replay {
        let header = Header {
            format: FORMAT.into(),
            scene: "room".into(),
            scene_hash: String::new(),
            parts: 2,
            faces: 6,
            initial_semantic: vec![1, 5],
            initial_instance: vec![-1, 3],
        };
        Replay::new(&header, vec![0, 0, 1, 1, 1, 1])
    }

    /// A line of the log with this edit, by nobody.
    fn entry(revision: u64, edit: Edit) -> Entry {
        Entry { revision, time: String::new(), client: "test".into(), who: None, id: None, edit }
    }

    fn label(piece: u32, semantic: i16, instance: i16) -> Edit {
        let next_instance = i32::from(instance) + 1;
        Edit::Label { description: String::new(), pieces: vec![piece], semantic: vec![semantic], instance: vec![instance], next_instance }
    }

    fn split(piece: u32, faces: [u32; 2]) -> Edit {
        Edit::Split { description: String::new(), piece, names: vec![format!("{piece}~")], faces: vec![vec![faces]] }
    }

    #[test]
    fn edits_are_done_undone_and_done_again() {
        let mut replay = replay();
        let edits = [label(0, 7, -1), split(1, [3, 2]), split(2, [4, 1]), label(3, 9, 4), Edit::Undo, Edit::Undo, Edit::Redo];
        for (revision, edit) in (1..).zip(edits) {
            replay.perform(entry(revision, edit)).unwrap();
        }
        let pair = |semantic, instance| PartLabel { semantic, instance };
        let found = replay.into_annotation();
        assert_eq!(found.labels.parts, [pair(7, -1), pair(5, 3), pair(5, 3), pair(5, 3)]);
        assert_eq!((found.pieces, found.piece_of_face), (vec![("1~".into(), 1), ("2~".into(), 1)], vec![0, 0, 1, 2, 3, 1]));
        assert_eq!(found.instances, 4, "a number that was given out once stays so");
    }

    #[test]
    fn all_undone_is_the_beginning() {
        let mut replay = replay();
        let edits = [split(1, [2, 2]), label(2, 9, 4), label(0, 2, 5), Edit::Undo, Edit::Undo, Edit::Undo];
        for (revision, edit) in (1..).zip(edits) {
            replay.perform(entry(revision, edit)).unwrap();
        }
        let found = replay.into_annotation();
        assert_eq!((found.labels.parts.len(), found.labels.parts[0].semantic, found.pieces.len()), (2, 1, 0));
        assert_eq!(found.piece_of_face, [0, 0, 1, 1, 1, 1]);
    }

    #[test]
    fn edits_that_do_not_fit_are_refused() {
        for edit in [Edit::Undo, Edit::Redo, label(2, 1, 1), split(0, [1, 2]), split(1, [5, 2]), split(9, [0, 1])] {
            assert!(replay().perform(entry(1, edit.clone())).is_err(), "{edit:?}");
        }
    }

    #[test]
    fn an_edit_below_later_ones_is_undone_and_done_again() {
        let mut replay = replay();
        let by = |who: &str, revision, edit| Entry { who: Some(who.into()), ..entry(revision, edit) };
        replay.perform(by("ada", 1, label(0, 7, -1))).unwrap();
        replay.perform(by("ben", 2, label(1, 9, -1))).unwrap();
        replay.perform(by("ada", 3, Edit::UndoOf { revision: 1 })).unwrap();
        assert_eq!(replay.labels.iter().map(|label| label.semantic).collect::<Vec<_>>(), [1, 9]);
        assert!(replay.perform(by("ada", 4, Edit::UndoOf { revision: 1 })).is_err());
        replay.perform(by("ben", 4, Edit::Undo)).unwrap();
        replay.perform(by("ada", 5, Edit::RedoOf { revision: 1 })).unwrap();
        assert_eq!(replay.labels.iter().map(|label| label.semantic).collect::<Vec<_>>(), [7, 5]);
    }
}
