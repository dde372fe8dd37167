//! `plan`: free space to one trajectory per start camera.

use super::kept::{Plan, remove_frames_of_other_poses};
use super::own_cameras::{self, OwnCamera};
use super::planned::Made;
use super::{Input, Inputs, Job, Outcome, Record, Stage, camera_files, carve, gate, imported, targets, variation};
use crate::error::Error;
use crate::gatekeeper::Gatekeeper;
use crate::report::StageCx;
use crate::workdir::Hash;
use crate::world::World;
use enfilade_dataset::{StereoRecord, StereoSide, counted, counted_as, remove_folder, remove_if_there, write_json};
use enfilade_explore::{
    CamerasConfig, CarveReport, ExploreError, FreeSpace, Keyframe, Mode, ObjectVisibility, PlanConfig, PlanReport, Planned, Preset, Spread,
    parse_keyframes, plan_objects,
};
use enfilade_geometry::OccupancyTree;
use enfilade_scene::{Camera, CameraView, Cx, Pose, Scene, StartCamera, Trajectory, Warning, decoded_text};
use enfilade_show::planview::remove_plan_preview;
use enfilade_verify::view_gates::GateAction;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Trajectories of cameras that see to the side and behind are planned by what is within this angle before them.
const WIDEST_VIEW_RAD: f64 = 2.1;

/// Fields of view that differ by less count as one: files round them.
const SAME_VIEW_RAD: f64 = 1e-3;

pub(super) fn settings(job: &Job) -> Hash {
    let scene = job.scene;
    Hash::of(&(&scene.plan, scene.size, scene.fov_x_deg, &scene.camera, &scene.gate, scene.exploring_seed("plan", scene.plan.preset)))
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    if let Some(first) = job.first()? {
        return variation::plan_inputs(&first).map(Some);
    }
    let mut inputs = vec![job.input_from(Stage::Import, &job.package()?)?];
    for path in carve::outputs(job)? {
        inputs.push(job.input_from(Stage::Carve, &path)?);
    }
    if let Some(grid) = &job.scene.camera.ray_grid {
        inputs.push(Input::of(&job.config.path(grid)?)?);
    }
    match &job.scene.plan.mode {
        Mode::Keyframes(keyframes) => {
            for file in &keyframes.files {
                inputs.push(Input::of(&job.config.path(file)?)?);
            }
        }
        Mode::Objects(_) if !job.scene.objects.is_empty() => {
            inputs.push(job.input_from(Stage::Import, &job.dataset.layout().placed_objects(&job.scene.name))?);
        }
        Mode::Photos(_) => inputs.push(job.input_from(Stage::Import, &job.work_file(imported::LABELS)?)?),
        _ => {}
    }
    Ok(Some(inputs))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let name = &job.scene.name;
    let first = job.first()?;
    let Made { camera, filmed, reports, summary } = first.as_ref().map_or_else(|| plan_anew(job, cx), variation::plan_of)?;
    let trajectories: Vec<Trajectory> = filmed.iter().map(|(trajectory, _)| trajectory.clone()).collect();
    // Remove what was made from an earlier plan, before it can be mistaken for something of this one.
    remove_plan_preview(job.dataset, name).map_err(Error::stage)?;
    gate::forget(job)?;
    remove_other_cameras(job, &trajectories)?;
    for (trajectory, stereo) in &filmed {
        remove_frames_of_other_poses(job, &Plan { trajectory, camera: &camera, stereo: stereo.as_ref() })?;
        remove_if_there(&job.dataset.layout().plan_report(name, &trajectory.name))?;
    }
    for (trajectory, stereo) in &filmed {
        job.dataset.write_trajectory(name, trajectory, &camera, stereo.as_ref()).map_err(Error::stage)?;
        if let Some(fps) = job.scene.plan.mode.fps() {
            job.dataset.write_frame_time(name, &trajectory.name, 1.0 / fps).map_err(Error::stage)?;
        }
    }
    warn_of_frame_time(job, &camera, cx);
    write_camera_row(job, &camera, cx)?;
    job.forget_filmed();
    let layout = job.dataset.layout();
    let mut outputs = camera_files::files(job, &trajectories);
    outputs.push(layout.metadata_cameras(name));
    outputs.extend(trajectories.iter().map(|trajectory| layout.metadata_camera(name, &trajectory.name)));
    for report in &reports {
        let path = layout.plan_report(name, &report.trajectory);
        write_json(&path, report)?;
        outputs.push(path);
    }
    if let Some(first) = &first {
        variation::share(job, first, &outputs)?;
    }
    let report = serde_json::to_value(&reports).unwrap_or_default();
    Ok(Outcome { summary, outputs, report, ..Outcome::default() })
}

/// Plans the trajectories of a scene.
fn plan_anew(job: &Job, cx: &StageCx) -> Result<Made, Error> {
    let own = if let Mode::Cameras(_) = job.scene.plan.mode { Some(own_cameras::chosen(job)?) } else { None };
    let starts = own.as_ref().map_or_else(|| carve::starts(job), |own| Ok(own.iter().map(|own| own.camera.clone()).collect()))?;
    let fov_x_rad = job.scene.fov_x_deg.map_or(starts[0].fov_x_rad, f64::to_radians);
    let camera = job.scene.camera.camera(job.scene.size, fov_x_rad, |path| job.config.path(path))?;
    if job.scene.fov_x_deg.is_none() && job.scene.camera.takes_field_of_view() && !matches!(job.scene.plan.mode, Mode::Keyframes(_)) {
        warn_of_other_views(&starts, cx);
    }
    let fov_x_rad = camera.projection.fov_x_rad(std::f64::consts::TAU);
    let mut reports = Vec::new();
    let mut filmed: Vec<(Trajectory, Option<StereoRecord>)> = Vec::new();
    for (number, Planned { trajectory, report }) in plan_all(job, &starts, own.as_deref(), &camera, cx)?.into_iter().enumerate() {
        match job.scene.camera.stereo {
            None => filmed.push((trajectory, None)),
            Some(stereo) => filmed.extend(rig(trajectory, number, stereo.baseline_m)),
        }
        // The report of a rig is the report of its left camera, which was planned.
        reports.push(report);
    }
    let summary = summary(&reports, fov_x_rad);
    Ok(Made { camera, filmed, reports, summary })
}

/// Sets the scene's row of the table that scenes share, and warns if the old table could not be read.
fn write_camera_row(job: &Job, camera: &Camera, cx: &StageCx) -> Result<(), Error> {
    if let Some(damage) = job.dataset.write_camera_parameters(&job.scene.name, camera).map_err(Error::stage)? {
        let message = format!("{damage}; the table was started again, and the next `plan` or `run` of the other scenes adds their rows");
        cx.warn(Warning { place: "table of cameras".into(), message });
    }
    Ok(())
}

/// A shutter blurs by the time between frames, so that should be the video's.
fn warn_of_frame_time(job: &Job, camera: &Camera, cx: &StageCx) {
    let (Some(fps), Some(shutter)) = (job.scene.plan.mode.fps(), camera.shutter) else { return };
    if (shutter.frame_time_s * fps - 1.0).abs() > 1e-3 {
        let (found, expected) = (shutter.frame_time_s, 1.0 / fps);
        let message =
            format!("its shutter counts {found} s between frames, but the video has {fps} a second: set frame_time_s = {expected:.5}");
        cx.warn(Warning { place: "[camera]".into(), message });
    }
}

/// All trajectories of a scene are filmed with one camera, with the field of view of the first start.
fn warn_of_other_views(starts: &[StartCamera], cx: &dyn Cx) {
    let first = &starts[0];
    let degrees = |camera: &StartCamera| format!("{:.1}", camera.fov_x_rad.to_degrees());
    for other in starts.iter().filter(|other| (other.fov_x_rad - first.fov_x_rad).abs() > SAME_VIEW_RAD) {
        let message = format!(
            "it is {} degrees wide, but its pictures will be {}, as those of camera {:?}: a scene has one field of view. Give this camera a \
             [[scene]] of its own (cameras = [{:?}]), or set render.fov_x_deg",
            degrees(other),
            degrees(first),
            first.name,
            other.name
        );
        cx.warn(Warning { place: format!("camera {:?}", other.name), message });
    }
}

/// One line: the number of poses, and their statistics.
fn summary(reports: &[PlanReport], fov_x_rad: f64) -> String {
    let poses: usize = reports.iter().map(|report| report.per_frame.frame.len()).sum();
    let mean = |of: fn(&PlanReport) -> f64| reports.iter().map(of).sum::<f64>() / reports.len().max(1) as f64;
    let mut text = format!(
        "{} with {}, {:.0} degrees wide, {:.0} % of the surfaces seen, mean overlap {:.0} %",
        counted_as(reports.len(), "trajectory", "trajectories"),
        counted(poses, "pose"),
        fov_x_rad.to_degrees(),
        100.0 * mean(|report| report.seen_area_share),
        100.0 * mean(|report| report.statistics.overlap.mean)
    );
    for coverage in reports.iter().filter_map(|report| report.coverage.as_ref()) {
        let enough = coverage.seen_share.last().copied().unwrap_or(0.0);
        text += &format!(
            "; {:.0} % of the area seen {} times, {:.0} % never, {} without a view",
            100.0 * enough,
            coverage.views,
            100.0 * coverage.seen_share.first().copied().unwrap_or(0.0),
            counted(coverage.never_seen.len(), "part")
        );
    }
    let objects: Vec<&ObjectVisibility> = reports.iter().flat_map(|report| &report.objects).collect();
    if !objects.is_empty() {
        let shares = Spread::of(objects.iter().map(|one| 100.0 * one.visible_share));
        text += &format!("; objects visible in {:.0} to {:.0} % of the frames, {:.0} % on average", shares.min, shares.max, shares.mean);
    }
    text
}

/// The carved space, with the written bounds: Hypersim's programs write the bounds of voxel centres.
fn free_space(job: &Job) -> Result<FreeSpace, Error> {
    let (bt, free_min, free_max) = job.dataset.read_free_space(&job.scene.name).map_err(Error::stage)?;
    let damaged =
        |error| Error::scene(format!("{}: {error}", job.dataset.layout().octomap(&job.scene.name).display()), job.again(Stage::Carve));
    let tree = OccupancyTree::from_bt(&bt).map_err(damaged)?;
    let space = FreeSpace::new(tree, CarveReport::default()).map_err(Error::stage)?;
    Ok(FreeSpace { free_min, free_max, ..space })
}

/// The configuration with the seed, and test images like the pictures; Hypersim's program has its own. In an open place most of a view
/// may be sky.
fn plan_config(job: &Job, camera: &Camera) -> Result<PlanConfig, Error> {
    let mut plan = job.scene.plan.clone();
    if plan.preset == Preset::Default && carve::is_open_place(job)? {
        plan.max_void_share = plan.max_void_share.max(job.scene.gate.max_void_share);
    }
    let seed = job.scene.exploring_seed("plan", plan.preset);
    if plan.preset == Preset::Hypersim {
        return Ok(PlanConfig { seed, ..plan });
    }
    let [width, height] = camera.size().map(u64::from);
    let limit = if camera.projection.is_linear() { std::f64::consts::PI } else { WIDEST_VIEW_RAD };
    Ok(PlanConfig {
        seed,
        fov_x_rad: camera.projection.fov_x_rad(limit),
        test_height: (u64::from(plan.test_width) * height / width).max(1) as u32,
        stereo_baseline_m: job.scene.camera.stereo.map_or(0.0, |stereo| stereo.baseline_m),
        ..plan
    })
}

/// One trajectory per start camera, per file of poses made by hand, or per camera of the scene that is filmed with as it is. A camera from which none can begin is left out with a
/// warning, as long as one remains.
fn plan_all(job: &Job, starts: &[StartCamera], own: Option<&[OwnCamera]>, camera: &Camera, cx: &StageCx) -> Result<Vec<Planned>, Error> {
    let config = plan_config(job, camera)?;
    config.validate().map_err(Error::stage)?;
    let world = job.load_world()?;
    let space = free_space(job)?;
    if let Mode::Keyframes(keyframes) = &config.mode {
        return follow_all(job, &keyframes.files, &world, &space, &config, cx);
    }
    let scene = job.load_scene()?;
    if let (Mode::Cameras(cameras), Some(own)) = (&config.mode, own) {
        return film_all(job, own, &scene, cameras, (&world, &space, &config), cx);
    }
    let rejects = job.scene.gate.action == GateAction::Reject && config.preset == Preset::Default;
    let gate = gate::config(job)?;
    let keeper = if rejects { Some(Gatekeeper::new(&scene, &world, &carve::standing(job)?, &gate)?) } else { None };
    let accepts = |pose: &Pose| keeper.as_ref().is_none_or(|keeper| passes(job, keeper, camera, pose));
    let objects = targets::targets(job, &config.mode, &scene)?;
    let mut planned = Vec::new();
    let mut first_error = None;
    for (index, start) in starts.iter().enumerate() {
        let name = trajectory_name(job.scene.camera.stereo.is_some(), index, planned.len());
        let number = index as u32;
        match plan_objects(&world.mesh, &world.bvh, &space, start, &name, number, &config, &objects, &accepts, cx) {
            Ok(found) => planned.push(found),
            Err(error) => {
                let message = format!("no trajectory begins here: {error}");
                cx.warn(Warning { place: format!("camera {:?}", start.name), message });
                first_error.get_or_insert(error);
            }
        }
    }
    match first_error {
        Some(error) if planned.is_empty() => Err(Error::stage(error)),
        _ => Ok(planned),
    }
}

/// Whether a view, and the view of the other camera of a rig, passes the gates that will apply to it.
fn passes(job: &Job, keeper: &Gatekeeper, camera: &Camera, pose: &Pose) -> bool {
    let one = Trajectory { name: String::new(), poses: vec![*pose] };
    let other = job.scene.camera.stereo.map(|stereo| one.beside(String::new(), stereo.baseline_m));
    let views = one.poses.iter().chain(other.iter().flat_map(|other| &other.poses));
    views.map(|pose| keeper.judge(&CameraView::still(camera, pose))).all(|judgement| judgement.fault.is_none())
}

/// The trajectories of files of poses.
fn follow_all(
    job: &Job,
    files: &[String],
    world: &World,
    space: &FreeSpace,
    config: &PlanConfig,
    cx: &StageCx,
) -> Result<Vec<Planned>, Error> {
    let mut planned = Vec::new();
    for (index, file) in files.iter().enumerate() {
        let path = job.config.path(file)?;
        let bytes = std::fs::read(&path).map_err(Error::io("read", &path))?;
        let keyframes: Vec<Keyframe> = parse_keyframes(&path.display().to_string(), &decoded_text(&bytes)).map_err(misread)?;
        let name = trajectory_name(job.scene.camera.stereo.is_some(), index, planned.len());
        let found = enfilade_explore::follow(&world.mesh, &world.bvh, space, &keyframes, &name, config, cx).map_err(Error::stage)?;
        planned.push(found);
    }
    Ok(planned)
}

/// The trajectories of the scene's own cameras.
fn film_all(
    job: &Job,
    own: &[OwnCamera],
    scene: &Scene,
    cameras: &CamerasConfig,
    (world, space, config): (&World, &FreeSpace, &PlanConfig),
    cx: &StageCx,
) -> Result<Vec<Planned>, Error> {
    let mut planned = Vec::new();
    for (index, poses) in own_cameras::poses(own, scene, cameras, config.frames, cx).into_iter().enumerate() {
        let name = trajectory_name(job.scene.camera.stereo.is_some(), index, planned.len());
        planned.push(enfilade_explore::film(&world.mesh, &world.bvh, space, poses, &name, config, cx).map_err(Error::stage)?);
    }
    Ok(planned)
}

fn misread(error: ExploreError) -> Error {
    Error::scene(error.to_string(), "correct the file; its format is explained in docs/trajectories.md")
}

/// The name of the trajectory from start or file number `index`, which comes after `before` others; the name of its left camera if it is a
/// rig. A start without a trajectory leaves a gap in the numbers of single cameras, and none in those of rigs.
fn trajectory_name(is_rig: bool, index: usize, before: usize) -> String {
    camera_name(if is_rig { 2 * before } else { index })
}

fn camera_name(number: usize) -> String {
    format!("cam_{number:02}")
}

/// The trajectory of the left camera of rig `number`, and the right one's: `cam_00` and `cam_01`, `cam_02` and `cam_03`, …
fn rig(left: Trajectory, number: usize, baseline_m: f64) -> [(Trajectory, Option<StereoRecord>); 2] {
    let right = left.beside(camera_name(2 * number + 1), baseline_m);
    let of_left = StereoRecord::new(StereoSide::Left, right.name.clone(), baseline_m);
    let of_right = StereoRecord::new(StereoSide::Right, left.name.clone(), baseline_m);
    [(left, Some(of_left)), (right, Some(of_right))]
}

/// The table of the cameras of all scenes.
pub(super) fn camera_table(job: &Job) -> PathBuf {
    job.dataset.camera_table()
}

/// Hash of the scene's row in it; `None` where there is none, without which nothing can be filmed.
pub(super) fn camera_row(job: &Job) -> Option<Hash> {
    job.dataset.read_camera_table().ok()?.cells(&job.scene.name).ok().map(|cells| Hash::of(&cells))
}

/// Removes the cameras of an earlier plan that are not in this one. They are found in the table of cameras and by their files: a removal
/// that was killed leaves files without a row, and the table may be damaged.
fn remove_other_cameras(job: &Job, trajectories: &[Trajectory]) -> Result<(), Error> {
    let name = &job.scene.name;
    let mut old: BTreeSet<String> = job.dataset.cameras(name).unwrap_or_default().into_iter().collect();
    old.extend(job.dataset.cameras_by_files(name).map_err(Error::stage)?);
    let others = old.iter().filter(|camera| trajectories.iter().all(|t| t.name != **camera));
    others.map(String::as_str).try_for_each(|camera| remove_camera(job, camera))?;
    // Last, as it names what is still to be removed.
    Ok(remove_if_there(&job.dataset.layout().metadata_cameras(name))?)
}

/// Removes everything of a camera: its frames first, so that none counts without its layers, and its poses last, because they show that
/// there is something left to remove where this is killed.
fn remove_camera(job: &Job, camera: &str) -> Result<(), Error> {
    let (layout, name) = (job.dataset.layout(), &job.scene.name);
    job.dataset.retain_frames(name, camera, |_| false).map_err(Error::stage)?;
    let prefix = format!("scene_{camera}_");
    let is_picture = |path: &Path| path.file_name().and_then(|name| name.to_str()).is_some_and(|name| name.starts_with(&prefix));
    remove_within(&layout.images_dir(name), is_picture)?;
    let (folder, poses) = (layout.camera_dir(name, camera), layout.keyframes(name, camera, "positions"));
    remove_within(&folder, |path| path != poses)?;
    Ok(remove_folder(&folder)?)
}

/// Removes the files and folders in `folder` that are to go.
fn remove_within(folder: &Path, goes: impl Fn(&Path) -> bool) -> Result<(), Error> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Ok(()) };
    for entry in entries {
        let path = entry.map_err(Error::io("read", folder))?.path();
        if goes(&path) {
            if path.is_dir() { remove_folder(&path)? } else { remove_if_there(&path)? }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::{DMat3, DVec3};
    use enfilade_scene::Heard;

    #[test]
    fn starts_of_another_field_of_view_than_the_first_are_named() {
        let start = |name: &str, degrees: f64| StartCamera {
            name: name.into(),
            position: DVec3::ZERO,
            world_from_camera: DMat3::IDENTITY,
            fov_x_rad: degrees.to_radians(),
            aspect: 1.5,
        };
        let heard = Heard::default();
        warn_of_other_views(&[start("hall", 60.0), start("detail", 25.0), start("door", 60.01)], &heard);
        let [line] = &heard.lines()[..] else { panic!("{:?}", heard.lines()) };
        for expected in ["camera \"detail\"", "25.0 degrees", "will be 60.0", "camera \"hall\"", "render.fov_x_deg"] {
            assert!(line.contains(expected), "{expected} is not in {line}");
        }
    }

    #[test]
    fn trajectories_of_rigs_are_named_by_their_left_cameras() {
        assert_eq!([0, 1].map(|index| trajectory_name(false, index, index)), ["cam_00", "cam_01"]);
        assert_eq!([0, 1].map(|index| trajectory_name(true, index, index)), ["cam_00", "cam_02"]);
        // From the first start there is none.
        assert_eq!([false, true].map(|is_rig| trajectory_name(is_rig, 1, 0)), ["cam_01", "cam_00"]);
        let left = Trajectory { name: trajectory_name(true, 1, 1), poses: Vec::new() };
        let [(left, of_left), (right, of_right)] = rig(left, 1, 0.1);
        assert_eq!((left.name.as_str(), right.name.as_str()), ("cam_02", "cam_03"));
        assert_eq!([of_left, of_right].map(|record| record.unwrap().partner), ["cam_03", "cam_02"]);
    }
}
