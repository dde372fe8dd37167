//! `carve`: the scene to its free space, beginning at the cameras where trajectories will begin.

use super::{Inputs, Job, Outcome, Record, Stage};
use crate::config::{CameraChoice, closest};
use crate::error::Error;
use crate::report::StageCx;
use crate::workdir::{Hash, read_json};
use enfilade_dataset::{counted, write_json};
use enfilade_explore::{CarveConfig, FreeSpace, StartReport, StartsConfig};
use enfilade_math::DVec3;
use enfilade_scene::{Pose, Scene, StartCamera};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The cameras where trajectories begin, in the work folder.
pub(super) const STARTS: &str = "starts.json";

/// One of them.
#[derive(Serialize, Deserialize)]
struct Start {
    #[serde(flatten)]
    camera: StartCamera,
    /// True where it was skipped, because it stands in a wall or outside.
    #[serde(default)]
    is_skipped: bool,
}

/// All of them; there is at least one.
pub(super) fn starts(job: &Job) -> Result<Vec<StartCamera>, Error> {
    Ok(read_starts(job)?.into_iter().map(|start| start.camera).collect())
}

/// Those that stand on the right side of things: carving began there.
pub(super) fn standing(job: &Job) -> Result<Vec<StartCamera>, Error> {
    Ok(read_starts(job)?.into_iter().filter(|start| !start.is_skipped).map(|start| start.camera).collect())
}

fn read_starts(job: &Job) -> Result<Vec<Start>, Error> {
    let path = job.work_file(STARTS)?;
    let unreadable = || Error::scene(format!("{}: the list of start cameras cannot be read", path.display()), job.again(Stage::Carve));
    read_json(&path).filter(|starts: &Vec<Start>| !starts.is_empty()).ok_or_else(unreadable)
}

pub(super) fn settings(job: &Job) -> Hash {
    Hash::of(&(&job.scene.carve, &job.scene.cameras, exploring_seed(job)))
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    Ok(Some(vec![job.input_from(Stage::Import, &job.package()?)?]))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let name = &job.scene.name;
    let world = job.load_world()?;
    let starts = start_cameras(job, cx)?;
    let positions: Vec<DVec3> = starts.iter().map(|s| s.position).collect();
    let config = CarveConfig { seed: exploring_seed(job), ..job.scene.carve.clone() };
    let space = enfilade_explore::carve(&world.mesh, &world.bvh, &positions, &config, cx).map_err(Error::stage)?;
    job.dataset.write_free_space(name, &space.tree.to_bt(), space.free_min, space.free_max).map_err(Error::stage)?;
    let summary = summary(&space, starts.len());
    let start = |(camera, report): (StartCamera, &StartReport)| Start { camera, is_skipped: report.used.is_none() };
    let starts: Vec<Start> = starts.into_iter().zip(&space.report.starts).map(start).collect();
    write_json(&job.work_file(STARTS)?, &starts)?;
    let report = serde_json::to_value(&space.report).unwrap_or_default();
    Ok(Outcome { summary, outputs: outputs(job)?, report, ..Outcome::default() })
}

fn summary(space: &FreeSpace, cameras: usize) -> String {
    let (size, report) = (space.free_max - space.free_min, &space.report);
    let seen = format!(
        "{:.0} m3 of free space within {:.1} x {:.1} x {:.1} m, seen from {}",
        report.free_volume_m3,
        size.x,
        size.y,
        size.z,
        counted(cameras, "camera")
    );
    let leaks = match report.leaks.first() {
        Some(leak) => format!("{}, the largest {:.1} m2 at {:.1}", counted(report.leaks.len(), "leak"), leak.area_m2, leak.position),
        None => "no leaks".into(),
    };
    format!("{seen}; {:.0} % of the domain unknown; {leaks}", 100.0 * report.unknown_share)
}

fn exploring_seed(job: &Job) -> u64 {
    job.scene.exploring_seed("carve", job.scene.carve.preset)
}

/// Every file that carving writes.
pub(super) fn outputs(job: &Job) -> Result<Vec<PathBuf>, Error> {
    let (layout, name) = (job.dataset.layout(), &job.scene.name);
    let octomap = [layout.octomap(name), layout.octomap_free_space_min(name), layout.octomap_free_space_max(name)];
    Ok(octomap.into_iter().chain([job.work_file(STARTS)?]).collect())
}

/// The chosen cameras; without a choice the file's, and for a file without any, found ones.
fn start_cameras(job: &Job, cx: &StageCx) -> Result<Vec<StartCamera>, Error> {
    let scene = job.load_scene()?;
    if !job.scene.cameras.is_empty() {
        return job.scene.cameras.iter().enumerate().map(|(i, choice)| chosen(&scene, i, choice, job.scene.size)).collect();
    }
    if !scene.cameras.is_empty() {
        return Ok(scene.cameras.clone());
    }
    let world = job.load_world()?;
    let config = StartsConfig { max_spread_m: job.scene.carve.extent_m, ..StartsConfig::default() };
    let found = enfilade_explore::find_starts(&world.mesh, &world.bvh, &config, cx);
    if found.is_empty() {
        let message = "the scene has no camera, and no place was found where one could stand";
        return Err(Error::scene(message, "say where to begin: cameras = [{ position = [x, y, z], look_at = [x, y, z] }] (metres, z up)"));
    }
    Ok(found)
}

fn chosen(scene: &Scene, index: usize, choice: &CameraChoice, size: [u32; 2]) -> Result<StartCamera, Error> {
    match choice {
        CameraChoice::Named(name) => scene.cameras.iter().find(|c| &c.name == name).cloned().ok_or_else(|| {
            let names: Vec<&str> = scene.cameras.iter().map(|c| c.name.as_str()).collect();
            let proposal = closest(name, &names).map_or(String::new(), |n| format!("did you mean {n:?}? "));
            Error::scene(format!("the scene has no camera {name:?}"), format!("{proposal}its cameras: {names:?}"))
        }),
        CameraChoice::Placed { position, look_at } => {
            let (position, look_at) = (DVec3::from(*position), DVec3::from(*look_at));
            let pose = Pose::look_at(0, position, look_at, DVec3::Z).filter(|p| p.world_from_camera.is_finite() && position.is_finite());
            let pose = pose.ok_or_else(|| {
                let message = format!("camera {index}: it cannot look from {position} to {look_at}");
                Error::scene(message, "the two points must differ, and not lie one above the other")
            })?;
            Ok(StartCamera {
                name: format!("camera {index}"),
                position,
                world_from_camera: pose.world_from_camera,
                fov_x_rad: DEFAULT_FOV_X_RAD,
                aspect: f64::from(size[0]) / f64::from(size[1]),
            })
        }
    }
}

/// Hypersim's: 60 degrees.
const DEFAULT_FOV_X_RAD: f64 = std::f64::consts::FRAC_PI_3;
