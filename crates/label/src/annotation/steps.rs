//! Edits that were done and that were undone, in order, and whose they are.
//!
//! Undo takes the last edit of one person, also where others have edited since, as long as none of the later edits is about the same
//! pieces; a split can be undone only while its pieces have the last numbers. Redo is the same the other way around. Edits without a name
//! are everybody's.

use super::edit::Edit;
use enfilade_scene::PartLabel;
use std::collections::{BTreeSet, HashSet};

/// An edit that was done, and what is needed to undo it.
#[derive(Clone, Debug)]
pub struct Step {
    /// The edit: a label or a split.
    pub edit: Edit,
    /// The revision at which it was last done, by which it is named.
    pub revision: u64,
    /// The revision at which it was first done; redoing does not change it.
    pub begun: u64,
    /// When it was last done, in UTC.
    pub time: String,
    /// Name of the person; none in logs of programs that knew no names.
    pub who: Option<String>,
    /// Labels of the pieces of an [`Edit::Label`] before.
    pub before: Vec<PartLabel>,
    /// The number of the first piece that an [`Edit::Split`] made.
    pub first_new: u32,
}

/// A step that was undone.
struct Undone {
    step: Step,
    by: Option<String>,
    /// The revision at which it was undone.
    at: u64,
}

/// Why a step cannot be undone or redone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StepProblem {
    /// There is none.
    Nothing,
    /// A later edit is about the same pieces.
    Later {
        /// The edit that was to be undone or redone.
        what: String,
        /// The later edit.
        later: String,
        /// Who made the later edit; empty without a name.
        who: String,
    },
}

/// Everything that was done and undone.
#[derive(Default)]
pub struct Steps {
    done: Vec<Step>,
    undone: Vec<Undone>,
}

impl Step {
    /// An edit that is done for the first time, before it is applied.
    pub fn new(edit: Edit, revision: u64, time: String, who: Option<String>) -> Self {
        Self { edit, revision, begun: revision, time, who, before: Vec::new(), first_new: 0 }
    }

    fn is_split(&self) -> bool {
        matches!(self.edit, Edit::Split { .. })
    }

    /// The pieces that it is about, those that it made included.
    fn pieces(&self) -> HashSet<u32> {
        match &self.edit {
            Edit::Label { pieces, .. } => pieces.iter().copied().collect(),
            Edit::Split { piece, names, .. } => {
                std::iter::once(*piece).chain(self.first_new..self.first_new + names.len() as u32).collect()
            }
            _ => HashSet::new(),
        }
    }

    /// Refuses to pass over later steps that are about the same pieces. Pieces of splits are numbered in order, so no split passes another.
    fn pass<'a>(&self, later: impl Iterator<Item = &'a Self>) -> Result<(), StepProblem> {
        let own = self.pieces();
        let is_in_the_way = |other: &&Self| (self.is_split() && other.is_split()) || !own.is_disjoint(&other.pieces());
        let problem = |other: &Self| StepProblem::Later {
            what: self.edit.description().into(),
            later: other.edit.description().into(),
            who: other.who.clone().unwrap_or_default(),
        };
        later.into_iter().find(is_in_the_way).map_or(Ok(()), |other| Err(problem(other)))
    }

    /// True if it is a person's or nobody's; everything is everybody's.
    fn is_of(&self, who: Option<&str>) -> bool {
        who.is_none() || self.who.is_none() || self.who.as_deref() == who
    }
}

impl Undone {
    /// True if a person may redo it: who made it, or who undid it.
    fn is_of(&self, who: Option<&str>) -> bool {
        self.step.is_of(who) || self.by.as_deref() == who
    }

    /// Refuses to redo it where something else was done to its pieces meanwhile, apart from what came before it.
    fn pass(&self, done: &[Step]) -> Result<(), StepProblem> {
        self.step.pass(done.iter().filter(|other| other.revision > self.at && other.begun > self.step.begun))
    }
}

impl Steps {
    /// What was done, in order.
    pub fn done(&self) -> &[Step] {
        &self.done
    }

    /// What was undone, the last one last.
    pub fn undone(&self) -> impl DoubleEndedIterator<Item = &Step> {
        self.undone.iter().map(|undone| &undone.step)
    }

    /// Everybody who has done something that was not forgotten.
    pub fn people(&self) -> BTreeSet<&str> {
        self.done.iter().chain(self.undone()).filter_map(|step| step.who.as_deref()).collect()
    }

    /// The step that undo takes for a person; without a name, the last one of all.
    pub fn to_undo(&self, who: Option<&str>) -> Option<&Step> {
        self.done.iter().rfind(|step| step.is_of(who))
    }

    /// The step that redo takes for a person; without a name, the last one of all.
    pub fn to_redo(&self, who: Option<&str>) -> Option<&Step> {
        self.undone.iter().rfind(|undone| undone.is_of(who)).map(|undone| &undone.step)
    }

    /// The edit that undoes the last step of a person; without a name, the last one of all.
    ///
    /// # Errors
    /// When there is none, or later edits are about the same pieces.
    pub fn undo_for(&self, who: Option<&str>) -> Result<Edit, StepProblem> {
        let at = self.done.iter().rposition(|step| step.is_of(who)).ok_or(StepProblem::Nothing)?;
        self.done[at].pass(self.done[at + 1..].iter())?;
        let is_last = at + 1 == self.done.len();
        Ok(if is_last { Edit::Undo } else { Edit::UndoOf { revision: self.done[at].revision } })
    }

    /// The edit that redoes what was undone last of a person; without a name, of all.
    ///
    /// # Errors
    /// When there is none, or others have changed the same pieces since.
    pub fn redo_for(&self, who: Option<&str>) -> Result<Edit, StepProblem> {
        let at = self.undone.iter().rposition(|undone| undone.is_of(who)).ok_or(StepProblem::Nothing)?;
        self.undone[at].pass(&self.done)?;
        let is_last = at + 1 == self.undone.len();
        Ok(if is_last { Edit::Redo } else { Edit::RedoOf { revision: self.undone[at].step.revision } })
    }

    /// The step that an undo of the log takes.
    ///
    /// # Errors
    /// Why it cannot be undone.
    pub(super) fn undone_by(&self, edit: &Edit) -> Result<usize, String> {
        let at = match edit {
            Edit::UndoOf { revision } => self.done.iter().position(|step| step.revision == *revision),
            _ => self.done.len().checked_sub(1),
        };
        let at = at.ok_or("there is nothing to undo")?;
        self.done[at].pass(self.done[at + 1..].iter()).map_err(|_| "a later edit is about the same pieces")?;
        Ok(at)
    }

    /// The step that a redo of the log takes.
    ///
    /// # Errors
    /// Why it cannot be redone.
    pub(super) fn redone_by(&self, edit: &Edit) -> Result<usize, String> {
        let at = match edit {
            Edit::RedoOf { revision } => self.undone.iter().position(|undone| undone.step.revision == *revision),
            _ => self.undone.len().checked_sub(1),
        };
        let at = at.ok_or("there is nothing to do again")?;
        self.undone[at].pass(&self.done).map_err(|_| "a later edit is about the same pieces")?;
        Ok(at)
    }

    /// The edit that a redo of the log does again.
    pub(super) fn redone(&self, at: usize) -> &Edit {
        &self.undone[at].step.edit
    }

    /// Adds a step. Unless it is one that was done again, its person's undone steps are forgotten, and those of nobody.
    pub fn push(&mut self, step: Step) {
        if step.begun == step.revision {
            let who = step.who.as_deref();
            self.undone.retain(|undone| who.is_some() && undone.by.is_some() && !undone.is_of(who));
        }
        self.done.push(step);
    }

    /// Takes the step that a checked undo is about, and keeps it to be redone. `None` if there is none.
    pub fn undo(&mut self, edit: &Edit, by: Option<String>, at: u64) -> Option<&Step> {
        let place = self.undone_by(edit).ok()?;
        let step = self.done.remove(place);
        self.undone.push(Undone { step, by, at });
        self.undone.last().map(|undone| &undone.step)
    }

    /// Takes the step that a checked redo is about. `None` if there is none.
    pub fn redo(&mut self, edit: &Edit) -> Option<Step> {
        let place = self.redone_by(edit).ok()?;
        Some(self.undone.remove(place).step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn label(pieces: &[u32]) -> Edit {
        let count = pieces.len();
        Edit::Label {
            description: format!("{pieces:?}"),
            pieces: pieces.into(),
            semantic: vec![1; count],
            instance: vec![-1; count],
            next_instance: 1,
        }
    }

    fn split(piece: u32) -> Edit {
        Edit::Split { description: "split".into(), piece, names: vec!["x".into()], faces: vec![vec![]] }
    }

    /// Steps by these people, in order, from revision 1 on; what splits make is numbered from 10 on.
    fn steps(edits: &[(&str, Edit)]) -> Steps {
        let mut steps = Steps::default();
        for (revision, (who, edit)) in (1..).zip(edits) {
            let who = (!who.is_empty()).then(|| (*who).to_string());
            let first_new = 9 + revision as u32;
            steps.push(Step { edit: edit.clone(), revision, begun: revision, time: String::new(), who, before: vec![], first_new });
        }
        steps
    }

    fn undo(steps: &mut Steps, who: &str, at: u64) -> Edit {
        let edit = steps.undo_for(Some(who)).unwrap();
        steps.undo(&edit, Some(who.into()), at).unwrap();
        edit
    }

    #[test]
    fn undo_takes_ones_own_last_step() {
        let mut steps = steps(&[("ada", label(&[1])), ("ada", label(&[2])), ("ben", label(&[3]))]);
        assert_eq!(undo(&mut steps, "ada", 4), Edit::UndoOf { revision: 2 });
        assert_eq!(steps.undo_for(None).unwrap(), Edit::Undo, "the last one of all");
        assert_eq!(undo(&mut steps, "ben", 5), Edit::Undo);
        assert_eq!(steps.redo_for(Some("ada")).unwrap(), Edit::RedoOf { revision: 2 });
        assert_eq!(steps.redo_for(Some("eve")), Err(StepProblem::Nothing));
        assert_eq!(steps.people().into_iter().collect::<Vec<_>>(), ["ada", "ben"]);
    }

    #[test]
    fn what_others_changed_since_is_neither_undone_nor_redone() {
        let mut steps = steps(&[("ada", label(&[1, 2])), ("ben", label(&[2])), ("ben", label(&[5]))]);
        let later = StepProblem::Later { what: "[1, 2]".into(), later: "[2]".into(), who: "ben".into() };
        assert_eq!(steps.undo_for(Some("ada")), Err(later));
        undo(&mut steps, "ben", 4);
        undo(&mut steps, "ben", 5);
        assert_eq!(undo(&mut steps, "ada", 6), Edit::Undo);
        // Ben's redo comes before Ada's in the order of what was begun, so Ada's is in the way of nothing and Ben's is in hers.
        let edit = steps.redo_for(Some("ben")).unwrap();
        let step = steps.redo(&edit).unwrap();
        steps.push(Step { revision: 7, ..step });
        assert!(matches!(steps.redo_for(Some("ada")), Err(StepProblem::Later { .. })));
    }

    #[test]
    fn splits_are_undone_in_order_and_a_new_step_forgets_ones_own() {
        let mut steps = steps(&[("ada", split(1)), ("ben", split(2))]);
        assert!(matches!(steps.undo_for(Some("ada")), Err(StepProblem::Later { .. })));
        undo(&mut steps, "ben", 3);
        undo(&mut steps, "ada", 4);
        let who = Some("ada".to_string());
        let edit = label(&[7]);
        steps.push(Step { edit, revision: 5, begun: 5, time: String::new(), who, before: vec![], first_new: 0 });
        assert_eq!(steps.redo_for(Some("ada")), Err(StepProblem::Nothing));
        assert_eq!(steps.redo_for(Some("ben")).unwrap(), Edit::Redo);
    }
}
