//! Cameras that come with a scene file: from where its free space is carved and where trajectories begin.

use crate::Pose;
use enfilade_math::{DAffine3, DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// A camera that came with the scene: where free-space carving and trajectories begin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StartCamera {
    /// Name from the file.
    pub name: String,
    /// World position, metres.
    pub position: DVec3,
    /// Camera to world; columns are the camera's x (right), y (up) and z (backward) axes. Orthonormal.
    pub world_from_camera: DMat3,
    /// Horizontal field of view of the file's camera.
    pub fov_x_rad: f64,
    /// Width over height of the file's camera.
    pub aspect: f64,
}

impl StartCamera {
    /// The pose of frame number `frame` at the start; it looks at the point a metre ahead.
    pub fn pose(&self, frame: u32) -> Pose {
        let look_at = self.position - self.world_from_camera.z_axis;
        Pose { frame, position: self.position, look_at, world_from_camera: self.world_from_camera }
    }

    /// The camera moved by a map of the world to itself. Its axes stay orthonormal and right-handed, whatever the map's scale.
    pub(crate) fn moved(&self, world_from_before: &DAffine3) -> Self {
        let turned = |axis: DVec3| world_from_before.transform_vector3(axis);
        let z = turned(self.world_from_camera.z_axis).normalize();
        let x = turned(self.world_from_camera.y_axis).cross(z).normalize();
        let position = world_from_before.transform_point3(self.position);
        Self { position, world_from_camera: DMat3::from_cols(x, z.cross(x), z), ..self.clone() }
    }
}
