//! Pinholes whose image plane is tilted (tilt-shift), as Hypersim's matrices describe them.

use super::{CameraError, Intrinsics};
use enfilade_math::{DMat3, DVec3};

/// The general pinhole: any matrix of Hypersim's form `M_cam_from_uv`, so also an image plane that is not across the viewing axis
/// (tilt-shift).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TiltedPinhole {
    width: u32,
    height: u32,
    cam_from_uv: DMat3,
    uv_from_cam: DMat3,
}

impl TiltedPinhole {
    /// `cam_from_uv` takes (u, v, 1) to a camera-space direction, u from −1 at the left border to +1 at the right, v from −1 at the
    /// bottom to +1 at the top.
    ///
    /// # Errors
    /// When the matrix has no inverse, mirrors, or does not look forward at every corner of the image.
    pub fn new(width: u32, height: u32, cam_from_uv: DMat3) -> Result<Self, CameraError> {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
        let forward = corners.iter().all(|[u, v]| (cam_from_uv * DVec3::new(*u, *v, 1.0)).z < 0.0);
        let uv_from_cam = cam_from_uv.inverse();
        // Right and up make a right-handed frame with backward; the third column looks forward.
        if !(forward && cam_from_uv.determinant() < 0.0 && uv_from_cam.is_finite()) {
            let expected = "a matrix with an inverse that looks forward (z < 0) at all corners and does not mirror";
            return Err(CameraError::new("cam_from_uv", format!("{:?}", cam_from_uv.transpose().to_cols_array_2d()), expected));
        }
        Ok(Self { width, height, cam_from_uv, uv_from_cam })
    }

    /// Pixels per row, and rows.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Hypersim's `M_cam_from_uv`.
    pub fn cam_from_uv(&self) -> DMat3 {
        self.cam_from_uv
    }

    /// Direction through the image point (x, y), with z = −1.
    pub fn ray(&self, x: f64, y: f64) -> DVec3 {
        let direction = self.cam_from_uv * DVec3::new(2.0 * x / f64::from(self.width) - 1.0, 1.0 - 2.0 * y / f64::from(self.height), 1.0);
        direction / -direction.z
    }

    /// Image point of a camera-space point; `None` when it is behind the image plane.
    pub fn project(&self, p_camera: DVec3) -> Option<(f64, f64)> {
        let uv = self.uv_from_cam * p_camera;
        let at = |v: f64, size: u32| 0.5 * f64::from(size) * (v / uv.z + 1.0);
        (uv.z > 0.0).then(|| (at(uv.x, self.width), at(-uv.y, self.height)))
    }

    /// A straight pinhole, turned, that takes the same pictures: its calibration, and the rotation from camera space to that pinhole's
    /// camera space.
    ///
    /// This is the RQ decomposition of the matrix that takes camera space to the image.
    pub fn straightened(&self) -> (Intrinsics, DMat3) {
        let (w, h) = (0.5 * f64::from(self.width), 0.5 * f64::from(self.height));
        // Rows of the matrix that takes camera space to pixels.
        let uv = self.uv_from_cam.transpose();
        let rows = [w * uv.x_axis + w * uv.z_axis, -h * uv.y_axis + h * uv.z_axis, uv.z_axis];
        let scale = rows[2].length();
        let forward = rows[2] / scale;
        let cy = rows[1].dot(forward) / scale;
        let down = rows[1] / scale - cy * forward;
        let fy = down.length();
        let down = down / fy;
        let (cx, skew) = (rows[0].dot(forward) / scale, rows[0].dot(down) / scale);
        let right = rows[0] / scale - cx * forward - skew * down;
        let fx = right.length();
        let rotation = DMat3::from_cols(right / fx, -down, -forward).transpose();
        // A skew within rounding error counts as none: formats without skew would refuse the camera.
        let skew = if skew.abs() > 1e-9 * fx { skew } else { 0.0 };
        (Intrinsics { width: self.width, height: self.height, fx, fy, cx, cy, skew }, rotation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_pinhole_is_a_special_case_and_comes_back() {
        let k = Intrinsics { width: 640, height: 480, fx: 500.0, fy: 510.0, cx: 300.0, cy: 260.0, skew: 7.0 };
        let tilted = TiltedPinhole::new(640, 480, k.cam_from_uv()).unwrap();
        assert!((tilted.ray(20.5, 300.0) - k.ray(20.5, 300.0)).length() < 1e-12);
        let (back, rotation) = tilted.straightened();
        assert!((rotation - DMat3::IDENTITY).to_cols_array().iter().all(|v| v.abs() < 1e-12));
        assert!((back.fx - 500.0).abs() < 1e-9 && (back.cy - 260.0).abs() < 1e-9 && (back.skew - 7.0).abs() < 1e-9, "{back:?}");
    }

    #[test]
    fn a_tilted_image_plane_is_a_turned_pinhole() {
        let k = Intrinsics { width: 640, height: 480, fx: 500.0, fy: 510.0, cx: 300.0, cy: 260.0, skew: 0.0 };
        let turn = DMat3::from_rotation_x(0.2) * DMat3::from_rotation_y(-0.1);
        let tilted = TiltedPinhole::new(640, 480, 3.0 * turn * k.cam_from_uv()).unwrap();
        let (straight, rotation) = tilted.straightened();
        assert!((rotation * turn - DMat3::IDENTITY).to_cols_array().iter().all(|v| v.abs() < 1e-12), "{rotation}");
        for (x, y) in [(0.0, 0.0), (123.5, 400.25), (640.0, 480.0)] {
            let ray = tilted.ray(x, y);
            assert!((rotation * ray).normalize().distance(straight.ray(x, y).normalize()) < 1e-12);
            let (px, py) = tilted.project(ray * 2.5).unwrap();
            assert!((px - x).abs() < 1e-9 && (py - y).abs() < 1e-9);
        }
        assert!(TiltedPinhole::new(640, 480, -1.0 * k.cam_from_uv()).is_err());
        assert!(TiltedPinhole::new(640, 480, DMat3::ZERO).is_err());
    }
}
