//! A scene that is open for annotation: everything that the routes ask for, safe to use from several requests at once.

use super::action::{Action, Look, Refusal};
use super::author::Author;
use super::camera::CameraRequest;
use super::carry::{CARRIED, Carried, set_aside};
use super::change::Change;
use super::clock;
use super::earlier::CarryError;
use super::events::Events;
use super::log::LogError;
use super::options::AnnotateOptions;
use super::part_shapes::{PartShape, SHAPES};
use super::progress::Seen;
use super::review::{REVIEW_LOG, Review, ReviewState, Reviews};
use super::save::Snapshot;
use super::scene::AnnotatedScene;
use super::scene_error::SceneError;
use super::session::{ActionError, Session};
use super::stroke::Picked;
use super::suggestions::{Suggestion, suggestions};
use super::worklog::{WORK_LOG, WorkLog, WorkSession};
use axum::body::Bytes;
use enfilade_dataset::{ANNOTATION_LOG, Classes, DatasetError, MeshFiles};
use enfilade_geometry::Bvh;
use enfilade_scene::{Cx, Warning};
use enfilade_serve::DisplayOrder;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError, RwLock, RwLockReadGuard};

/// Hypersim's log of when a scene was open.
const TOOL_LOG: &str = "metadata_scene_annotation_tool.log";
const TOOL_PREFIX: &str = "[HYPERSIM: SCENE_ANNOTATION_TOOL]";

/// Why a scene cannot be opened.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "plain words")]
pub enum OpenError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Log(#[from] LogError),
    #[error("{0}")]
    WorkLog(String),
    #[error("{0}")]
    Reviews(String),
    #[error(transparent)]
    Carry(#[from] CarryError),
    #[error(transparent)]
    File(#[from] DatasetError),
}

/// An open scene. Edits are done one after the other; reads run in parallel.
pub struct App {
    scene: Arc<AnnotatedScene>,
    classes: Arc<Classes>,
    bvh: Arc<Bvh>,
    order: DisplayOrder,
    session: RwLock<Session>,
    events: Events,
    worklog: Mutex<WorkLog>,
    reviews: RwLock<Reviews>,
    seen: OnceLock<Seen>,
    suggestions: OnceLock<Vec<Option<Suggestion>>>,
    face_colors: OnceLock<Result<Bytes, String>>,
    saved: Mutex<Saved>,
}

/// Contents of the label files.
#[derive(Default)]
struct Saved {
    revision: u64,
    objects: Option<blake3::Hash>,
}

impl App {
    /// Loads a scene and continues where its log ends.
    ///
    /// # Errors
    /// When the scene, the list of classes or the log cannot be read, or the folder of labels cannot be written.
    pub fn open(options: &AnnotateOptions, cx: &dyn Cx) -> Result<Self, OpenError> {
        let scene = Arc::new(AnnotatedScene::load(options, cx)?);
        let folder = &scene.labels_folder;
        let classes = match &options.classes {
            Some(file) => Classes::read(file)?,
            None => MeshFiles::new(folder).read_own_classes()?.unwrap_or_else(Classes::nyu40),
        };
        let carried = carried(&scene, options)?;
        cx.progress("preparing rays", 1, 3);
        let bvh = Arc::new(Bvh::new(&scene.corners, &|_| true));
        cx.progress("sorting faces", 2, 3);
        let order = DisplayOrder::new(&scene.corners);
        let classes = Arc::new(classes);
        let (mut session, warning) = Session::open(scene.clone(), classes.clone(), bvh.clone(), folder)?;
        if let Some(message) = warning {
            cx.warn(Warning { place: scene.name.clone(), message });
        }
        if let Some(carried) = carried {
            if session.revision() > 0 {
                return Err(CarryError::Begun(folder.clone()).into());
            }
            session.carry(&carried.labels)?;
            let list = carried.write(folder)?;
            let message = format!("{}; {} lists them", carried.summary, list.display());
            cx.warn(Warning { place: scene.name.clone(), message });
        }
        let unknown_class = session.pieces().list().iter().find(|piece| classes.check(piece.label.semantic.into()).is_err());
        if let Some(piece) = unknown_class {
            let message =
                format!("{} has class {}, which the list of classes lacks; give the list with --classes", piece.name, piece.label.semantic);
            cx.warn(Warning { place: scene.name.clone(), message });
        }
        // What people did beside editing.
        let worklog = WorkLog::open(folder).map_err(OpenError::WorkLog)?;
        let reviews = Reviews::open(folder).map_err(OpenError::Reviews)?;
        let revision = session.revision();
        let app = Self {
            events: Events::new(revision),
            session: RwLock::new(session),
            worklog: Mutex::new(worklog),
            reviews: RwLock::new(reviews),
            seen: OnceLock::new(),
            suggestions: OnceLock::new(),
            face_colors: OnceLock::new(),
            saved: Mutex::default(),
            scene,
            classes,
            bvh,
            order,
        };
        app.note("Loaded scene:  ")?;
        if revision > 0 {
            // The program may have been killed after the last edit and before its files were written.
            app.save()?;
        }
        Ok(app)
    }

    /// Appends to Hypersim's log.
    fn note(&self, what: &str) -> Result<(), DatasetError> {
        let path = self.scene.labels_folder.join(TOOL_LOG);
        let line = format!("{TOOL_PREFIX} {what} {}\n", clock::ctime(clock::now_s()));
        let append = std::fs::File::options().create(true).append(true).open(&path).and_then(|mut file| file.write_all(line.as_bytes()));
        append.map_err(|source| DatasetError::Io { action: "write", path, source })
    }

    /// The scene.
    pub fn scene(&self) -> &AnnotatedScene {
        &self.scene
    }

    /// The list of classes.
    pub fn classes(&self) -> &Classes {
        &self.classes
    }

    /// Faces in the order of display.
    pub fn order(&self) -> &DisplayOrder {
        &self.order
    }

    /// Channel on which pages listen for changes.
    pub fn events(&self) -> &Events {
        &self.events
    }

    /// The hierarchy over all faces.
    pub fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// The state, to read.
    pub fn session(&self) -> RwLockReadGuard<'_, Session> {
        self.session.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// The faces that the cameras see; computed at the first call.
    pub fn seen(&self) -> &Seen {
        self.seen.get_or_init(|| Seen::new(&self.scene, &self.bvh))
    }

    /// The suggestion for each part, and so for its pieces.
    pub fn suggestions(&self) -> &[Option<Suggestion>] {
        self.suggestions.get_or_init(|| suggestions(&self.scene, &self.classes))
    }

    /// The colour of each face, three bytes each; computed at the first call.
    ///
    /// # Errors
    /// Why there are none.
    pub fn face_colors(&self) -> &Result<Bytes, String> {
        self.face_colors.get_or_init(|| self.scene.colors.bytes(self.scene.corners.len()).map(Bytes::from))
    }

    /// Does an action, and announces the change to every page. An action whose `id` was used before is not done again: its first answer
    /// is repeated.
    ///
    /// # Errors
    /// When it is refused or cannot be logged; then nothing has changed.
    pub fn act(&self, action: &Action, author: &Author) -> Result<Change, ActionError> {
        let mut session = self.session.write().unwrap_or_else(PoisonError::into_inner);
        let before = session.revision();
        let change = session.act(action, author)?;
        if change.revision > before {
            // Announced while the session is locked, so that pages get changes in order.
            self.events.publish(&change);
            self.worklog().action(clock::now_s());
        }
        Ok(change)
    }

    /// The visible faces and the pieces that a stroke would select.
    ///
    /// # Errors
    /// When the request is wrong.
    pub fn select(&self, look: &Look) -> Result<(Vec<u32>, Vec<u32>), Refusal> {
        self.session().select(look)
    }

    /// The surface under an image point, and its piece.
    ///
    /// # Errors
    /// When the camera or a piece number is wrong, or the point is not in the image.
    pub fn pick(&self, camera: &CameraRequest, pixel: [f64; 2], hidden: &[u32]) -> Result<Option<(u32, Picked)>, Refusal> {
        self.session().pick(camera, pixel, hidden)
    }

    /// Records how far pieces are, and why.
    ///
    /// # Errors
    /// When a piece number is wrong, or the log cannot be written; then nothing has changed.
    pub fn review(&self, author: &Author, pieces: &[u32], state: ReviewState, note: &str) -> Result<(), ActionError> {
        let names = {
            let session = self.session();
            session.context().check_pieces("pieces", pieces)?;
            pieces.iter().map(|&piece| session.pieces().list()[piece as usize].name.clone()).collect()
        };
        let Author { client, who, .. } = author.clone();
        let review = Review { time: clock::iso(clock::now_s()), client, who, pieces: names, state, note: note.into() };
        self.reviews.write().unwrap_or_else(PoisonError::into_inner).add(review).map_err(ActionError::Review)?;
        self.write_reviews().map_err(ActionError::Review)?;
        self.events.publish_reviews();
        self.worklog().input(clock::now_s());
        Ok(())
    }

    /// Writes the table of reviews, if there are any.
    fn write_reviews(&self) -> Result<Option<PathBuf>, DatasetError> {
        let session = self.session();
        self.reviews().write(session.pieces().list().iter().map(|piece| piece.name.as_str()))
    }

    /// The current reviews.
    pub fn reviews(&self) -> RwLockReadGuard<'_, Reviews> {
        self.reviews.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// Records that somebody worked at this moment, seconds since 1970.
    ///
    /// # Errors
    /// When the work log cannot be written.
    pub fn worked(&self, moment_s: f64) -> Result<(), DatasetError> {
        let mut worklog = self.worklog();
        worklog.input(moment_s);
        worklog.write()
    }

    /// Sessions of work.
    pub fn work_sessions(&self) -> Vec<WorkSession> {
        self.worklog().sessions()
    }

    /// Writes all that is made from the log here, and returns the files. Tables that a label stage makes are left to it.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn save(&self) -> Result<Vec<PathBuf>, DatasetError> {
        let mut saved = self.saved.lock().unwrap_or_else(PoisonError::into_inner);
        let (snapshot, revision) = {
            let session = self.session();
            let standing = session.standing();
            (Snapshot::new(session.pieces(), standing.next_instance), standing.revision)
        };
        let objects = snapshot.objects_hash();
        let folder = self.scene.labels_folder.as_path();
        let mesh = MeshFiles::new(folder);
        let mut files = vec![snapshot.write_list(&mesh, &self.classes)?];
        if !self.scene.has_label_stage {
            files.extend(snapshot.write_tables(&mesh, &self.classes, saved.objects != Some(objects))?);
        }
        files.extend(self.write_reviews()?);
        if saved.objects.is_none() {
            PartShape::write(&PartShape::of_scene(&self.scene), folder)?;
        }
        *saved = Saved { revision, objects: Some(objects) };
        let worklog = self.worklog();
        worklog.write()?;
        files.extend(
            [ANNOTATION_LOG, TOOL_LOG, WORK_LOG, REVIEW_LOG, SHAPES, CARRIED]
                .map(|name| folder.join(name))
                .into_iter()
                .filter(|path| path.is_file()),
        );
        Ok(files)
    }

    /// True when there are edits that are not in the files yet. They are in the log all the same.
    pub fn is_unsaved(&self) -> bool {
        self.saved.lock().unwrap_or_else(PoisonError::into_inner).revision < self.session().revision()
    }

    /// Writes what is not written yet, and notes that the scene is closed.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn close(&self) -> Result<(), DatasetError> {
        if self.is_unsaved() {
            self.save()?;
        }
        self.worklog().write()?;
        self.note("Unloaded scene:")
    }

    fn worklog(&self) -> MutexGuard<'_, WorkLog> {
        self.worklog.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Folder of the labels.
    pub fn labels_folder(&self) -> &Path {
        &self.scene.labels_folder
    }
}

/// The labels of an earlier version, if they were asked for; where they are in the scene's own folder, their log is set aside.
fn carried(scene: &AnnotatedScene, options: &AnnotateOptions) -> Result<Option<Carried>, OpenError> {
    let Some(from) = &options.carry else { return Ok(None) };
    let labels = &scene.labels_folder;
    let is_own = labels.canonicalize().ok().zip(from.canonicalize().ok()).is_some_and(|(labels, from)| labels == from);
    if MeshFiles::new(labels).annotated_scene()?.is_some_and(|hash| !is_own || hash == scene.hash()) {
        return Err(CarryError::Begun(labels.clone()).into());
    }
    let carried = Carried::find(from, &PartShape::of_scene(scene)).map_err(OpenError::Carry)?;
    if is_own {
        set_aside(labels)?;
    }
    Ok(Some(carried))
}
