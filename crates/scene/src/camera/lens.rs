//! The aperture of a thin lens, which blurs what is out of focus, and the shutter, which blurs what moves.

use super::CameraError;
use enfilade_math::{DVec2, DVec3, warp};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A thin lens: what is not at the distance of focus is blurred, and every layer but colour is not.
///
/// Rays start on a disk across the viewing axis and meet where the ray through the lens's centre meets the plane of focus. Cameras
/// that see to the side or behind (fisheye, panorama) have no such plane: each of their rays is in focus at the distance of focus
/// along it, and the disk lies across the ray.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThinLens {
    /// Radius of the aperture, metres: focal length over twice the f-number.
    pub aperture_radius_m: f64,
    /// Distance of the plane of focus from the camera centre along the viewing axis, metres.
    pub focus_distance_m: f64,
    /// Straight edges of the aperture, the first corner up; 0 for a circle. The corners lie at the radius.
    #[serde(default)]
    pub blades: u32,
    /// Turns the plane of focus about the camera's x and y axis, radians: a tilted lens (Scheimpflug). Only where there is a plane.
    #[serde(default)]
    pub focus_tilt_rad: [f64; 2],
}

impl ThinLens {
    pub(super) fn validate(&self, has_plane: bool) -> Result<(), CameraError> {
        let length = |v: f64| v.is_finite() && v > 0.0;
        let number = |field, v: f64, expected| Err(CameraError::new(field, v.to_string(), expected));
        if !length(self.aperture_radius_m) {
            return number("aperture_radius_m", self.aperture_radius_m, "a length above 0");
        }
        if !length(self.focus_distance_m) {
            return number("focus_distance_m", self.focus_distance_m, "a length above 0");
        }
        if matches!(self.blades, 1 | 2) {
            return number("blades", f64::from(self.blades), "0 for a circle, or 3 or more");
        }
        let tilted = self.focus_tilt_rad != [0.0; 2];
        let right_angle = 0.5 * std::f64::consts::PI;
        if !self.focus_tilt_rad.iter().all(|t| t.abs() < right_angle) || (tilted && !has_plane) {
            let expected = "two angles below 90 degrees, and 0 for fisheye and panorama";
            return Err(CameraError::new("focus_tilt_rad", format!("{:?}", self.focus_tilt_rad), expected));
        }
        Ok(())
    }

    /// A point of the aperture, metres, uniform for `u` uniform on [0,1)².
    #[inline]
    pub(super) fn point(&self, u: [f32; 2]) -> DVec2 {
        if self.blades == 0 {
            return self.aperture_radius_m * warp::disk(u).as_dvec2();
        }
        let blades = f64::from(self.blades);
        let at = f64::from(u[0]) * blades;
        let corner = |i: f64| DVec2::from_angle(TAU * (0.25 + i / blades));
        let within = warp::triangle([(at - at.floor()) as f32, u[1]]).as_dvec2();
        self.aperture_radius_m * (corner(at.floor()) * within.x + corner(at.floor() + 1.0) * within.y)
    }

    /// The direction of the ray from the point `p` of the aperture that meets the ray `direction` through the lens's centre where that
    /// one is in focus.
    #[inline]
    pub(super) fn refract(&self, direction: DVec3, p: DVec3, has_plane: bool) -> DVec3 {
        if !has_plane {
            return direction - p / self.focus_distance_m;
        }
        // With normal n the plane is met at t = −F n.z / n·d, and (t d − p) / t has no pole where the two are parallel.
        let [about_x, about_y] = self.focus_tilt_rad;
        let n = DVec3::new(about_y.tan(), -about_x.tan() / about_y.cos(), 1.0);
        direction + p * (n.dot(direction) / (n.z * self.focus_distance_m))
    }
}

/// When the picture is exposed. A frame's pose is the camera's in the middle of the exposure of the image's middle row.
///
/// Between two frames of a trajectory the camera moves straight and turns evenly about a fixed axis; before the first and after the
/// last it continues as it did.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shutter {
    /// How long each row is exposed, seconds; 0 freezes all motion within a row.
    pub exposure_s: f64,
    /// How much later the lower border of the image is exposed than the upper one, seconds: rolling shutter. 0 for a global one.
    #[serde(default)]
    pub readout_s: f64,
    /// Time between frames of consecutive numbers, seconds.
    #[serde(default = "one_second")]
    pub frame_time_s: f64,
}

fn one_second() -> f64 {
    1.0
}

impl Shutter {
    pub(super) fn validate(&self) -> Result<(), CameraError> {
        let number = |field, v: f64, expected| Err(CameraError::new(field, v.to_string(), expected));
        if !(self.frame_time_s.is_finite() && self.frame_time_s > 0.0) {
            return number("frame_time_s", self.frame_time_s, "a time above 0");
        }
        for (field, v) in [("exposure_s", self.exposure_s), ("readout_s", self.readout_s)] {
            if !(0.0..=self.frame_time_s).contains(&v) {
                return number(field, v, "a time from 0 to frame_time_s");
            }
        }
        Ok(())
    }

    /// Middle of the exposure of the image's row at `y` of `height`, seconds after the frame's own time.
    #[inline]
    pub fn row_time_s(&self, y: f64, height: f64) -> f64 {
        self.readout_s * (y / height - 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENS: ThinLens = ThinLens { aperture_radius_m: 0.02, focus_distance_m: 2.0, blades: 0, focus_tilt_rad: [0.0; 2] };

    #[test]
    fn rays_of_one_image_point_meet_in_the_plane_of_focus() {
        let direction = DVec3::new(0.3, -0.2, -1.0);
        for p in [DVec3::new(0.01, 0.02, 0.0), DVec3::new(-0.02, 0.0, 0.0)] {
            let met = p + LENS.refract(direction, p, true) * 2.0;
            assert!((met - direction * 2.0).length() < 1e-15);
            let met = p + LENS.refract(direction, p, false) * 2.0;
            assert!((met - direction * 2.0).length() < 1e-15);
        }
    }

    #[test]
    fn a_tilted_plane_of_focus_is_where_rays_meet() {
        let lens = ThinLens { focus_tilt_rad: [0.3, -0.5], ..LENS };
        let turn = enfilade_math::DMat3::from_rotation_y(-0.5) * enfilade_math::DMat3::from_rotation_x(0.3);
        let (n, middle) = (turn * DVec3::Z, DVec3::new(0.0, 0.0, -2.0));
        let (direction, p) = (DVec3::new(0.3, -0.2, -1.0), DVec3::new(0.01, 0.02, 0.0));
        let t = middle.dot(n) / direction.dot(n);
        let off = direction * t - p;
        assert!(lens.refract(direction, p, true).cross(off).length() < 1e-12, "the ray from p meets the plane where the centre's does");
    }

    #[test]
    fn the_aperture_has_its_shape_and_its_middle() {
        for (blades, area) in [(0, TAU / 2.0), (6, 3.0 * (TAU / 6.0).sin()), (3, 1.5 * (TAU / 3.0).sin())] {
            let lens = ThinLens { aperture_radius_m: 1.0, blades, ..LENS };
            let points: Vec<DVec2> = (0..16_384).map(|i| lens.point(warp::hammersley(i, 16_384))).collect();
            assert!(points.iter().all(|p| p.length() <= 1.0 + 1e-6));
            assert!((points.iter().sum::<DVec2>() / 16_384.0).length() < 2e-3);
            // Uniform: as many points per area near the middle as everywhere.
            let near = points.iter().filter(|p| p.length() < 0.4).count() as f64 / 16_384.0;
            assert!((near - 0.16 * TAU / 2.0 / area).abs() < 3e-3, "{blades} blades: {near}");
        }
    }

    #[test]
    fn values_out_of_range_are_named() {
        let message = |lens: ThinLens| lens.validate(false).unwrap_err().to_string();
        assert!(message(ThinLens { aperture_radius_m: 0.0, ..LENS }).contains("aperture_radius_m"));
        assert!(message(ThinLens { blades: 2, ..LENS }).contains("3 or more"));
        assert!(message(ThinLens { focus_tilt_rad: [0.1, 0.0], ..LENS }).contains("focus_tilt_rad"));
        let shutter = Shutter { exposure_s: 1.5, readout_s: 0.0, frame_time_s: 1.0 };
        assert!(shutter.validate().unwrap_err().to_string().contains("a time from 0 to frame_time_s"));
    }
}
