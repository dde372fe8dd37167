//! `plan`: free space to one trajectory per start camera.

use super::{Input, Inputs, Job, Outcome, Record, Stage, carve};
use crate::error::Error;
use crate::report::{StageCx, count, count_of};
use crate::workdir::{Hash, read_json, remove_if_there};
use enfilade_explore::{CarveReport, FreeSpace, PlanConfig};
use enfilade_geometry::OccupancyTree;
use enfilade_scene::{Cx, Intrinsics, StartCamera, Trajectory, Warning};
use std::path::{Path, PathBuf};

/// The four arrays of a trajectory.
const KEYFRAMES: [&str; 4] = ["frame_indices", "positions", "look_at_positions", "orientations"];

pub(super) fn settings(job: &Job) -> Hash {
    let scene = job.scene;
    Hash::of(&(&scene.plan, scene.size, scene.fov_x_deg, scene.seed_for("plan")))
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    let mut inputs = vec![job.input_from(Stage::Import, &job.package()?)?];
    for path in carve::outputs(job)? {
        inputs.push(job.input_from(Stage::Carve, &path)?);
    }
    Ok(Some(inputs))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let name = &job.scene.name;
    let starts: Vec<StartCamera> = read_json(&job.work_file(carve::STARTS)?)
        .filter(|starts: &Vec<StartCamera>| !starts.is_empty())
        .ok_or_else(|| Error::scene("the list of start cameras cannot be read", "make it again: enfilade carve --force"))?;
    let [width, height] = job.scene.size;
    let fov_x_rad = job.scene.fov_x_deg.map_or(starts[0].fov_x_rad, f64::to_radians);
    let intrinsics = Intrinsics::from_fov_x(width, height, fov_x_rad);
    let trajectories = plan_all(job, &starts, &intrinsics, cx)?;
    remove_other_cameras(job, &trajectories)?;
    for trajectory in &trajectories {
        job.dataset.write_trajectory(name, trajectory, &intrinsics).map_err(Error::stage)?;
    }
    job.dataset.write_intrinsics(name, &intrinsics).map_err(Error::stage)?;
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
fn plan_all(job: &Job, starts: &[StartCamera], intrinsics: &Intrinsics, cx: &StageCx) -> Result<Vec<Trajectory>, Error> {
    let world = job.load_world()?;
    let (bt, _, _) = job.dataset.read_free_space(&job.scene.name).map_err(Error::stage)?;
    let tree = OccupancyTree::from_bt(&bt).map_err(Error::stage)?;
    let space = FreeSpace::new(tree, CarveReport::default()).map_err(Error::stage)?;
    let test_width = job.scene.plan.test_width;
    let config = PlanConfig {
        seed: job.scene.seed_for("plan"),
        fov_x_rad: intrinsics.fov_x_rad(),
        test_height: (u64::from(test_width) * u64::from(intrinsics.height) / u64::from(intrinsics.width)).max(1) as u32,
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

/// Every file that says where the cameras are, as inputs of later stages.
pub(super) fn outputs(job: &Job) -> Result<Vec<Input>, Error> {
    let (_, trajectories) = job.trajectories()?;
    let files = outputs_of(job, &trajectories).into_iter();
    files.map(|path| job.input_from(Stage::Plan, &path)).collect()
}

fn outputs_of(job: &Job, trajectories: &[Trajectory]) -> Vec<PathBuf> {
    let (layout, name) = (job.dataset.layout(), &job.scene.name);
    let keyframes = trajectories.iter().flat_map(|t| KEYFRAMES.map(|what| layout.keyframes(name, &t.name, what)));
    let opencv = trajectories.iter().map(|t| layout.cameras_opencv(name, &t.name));
    keyframes.chain(opencv).collect()
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
