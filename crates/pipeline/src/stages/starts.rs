//! Starts of trajectories: chosen cameras, the file's cameras, or found places, with the free space around them.

use super::Job;
use crate::config::CameraChoice;
use crate::error::Error;
use crate::report::StageCx;
use crate::world::World;
use enfilade_dataset::counted_as;
use enfilade_explore::{CarveConfig, ExploreError, FreeSpace, Mode, Preset, StartsConfig};
use enfilade_math::DVec3;
use enfilade_options::closest;
use enfilade_scene::{Cx, Pose, Quiet, Scene, StartCamera, Warning};

/// The cameras where trajectories begin, and the space around them. The file's own cameras are replaced by found places if none of them is
/// in a building or all are in walls, unless they were chosen by name.
pub(super) fn carved(job: &Job, world: &World, seed: u64, cx: &StageCx) -> Result<(Vec<StartCamera>, FreeSpace), Error> {
    let config = CarveConfig { seed, ..job.scene.carve.clone() };
    let carve = |starts: &[StartCamera]| {
        let positions: Vec<DVec3> = starts.iter().map(|s| s.position).collect();
        enfilade_explore::carve(&world.mesh, &world.bvh, &positions, &config, cx)
    };
    let scene = job.load_scene()?;
    let starts = if !job.scene.cameras.is_empty() {
        let choices = job.scene.cameras.iter().enumerate();
        choices.map(|(i, choice)| chosen(&scene, i, choice, job.scene.size)).collect::<Result<_, _>>()?
    } else if job.scene.finds_cameras || scene.cameras.is_empty() {
        found(job, world, cx)?
    } else {
        let starts = indoors(job, &scene, world, cx)?;
        match carve(&starts) {
            Err(ExploreError::StartInWall { .. }) if scene.cameras.contains(&starts[0]) => {
                let instead = found(job, world, cx)?;
                warn_of_replacement(&scene, "every camera of the file is inside a wall or an object", &instead, cx);
                instead
            }
            space => return Ok((starts, space.map_err(Error::stage)?)),
        }
    };
    match carve(&starts) {
        // What films as it is may be in things: a camera on a hand, or in a cupboard.
        Err(ExploreError::StartInWall { .. }) if matches!(job.scene.plan.mode, Mode::Cameras(_)) && !job.scene.finds_cameras => {
            let instead = found(job, world, cx)?;
            Ok((instead.clone(), carve(&instead).map_err(Error::stage)?))
        }
        space => Ok((starts, space.map_err(Error::stage)?)),
    }
}

/// Start cameras of the file that are in a building; if there are none, found places, and without any of these the cameras after all: the
/// scene is an open place. Hypersim's program takes all.
fn indoors(job: &Job, scene: &Scene, world: &World, cx: &StageCx) -> Result<Vec<StartCamera>, Error> {
    let is_inside = |camera: &StartCamera| !camera.position.is_finite() || enfilade_explore::is_indoors(&world.bvh, camera.position);
    let (inside, outside): (Vec<StartCamera>, Vec<StartCamera>) = scene.cameras.iter().cloned().partition(is_inside);
    if outside.is_empty() || job.scene.carve.preset == Preset::Hypersim {
        return Ok(scene.cameras.clone());
    }
    if !inside.is_empty() {
        for camera in outside {
            let message = format!("is outside and was left out; to begin there, select it: cameras = [{:?}]", camera.name);
            cx.warn(Warning { place: format!("camera {:?}", camera.name), message });
        }
        return Ok(inside);
    }
    let places = enfilade_explore::find_starts(&world.mesh, &world.bvh, &starts_config(job), &Quiet);
    if places.is_empty() {
        return Ok(outside);
    }
    warn_of_replacement(scene, "no camera of the file is in a building", &places, cx);
    Ok(places)
}

/// Warns that found places replace the file's cameras, and why.
fn warn_of_replacement(scene: &Scene, wrong: &str, places: &[StartCamera], cx: &StageCx) {
    let message = format!(
        "{wrong}; trajectories begin at {} instead. To begin at one of the file's, choose it: cameras = [{:?}]",
        counted_as(places.len(), "place that was found", "places that were found"),
        scene.cameras[0].name
    );
    cx.warn(Warning { place: "start cameras".into(), message });
}

fn starts_config(job: &Job) -> StartsConfig {
    StartsConfig { max_spread_m: job.scene.carve.extent_m, ..StartsConfig::default() }
}

/// Found places for cameras; there is at least one.
fn found(job: &Job, world: &World, cx: &StageCx) -> Result<Vec<StartCamera>, Error> {
    let found = enfilade_explore::find_starts(&world.mesh, &world.bvh, &starts_config(job), cx);
    if found.is_empty() {
        let message = "no place for a camera was found in the scene";
        return Err(Error::scene(message, "say where to begin: cameras = [{ position = [x, y, z], look_at = [x, y, z] }] (metres, z up)"));
    }
    Ok(found)
}

/// The camera that the configuration chooses as its number `index`.
///
/// # Errors
/// When the scene has no camera of the name, or the view has no direction.
pub(super) fn chosen(scene: &Scene, index: usize, choice: &CameraChoice, size: [u32; 2]) -> Result<StartCamera, Error> {
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
                Error::scene(message, "the two points must differ, and one must not be straight above the other")
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
