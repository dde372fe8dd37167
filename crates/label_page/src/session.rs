//! The state of an annotation: the pieces with their labels, and the edits that led to them.

use super::action::{Action, Context, Look, Refusal};
use super::camera::CameraRequest;
use super::change::{Change, Standing};
use super::clock;
use super::log::{Log, LogError, Recorded};
use super::pieces::Pieces;
use super::scene::AnnotatedScene;
use super::stroke::Picked;
use super::viewpoint::Viewpoint;
use enfilade_dataset::Classes;
use enfilade_geometry::Bvh;
use enfilade_label::annotation::{Before, Edit, Entry, numbers};
use enfilade_scene::PartLabel;
use serde::Serialize;
use std::collections::{HashMap, VecDeque};
use std::path::Path;
use std::sync::Arc;

/// Changes that are kept for pages that lost the answer and send the edit again.
const KEPT: usize = 64;

/// A session of labelling, in which all labels change: edits are done one after the other, each logged before it counts.
pub struct Session {
    pieces: Pieces,
    classes: Arc<Classes>,
    bvh: Arc<Bvh>,
    next_instance: i32,
    log: Log,
    done: Vec<Done>,
    undone: Vec<Undone>,
    revision: u64,
    /// Revisions of the edits that have an id.
    known: HashMap<String, u64>,
    /// The last changes by such edits.
    recent: VecDeque<Change>,
}

/// An edit, and what is needed to undo it.
struct Done {
    edit: Edit,
    /// Labels of the pieces of a [`Edit::Label`] before.
    before: Vec<PartLabel>,
    /// When, in UTC.
    time: String,
}

/// An edit that was undone.
struct Undone {
    edit: Edit,
    /// When it was done, in UTC.
    time: String,
}

/// An edit in the history of a scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct HistoryRow {
    /// For people.
    pub description: String,
    /// When it was done, in UTC.
    pub time: String,
}

/// Why an action was not done.
#[derive(Debug)]
pub enum ActionError {
    /// The action is wrong, or cannot be done as things are.
    Refused(Refusal),
    /// The log cannot be written.
    Log(LogError),
    /// The log of reviews cannot be written.
    Review(enfilade_dataset::DatasetError),
}

impl From<Refusal> for ActionError {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

impl Session {
    /// Continues the log in `folder`, or begins one; also returns what was wrong with the log, if it could be fixed.
    ///
    /// # Errors
    /// When the log cannot be opened, is about another scene, or has an edit that cannot be done.
    pub fn open(
        scene: Arc<AnnotatedScene>,
        classes: Arc<Classes>,
        bvh: Arc<Bvh>,
        folder: &Path,
    ) -> Result<(Self, Option<String>), LogError> {
        let (log, Recorded { initial, entries, warning }) = Log::open(folder, &scene)?;
        let pieces = Pieces::new(scene, &initial);
        let next_instance = initial.iter().map(|label| i32::from(label.instance)).max().unwrap_or(0).max(0) + 1;
        let mut session = Self {
            pieces,
            classes,
            bvh,
            next_instance,
            log,
            done: Vec::new(),
            undone: Vec::new(),
            revision: 0,
            known: HashMap::new(),
            recent: VecDeque::new(),
        };
        // Everything that was done since the scene was first opened is done again.
        for entry in entries {
            let problem = |problem: String, session: &Self| session.log.problem(entry.revision, problem);
            session.check(&entry.edit).map_err(|e| problem(e, &session))?;
            session.perform(&entry);
        }
        Ok((session, warning))
    }

    /// The labelled pieces.
    pub fn pieces(&self) -> &Pieces {
        &self.pieces
    }

    /// Revision, and what can be undone and done again.
    pub fn standing(&self) -> Standing<'_> {
        Standing {
            revision: self.revision,
            undo_description: self.done.last().map(|done| done.edit.description()),
            redo_description: self.undone.last().map(|undone| undone.edit.description()),
            next_instance: self.next_instance,
        }
    }

    /// The last edits that were done, at most `most`, and those that can be done again; what undo and redo take next comes first.
    pub fn history(&self, most: usize) -> [Vec<HistoryRow>; 2] {
        let row = |edit: &Edit, time: &str| HistoryRow { description: edit.description().into(), time: time.into() };
        let done = self.done.iter().rev().take(most).map(|done| row(&done.edit, &done.time));
        let undone = self.undone.iter().rev().take(most).map(|undone| row(&undone.edit, &undone.time));
        [done.collect(), undone.collect()]
    }

    /// The visible faces and the pieces that a stroke would select.
    ///
    /// # Errors
    /// When the request is wrong.
    pub fn select(&self, look: &Look) -> Result<(Vec<u32>, Vec<u32>), Refusal> {
        look.select(&self.context())
    }

    /// The surface under an image point, and its piece.
    ///
    /// # Errors
    /// When the camera or a piece number is wrong, or the point is not in the image.
    pub fn pick(&self, camera: &CameraRequest, pixel: [f64; 2], hidden: &[u32]) -> Result<Option<(u32, Picked)>, Refusal> {
        self.context().pick(camera, pixel, hidden)
    }

    /// From where these pieces are seen well; `None` for pieces without faces.
    ///
    /// # Errors
    /// When the camera or a piece number is wrong.
    pub fn viewpoint(&self, camera: &CameraRequest, pieces: &[u32], hidden: &[u32]) -> Result<Option<Viewpoint>, Refusal> {
        self.context().viewpoint(camera, pieces, hidden)
    }

    /// Does what a page asks for. On success the change is on the disk; on failure nothing has changed.
    ///
    /// The change has the old revision if nothing had to change. An edit whose `id` was used before is not done twice: its first change
    /// is returned.
    ///
    /// # Errors
    /// When the action is wrong, cannot be done as things are, or cannot be logged.
    pub fn act(&mut self, action: &Action, client: &str, id: Option<&str>) -> Result<Change, ActionError> {
        if let Some(&revision) = id.and_then(|id| self.known.get(id)) {
            return self.told_again(revision).map_err(ActionError::Refused);
        }
        // The action becomes an edit that needs no further decision.
        let edit = match action {
            Action::Undo if self.done.is_empty() => {
                return Err(Refusal::conflict("there is nothing to undo", "everything is as it was in the beginning").into());
            }
            Action::Redo if self.undone.is_empty() => {
                return Err(Refusal::conflict("there is nothing to do again", "only what was undone last can be done again").into());
            }
            Action::Undo => Some(Edit::Undo),
            Action::Redo => Some(Edit::Redo),
            action => self.context().decide(action)?,
        };
        let Some(edit) = edit else { return Ok(Change::default().told(None, client, &self.standing())) };
        // The log is written before the pieces change: what was sent to pages survives a crash.
        let (time, id) = (clock::iso(clock::now_s()), id.map(Into::into));
        let entry = Entry { revision: self.revision + 1, time, client: client.into(), id, edit };
        self.log.append(&entry).map_err(ActionError::Log)?;
        Ok(self.perform(&entry))
    }

    /// The change that an edit made when it came first.
    fn told_again(&self, revision: u64) -> Result<Change, Refusal> {
        let change = self.recent.iter().find(|change| change.revision == revision).cloned();
        let error = || format!("this edit was done already, long ago: it made revision {revision} of {}", self.revision);
        change.ok_or_else(|| Refusal::conflict(error(), "reload the page to see the current state"))
    }

    /// The state in which actions are decided.
    pub fn context(&self) -> Context<'_> {
        Context { pieces: &self.pieces, next_instance: self.next_instance, classes: &self.classes, bvh: &self.bvh }
    }

    /// Checks that an edit of the log can be done.
    fn check(&self, edit: &Edit) -> Result<(), String> {
        let steps = [self.done.len(), self.undone.len()];
        edit.check(&Before { pieces: self.pieces.list().len(), piece_of_face: self.pieces.of_face(), steps })
    }

    /// Does an edit that was checked or decided here.
    fn perform(&mut self, entry: &Entry) -> Change {
        self.revision += 1;
        let change = match &entry.edit {
            Edit::Undo => self.done.pop().map(|done| {
                let change = self.revert(&done);
                self.undone.push(Undone { edit: done.edit, time: done.time });
                change
            }),
            Edit::Redo => self.undone.pop().map(|undone| self.apply(undone.edit, &entry.time)),
            edit => {
                self.undone.clear();
                Some(self.apply(edit.clone(), &entry.time))
            }
        };
        let change = change.unwrap_or_default().told(Some(&entry.edit), &entry.client, &self.standing());
        if let Some(id) = &entry.id {
            self.known.insert(id.clone(), self.revision);
            self.recent.push_back(change.clone());
            if self.recent.len() > KEPT {
                self.recent.pop_front();
            }
        }
        change
    }

    fn apply(&mut self, edit: Edit, time: &str) -> Change {
        let mut before = Vec::new();
        let change = match &edit {
            Edit::Label { pieces, semantic, instance, next_instance, .. } => {
                self.next_instance = self.next_instance.max(*next_instance);
                for ((&piece, &semantic), &instance) in pieces.iter().zip(semantic).zip(instance) {
                    before.push(self.pieces.list()[piece as usize].label);
                    self.pieces.set_label(piece, PartLabel { semantic, instance });
                }
                Change::labels(&self.pieces, pieces)
            }
            Edit::Split { piece, names, faces, .. } => {
                let end = self.pieces.of_face().len();
                let groups: Vec<Vec<u32>> = faces.iter().filter_map(|runs| numbers(runs, end)).collect();
                self.pieces.split(*piece, names, &groups);
                Change::split(&self.pieces, *piece, groups.len())
            }
            Edit::Undo | Edit::Redo => Change::default(),
        };
        self.done.push(Done { edit, before, time: time.into() });
        change
    }

    fn revert(&mut self, done: &Done) -> Change {
        match &done.edit {
            Edit::Label { pieces, .. } => {
                pieces.iter().zip(&done.before).rev().for_each(|(&piece, &label)| self.pieces.set_label(piece, label));
                Change::labels(&self.pieces, pieces)
            }
            Edit::Split { piece, names, .. } => {
                let first = self.pieces.list().len() - names.len();
                let moved = self.pieces.list()[first..].iter().flat_map(|piece| piece.faces.iter().copied()).collect();
                self.pieces.join(*piece, names.len());
                Change::join(&self.pieces, *piece, first as u32, names.len(), moved)
            }
            Edit::Undo | Edit::Redo => Change::default(),
        }
    }
}
