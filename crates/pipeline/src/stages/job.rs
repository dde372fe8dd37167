//! One scene in the stages: its files, their loaded contents, and the frames that are made here.

use super::{Input, Shift, Stage};
use crate::config::{Config, SceneConfig};
use crate::error::Error;
use crate::workdir::{Hash, PACKAGE, Workdir};
use crate::world::World;
use enfilade_dataset::{Dataset, DatasetError, quoted, read_package};
use enfilade_frame::Pass;
use enfilade_scene::{Camera, Scene, Trajectory};
use enfilade_verify::NotJudged;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// One scene in the stages: its files and their loaded contents.
pub(crate) struct Job<'a> {
    pub config: &'a Config,
    pub scene: &'a SceneConfig,
    pub dataset: &'a Dataset,
    /// Do the work even if its result exists.
    pub force: bool,
    /// The part that is made here, if other machines make the rest.
    pub shift: Option<&'a Shift<'a>>,
    workdir: &'a Workdir,
    loaded: Arc<Mutex<Loaded>>,
}

#[derive(Default)]
struct Loaded {
    scene: Option<Arc<Scene>>,
    world: Option<Arc<World>>,
    filmed: Option<Filmed>,
    not_judged: NotJudged,
}

/// Trajectories and what each is filmed with.
pub(crate) type Filmed = Arc<Vec<(Camera, Trajectory)>>;

/// Numbers of frames by the names of their trajectories.
pub(crate) type FramesByTrajectory = BTreeMap<String, BTreeSet<u32>>;

impl<'a> Job<'a> {
    pub fn new(config: &'a Config, scene: &'a SceneConfig, dataset: &'a Dataset, workdir: &'a Workdir, force: bool) -> Self {
        Self { config, scene, dataset, force, shift: None, workdir, loaded: Arc::default() }
    }

    /// A job of the same scene, of which only the frames of `shift` are made. What is loaded by one of the two is there for both.
    pub fn on_shift<'b>(&'b self, shift: &'b Shift<'b>) -> Job<'b> {
        let Self { config, scene, dataset, force, workdir, .. } = *self;
        Job { config, scene, dataset, force, shift: Some(shift), workdir, loaded: self.loaded.clone() }
    }

    /// A job of the scene that this one is a variation of; `None` for scenes by themselves.
    pub fn first(&self) -> Result<Option<Job<'a>>, Error> {
        let Some(varies) = &self.scene.varies else { return Ok(None) };
        let first = self.config.scenes.iter().find(|scene| scene.name == varies.of && scene.varies.is_none());
        let first = first.ok_or_else(|| {
            let message = format!("scene {} is a variation of {}, which the configuration does not have", self.scene.name, varies.of);
            Error::scene(message, "give that scene to the configuration too: variations are made from it")
        })?;
        Ok(Some(Job::new(self.config, first, self.dataset, self.workdir, false)))
    }

    /// The dataset's folder.
    pub fn out(&self) -> &Path {
        self.workdir.out()
    }

    /// A file of the scene's work folder.
    pub fn work_file(&self, name: &str) -> Result<PathBuf, Error> {
        self.workdir.scene_file(&self.scene.name, name)
    }

    /// Leaves files of products that are out of date out of verification.
    pub fn leave_out(&self, not_judged: NotJudged) {
        self.loaded.lock().unwrap_or_else(PoisonError::into_inner).not_judged = not_judged;
    }

    /// The files that are left out of verification.
    pub fn not_judged(&self) -> NotJudged {
        self.loaded.lock().unwrap_or_else(PoisonError::into_inner).not_judged.clone()
    }

    /// The scene package.
    pub fn package(&self) -> Result<PathBuf, Error> {
        self.work_file(PACKAGE)
    }

    /// `path` as an input that an earlier stage makes.
    pub fn input_from(&self, stage: Stage, path: &Path) -> Result<Input, Error> {
        if path.is_file() { Input::of(path) } else { Err(self.run_first(stage)) }
    }

    /// The scene, decoded once per run.
    pub fn load_scene(&self) -> Result<Arc<Scene>, Error> {
        let mut loaded = self.loaded.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(scene) = &loaded.scene {
            return Ok(scene.clone());
        }
        let path = self.package()?;
        let bytes = std::fs::read(&path).map_err(Error::io("read", &path))?;
        let scene = read_package(&path, &bytes).map_err(|e| Error::scene(format!("{}: {e}", path.display()), self.again(Stage::Import)))?;
        Ok(loaded.scene.insert(Arc::new(scene)).clone())
    }

    /// Forgets what was loaded, because the package is a new one.
    pub fn forget_scene(&self) {
        *self.loaded.lock().unwrap_or_else(PoisonError::into_inner) = Loaded::default();
    }

    /// Gives back the memory of [`Job::load_world`], which the renderer has no use for.
    pub fn forget_world(&self) {
        self.loaded.lock().unwrap_or_else(PoisonError::into_inner).world = None;
    }

    /// The scene as rays meet it, built once per run.
    pub fn load_world(&self) -> Result<Arc<World>, Error> {
        let scene = self.load_scene()?;
        let mut loaded = self.loaded.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(world) = &loaded.world {
            return Ok(world.clone());
        }
        Ok(loaded.world.insert(Arc::new(World::of(&scene))).clone())
    }

    /// The cameras that are there; by their files where the table of them is damaged, as planning has still to make it again.
    pub fn there(&self) -> Result<Vec<String>, Error> {
        let name = &self.scene.name;
        self.dataset.cameras(name).or_else(|_| self.dataset.cameras_by_files(name)).map_err(Error::stage)
    }

    /// The planned trajectories and what each is filmed with, read once per run.
    pub fn filmed(&self) -> Result<Filmed, Error> {
        let mut loaded = self.loaded.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(filmed) = &loaded.filmed {
            return Ok(filmed.clone());
        }
        Ok(loaded.filmed.insert(Arc::new(self.read_filmed()?)).clone())
    }

    /// Forgets what was read of trajectories, because they are planned anew.
    pub fn forget_filmed(&self) {
        self.loaded.lock().unwrap_or_else(PoisonError::into_inner).filmed = None;
    }

    fn read_filmed(&self) -> Result<Vec<(Camera, Trajectory)>, Error> {
        let name = &self.scene.name;
        if !self.dataset.layout().metadata_cameras(name).is_file() {
            return Err(self.run_first(Stage::Plan));
        }
        let cameras = self.dataset.cameras(name).map_err(Error::stage)?;
        let filmed =
            cameras.iter().map(|camera| Ok((self.dataset.read_camera(name, camera)?, self.dataset.read_trajectory(name, camera)?)));
        filmed.collect::<Result<_, _>>().map_err(|error: DatasetError| Error::stage(error))
    }

    /// Every frame that is rendered, by camera name.
    pub fn frames(&self) -> Result<Vec<(String, u32)>, Error> {
        let mut frames = Vec::new();
        for (_, trajectory) in self.filmed()?.iter() {
            frames.extend(self.frames_of(trajectory)?.into_iter().map(|frame| (trajectory.name.clone(), frame)));
        }
        Ok(frames)
    }

    /// The frames of a trajectory that are rendered: all but those that a gate rejects.
    pub fn frames_of(&self, trajectory: &Trajectory) -> Result<BTreeSet<u32>, Error> {
        let rejected = self.dataset.rejected_views(&self.scene.name, &trajectory.name).map_err(Error::stage)?;
        let is_made = |frame: &u32| !rejected.contains_key(frame) && self.shift.is_none_or(|shift| shift.has(&trajectory.name, *frame));
        Ok(trajectory.poses.iter().map(|pose| pose.frame).filter(is_made).collect())
    }

    /// Frames by trajectory, those without any left out.
    pub fn frames_by_trajectory(&self) -> Result<FramesByTrajectory, Error> {
        let filmed = self.filmed()?;
        let frames = filmed.iter().map(|(_, trajectory)| Ok((trajectory.name.clone(), self.frames_of(trajectory)?)));
        let mut frames: FramesByTrajectory = frames.collect::<Result<_, Error>>()?;
        frames.retain(|_, frames| !frames.is_empty());
        Ok(frames)
    }

    /// Whether every frame has a record of these layers that can be read and is about this frame, and all files of that record in full
    /// length.
    pub fn layers_are_whole(&self, pass: Pass) -> bool {
        let is_whole = |(camera, frame): &(String, u32)| self.dataset.layers_are_whole(&self.scene.name, camera, *frame, pass);
        self.frames().is_ok_and(|frames| frames.iter().all(is_whole))
    }

    /// The commit records of all frames as inputs: they have the checksums of every layer.
    pub fn frame_records(&self) -> Result<Vec<Input>, Error> {
        let layout = self.dataset.layout();
        let record =
            |(camera, frame): &(String, u32)| self.input_from(Stage::Render, &layout.frame_record(&self.scene.name, camera, *frame));
        self.frames()?.iter().map(record).collect()
    }

    /// The commit records of the label layers of all frames.
    pub fn label_records(&self) -> Result<Vec<Input>, Error> {
        let layout = self.dataset.layout();
        let record =
            |(camera, frame): &(String, u32)| self.input_from(Stage::Label, &layout.label_record(&self.scene.name, camera, *frame));
        self.frames()?.iter().map(record).collect()
    }

    /// Records of the frames, limited to the rendered layers: later denoising of colour does not count.
    pub fn rendered_records(&self) -> Result<Vec<Input>, Error> {
        self.frames()?.iter().map(|(camera, frame)| self.rendered_record(camera, *frame)).collect()
    }

    /// Record of one frame, likewise.
    pub fn rendered_record(&self, camera: &str, frame: u32) -> Result<Input, Error> {
        let name = &self.scene.name;
        let path = self.dataset.layout().frame_record(name, camera, frame);
        let record = self.dataset.frame_record(name, camera, frame).map_err(Error::stage)?;
        let record = record.ok_or_else(|| self.run_first(Stage::Render))?;
        Ok(Input { path, content: Hash::of(&record.as_rendered()) })
    }

    pub fn run_first(&self, stage: Stage) -> Error {
        let message = format!("the results of `{}` for scene {} are not there", stage.name(), self.scene.name);
        Error::scene(message, format!("run first: {}", self.command(stage)))
    }

    /// A file of an earlier stage is not what it wrote.
    pub fn not_as_written(&self, stage: Stage, path: &Path) -> Error {
        let (path, verb) = (path.display(), stage.name());
        let message = format!("{path} is not as `{verb}` wrote it, and frames made by it would take the place of those that are finished");
        Error::scene(message, format!("make it again, which keeps these: {}", self.command(stage)))
    }

    /// The command that makes the results of a stage anew, in words.
    pub fn again(&self, stage: Stage) -> String {
        format!("make it again: {} --force", self.command(stage))
    }

    /// The command that runs a stage of this scene.
    pub fn command(&self, stage: Stage) -> String {
        format!("enfilade run {} --only {} --scene {}", quoted(self.out().display()), stage.name(), quoted(&self.scene.name))
    }
}
