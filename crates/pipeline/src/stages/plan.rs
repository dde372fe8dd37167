//! `plan`: free space to one trajectory per start camera.

use super::{Input, Inputs, Job, Outcome, Record, Stage, carve};
use crate::error::Error;
use crate::report::{StageCx, count, count_of};
use crate::workdir::{Hash, read_json, remove_if_there};
use enfilade_dataset::{StereoRecord, StereoSide};
use enfilade_explore::{CarveReport, FreeSpace, PlanConfig};
use enfilade_geometry::OccupancyTree;
use enfilade_post::planview::remove_plan_preview;
use enfilade_scene::{Camera, Cx, StartCamera, Trajectory, Warning};
use std::path::{Path, PathBuf};

/// The four arrays of a trajectory.
const KEYFRAMES: [&str; 4] = ["frame_indices", "positions", "look_at_positions", "orientations"];

/// Trajectories of cameras that see to the side and behind are planned by what is within this angle before them.
const WIDEST_VIEW_RAD: f64 = 2.1;

pub(super) fn settings(job: &Job) -> Hash {
    let scene = job.scene;
    Hash::of(&(&scene.plan, scene.size, scene.fov_x_deg, &scene.camera, scene.seed_for("plan")))
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    let mut inputs = vec![job.input_from(Stage::Import, &job.package()?)?];
    for path in carve::outputs(job)? {
        inputs.push(job.input_from(Stage::Carve, &path)?);
    }
    if let Some(grid) = &job.scene.camera.ray_grid {
        inputs.push(Input::of(&job.config.path(grid)?)?);
    }
    Ok(Some(inputs))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let name = &job.scene.name;
    let starts: Vec<StartCamera> = read_json(&job.work_file(carve::STARTS)?)
        .filter(|starts: &Vec<StartCamera>| !starts.is_empty())
        .ok_or_else(|| Error::scene("the list of start cameras cannot be read", "make it again: enfilade carve --force"))?;
    let fov_x_rad = job.scene.fov_x_deg.map_or(starts[0].fov_x_rad, f64::to_radians);
    let camera = job.scene.camera.camera(job.scene.size, fov_x_rad, |path| job.config.path(path))?;
    let fov_x_rad = camera.projection.fov_x_rad(std::f64::consts::TAU);
    let planned = plan_all(job, &starts, &camera, cx)?;
    let filmed: Vec<(Trajectory, Option<StereoRecord>)> = match job.scene.camera.stereo {
        None => planned.into_iter().map(|trajectory| (trajectory, None)).collect(),
        Some(stereo) => planned.into_iter().enumerate().flat_map(|(i, left)| rig(left, i, stereo.baseline_m)).collect(),
    };
    let trajectories: Vec<Trajectory> = filmed.iter().map(|(trajectory, _)| trajectory.clone()).collect();
    // Pictures of an earlier plan would be taken for pictures of this one.
    remove_plan_preview(job.dataset, name).map_err(Error::stage)?;
    remove_other_cameras(job, &trajectories)?;
    for (trajectory, stereo) in &filmed {
        job.dataset.write_trajectory(name, trajectory, &camera, stereo.as_ref()).map_err(Error::stage)?;
    }
    job.dataset.write_camera_parameters(name, &camera).map_err(Error::stage)?;
    let poses: usize = trajectories.iter().map(|t| t.poses.len()).sum();
    let summary = format!(
        "{} with {}, {:.0} degrees wide",
        count_of(trajectories.len(), "trajectory", "trajectories"),
        count(poses, "pose"),
        fov_x_rad.to_degrees()
    );
    let layout = job.dataset.layout();
    let mut outputs = outputs_of(job, &trajectories);
    outputs.push(layout.metadata_cameras(name));
    Ok(Outcome { summary, outputs, ..Outcome::default() })
}

/// One trajectory per start camera. A camera from which none can begin is left out with a warning, as long as one remains.
fn plan_all(job: &Job, starts: &[StartCamera], camera: &Camera, cx: &StageCx) -> Result<Vec<Trajectory>, Error> {
    let world = job.load_world()?;
    let (bt, _, _) = job.dataset.read_free_space(&job.scene.name).map_err(Error::stage)?;
    let tree = OccupancyTree::from_bt(&bt).map_err(Error::stage)?;
    let space = FreeSpace::new(tree, CarveReport::default()).map_err(Error::stage)?;
    let test_width = job.scene.plan.test_width;
    let [width, height] = camera.size().map(u64::from);
    let limit = if camera.projection.is_linear() { std::f64::consts::PI } else { WIDEST_VIEW_RAD };
    let config = PlanConfig {
        seed: job.scene.seed_for("plan"),
        fov_x_rad: camera.projection.fov_x_rad(limit),
        test_height: (u64::from(test_width) * height / width).max(1) as u32,
        stereo_baseline_m: job.scene.camera.stereo.map_or(0.0, |stereo| stereo.baseline_m),
        ..job.scene.plan.clone()
    };
    let mut trajectories = Vec::new();
    let mut first_error = None;
    for (index, start) in starts.iter().enumerate() {
        match enfilade_explore::plan(&world.mesh, &world.bvh, &space, start, index as u32, &config, cx) {
            Ok(trajectory) => trajectories.push(trajectory),
            Err(error) => {
                let message = format!("no trajectory begins here: {error}");
                cx.warn(Warning { place: format!("camera {:?}", start.name), message });
                first_error.get_or_insert(error);
            }
        }
    }
    match first_error {
        Some(error) if trajectories.is_empty() => Err(Error::stage(error)),
        _ => Ok(trajectories),
    }
}

/// The planned trajectory number `index` as the left camera of a rig, and the right one's: `cam_00` and `cam_01`, `cam_02` and
/// `cam_03`, …
fn rig(planned: Trajectory, index: usize, baseline_m: f64) -> [(Trajectory, Option<StereoRecord>); 2] {
    let [left, right] = [0, 1].map(|side| format!("cam_{:02}", 2 * index + side));
    let beside = planned.beside(right.clone(), baseline_m);
    [
        (Trajectory { name: left.clone(), ..planned }, Some(StereoRecord::new(StereoSide::Left, right, baseline_m))),
        (beside, Some(StereoRecord::new(StereoSide::Right, left, baseline_m))),
    ]
}

/// Every file that says where the cameras are, as inputs of later stages.
pub(super) fn outputs(job: &Job) -> Result<Vec<Input>, Error> {
    let trajectories: Vec<Trajectory> = job.filmed()?.into_iter().map(|(_, trajectory)| trajectory).collect();
    let files = outputs_of(job, &trajectories).into_iter();
    files.map(|path| job.input_from(Stage::Plan, &path)).collect()
}

fn outputs_of(job: &Job, trajectories: &[Trajectory]) -> Vec<PathBuf> {
    let (layout, name) = (job.dataset.layout(), &job.scene.name);
    let keyframes = trajectories.iter().flat_map(|t| KEYFRAMES.map(|what| layout.keyframes(name, &t.name, what)));
    let opencv = trajectories.iter().map(|t| layout.cameras_opencv(name, &t.name));
    let models = trajectories.iter().flat_map(|t| job.dataset.camera_model_files(name, &t.name));
    keyframes.chain(opencv).chain(models).collect()
}

/// Cameras of an earlier plan that are not in this one would be taken for cameras of this dataset.
fn remove_other_cameras(job: &Job, trajectories: &[Trajectory]) -> Result<(), Error> {
    let (layout, name) = (job.dataset.layout(), &job.scene.name);
    let table = layout.metadata_cameras(name);
    if !table.is_file() {
        return Ok(());
    }
    let old = job.dataset.cameras(name).map_err(Error::stage)?;
    remove_if_there(&table)?;
    for camera in old.iter().filter(|camera| trajectories.iter().all(|t| &t.name != *camera)) {
        remove_folder(&layout.camera_dir(name, camera))?;
        let images = layout.images_dir(name);
        let Ok(entries) = std::fs::read_dir(&images) else { continue };
        for entry in entries {
            let path = entry.map_err(Error::io("read", &images))?.path();
            let of_camera = path.file_name().and_then(|n| n.to_str()).is_some_and(|n| n.starts_with(&format!("scene_{camera}_")));
            match (of_camera, path.is_dir()) {
                (false, _) => {}
                (true, true) => remove_folder(&path)?,
                (true, false) => std::fs::remove_file(&path).map_err(Error::io("remove", &path))?,
            }
        }
    }
    Ok(())
}

fn remove_folder(path: &Path) -> Result<(), Error> {
    match std::fs::remove_dir_all(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(Error::io("remove", path)(e)),
        _ => Ok(()),
    }
}
