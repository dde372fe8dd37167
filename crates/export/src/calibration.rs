//! A camera in the words of other programs: K, distortion, and poses in OpenCV's axes (x right, y down, z forward).

use crate::ExportError;
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_math::{DMat3, DVec3};
pub(crate) use enfilade_scene::OPENCV;
use enfilade_scene::{Intrinsics, Pose, Projection};

/// The distortion of straight lines.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Distortion {
    None,
    /// OpenCV's `k1 k2 p1 p2 k3 k4 k5 k6`.
    RadialTangential([f64; 8]),
    /// OpenCV's fisheye, `k1 k2 k3 k4`.
    Fisheye([f64; 4]),
}

/// A camera that K describes before distortion.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Calibration {
    /// Image coordinates from the upper left corner of the image: pixel centres are at half-integers.
    pub intrinsics: Intrinsics,
    pub distortion: Distortion,
    /// From the camera's space to the space of `intrinsics`; a tilted image plane is a turned camera with a straight one.
    turn: DMat3,
}

impl Calibration {
    /// Calibration of a track's camera; `None` for panoramas and grids of rays, which have no K.
    pub fn of(track: &Track) -> Option<Self> {
        let (intrinsics, distortion, turn) = match &track.camera.projection {
            Projection::Pinhole(k) => (*k, Distortion::None, DMat3::IDENTITY),
            Projection::TiltedPinhole(tilted) => {
                let (k, turn) = tilted.straightened();
                (k, Distortion::None, turn)
            }
            Projection::RadialTangential(k, d) => (*k, Distortion::RadialTangential(d.coefficients()), DMat3::IDENTITY),
            Projection::Fisheye(k, d) => (*k, Distortion::Fisheye(d.coefficients()), DMat3::IDENTITY),
            Projection::Equirectangular { .. } | Projection::RayGrid(_) => return None,
        };
        Some(Self { intrinsics, distortion, turn })
    }

    /// Calibration of a track whose camera must be a pinhole.
    pub fn of_pinhole(selected: &SelectedFrames<'_>, track: &Track) -> Result<Self, ExportError> {
        let found = Self::of(track).filter(|c| c.distortion == Distortion::None);
        found.ok_or_else(|| selected.unsuitable(track.folder(), "its camera is no pinhole, and the format has no distortion; leave it out"))
    }

    /// Calibration of a track whose camera must be a pinhole of rectangular pixels.
    pub fn of_upright_pinhole(selected: &SelectedFrames<'_>, track: &Track) -> Result<Self, ExportError> {
        let found = Self::of_pinhole(selected, track)?;
        if found.intrinsics.skew != 0.0 {
            return Err(selected.unsuitable(track.folder(), "its pixels are skewed, which the format cannot say; leave it out"));
        }
        Ok(found)
    }

    /// Rotation from OpenCV's camera axes to the world.
    pub fn world_from_opencv(&self, view: View<'_>) -> DMat3 {
        view.pose().world_from_camera * self.turn.transpose() * OPENCV
    }

    /// Rotation from the axes of this calibration to those of the camera's body, both OpenCV's; a turn where the image plane is tilted.
    pub fn body_from_opencv(&self) -> DMat3 {
        OPENCV * self.turn.transpose() * OPENCV
    }

    /// Rotation and translation from the world to OpenCV's camera axes, metres.
    pub fn opencv_from_world(&self, view: View<'_>) -> (DMat3, DVec3) {
        let rotation = self.world_from_opencv(view).transpose();
        (rotation, -(rotation * view.pose().position))
    }

    /// Camera to world with OpenGL's axes (x right, y up, z backward), as rows of a 4 × 4 matrix, metres.
    pub fn opengl_pose(&self, view: View<'_>) -> [[f64; 4]; 4] {
        rows_of(view.pose().world_from_camera * self.turn.transpose(), view.pose().position)
    }

    /// Camera to world with OpenCV's axes, as rows of a 4 × 4 matrix, metres.
    pub fn opencv_pose(&self, view: View<'_>) -> [[f64; 4]; 4] {
        rows_of(self.world_from_opencv(view), view.pose().position)
    }

    /// [`Calibration::opencv_pose`] of a camera without K.
    pub fn opencv_pose_of(pose: &Pose) -> [[f64; 4]; 4] {
        rows_of(pose.world_from_camera * OPENCV, pose.position)
    }

    /// Component along the viewing axis of K of a unit of distance along `ray`, which is in the camera's space.
    pub fn forward(&self, ray: DVec3) -> f64 {
        -(self.turn * ray.normalize()).z
    }

    /// True when the viewing axis of K is the camera's own.
    pub fn is_straight(&self) -> bool {
        self.turn == DMat3::IDENTITY
    }
}

/// Rows of the matrix that turns and then moves. Adding zero turns −0 into 0.
fn rows_of(rotation: DMat3, position: DVec3) -> [[f64; 4]; 4] {
    let row = |i: usize| [rotation.x_axis[i] + 0.0, rotation.y_axis[i] + 0.0, rotation.z_axis[i] + 0.0, position[i] + 0.0];
    [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]
}

/// The elements of a matrix row by row, without −0.
pub(crate) fn row_major(m: DMat3) -> [f64; 9] {
    m.transpose().to_cols_array().map(|v| v + 0.0)
}
