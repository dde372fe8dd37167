//! The views of a trajectory.

use enfilade_scene::{Camera, CameraView, Trajectory};

/// The views of a camera from every pose of a trajectory.
pub(crate) fn views<'a>(camera: &'a Camera, trajectory: &'a Trajectory) -> Vec<CameraView<'a>> {
    (0..trajectory.poses.len()).map(|index| CameraView::of_frame(camera, &trajectory.poses, index)).collect()
}
