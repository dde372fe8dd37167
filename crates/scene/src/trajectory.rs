//! Poses, one per frame, and named sequences of them. Camera axes are x right, y up, z backward.

use enfilade_math::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// Pose of a camera for one frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Frame number; poses of a trajectory have ascending numbers.
    pub frame: u32,
    /// Camera centre in the world, metres.
    pub position: DVec3,
    /// A point on the viewing axis in front of the camera.
    pub look_at: DVec3,
    /// Camera to world; columns are the camera's x (right), y (up) and z (backward) axes. Orthonormal.
    pub world_from_camera: DMat3,
}

impl Pose {
    /// The moment that the frame shows of a scene that moves, seconds, where frames are `frame_time_s` apart.
    pub fn moment_s(&self, frame_time_s: f64) -> f64 {
        f64::from(self.frame) * frame_time_s
    }

    /// The pose that looks from `position` to `look_at` with `up` as close to the image's vertical as can be.
    ///
    /// `None` when the two points coincide or the view is along `up`.
    ///
    /// ```
    /// use enfilade_math::DVec3;
    /// use enfilade_scene::Pose;
    ///
    /// // A camera at eye height that looks along y: x to its right, y up, z backward.
    /// let eye = DVec3::new(1.0, 0.0, 1.6);
    /// let pose = Pose::look_at(0, eye, eye + DVec3::Y, DVec3::Z).unwrap();
    /// let axes = pose.world_from_camera;
    /// assert_eq!([axes.x_axis, axes.y_axis, axes.z_axis], [DVec3::X, DVec3::Z, DVec3::NEG_Y]);
    /// assert_eq!(pose.roll_rad(), 0.0);
    /// assert_eq!(Pose::look_at(0, eye, eye + DVec3::Z, DVec3::Z), None);
    /// ```
    pub fn look_at(frame: u32, position: DVec3, look_at: DVec3, up: DVec3) -> Option<Self> {
        let z = (position - look_at).try_normalize()?;
        let x = up.cross(z).try_normalize()?;
        let y = z.cross(x);
        Some(Self { frame, position, look_at, world_from_camera: DMat3::from_cols(x, y, z) })
    }

    /// How far the orientation is from a rotation: the largest entry of |R Rᵀ − 1|.
    pub fn orthonormality_error(&self) -> f64 {
        let r = self.world_from_camera;
        (r * r.transpose() - DMat3::IDENTITY).to_cols_array().iter().fold(0.0, |worst: f64, v| worst.max(v.abs()))
    }

    /// Angle between the camera's x axis and the horizon, measured about the viewing axis.
    pub fn roll_rad(&self) -> f64 {
        let (x, y) = (self.world_from_camera.x_axis, self.world_from_camera.y_axis);
        x.z.atan2(y.z)
    }
}

/// A named sequence of poses: Hypersim's `cam_XX`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trajectory {
    /// `cam_00`, `cam_01`, …
    pub name: String,
    /// In order of frame number.
    pub poses: Vec<Pose>,
}

impl Trajectory {
    /// The trajectory of a camera fixed to the right of this one's, at a distance in metres, that looks the same way.
    pub fn beside(&self, name: String, distance_m: f64) -> Self {
        let moved = |pose: &Pose| {
            let offset = distance_m * pose.world_from_camera.x_axis;
            Pose { position: pose.position + offset, look_at: pose.look_at + offset, ..*pose }
        };
        Self { name, poses: self.poses.iter().map(moved).collect() }
    }
}
