//! OpenCV's fisheye model: the distance from the principal point as an odd polynomial of the angle from the viewing axis.

use super::CameraError;
use super::roots::{first_fall, solve_rising};
use enfilade_math::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Directions beyond the image circle by no more than this share of its angle count as on it: the rounding of single precision.
const END_SLACK: f64 = 1e-6;

/// Kannala and Brandt's model as OpenCV's `fisheye` module has it: a ray at the angle θ from the viewing axis falls
/// θ·(1 + k1·θ² + k2·θ⁴ + k3·θ⁶ + k4·θ⁸) focal lengths from the principal point.
///
/// The picture ends at the angle where that radius first falls again, at the latest straight behind the camera: this is the image
/// circle. With all coefficients zero the projection is equidistant and sees everything.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "[f64; 4]", into = "[f64; 4]")]
pub struct Fisheye {
    k: [f64; 4],
    theta_max: f64,
    /// Radius of the image circle, focal lengths.
    radius_max: f64,
}

impl Fisheye {
    /// From OpenCV's vector k1, k2, k3, k4.
    ///
    /// # Errors
    /// When a number is not finite.
    pub fn new(k: [f64; 4]) -> Result<Self, CameraError> {
        if k.iter().any(|c| !c.is_finite()) {
            return Err(CameraError::new("distortion", format!("{k:?}"), "4 finite numbers: k1, k2, k3, k4"));
        }
        let mut model = Self { k, theta_max: PI, radius_max: PI };
        let angles = (1..=4096).map(|i| PI * f64::from(i) / 4096.0);
        model.theta_max = first_fall(angles, |theta| model.radius(theta).1).unwrap_or(PI);
        model.radius_max = model.radius(model.theta_max).0;
        Ok(model)
    }

    /// k1, k2, k3, k4.
    pub fn coefficients(&self) -> [f64; 4] {
        self.k
    }

    /// The unit direction (x right, y up, z backward) seen at `q`, focal lengths from the principal point, x right and y up.
    /// `None` outside of the image circle.
    pub fn direction(&self, q: DVec2) -> Option<DVec3> {
        let radius = q.length();
        if radius.is_nan() || radius > self.radius_max {
            return None;
        }
        let theta = solve_rising(radius, self.theta_max, |theta| self.radius(theta));
        let (sin, cos) = theta.sin_cos();
        let around = if radius > 0.0 { q * (sin / radius) } else { DVec2::ZERO };
        Some(around.extend(-cos))
    }

    /// The inverse of [`Fisheye::direction`], for vectors of any length. `None` for directions that are not in the picture.
    pub fn project(&self, direction: DVec3) -> Option<DVec2> {
        let off_axis = direction.truncate();
        let theta = off_axis.length().atan2(-direction.z);
        // Straight behind, all around is the same.
        let is_everywhere = off_axis == DVec2::ZERO && direction.z > 0.0;
        if theta.is_nan() || is_everywhere || theta > self.theta_max * (1.0 + END_SLACK) {
            return None;
        }
        Some(off_axis.try_normalize().map_or(DVec2::ZERO, |around| around * self.radius(theta).0))
    }

    /// Radius and its derivative by the angle.
    #[inline]
    fn radius(&self, theta: f64) -> (f64, f64) {
        let ([k1, k2, k3, k4], s) = (self.k, theta * theta);
        let value = theta * (1.0 + s * (k1 + s * (k2 + s * (k3 + s * k4))));
        (value, 1.0 + s * (3.0 * k1 + s * (5.0 * k2 + s * (7.0 * k3 + s * 9.0 * k4))))
    }
}

impl TryFrom<[f64; 4]> for Fisheye {
    type Error = CameraError;
    fn try_from(k: [f64; 4]) -> Result<Self, CameraError> {
        Self::new(k)
    }
}

impl From<Fisheye> for [f64; 4] {
    fn from(model: Fisheye) -> Self {
        model.k
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radius_is_opencvs_polynomial() {
        let k = [-0.013, 0.002, -0.0008, 0.000_05];
        let theta: f64 = 1.1;
        let expected = theta + k[0] * theta.powi(3) + k[1] * theta.powi(5) + k[2] * theta.powi(7) + k[3] * theta.powi(9);
        let found = Fisheye::new(k).unwrap().project(DVec3::new(theta.sin(), 0.0, -theta.cos())).unwrap();
        assert!((found - DVec2::new(expected, 0.0)).length() < 1e-15);
    }

    #[test]
    fn directions_come_back_from_all_around() {
        for k in [[0.0; 4], [-0.013, 0.002, -0.0008, 0.000_05]] {
            let model = Fisheye::new(k).unwrap();
            for i in 0..500 {
                let (theta, around) = (0.999 * model.theta_max * f64::from(i) / 500.0, DVec2::from_angle(f64::from(i)));
                let direction = (around * theta.sin()).extend(-theta.cos());
                let back = model.direction(model.project(direction * 3.0).unwrap()).unwrap();
                assert!((back - direction).length() < 1e-11, "{direction} became {back}");
            }
        }
    }

    #[test]
    fn beyond_the_image_circle_there_is_nothing() {
        // θ - 0.1 θ³ rises up to θ = sqrt(10/3).
        let model = Fisheye::new([-0.1, 0.0, 0.0, 0.0]).unwrap();
        let end = (10.0f64 / 3.0).sqrt();
        assert!((model.theta_max - end).abs() < 1e-9);
        assert!(model.direction(DVec2::new(0.0, end * 2.0 / 3.0 - 1e-9)).is_some());
        assert_eq!(model.direction(DVec2::new(0.0, end * 2.0 / 3.0 + 1e-6)), None);
        assert_eq!(model.project(DVec3::new(0.0, 0.1, 1.0)), None);
        assert_eq!(Fisheye::new([0.0; 4]).unwrap().project(DVec3::Z), None, "straight behind");
        assert_eq!(Fisheye::new([0.0; 4]).unwrap().direction(DVec2::new(3.2, 0.0)), None);
    }
}
