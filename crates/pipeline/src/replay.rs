//! `replay`: a frame rendered once more from its commit record, and its files compared with those that the record lists.

use crate::error::Error;
use crate::stages::{Moment, Stage, Timing, add_extra, config_hash, frame_time, program, take_at, views};
use crate::workdir::{Hash, PACKAGE};
use enfilade_dataset::{Dataset, FileRecord, FrameInfo, FrameRecord, FrameTime, Layout, Recipe, StoppedBy, WORKDIR, quoted, read_package};
use enfilade_frame::{Frame, LAYERS};
use enfilade_render::{FrameRender, Guide, RenderConfig, RenderScene};
use enfilade_scene::{Camera, Cx, Scene, Trajectory, Warning};
use std::path::{Path, PathBuf};

/// Result of rendering a frame again.
#[derive(Clone, Debug, PartialEq)]
pub struct Replay {
    /// `SCENE/CAMERA/frame.IIII`.
    pub frame: String,
    /// The files of the record, by name.
    pub files: Vec<ReplayedFile>,
}

/// A file of a frame that was rendered again.
#[derive(Clone, Debug, PartialEq)]
pub struct ReplayedFile {
    /// Path relative to the scene's folder.
    pub name: String,
    /// True if the file has the bytes stated in the record.
    pub same: bool,
}

impl Replay {
    /// True if every file has the bytes stated in the record.
    pub fn is_same(&self) -> bool {
        self.files.iter().all(|file| file.same)
    }
}

/// Everything that a frame is made from.
struct Source {
    /// The scene's folder.
    folder: PathBuf,
    record: FrameRecord,
    recipe: Recipe,
    config: RenderConfig,
    scene: Scene,
    camera: Camera,
    trajectory: Trajectory,
    /// Index of the frame in the trajectory.
    index: usize,
    /// Seconds between frames, if the scene moves.
    frame_time_s: Option<f64>,
}

/// Renders the frame of the commit record `file` (`OUT/scenes/SCENE/_detail/CAMERA/frames/frame.IIII.json`) once more and compares its
/// files with the record. They are written below `out` as a separate dataset; without it nothing is kept.
///
/// Layers that are made from a frame afterwards (labels, denoised ones) are not part of its record. A frame that was ended by a time limit
/// gets as many samples as it had. If files in the dataset now have other bytes than the record states, `cx` receives a warning.
///
/// # Errors
/// If the file is not a record with a recipe, if its inputs are missing or have changed, if this is another version of the program, or if
/// `out` already has this frame.
pub fn replay(file: &Path, out: Option<&Path>, cx: &dyn Cx) -> Result<Replay, Error> {
    let source = read(file)?;
    if let Some(out) = out {
        refuse_older(out, &source.record)?;
    }
    warn_of_changed(&source, cx);
    let frame = render(&source, cx)?;
    let scratch;
    let root = match out {
        Some(out) => out,
        None => {
            scratch = tempfile::tempdir().map_err(Error::io("create a scratch folder in", &std::env::temp_dir()))?;
            scratch.path()
        }
    };
    let Source { record, recipe, camera, trajectory, index, .. } = source;
    let info = FrameInfo {
        seed: record.seed,
        samples: record.samples,
        config_hash: record.config_hash.clone(),
        pose: trajectory.poses[index],
        camera,
        sampling: record.sampling,
        recipe: Some(recipe),
    };
    let again = Dataset::create(root).map_err(Error::stage)?;
    let again = again.write_frame(&record.scene, &record.camera, &frame, &info, FrameTime::default()).map_err(Error::stage)?;
    let same = |(name, then): (&String, &FileRecord)| ReplayedFile { name: name.clone(), same: again.files.get(name) == Some(then) };
    let files = record.as_rendered().files.iter().map(same).collect();
    Ok(Replay { frame: format!("{}/{}/frame.{:04}", record.scene, record.camera, record.frame), files })
}

/// Warns of the dataset's own files that differ from the record: only the newly rendered files are compared with it.
fn warn_of_changed(source: &Source, cx: &dyn Cx) {
    let is_changed = |name: &str, then: &FileRecord| FileRecord::of(&source.folder.join(name)).is_ok_and(|found| found != *then);
    for (name, _) in source.record.files.iter().filter(|(name, then)| is_changed(name, then)) {
        let message = "its bytes in the dataset differ from those of the frame's record, with which the replay is compared";
        cx.warn(Warning { place: source.folder.join(name).display().to_string(), message: message.into() });
    }
}

/// An existing frame below `out` would be replaced, and its labels would be lost.
fn refuse_older(out: &Path, record: &FrameRecord) -> Result<(), Error> {
    let (layout, FrameRecord { scene, camera, frame, .. }) = (Layout::new(out), record);
    let layers = LAYERS.iter().map(|spec| layout.layer(scene, camera, *frame, spec.layer));
    let Some(older) = layers.chain([layout.frame_record(scene, camera, *frame)]).find(|path| path.exists()) else { return Ok(()) };
    let message = format!("{scene}/{camera}/frame.{frame:04} is in {} already: {}", out.display(), older.display());
    Err(Error::usage(message, "name another folder with -o; the frame that is there would be replaced"))
}

/// Finds all that the record names, and makes sure that it is still the same.
fn read(file: &Path) -> Result<Source, Error> {
    let hint = "name the commit record of a frame: OUT/scenes/SCENE/_detail/CAMERA/frames/frame.0000.json";
    let file = std::path::absolute(file).map_err(Error::io("find", file))?;
    let text = std::fs::read(&file).map_err(|e| Error::usage(format!("cannot read {}: {e}", file.display()), hint))?;
    let no_record = |e: serde_json::Error| Error::usage(format!("{} is no commit record of a frame: {e}", file.display()), hint);
    let record: FrameRecord = serde_json::from_slice(&text).map_err(no_record)?;
    let root = root_of(&file, &record).ok_or_else(|| {
        Error::usage(format!("{} is not where a dataset keeps the record of {}/{}", file.display(), record.scene, record.camera), hint)
    })?;
    let again =
        format!("render the frame again: enfilade run {} --only render --scene {} --force", quoted(root.display()), quoted(&record.scene));
    let changed = |what: String| Error::scene(format!("{what}, so the frame cannot be replayed"), again.clone());
    let recipe =
        record.recipe.clone().ok_or_else(|| changed("its record is of an earlier version, which did not tell the settings".into()))?;
    let (version, here) = (recipe.render_version, Stage::Render.version());
    // Releases whose rendering has one version make the same bytes.
    let is_ours = recipe.program.split(' ').next() == program().split(' ').next();
    if !is_ours || version != here {
        let message =
            format!("the frame was rendered by {} (rendering {version}), and this is {} (rendering {here})", recipe.program, program());
        return Err(Error::scene(message, format!("use the program that rendered it, or {again}")));
    }
    let config: RenderConfig = serde_json::from_value(recipe.settings.clone())
        .map_err(|e| changed(format!("the settings in {} cannot be understood ({e})", file.display())))?;
    let dataset = Dataset::open(&root).map_err(Error::stage)?;
    let camera = dataset.read_camera(&record.scene, &record.camera).map_err(Error::stage)?;
    let trajectory = dataset.read_trajectory(&record.scene, &record.camera).map_err(Error::stage)?;
    let at = trajectory.poses.iter().position(|pose| pose.frame == record.frame);
    let index = at.ok_or_else(|| changed(format!("the trajectory of {} has no frame {} any more", record.camera, record.frame)))?;
    let (scene, package) = package_of(&root, &record, &recipe, &changed)?;
    let package_file = root.join(WORKDIR).join(&record.scene).join(PACKAGE);
    let frame_time_s = frame_time(&dataset, &package_file, &record.scene, &record.camera)?;
    let timing = Timing { limit_s: recipe.time_limit_s, frame_s: frame_time_s };
    if config_hash(&package, &config, timing, &camera, &trajectory, &trajectory.poses[index]) != record.config_hash {
        return Err(changed(format!("the camera or the trajectory of {} is not the one that the frame was rendered with", record.camera)));
    }
    let folder = dataset.layout().scene_dir(&record.scene);
    Ok(Source { folder, record, recipe, config, scene, camera, trajectory, index, frame_time_s })
}

/// The dataset's folder, if the file is at the place in it that the record states.
fn root_of(file: &Path, record: &FrameRecord) -> Option<PathBuf> {
    let root = file.ancestors().nth(6)?;
    let there = Dataset::open(root).ok()?.layout().frame_record(&record.scene, &record.camera, record.frame);
    (there == file).then(|| root.to_path_buf())
}

/// The scene package of the work folder, if it is the one that the frame was rendered from.
fn package_of(root: &Path, record: &FrameRecord, recipe: &Recipe, changed: &dyn Fn(String) -> Error) -> Result<(Scene, Hash), Error> {
    let path = root.join(WORKDIR).join(&record.scene).join(PACKAGE);
    let Ok(bytes) = std::fs::read(&path) else { return Err(changed(format!("the scene package {} is not there", path.display()))) };
    let package = Hash::of_bytes(&bytes);
    if package.0 != recipe.scene_blake3 {
        return Err(changed(format!("the scene package {} has changed since (its checksum is another)", path.display())));
    }
    let scene = read_package(&path, &bytes).map_err(|e| changed(format!("{}: {e}", path.display())))?;
    Ok((scene, package))
}

/// The frame, with as many samples as it had.
fn render(source: &Source, cx: &dyn Cx) -> Result<Frame, Error> {
    let Source { record, config, scene, camera, trajectory, index, .. } = source;
    let views = views(camera, trajectory);
    if let Some(frame_time_s) = source.frame_time_s {
        let moment = Moment::new(scene, &views, &trajectory.poses, *index, frame_time_s);
        return Ok(take_at(&moment, &views, *index, config, |rendering| Ok((taken(record, rendering, cx), ())))?.0);
    }
    let scene = RenderScene::new(scene, cx).map_err(Error::stage)?.settled(config);
    let guide = Guide::learn(&scene, &views, config);
    let rendering = FrameRender::new(&scene, &guide, &views[*index], config).map_err(Error::stage)?;
    let mut frame = taken(record, rendering, cx);
    add_extra(&scene, &views, *index, config, &mut frame);
    Ok(frame)
}

/// The frame after as many samples as the record states.
fn taken(record: &FrameRecord, mut rendering: FrameRender<'_, '_>, cx: &dyn Cx) -> Frame {
    let ended = record.sampling.filter(|sampling| sampling.stopped_by == StoppedBy::TimeLimit);
    while !rendering.is_done() && ended.is_none_or(|sampling| rendering.samples() < sampling.samples_taken) {
        if ended.is_some() {
            rendering.short_pass(cx);
        } else {
            rendering.pass(cx);
        }
    }
    rendering.frame()
}
