//! `render`: trajectories to frames. Resumes frame by frame: a frame is not rendered again if its record has the current hash of everything
//! that its values depend on; for resuming within a frame, see `progressive`.

use super::views::views;
use super::{FramesByTrajectory, HASHED_AS, Input, Inputs, Job, Outcome, Record, Stage, camera_files, denoise, gate, moments, progressive};
use crate::error::Error;
use crate::report::{StageCx, Stopwatch};
use crate::workdir::Hash;
use enfilade_dataset::{CameraRecord, ColorKind, Fixture, FrameInfo, FrameRecord, Recipe, StoppedBy, counted, remove_folder};
use enfilade_frame::{Frame, Pass};
use enfilade_render::{FixtureKind, FlowTo, FrameRender, Guide, RenderConfig, RenderScene, Rows, add_extra_layers};
use enfilade_scene::{Camera, CameraView, Cx, Pose, Quiet, Scene, Trajectory, Warning};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

pub(super) fn settings(job: &Job) -> Hash {
    Hash::of(&(&job.scene.render, job.scene.time_limit_s, job.scene.seed_for("render")))
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    let mut inputs = vec![job.input_from(Stage::Import, &job.package()?)?];
    inputs.extend(camera_files::inputs(job)?);
    inputs.extend(gate::verdicts(job)?);
    inputs.extend(moments::inputs(job)?);
    Ok(Some(inputs))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    // Remove what a killed run and other plans have left.
    let filmed = job.filmed()?;
    let wanted = wanted(job, &filmed)?;
    let total: usize = wanted.iter().map(BTreeSet::len).sum();
    for ((_, trajectory), wanted) in filmed.iter().zip(&wanted) {
        job.dataset.remove_temporaries(&job.scene.name, &trajectory.name).map_err(Error::stage)?;
        remove_unwanted_frames(job, trajectory, wanted)?;
    }

    // Find the missing frames. For the others no saved state is needed.
    denoise::warn_of_lost(job, cx);
    let missing = missing(job, &filmed, &wanted)?;
    let unfinished = missing.iter().flat_map(|m| m.frames.iter().map(|info| (m.trajectory.name.as_str(), info.pose.frame)));
    progressive::forget_all_but(job, unfinished)?;

    let rendered: usize = missing.iter().map(|m| m.frames.len()).sum();
    if !job.scene.render.fixtures {
        job.dataset.write_fixtures(&job.scene.name, &[]).map_err(Error::stage)?;
    }

    // List what lights the scene, and render them. Where several machines render, each lists it with its frames.
    let lists_fixtures = job.scene.render.fixtures && (rendered > 0 || job.shift.is_none());
    let mut timed_out = 0;
    if moments::moves(&job.package()?) {
        job.forget_world();
        let scene = job.load_scene()?;
        refuse_unfit(job)?;
        moments::write_tables(job, Some(&scene))?;
        timed_out = render(job, &Rendered::Moving(&scene), &missing, [total - rendered, total], cx)?;
    } else {
        let jointed = if moments::has_joints(&job.package()?) { Some(job.load_scene()?) } else { None };
        moments::write_tables(job, jointed.as_deref())?;
        if rendered > 0 || lists_fixtures {
            job.forget_world();
            let scene = job.load_scene()?;
            let scene = RenderScene::new(&scene, cx).map_err(Error::stage)?.settled(&job.scene.render);
            if lists_fixtures {
                list_fixtures(job, scene.fixtures())?;
            }
            timed_out = render(job, &Rendered::Still(&scene), &missing, [total - rendered, total], cx)?;
        }
    }
    let [width, height] = job.scene.size;
    let kept = if rendered < total { format!(", {} kept", total - rendered) } else { String::new() };
    let ended = if timed_out > 0 { format!(", {timed_out} ended by the time limit") } else { String::new() };
    let summary = format!("{} of {width}x{height} at {} samples{kept}{ended}", counted(rendered, "frame"), job.scene.render.samples);
    Ok(Outcome { summary, outputs: outputs(job)?, ..Outcome::default() })
}

/// Refuses what cannot be made of scenes that move.
fn refuse_unfit(job: &Job) -> Result<(), Error> {
    if job.scene.render.fixtures {
        let message = "the scene moves, and light is kept apart by lamp and window only of still scenes".to_string();
        return Err(Error::scene(message, "take out fixtures = true, or give the scene still = true and no [[motion]]"));
    }
    Ok(())
}

/// Renders the missing frames of `job`, regardless of the stage's record.
pub(crate) fn render_frames(job: &Job, cx: &StageCx) -> Result<(), Error> {
    run(job, cx).map(drop)
}

/// The frames that a run of the stage would render, by trajectory; without those that have none.
pub(crate) fn missing_frames(job: &Job) -> Result<FramesByTrajectory, Error> {
    let filmed = job.filmed()?;
    let frames = |m: &Missing| (m.trajectory.name.clone(), m.frames.iter().map(|info| info.pose.frame).collect());
    Ok(missing(job, &filmed, &wanted(job, &filmed)?)?.iter().map(frames).collect())
}

/// The frames that each trajectory should have.
fn wanted(job: &Job, filmed: &[(Camera, Trajectory)]) -> Result<Vec<BTreeSet<u32>>, Error> {
    filmed.iter().map(|(_, trajectory)| job.frames_of(trajectory)).collect()
}

/// The frames to render of each incomplete trajectory.
fn missing<'a>(job: &Job, filmed: &'a [(Camera, Trajectory)], wanted: &[BTreeSet<u32>]) -> Result<Vec<Missing<'a>>, Error> {
    let package = Input::of(&job.package()?)?.content;
    let mut missing = Vec::new();
    for ((camera, trajectory), wanted) in filmed.iter().zip(wanted) {
        let config = settings_of(job, trajectory);
        let recipe = Recipe {
            program: program(),
            render_version: Stage::Render.version(),
            scene_blake3: package.0.clone(),
            settings: serde_json::to_value(&config).unwrap_or_default(),
            time_limit_s: job.scene.time_limit_s,
        };
        let poses = trajectory.poses.iter().filter(|pose| wanted.contains(&pose.frame));
        let timing = Timing { limit_s: job.scene.time_limit_s, frame_s: frame_time_of(job, trajectory)? };
        let infos = poses.map(|pose| FrameInfo {
            seed: config.seed,
            samples: config.samples,
            config_hash: config_hash(&package, &config, timing, camera, trajectory, pose),
            pose: *pose,
            camera: camera.clone(),
            sampling: None,
            recipe: Some(recipe.clone()),
        });
        let frames: Vec<FrameInfo> = infos.filter(|info| job.force || !is_complete(job, trajectory, info)).collect();
        if !frames.is_empty() {
            missing.push(Missing { camera, trajectory, config, frames });
        }
    }
    Ok(missing)
}

/// Seconds between the frames of a trajectory, if the scene moves.
fn frame_time_of(job: &Job, trajectory: &Trajectory) -> Result<Option<f64>, Error> {
    moments::frame_time(job.dataset, &job.package()?, &job.scene.name, &trajectory.name)
}

/// The settings that a trajectory is rendered with.
fn settings_of(job: &Job, trajectory: &Trajectory) -> RenderConfig {
    RenderConfig { seed: job.scene.seed_for(&format!("render/{}", trajectory.name)), ..job.scene.render.clone() }
}

/// The [`config_hash`] of every frame of a trajectory that was read from files.
pub(super) fn config_hashes(job: &Job, camera: &Camera, trajectory: &Trajectory) -> Result<BTreeMap<u32, String>, Error> {
    let package = Input::of(&job.package()?)?.content;
    let config = settings_of(job, trajectory);
    let timing = Timing { limit_s: job.scene.time_limit_s, frame_s: frame_time_of(job, trajectory)? };
    let hash = |pose: &Pose| (pose.frame, config_hash(&package, &config, timing, camera, trajectory, pose));
    Ok(trajectory.poses.iter().map(hash).collect())
}

/// The frames to render of a trajectory.
struct Missing<'a> {
    camera: &'a Camera,
    trajectory: &'a Trajectory,
    config: RenderConfig,
    frames: Vec<FrameInfo>,
}

fn is_complete(job: &Job, trajectory: &Trajectory, info: &FrameInfo) -> bool {
    rendered_record(job, trajectory, &info.camera, &info.pose).is_some_and(|record| record.config_hash == info.config_hash)
}

/// The record of a frame that agrees with its trajectory and whose rendered layers all exist; also its rendered colour if that is
/// requested.
fn rendered_record(job: &Job, trajectory: &Trajectory, camera: &Camera, pose: &Pose) -> Option<FrameRecord> {
    let record = job.dataset.rendered_record(&job.scene.name, &trajectory.name, pose.frame)?;
    let has_what_is_asked_for = job.scene.color == ColorKind::Denoised || record.has_rendered();
    (has_what_is_asked_for && record.is_taken(camera, pose)).then_some(record)
}

/// Whether every frame exists and agrees with its trajectory.
pub(super) fn frames_are_whole(job: &Job) -> bool {
    frames_are_taken(job).unwrap_or(false)
}

fn frames_are_taken(job: &Job) -> Result<bool, Error> {
    for (camera, trajectory) in job.filmed()?.iter() {
        let wanted = job.frames_of(trajectory)?;
        let mut poses = trajectory.poses.iter().filter(|pose| wanted.contains(&pose.frame));
        if !poses.all(|pose| rendered_record(job, trajectory, camera, pose).is_some()) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// What is rendered.
enum Rendered<'a> {
    /// A scene that is the same in every frame.
    Still(&'a RenderScene<'a>),
    /// A scene that each frame finds in another state.
    Moving(&'a Scene),
}

/// Renders and writes the frames that are `missing`; `kept` of the `total` are there. Returns how many the time limit has ended.
fn render(job: &Job, scene: &Rendered, missing: &[Missing], [kept, total]: [usize; 2], cx: &StageCx) -> Result<usize, Error> {
    let (mut done, mut timed_out, mut coarsest_px) = (kept, 0, 0.0f64);
    for Missing { camera, trajectory, config, frames } in missing {
        // One guide per trajectory: it learns from all views where light comes from. Of a scene that moves each frame has its own.
        let views = views(camera, trajectory);
        let mut learnt = None;
        let frame_time_s = frame_time_of(job, trajectory)?.unwrap_or_default();
        for info in frames {
            let Some(index) = views.iter().position(|view| view.pose().frame == info.pose.frame) else { continue };

            // Render a frame; it continues where a killed run ended.
            let time = Stopwatch::start();
            let frame_cx = FrameCx { outer: cx, done, total };
            let take = |rendering: FrameRender<'_, '_>| progressive::render(job, &trajectory.name, info, rendering, &frame_cx);
            let (frame, sampling) = match scene {
                Rendered::Moving(scene) => {
                    let moment = moments::Moment::new(scene, &views, &trajectory.poses, index, frame_time_s);
                    coarsest_px = coarsest_px.max(if moment.bands.is_empty() { 0.0 } else { moment.step_px });
                    take_at(&moment, &views, index, config, take)?
                }
                Rendered::Still(scene) => {
                    let guide = learnt.get_or_insert_with(|| {
                        cx.progress("learning where light comes from", done as u64, total as u64);
                        Guide::learn(scene, &views, config)
                    });
                    let rendering = FrameRender::new(scene, guide, &views[index], config).map_err(Error::stage)?;
                    let (mut frame, sampling) = take(rendering)?;
                    add_extra(scene, &views, index, config, &mut frame);
                    (frame, sampling)
                }
            };

            // Write it with its record, announce it, and only then remove its saved state.
            let time = time.of_frame();
            let info = FrameInfo { sampling: Some(sampling), ..info.clone() };
            job.dataset.write_rendered(&job.scene.name, &trajectory.name, &frame, &info, time).map_err(Error::stage)?;
            if let Some(shift) = job.shift {
                (shift.rendered)(&trajectory.name, info.pose.frame)?;
            }
            progressive::forget(job, &trajectory.name, info.pose.frame)?;
            done += 1;
            timed_out += usize::from(sampling.stopped_by == StoppedBy::TimeLimit);
        }
    }
    if coarsest_px > COARSE_PX {
        let message = format!(
            "the rows of its rolling shutter see what moves in few bands: it is up to {coarsest_px:.1} pixels farther in each, because it is \
             fast, near, or the scene has too many triangles for more (docs/cameras.md)"
        );
        cx.warn(Warning { place: job.scene.name.clone(), message });
    }
    Ok(timed_out)
}

/// Prepares a scene as a frame finds it, has `take` take its samples, and adds the further layers.
pub(crate) fn take_at<T>(
    moment: &moments::Moment,
    views: &[CameraView],
    index: usize,
    config: &RenderConfig,
    take: impl FnOnce(FrameRender<'_, '_>) -> Result<(Frame, T), Error>,
) -> Result<(Frame, T), Error> {
    let (scene, guide) = prepared(&moment.scene, &views[index], config, 1)?;
    // What moves while the shutter is open is blurred.
    let stretches = moment.exposed.iter().map(|scene| prepared(scene, &views[index], config, moment.exposed.len()));
    let stretches = stretches.collect::<Result<Vec<_>, _>>()?;
    let rows = match &moment.bands[..] {
        [] => Rows::from(&scene),
        bands => Rows::bands(bands.iter().map(|&(row, stretch)| (row, &stretches[stretch].0))),
    };
    let rendering =
        FrameRender::new(&scene, &guide, &views[index], config).map_err(Error::stage)?.exposed(&stretches).in_rows(rows.clone());
    let (mut frame, taken) = take(rendering)?;
    if config.extra {
        let moved = moment.moved()?;
        let next = views.get(index + 1).map(|view| FlowTo { view, moved: moved.as_ref() });
        add_extra_layers(rows, &views[index], next, &mut frame);
        moment.mark(&mut frame);
    }
    Ok((frame, taken))
}

/// A state of a scene, ready for rays, and what was learned of it; `share` states divide the effort among them.
fn prepared<'s>(scene: &'s Scene, view: &CameraView<'_>, config: &RenderConfig, share: usize) -> Result<(RenderScene<'s>, Guide), Error> {
    let scene = RenderScene::new(scene, &Quiet).map_err(Error::stage)?.settled(config);
    let learning = RenderConfig { samples: config.samples.div_ceil(share as u32), ..config.clone() };
    let guide = Guide::learn(&scene, &[*view], &learning);
    Ok((scene, guide))
}

/// Lists what lights the scene, where the light of each is kept apart.
fn list_fixtures(job: &Job, found: &[enfilade_render::Fixture]) -> Result<(), Error> {
    let fixture = |(fixture, id): (&enfilade_render::Fixture, u32)| Fixture {
        id,
        kind: fixture.kind.name().into(),
        name: fixture.name.clone(),
        intensity: matches!(fixture.kind, FixtureKind::Lamp | FixtureKind::Rest).then_some(fixture.intensity),
        position: fixture.position,
        node_ids: fixture.parts.iter().map(|part| part + 1).collect(),
        lights: fixture.lights.clone(),
    };
    let listed: Vec<Fixture> = found.iter().zip(1..).map(fixture).collect();
    job.dataset.write_fixtures(&job.scene.name, &listed).map_err(Error::stage)
}

/// Adds the further layers of a view, if requested; flow leads to the next one.
pub(crate) fn add_extra(scene: &RenderScene, views: &[CameraView], index: usize, config: &RenderConfig, frame: &mut Frame) {
    if config.extra {
        add_extra_layers(scene, &views[index], views.get(index + 1).map(FlowTo::still), frame);
    }
}

/// Bands of rows between which things move farther are worth a warning, pixels.
const COARSE_PX: f64 = 1.0;

/// Units of progress per frame.
const PER_FRAME: u64 = 1000;

/// The times that a frame's values depend on.
#[derive(Clone, Copy)]
pub(crate) struct Timing {
    /// Wall-clock seconds after which the frame was to end.
    pub limit_s: Option<f64>,
    /// Seconds between frames, if the scene moves.
    pub frame_s: Option<f64>,
}

/// Names everything that a frame's values depend on. It depends on its whole trajectory, because the guide is learned from all of it,
/// and the camera moves on while it is exposed. Views that a gate rejects are learned from too, so that other limits change no frame.
pub(crate) fn config_hash(
    package: &Hash,
    config: &RenderConfig,
    timing: Timing,
    camera: &Camera,
    trajectory: &Trajectory,
    pose: &Pose,
) -> String {
    let version = (HASHED_AS, Stage::Render.version());
    let still = (version, package, config, timing.limit_s, CameraRecord::from(camera), &trajectory.poses, pose);
    match (timing.frame_s, camera.shutter) {
        (None, _) => Hash::of(&still).0,
        (Some(frame_s), None) => Hash::of(&(&still, frame_s)).0,
        (Some(frame_s), Some(shutter)) if shutter.readout_s > 0.0 => Hash::of(&(&still, frame_s, "rolling")).0,
        (Some(frame_s), Some(_)) => Hash::of(&(&still, frame_s, "blurred")).0,
    }
}

/// The program as records name it.
pub(crate) fn program() -> String {
    format!("enfilade {}", env!("CARGO_PKG_VERSION"))
}

/// Every file that rendering writes for the scene as a whole; records vouch for the files of frames.
fn outputs(job: &Job) -> Result<Vec<PathBuf>, Error> {
    let has_fixtures = !job.dataset.read_fixtures(&job.scene.name).map_err(Error::stage)?.is_empty();
    let mut outputs: Vec<PathBuf> = has_fixtures.then(|| job.dataset.layout().metadata_fixtures(&job.scene.name)).into_iter().collect();
    if moments::has_joints(&job.package()?) {
        outputs.push(job.dataset.layout().metadata_bodies(&job.scene.name));
    }
    if moments::moves(&job.package()?) {
        outputs.extend(job.filmed()?.iter().map(|(_, filmed)| job.dataset.layout().metadata_body_poses(&job.scene.name, &filmed.name)));
    }
    Ok(outputs)
}

/// Removes frames of an earlier, longer trajectory and of views that gates reject now.
fn remove_unwanted_frames(job: &Job, trajectory: &Trajectory, wanted: &BTreeSet<u32>) -> Result<(), Error> {
    let layout = job.dataset.layout();
    let (name, camera) = (&job.scene.name, &trajectory.name);
    let keep: BTreeSet<String> = wanted.iter().map(|frame| format!("{frame:04}")).collect();
    let folders = [
        layout.records_dir(name, camera),
        layout.layer_dir(name, camera, Pass::Final),
        layout.layer_dir(name, camera, Pass::Geometry),
        layout.preview_dir(name, camera, Pass::Final),
        layout.preview_dir(name, camera, Pass::Geometry),
        layout.after_frame_dir(name, camera),
    ];
    // Records first: a frame without one does not count.
    for folder in folders {
        let Ok(entries) = std::fs::read_dir(&folder) else { continue };
        for entry in entries {
            let path = entry.map_err(Error::io("read", &folder))?.path();
            let number = path.file_name().and_then(|n| n.to_str()).and_then(|n| n.strip_prefix("frame.")).and_then(|n| n.split('.').next());
            if number.is_none_or(|n| keep.contains(n)) {
                continue;
            }
            if path.is_dir() {
                remove_folder(&path)?;
            } else {
                std::fs::remove_file(&path).map_err(Error::io("remove", &path))?;
            }
        }
    }
    Ok(())
}

/// Converts the progress within a frame to the progress of all frames.
pub(crate) struct FrameCx<'a> {
    pub outer: &'a dyn Cx,
    /// Frames before this one.
    pub done: usize,
    /// All frames.
    pub total: usize,
}

impl Cx for FrameCx<'_> {
    fn progress(&self, _what: &str, done: u64, total: u64) {
        let within = PER_FRAME * done.min(total) / total.max(1);
        let what = format!("frame {} of {}", (self.done + 1).min(self.total), self.total);
        self.outer.progress(&what, self.done as u64 * PER_FRAME + within, self.total as u64 * PER_FRAME);
    }

    fn warn(&self, warning: Warning) {
        self.outer.warn(warning);
    }
}
