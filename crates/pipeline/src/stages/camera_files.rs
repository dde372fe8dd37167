//! The files with the cameras of a scene: `plan` writes them, and later stages have them as inputs.

use super::{Input, Job, Stage};
use crate::error::Error;
use enfilade_scene::Trajectory;
use std::path::PathBuf;

/// The four arrays of a trajectory.
const KEYFRAMES: [&str; 4] = ["frame_indices", "positions", "look_at_positions", "orientations"];

/// Camera files of the planned trajectories, as inputs.
pub(super) fn inputs(job: &Job) -> Result<Vec<Input>, Error> {
    let trajectories: Vec<Trajectory> = job.filmed()?.iter().map(|(_, trajectory)| trajectory.clone()).collect();
    files(job, &trajectories).iter().map(|path| job.input_from(Stage::Plan, path)).collect()
}

/// Camera files of `trajectories`.
pub(super) fn files(job: &Job, trajectories: &[Trajectory]) -> Vec<PathBuf> {
    let (layout, name) = (job.dataset.layout(), &job.scene.name);
    let keyframes = trajectories.iter().flat_map(|t| KEYFRAMES.map(|what| layout.keyframes(name, &t.name, what)));
    let opencv = trajectories.iter().map(|t| layout.cameras_opencv(name, &t.name));
    let models = trajectories.iter().flat_map(|t| job.dataset.camera_model_files(name, &t.name));
    keyframes.chain(opencv).chain(models).collect()
}
