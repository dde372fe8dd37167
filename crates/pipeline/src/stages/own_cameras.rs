//! Cameras of the scene that are filmed with as they are: those that ride on bodies go with these, frame by frame.

use super::{Job, carve, starts};
use crate::config::CameraChoice;
use crate::error::Error;
use enfilade_explore::CamerasConfig;
use enfilade_scene::{Cx, Pose, Scene, StartCamera, Warning};

/// A camera to film with.
pub(super) struct OwnCamera {
    /// The camera at rest.
    pub camera: StartCamera,
    /// Number of the camera among those of the scene; `None` of other places, which stay.
    number: Option<usize>,
}

/// The cameras that were chosen, or all of the scene; there is at least one.
pub(super) fn chosen(job: &Job) -> Result<Vec<OwnCamera>, Error> {
    if job.scene.finds_cameras {
        return Ok(carve::starts(job)?.into_iter().map(|camera| OwnCamera { camera, number: None }).collect());
    }
    let scene = job.load_scene()?;
    if job.scene.cameras.is_empty() {
        let own: Vec<OwnCamera> =
            scene.cameras.iter().cloned().enumerate().map(|(number, camera)| OwnCamera { camera, number: Some(number) }).collect();
        let remedy = "place some: cameras = [{ position = [x, y, z], look_at = [x, y, z] }] (metres, z up), or choose another mode";
        return if own.is_empty() { Err(Error::scene("mode cameras: the scene has no cameras", remedy)) } else { Ok(own) };
    }
    let one = |(index, choice): (usize, &CameraChoice)| {
        let camera = starts::chosen(&scene, index, choice, job.scene.size)?;
        let is_named = matches!(choice, CameraChoice::Named(_));
        let number = scene.cameras.iter().position(|known| is_named && known.name == camera.name);
        Ok(OwnCamera { camera, number })
    };
    job.scene.cameras.iter().enumerate().map(one).collect()
}

/// The poses of each camera: `frames` of them at `fps`, or one where nothing in the scene moves.
pub(super) fn poses(own: &[OwnCamera], scene: &Scene, cameras: &CamerasConfig, frames: u32, cx: &dyn Cx) -> Vec<Vec<Pose>> {
    let moves = scene.moving_bodies().contains(&true);
    if !moves && frames > 1 {
        let message = format!("nothing in the scene moves, so each camera takes one picture instead of {frames} that are the same");
        cx.warn(Warning { place: "mode cameras".into(), message });
    }
    let mut poses = vec![Vec::new(); own.len()];
    for frame in 0..if moves { frames } else { 1 } {
        // As frames count their moments.
        let placed = scene.cameras_at(f64::from(frame) * (1.0 / cameras.fps));
        for (poses, own) in poses.iter_mut().zip(own) {
            poses.push(own.number.map_or(&own.camera, |number| &placed[number]).pose(frame));
        }
    }
    poses
}
