//! The calibration of a pinhole: K in Hypersim's convention, where image coordinates count from the image's corner, and in OpenCV's.

use enfilade_math::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// A pinhole camera's image size and calibration, in pixels.
///
/// Image coordinates have x to the right and y downward, and (0,0) is the upper left *corner* of the image, so that the
/// centre of the upper left pixel is (0.5, 0.5). OpenCV's matrices put (0,0) at that centre: [`Intrinsics::opencv_k`].
///
/// ```
/// use enfilade_math::DVec3;
/// use enfilade_scene::Intrinsics;
///
/// // 640 pixels across 90 degrees: the focal length is half the width.
/// let k = Intrinsics::from_fov_x(640, 480, 90f64.to_radians());
/// assert!((k.fx - 320.0).abs() < 1e-9);
///
/// // The middle of the image looks ahead, and a point up and to the right of the axis is up and to the right in the image.
/// assert_eq!(k.ray(320.0, 240.0), DVec3::NEG_Z);
/// let (x, y) = k.project(DVec3::new(1.0, 0.5, -2.0));
/// assert!((x - 480.0).abs() < 1e-9 && (y - 160.0).abs() < 1e-9);
/// assert_eq!(k.opencv_k()[0][2], 319.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Intrinsics {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Focal length along x.
    pub fx: f64,
    /// Focal length along y.
    pub fy: f64,
    /// Principal point.
    pub cx: f64,
    /// Principal point.
    pub cy: f64,
    /// The second entry of K's first row: how far x moves per focal length of y. Zero where rows and columns are at right angles.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub skew: f64,
}

fn is_zero(v: &f64) -> bool {
    *v == 0.0
}

impl Intrinsics {
    /// Square pixels, centred principal point, horizontal field of view `fov_x_rad`.
    pub fn from_fov_x(width: u32, height: u32, fov_x_rad: f64) -> Self {
        let f = 0.5 * f64::from(width) / (0.5 * fov_x_rad).tan();
        Self { width, height, fx: f, fy: f, cx: 0.5 * f64::from(width), cy: 0.5 * f64::from(height), skew: 0.0 }
    }

    /// Horizontal field of view of a centred camera of this focal length.
    pub fn fov_x_rad(&self) -> f64 {
        2.0 * (0.5 * f64::from(self.width) / self.fx).atan()
    }

    /// Direction through the image point (x, y), in camera space (x right, y up, z backward), with z = −1.
    #[inline]
    pub fn ray(&self, x: f64, y: f64) -> DVec3 {
        let up = (self.cy - y) / self.fy;
        DVec3::new((x - self.cx + self.skew * up) / self.fx, up, -1.0)
    }

    /// Image point of a camera-space point in front of the camera.
    #[inline]
    pub fn project(&self, p_camera: DVec3) -> (f64, f64) {
        let depth = -p_camera.z;
        let sheared = self.skew * p_camera.y / depth;
        (self.cx + self.fx * p_camera.x / depth - sheared, self.cy - self.fy * p_camera.y / depth)
    }

    /// The 3×3 matrix K of OpenCV's conventions (x right, y down, z forward; pixel centres at whole numbers), row by row.
    pub fn opencv_k(&self) -> [[f64; 3]; 3] {
        [[self.fx, self.skew, self.cx - 0.5], [0.0, self.fy, self.cy - 0.5], [0.0, 0.0, 1.0]]
    }

    /// Hypersim's `M_cam_from_uv`: takes (u, v, 1) to a camera-space direction, where u runs from −1 at the left border of the
    /// image to +1 at the right and v from −1 at the bottom to +1 at the top.
    pub fn cam_from_uv(&self) -> DMat3 {
        let (w, h) = (0.5 * f64::from(self.width), 0.5 * f64::from(self.height));
        DMat3::from_cols(
            DVec3::new(w / self.fx, 0.0, 0.0),
            DVec3::new(self.skew * h / (self.fx * self.fy), h / self.fy, 0.0),
            self.ray(w, h),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn projection_inverts_rays_and_the_matrices_agree() {
        for skew in [0.0, 12.0] {
            let k = Intrinsics { width: 640, height: 480, fx: 500.0, fy: 510.0, cx: 300.0, cy: 260.0, skew };
            let (x, y) = (123.5, 400.25);
            let (px, py) = k.project(k.ray(x, y) * 3.0);
            assert!((px - x).abs() < 1e-9 && (py - y).abs() < 1e-9);
            let uv1 = DVec3::new(2.0 * x / 640.0 - 1.0, 1.0 - 2.0 * y / 480.0, 1.0);
            assert!((k.cam_from_uv() * uv1 - k.ray(x, y)).length() < 1e-12);
            let p = k.ray(x, y) * DVec3::new(1.0, -1.0, -1.0);
            let [row_x, row_y, _] = k.opencv_k().map(|row| DVec3::from(row).dot(p));
            assert!((row_x + 0.5 - x).abs() < 1e-9 && (row_y + 0.5 - y).abs() < 1e-9);
        }
        assert!((Intrinsics::from_fov_x(64, 48, 1.0).fov_x_rad() - 1.0).abs() < 1e-12);
    }
}
