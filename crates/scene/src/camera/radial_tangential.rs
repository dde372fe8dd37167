//! OpenCV's distortion of ordinary lenses, radial and tangential, and its inverse by Newton's method.

use super::CameraError;
use super::roots::{first_fall, solve_rising};
use enfilade_math::{DMat2, DVec2};
use serde::{Deserialize, Serialize};

/// Image points farther out than this, as a multiple of the focal length, are not looked for: 89.9 degrees.
const R_LIMIT: f64 = 573.0;
/// Steps of Newton's method; four or five are enough for a lens.
const STEPS: usize = 30;
/// How often a step is halved in search of a nearer point.
const HALVINGS: i32 = 12;
/// Points beyond the largest radius by no more than this share of it count as on it: the rounding of single precision.
const END_SLACK: f64 = 1e-6;
/// Largest error of an inverse, as a multiple of the focal length.
const TOLERANCE: f64 = 1e-13;

/// Radial and tangential distortion with rational radial factor: OpenCV's model with up to eight coefficients.
///
/// A point (x, y) of the undistorted image plane at distance 1, x right and y down, goes to
/// x·f + 2·p1·x·y + p2·(r² + 2x²), y·f + p1·(r² + 2y²) + 2·p2·x·y with
/// f = (1 + k1·r² + k2·r⁴ + k3·r⁶) / (1 + k4·r² + k5·r⁴ + k6·r⁶). OpenCV's documentation, "Camera Calibration and 3D
/// Reconstruction". The model is meant for radii below the first at which the distorted radius falls again; beyond it the picture
/// would fold over itself, and such points have no image here.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<f64>", into = "Vec<f64>")]
pub struct RadialTangential {
    /// k1, k2, k3, k4, k5, k6.
    k: [f64; 6],
    /// p1, p2.
    p: [f64; 2],
    /// Largest undistorted radius.
    r_max: f64,
    /// The distorted radius that belongs to it.
    distorted_r_max: f64,
}

impl RadialTangential {
    /// From OpenCV's vector k1, k2, p1, p2 [, k3 [, k4, k5, k6]].
    ///
    /// # Errors
    /// When there are not 4, 5 or 8 numbers, or they are not finite.
    pub fn new(coefficients: &[f64]) -> Result<Self, CameraError> {
        if !matches!(coefficients.len(), 4 | 5 | 8) || coefficients.iter().any(|c| !c.is_finite()) {
            let expected = "4, 5 or 8 finite numbers: k1, k2, p1, p2 [, k3 [, k4, k5, k6]]";
            return Err(CameraError::new("distortion", format!("{coefficients:?}"), expected));
        }
        let c: [f64; 8] = std::array::from_fn(|i| coefficients.get(i).copied().unwrap_or(0.0));
        let mut model = Self { k: [c[0], c[1], c[4], c[5], c[6], c[7]], p: [c[2], c[3]], r_max: R_LIMIT, distorted_r_max: f64::INFINITY };
        // Steps of half a percent of the radius.
        let radii = (0..3000).map(|i| 1e-3 * 1.005f64.powi(i)).take_while(|r| *r < R_LIMIT);
        model.r_max = first_fall(radii, |r| model.radial(r).1).unwrap_or(R_LIMIT);
        model.distorted_r_max = model.radial(model.r_max).0;
        Ok(model)
    }

    /// k1, k2, p1, p2, k3, k4, k5, k6.
    pub fn coefficients(&self) -> [f64; 8] {
        let ([k1, k2, k3, k4, k5, k6], [p1, p2]) = (self.k, self.p);
        [k1, k2, p1, p2, k3, k4, k5, k6]
    }

    /// The distorted position of a point of the undistorted image plane. `None` beyond the radii that the model is meant for.
    pub fn distort(&self, p: DVec2) -> Option<DVec2> {
        (p.length() <= self.r_max * (1.0 + END_SLACK)).then(|| self.map(p))
    }

    /// The point that the lens puts at `q`. `None` when there is none.
    pub fn undistort(&self, q: DVec2) -> Option<DVec2> {
        // The radial part alone can be solved safely; from there the tangential part is a small step.
        let distorted = q.length();
        let r = solve_rising(distorted.min(self.distorted_r_max), self.r_max, |r| self.radial(r));
        let mut p = if distorted > 0.0 { q * (r / distorted) } else { q };
        let mut error = self.map(p) - q;
        for _ in 0..STEPS {
            let jacobian = self.jacobian(p);
            if error == DVec2::ZERO || jacobian.determinant() <= 0.0 {
                break;
            }
            let step = jacobian.inverse() * error;
            // Halve the step until it leads nearer: near the fold a whole step leads beyond it.
            let tries = (0..HALVINGS).map(|i| p - step * 0.5f64.powi(i));
            let nearer = tries.map(|next| (next, self.map(next) - q)).find(|(_, e)| e.length_squared() < error.length_squared());
            let Some(next) = nearer else { break };
            (p, error) = next;
        }
        let good = error.length() <= TOLERANCE * (1.0 + distorted) && p.length() <= self.r_max && self.jacobian(p).determinant() > 0.0;
        good.then_some(p)
    }

    /// The radial factor f and its derivative by r².
    #[inline]
    fn factor(&self, s: f64) -> (f64, f64) {
        let [k1, k2, k3, k4, k5, k6] = self.k;
        let (n, dn) = (1.0 + s * (k1 + s * (k2 + s * k3)), k1 + s * (2.0 * k2 + s * 3.0 * k3));
        let (d, dd) = (1.0 + s * (k4 + s * (k5 + s * k6)), k4 + s * (2.0 * k5 + s * 3.0 * k6));
        // The model ends at the latest where the denominator is zero.
        if d > 0.0 { (n / d, (dn * d - n * dd) / (d * d)) } else { (f64::NAN, f64::NAN) }
    }

    /// The distorted radius and its derivative, without the tangential part.
    #[inline]
    fn radial(&self, r: f64) -> (f64, f64) {
        let (f, df) = self.factor(r * r);
        (r * f, f + 2.0 * r * r * df)
    }

    #[inline]
    fn map(&self, p: DVec2) -> DVec2 {
        let (s, [p1, p2]) = (p.length_squared(), self.p);
        let xy = 2.0 * p.x * p.y;
        p * self.factor(s).0 + DVec2::new(p1 * xy + p2 * (s + 2.0 * p.x * p.x), p1 * (s + 2.0 * p.y * p.y) + p2 * xy)
    }

    fn jacobian(&self, p: DVec2) -> DMat2 {
        let ((f, df), [p1, p2]) = (self.factor(p.length_squared()), self.p);
        let off = 2.0 * (df * p.x * p.y + p1 * p.x + p2 * p.y);
        let xx = f + 2.0 * df * p.x * p.x + 2.0 * p1 * p.y + 6.0 * p2 * p.x;
        let yy = f + 2.0 * df * p.y * p.y + 6.0 * p1 * p.y + 2.0 * p2 * p.x;
        DMat2::from_cols(DVec2::new(xx, off), DVec2::new(off, yy))
    }
}

impl TryFrom<Vec<f64>> for RadialTangential {
    type Error = CameraError;
    fn try_from(coefficients: Vec<f64>) -> Result<Self, CameraError> {
        Self::new(&coefficients)
    }
}

impl From<RadialTangential> for Vec<f64> {
    fn from(model: RadialTangential) -> Self {
        model.coefficients().to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distortion_is_opencvs_formula() {
        // x = 0.3, y = -0.2: r² = 0.13, evaluated by hand from the formula of OpenCV's documentation.
        let model = RadialTangential::new(&[-0.28, 0.07, 0.001, -0.002, 0.01, 0.02, -0.03, 0.004]).unwrap();
        let s: f64 = 0.13;
        let f = (1.0 - 0.28 * s + 0.07 * s.powi(2) + 0.01 * s.powi(3)) / (1.0 + 0.02 * s - 0.03 * s.powi(2) + 0.004 * s.powi(3));
        let x = 0.3 * f + 2.0 * 0.001 * 0.3 * -0.2 - 0.002 * (s + 2.0 * 0.09);
        let y = -0.2 * f + 0.001 * (s + 2.0 * 0.04) + 2.0 * -0.002 * 0.3 * -0.2;
        assert!((model.distort(DVec2::new(0.3, -0.2)).unwrap() - DVec2::new(x, y)).length() < 1e-15);
    }

    #[test]
    fn undistortion_inverts_and_ends_where_the_picture_folds() {
        // r (1 - 0.2 r²) rises up to r = sqrt(5/3), where it is 2/3 of that.
        let model = RadialTangential::new(&[-0.2, 0.0, 0.0, 0.0]).unwrap();
        assert!((model.r_max - (5.0f64 / 3.0).sqrt()).abs() < 1e-9, "{}", model.r_max);
        assert!((model.distorted_r_max - (5.0f64 / 3.0).sqrt() * 2.0 / 3.0).abs() < 1e-9);
        for tangential in [[0.0, 0.0], [2e-3, -3e-3]] {
            let model = RadialTangential::new(&[-0.2, 0.0, tangential[0], tangential[1]]).unwrap();
            for i in 0..400 {
                let angle = f64::from(i);
                let p = DVec2::from_angle(angle) * (1.25 * f64::from(i) / 400.0);
                let back = model.undistort(model.distort(p).unwrap()).unwrap();
                assert!((back - p).length() < 1e-9, "{p} became {back}");
            }
            assert_eq!(model.undistort(DVec2::new(0.9, 0.0)), None);
            assert_eq!(model.distort(DVec2::new(1.4, 0.0)), None);
        }
    }

    #[test]
    fn a_pole_of_the_rational_factor_is_the_end_of_the_model() {
        let model = RadialTangential::new(&[0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0]).unwrap();
        assert!(model.r_max <= 1.0 && model.r_max > 0.99, "{}", model.r_max);
        let p = model.undistort(DVec2::new(0.5, 0.0)).unwrap();
        assert!((p.x / (1.0 - p.x * p.x) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn coefficients_survive_json_and_wrong_ones_are_refused() {
        let model = RadialTangential::new(&[0.1, 0.02, 0.003, -0.001, 0.5]).unwrap();
        let json = serde_json::to_string(&model).unwrap();
        assert_eq!(json, "[0.1,0.02,0.003,-0.001,0.5,0.0,0.0,0.0]");
        assert_eq!(serde_json::from_str::<RadialTangential>(&json).unwrap(), model);
        assert!(RadialTangential::new(&[0.1, 0.2]).unwrap_err().to_string().contains("4, 5 or 8 finite numbers"));
    }
}
