//! A camera as it is written in JSON: in `camera.json` and in the commit records of frames.

use enfilade_math::DMat3;
use enfilade_scene::{Camera, CameraError, Fisheye, Intrinsics, Projection, RadialTangential, RayGrid, Shutter, ThinLens, TiltedPinhole};
use serde::{Deserialize, Serialize};

/// A [`Camera`] in words and numbers. A grid of rays is named by its checksum; the rays are in a file of their own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CameraRecord {
    /// The projection: the direction of each image point.
    pub projection: ProjectionRecord,
    /// Absent: everything is in focus.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lens: Option<ThinLens>,
    /// Absent: the camera is at rest for each frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shutter: Option<Shutter>,
}

/// A [`Projection`]; `model` names which.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "model", rename_all = "snake_case")]
#[allow(missing_docs, reason = "Projection describes each one")]
pub enum ProjectionRecord {
    Pinhole { calibration: Intrinsics },
    TiltedPinhole { width: u32, height: u32, cam_from_uv: [[f64; 3]; 3] },
    RadialTangential { calibration: Intrinsics, distortion: RadialTangential },
    Fisheye { calibration: Intrinsics, distortion: Fisheye },
    Equirectangular { width: u32, height: u32 },
    RayGrid { width: u32, height: u32, rows: usize, columns: usize, blake3: String },
}

impl From<&Camera> for CameraRecord {
    fn from(camera: &Camera) -> Self {
        let [width, height] = camera.size();
        let projection = match &camera.projection {
            Projection::Pinhole(calibration) => ProjectionRecord::Pinhole { calibration: *calibration },
            Projection::TiltedPinhole(tilted) => {
                ProjectionRecord::TiltedPinhole { width, height, cam_from_uv: tilted.cam_from_uv().transpose().to_cols_array_2d() }
            }
            Projection::RadialTangential(calibration, distortion) => {
                ProjectionRecord::RadialTangential { calibration: *calibration, distortion: *distortion }
            }
            Projection::Fisheye(calibration, distortion) => {
                ProjectionRecord::Fisheye { calibration: *calibration, distortion: *distortion }
            }
            Projection::Equirectangular { .. } => ProjectionRecord::Equirectangular { width, height },
            Projection::RayGrid(grid) => {
                let [rows, columns] = grid.shape();
                ProjectionRecord::RayGrid { width, height, rows, columns, blake3: grid_checksum(grid) }
            }
        };
        Self { projection, lens: camera.lens, shutter: camera.shutter }
    }
}

impl CameraRecord {
    /// The camera. `grid` finds the rays of a grid over an image of this size; its checksum is the caller's to compare.
    ///
    /// # Errors
    /// Those of `grid`, and `wrong` of what is no camera.
    pub(crate) fn to_camera<E>(
        &self,
        grid: impl FnOnce([u32; 2]) -> Result<RayGrid, E>,
        wrong: impl Fn(CameraError) -> E,
    ) -> Result<Camera, E> {
        let projection = match &self.projection {
            ProjectionRecord::Pinhole { calibration } => Projection::Pinhole(*calibration),
            ProjectionRecord::TiltedPinhole { width, height, cam_from_uv } => {
                let matrix = DMat3::from_cols_array_2d(cam_from_uv).transpose();
                Projection::TiltedPinhole(TiltedPinhole::new(*width, *height, matrix).map_err(&wrong)?)
            }
            ProjectionRecord::RadialTangential { calibration, distortion } => Projection::RadialTangential(*calibration, *distortion),
            ProjectionRecord::Fisheye { calibration, distortion } => Projection::Fisheye(*calibration, *distortion),
            ProjectionRecord::Equirectangular { width, height } => Projection::Equirectangular { width: *width, height: *height },
            ProjectionRecord::RayGrid { width, height, .. } => Projection::RayGrid(grid([*width, *height])?),
        };
        let camera = Camera { projection, lens: self.lens, shutter: self.shutter };
        camera.validate().map_err(wrong)?;
        Ok(camera)
    }
}

/// BLAKE3 of a grid's rays, as little-endian doubles with z = −1.
pub(crate) fn grid_checksum(grid: &RayGrid) -> String {
    let mut hasher = blake3::Hasher::new();
    for value in grid.rays().flat_map(|ray| ray.to_array()) {
        hasher.update(&value.to_le_bytes());
    }
    hasher.finalize().to_hex().to_string()
}
