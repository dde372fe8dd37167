//! The state of an annotation: the pieces with their labels, and the edits that led to them.

use super::action::{Action, Context, Look, Refusal};
use super::author::Author;
use super::camera::CameraRequest;
use super::change::{Change, Own, Standing};
use super::clock;
use super::log::{Log, LogError, Recorded};
use super::pieces::Pieces;
use super::scene::AnnotatedScene;
use super::stroke::Picked;
use super::viewpoint::Viewpoint;
use enfilade_dataset::Classes;
use enfilade_geometry::Bvh;
use enfilade_label::annotation::{Before, Edit, Entry, Step, StepProblem, Steps, numbers};
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
    steps: Steps,
    revision: u64,
    /// Revisions of the edits that have an id.
    known: HashMap<String, u64>,
    /// The last changes by such edits.
    recent: VecDeque<Change>,
}

/// An edit in the history of a scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct HistoryRow {
    /// For people.
    pub description: String,
    /// When it was done, in UTC.
    pub time: String,
    /// The name of the person; none in logs of programs that knew no names.
    pub who: Option<String>,
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
            steps: Steps::default(),
            revision: 0,
            known: HashMap::new(),
            recent: VecDeque::new(),
        };
        // Everything that was done since the scene was first opened is done again; only the changes that are kept are told.
        let named = entries.iter().enumerate().rev().filter(|(_, entry)| entry.id.is_some());
        let told_from = named.map(|(i, _)| i).nth(KEPT - 1).unwrap_or(0);
        for (i, entry) in entries.into_iter().enumerate() {
            session.check(&entry.edit).map_err(|problem| session.log.problem(entry.revision, problem))?;
            if i < told_from {
                session.take(entry);
            } else {
                session.perform(entry);
            }
        }
        Ok((session, warning))
    }

    /// The labelled pieces.
    pub fn pieces(&self) -> &Pieces {
        &self.pieces
    }

    /// Number of edits ever made, undone ones and undoing included.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Revision, and what can be undone and done again.
    pub fn standing(&self) -> Standing {
        let own = |who: Option<&str>| {
            let description = |step: Option<&Step>| step.map(|step| step.edit.description().to_string());
            Own { undo: description(self.steps.to_undo(who)), redo: description(self.steps.to_redo(who)) }
        };
        // Who has done nothing yet can undo what has no name.
        let people = self.steps.people().into_iter().chain([""]).map(|who| (who.to_string(), own(Some(who)))).collect();
        Standing { revision: self.revision, all: own(None), people, next_instance: self.next_instance }
    }

    /// The last edits that were done, at most `most`, and those that can be done again; what undo and redo take next comes first.
    pub fn history(&self, most: usize) -> [Vec<HistoryRow>; 2] {
        let row = |step: &Step| HistoryRow { description: step.edit.description().into(), time: step.time.clone(), who: step.who.clone() };
        [self.steps.done().iter().rev().take(most).map(row).collect(), self.steps.undone().rev().take(most).map(row).collect()]
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
    /// The change has the old revision if nothing had to change. An edit whose id was used before is not done twice: its first change is
    /// returned.
    ///
    /// # Errors
    /// When the action is wrong, cannot be done as things are, or cannot be logged.
    pub fn act(&mut self, action: &Action, author: &Author) -> Result<Change, ActionError> {
        let Author { client, who, id } = author.clone();
        if let Some(&revision) = id.as_ref().and_then(|id| self.known.get(id)) {
            return self.told_again(revision).map_err(ActionError::Refused);
        }
        // The action becomes an edit that needs no further decision.
        let edit = match action {
            Action::Undo { everyone } => Some(self.steps.undo_for(who.as_deref().filter(|_| !everyone)).map_err(not_undone)?),
            Action::Redo { everyone } => Some(self.steps.redo_for(who.as_deref().filter(|_| !everyone)).map_err(not_redone)?),
            action => self.context().decide(action)?,
        };
        let Some(edit) = edit else { return Ok(Change::default().told(&self.standing(), &client, who, "Nothing to change".into())) };
        self.check(&edit).map_err(|problem| Refusal::conflict(problem, "look at the history of the scene"))?;
        self.log_and_perform(edit, Author { client, who, id }).map_err(ActionError::Log)
    }

    /// Does an edit that was checked. The log is written before the pieces change: what was sent to pages survives a crash.
    fn log_and_perform(&mut self, edit: Edit, Author { client, who, id }: Author) -> Result<Change, LogError> {
        let entry = Entry { revision: self.revision + 1, time: clock::iso(clock::now_s()), client, who, id, edit };
        self.log.append(&entry)?;
        Ok(self.perform(entry))
    }

    /// Labels parts as they were in an earlier version of the scene, as the first edit.
    ///
    /// # Errors
    /// When the edit cannot be logged.
    pub fn carry(&mut self, labels: &[(u32, PartLabel)]) -> Result<(), LogError> {
        let last = labels.iter().map(|(_, label)| i32::from(label.instance)).max().unwrap_or(0);
        let (pieces, labels): (Vec<u32>, Vec<PartLabel>) = labels.iter().copied().unzip();
        if pieces.is_empty() {
            return Ok(());
        }
        let (semantic, instance) = labels.iter().map(|label| (label.semantic, label.instance)).unzip();
        let description = format!("Carried over: the labels of {} parts", pieces.len());
        let edit = Edit::Label { description, pieces, semantic, instance, next_instance: self.next_instance.max(last + 1) };
        self.log_and_perform(edit, Author { client: "carry".into(), ..Author::default() }).map(drop)
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

    /// Checks that an edit can be done.
    fn check(&self, edit: &Edit) -> Result<(), String> {
        edit.check(&Before { pieces: self.pieces.list().len(), piece_of_face: self.pieces.of_face(), steps: &self.steps })
    }

    /// Does an edit of the log, and keeps the change for pages that send it again.
    fn perform(&mut self, entry: Entry) -> Change {
        let (client, who, is_named) = (entry.client.clone(), entry.who.clone(), entry.id.is_some());
        let (change, description) = self.take(entry);
        let change = change.told(&self.standing(), &client, who, description);
        if is_named {
            self.recent.push_back(change.clone());
            if self.recent.len() > KEPT {
                self.recent.pop_front();
            }
        }
        change
    }

    /// Does an edit of the log: what it changes, and what was done.
    fn take(&mut self, Entry { revision, time, who, id, edit, .. }: Entry) -> (Change, String) {
        self.revision = revision;
        if let Some(id) = id {
            self.known.insert(id, revision);
        }
        match edit {
            Edit::Undo | Edit::UndoOf { .. } => self.undo(&edit, who),
            Edit::Redo | Edit::RedoOf { .. } => match self.steps.redo(&edit) {
                Some(step) => {
                    let (description, of) = (format!("Done again: {}", step.edit.description()), step.who.clone());
                    (Change { of, ..self.apply(Step { revision, time, ..step }) }, description)
                }
                None => (Change::default(), String::new()),
            },
            edit => {
                let description = edit.description().to_string();
                (self.apply(Step::new(edit, revision, time, who)), description)
            }
        }
    }

    fn undo(&mut self, edit: &Edit, by: Option<String>) -> (Change, String) {
        let Some(step) = self.steps.undo(edit, by, self.revision) else { return (Change::default(), String::new()) };
        let description = format!("Undone: {}", step.edit.description());
        (Change { of: step.who.clone(), ..revert(&mut self.pieces, step) }, description)
    }

    fn apply(&mut self, mut step: Step) -> Change {
        step.first_new = self.pieces.list().len() as u32;
        step.before.clear();
        let change = match &step.edit {
            Edit::Label { pieces, semantic, instance, next_instance, .. } => {
                self.next_instance = self.next_instance.max(*next_instance);
                for ((&piece, &semantic), &instance) in pieces.iter().zip(semantic).zip(instance) {
                    step.before.push(self.pieces.list()[piece as usize].label);
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
            _ => Change::default(),
        };
        self.steps.push(step);
        change
    }
}

fn revert(pieces: &mut Pieces, step: &Step) -> Change {
    match &step.edit {
        Edit::Label { pieces: labelled, .. } => {
            labelled.iter().zip(&step.before).rev().for_each(|(&piece, &label)| pieces.set_label(piece, label));
            Change::labels(pieces, labelled)
        }
        Edit::Split { piece, names, .. } => {
            let first = pieces.list().len() - names.len();
            let moved = pieces.list()[first..].iter().flat_map(|piece| piece.faces.iter().copied()).collect();
            pieces.join(*piece, names.len());
            Change::join(pieces, *piece, first as u32, names.len(), moved)
        }
        _ => Change::default(),
    }
}

/// Why nothing is undone.
fn not_undone(problem: StepProblem) -> Refusal {
    match problem {
        StepProblem::Nothing => Refusal::conflict("there is nothing to undo", "what others did is undone in the history"),
        StepProblem::Later { what, later, who } => {
            let error = format!("{what:?} cannot be undone: {} has changed the same since ({later})", person(&who));
            Refusal::conflict(error, "go back in the history, which undoes the later edits too, or label it anew")
        }
    }
}

/// Why nothing is done again.
fn not_redone(problem: StepProblem) -> Refusal {
    match problem {
        StepProblem::Nothing => Refusal::conflict("there is nothing to do again", "only what was undone last can be done again"),
        StepProblem::Later { what, later, who } => {
            let error = format!("{what:?} cannot be done again: {} has changed the same since ({later})", person(&who));
            Refusal::conflict(error, "label it anew")
        }
    }
}

fn person(who: &str) -> &str {
    if who.is_empty() { "somebody" } else { who }
}
