//! Measured luminaires: intensity by direction as IES files state it, interpolated between the measured angles.

use enfilade_math::Vec3;
use serde::{Deserialize, Serialize};

/// The measured intensity of a luminaire by direction: a photometric web of type C, as in IES LM-63 files.
///
/// Its own space has the luminaire's axis, where vertical angles begin, along −z; horizontal angles count from +x towards +y.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhotometricWeb {
    vertical_deg: Vec<f32>,
    horizontal_deg: Vec<f32>,
    /// Plane by plane of the horizontal angles.
    candela: Vec<f32>,
}

impl PhotometricWeb {
    /// From vertical angles (0 on the axis, to 180), horizontal angles, and candela for each plane of a horizontal angle. A single
    /// horizontal angle means the same all round; planes from 0 to 90 degrees are mirrored at both axes, from 0 to 180 at x, and
    /// from 90 to 270 at y.
    ///
    /// # Errors
    /// The problem, as the end of a sentence: angles out of order or range, counts that do not fit, values that are not intensities.
    pub fn new(vertical_deg: Vec<f32>, horizontal_deg: Vec<f32>, candela: Vec<f32>) -> Result<Self, String> {
        let ordered = |angles: &[f32]| angles.windows(2).all(|pair| pair[0] < pair[1]);
        let (Some(&v0), Some(&v1)) = (vertical_deg.first(), vertical_deg.last()) else { return Err("there are no vertical angles".into()) };
        let (Some(&h0), Some(&h1)) = (horizontal_deg.first(), horizontal_deg.last()) else {
            return Err("there are no horizontal angles".into());
        };
        if !ordered(&vertical_deg) || !(0.0..=180.0).contains(&v0) || !(0.0..=180.0).contains(&v1) {
            return Err(format!("vertical angles must rise within 0 to 180 degrees, found {v0} to {v1}"));
        }
        let known = [(0.0, 0.0), (0.0, 90.0), (0.0, 180.0), (90.0, 270.0), (0.0, 360.0)];
        let once_round = h0 == 0.0 && h1 > 180.0 && h1 < 360.0;
        if !ordered(&horizontal_deg) || !(known.contains(&(h0, h1)) || once_round) {
            return Err(format!("horizontal angles must rise from 0 to 0, 90, 180 or 360, or from 90 to 270 degrees, found {h0} to {h1}"));
        }
        if candela.len() != vertical_deg.len() * horizontal_deg.len() {
            let (wanted, found) = (vertical_deg.len() * horizontal_deg.len(), candela.len());
            return Err(format!("{} x {} angles need {wanted} intensities, found {found}", horizontal_deg.len(), vertical_deg.len()));
        }
        if let Some(bad) = candela.iter().find(|c| !(c.is_finite() && **c >= 0.0)) {
            return Err(format!("{bad} is no intensity"));
        }
        Ok(Self { vertical_deg, horizontal_deg, candela })
    }

    /// Candela in the unit direction `d` of the web's own space; none beyond the vertical angles that were measured.
    pub fn candela(&self, d: Vec3) -> f32 {
        let vertical = (d.x.hypot(d.y)).atan2(-d.z).to_degrees();
        // A direction that is beyond the ends by a rounding error was measured.
        let (first, last) = (self.vertical_deg[0], self.vertical_deg[self.vertical_deg.len() - 1]);
        if vertical < first - 1e-3 || vertical > last + 1e-3 {
            return 0.0;
        }
        let (row, t) = interval(&self.vertical_deg, vertical);
        let in_plane = |plane: usize| {
            let plane = &self.candela[plane * self.vertical_deg.len()..];
            let next = (row + 1).min(self.vertical_deg.len() - 1);
            plane[row] + (plane[next] - plane[row]) * t
        };
        let horizontal = self.mirrored(d.y.atan2(d.x).to_degrees().rem_euclid(360.0));
        let last = self.horizontal_deg.len() - 1;
        if horizontal > self.horizontal_deg[last] {
            // Between the last plane and the first, once round.
            let t = (horizontal - self.horizontal_deg[last]) / (360.0 - self.horizontal_deg[last]);
            return in_plane(last) + (in_plane(0) - in_plane(last)) * t;
        }
        let (plane, t) = interval(&self.horizontal_deg, horizontal);
        in_plane(plane) + (in_plane((plane + 1).min(last)) - in_plane(plane)) * t
    }

    /// The largest intensity, candela.
    pub fn peak_candela(&self) -> f32 {
        self.candela.iter().fold(0.0, |peak, &c| peak.max(c))
    }

    /// The vertical angle beyond which nothing is emitted, degrees.
    pub fn widest_deg(&self) -> f32 {
        let rows = self.vertical_deg.len();
        let dark = |row: usize| self.candela.iter().skip(row).step_by(rows).all(|&c| c == 0.0);
        let last_lit = (0..rows).rev().find(|&row| !dark(row)).unwrap_or(0);
        self.vertical_deg[(last_lit + 1).min(rows - 1)]
    }

    /// Luminous flux, lumens, by the trapezoidal rule over steps of one degree.
    pub fn lumens(&self) -> f64 {
        let mut flux = 0.0;
        for v in 0..180 {
            let theta = (f64::from(v) + 0.5).to_radians();
            let ring = (theta - 0.5f64.to_radians()).cos() - (theta + 0.5f64.to_radians()).cos();
            for h in 0..360 {
                let phi = (f64::from(h) + 0.5).to_radians();
                let d = Vec3::new((theta.sin() * phi.cos()) as f32, (theta.sin() * phi.sin()) as f32, -theta.cos() as f32);
                flux += f64::from(self.candela(d)) * ring * 1f64.to_radians();
            }
        }
        flux
    }

    /// A horizontal angle on [0, 360) moved into the planes that were measured.
    fn mirrored(&self, degrees: f32) -> f32 {
        let at_x = |a: f32| if a > 180.0 { 360.0 - a } else { a };
        match (self.horizontal_deg[0], self.horizontal_deg[self.horizontal_deg.len() - 1]) {
            (0.0, 0.0) => 0.0,
            (0.0, 90.0) => {
                let a = at_x(degrees);
                if a > 90.0 { 180.0 - a } else { a }
            }
            (0.0, 180.0) => at_x(degrees),
            (90.0, _) => {
                if degrees < 90.0 {
                    180.0 - degrees
                } else if degrees > 270.0 {
                    540.0 - degrees
                } else {
                    degrees
                }
            }
            _ => degrees,
        }
    }
}

/// The interval of rising `angles` that contains `angle`, and its position there on [0, 1].
fn interval(angles: &[f32], angle: f32) -> (usize, f32) {
    let first = angles.partition_point(|&a| a <= angle).saturating_sub(1).min(angles.len().saturating_sub(2));
    let Some(&next) = angles.get(first + 1) else { return (0, 0.0) };
    (first, ((angle - angles[first]) / (next - angles[first])).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direction(vertical_deg: f32, horizontal_deg: f32) -> Vec3 {
        let ((sin_v, cos_v), (sin_h, cos_h)) = (vertical_deg.to_radians().sin_cos(), horizontal_deg.to_radians().sin_cos());
        Vec3::new(sin_v * cos_h, sin_v * sin_h, -cos_v)
    }

    #[test]
    fn intensities_are_interpolated_and_end_where_measurement_ends() {
        let web = PhotometricWeb::new(vec![0.0, 45.0, 90.0], vec![0.0], vec![100.0, 60.0, 0.0]).unwrap();
        for (angle, expected) in [(0.0, 100.0), (22.5, 80.0), (45.0, 60.0), (67.5, 30.0), (91.0, 0.0), (180.0, 0.0)] {
            assert!((web.candela(direction(angle, 123.0)) - expected).abs() < 0.01, "{angle}");
        }
        assert_eq!((web.peak_candela(), web.widest_deg()), (100.0, 90.0));
        let narrow = PhotometricWeb::new(vec![0.0, 30.0, 60.0, 90.0], vec![0.0], vec![1.0, 0.0, 0.0, 0.0]).unwrap();
        assert_eq!(narrow.widest_deg(), 30.0);
    }

    #[test]
    fn planes_are_mirrored_as_their_range_says() {
        let web = |horizontal: Vec<f32>| {
            // The intensity identifies the plane.
            let candela = horizontal.iter().flat_map(|&h| [h + 1.0; 2]).collect();
            PhotometricWeb::new(vec![0.0, 180.0], horizontal, candela).unwrap()
        };
        for (range, angle, plane) in [
            (vec![0.0, 90.0], 150.0, 30.0),
            (vec![0.0, 90.0], 200.0, 20.0),
            (vec![0.0, 90.0], 300.0, 60.0),
            (vec![0.0, 90.0, 180.0], 300.0, 60.0),
            (vec![90.0, 180.0, 270.0], 30.0, 150.0),
            (vec![90.0, 180.0, 270.0], 300.0, 240.0),
            (vec![0.0, 180.0, 360.0], 300.0, 300.0),
        ] {
            let found = web(range.clone()).candela(direction(80.0, angle)) - 1.0;
            assert!((found - plane).abs() < 0.01, "{range:?} at {angle}: {found}, expected {plane}");
        }
        // Once round without a last plane at 360: back to the first.
        let found = web(vec![0.0, 90.0, 180.0, 270.0]).candela(direction(80.0, 315.0));
        assert!((found - 136.0).abs() < 0.01, "{found}");
    }

    #[test]
    fn an_even_web_has_four_pi_times_its_intensity() {
        let even = PhotometricWeb::new(vec![0.0, 180.0], vec![0.0], vec![10.0; 2]).unwrap();
        assert!((even.lumens() / (4.0 * std::f64::consts::PI * 10.0) - 1.0).abs() < 1e-4);
        // A Lambert surface: I₀ cosθ has π I₀.
        let vertical: Vec<f32> = (0..=90).map(|v| v as f32).collect();
        let candela = vertical.iter().map(|v| 100.0 * v.to_radians().cos().max(0.0)).collect();
        let lambert = PhotometricWeb::new(vertical, vec![0.0], candela).unwrap();
        assert!((lambert.lumens() / (std::f64::consts::PI * 100.0) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn webs_that_make_no_sense_are_refused_with_reasons() {
        let refused = |v: Vec<f32>, h: Vec<f32>, c: Vec<f32>| PhotometricWeb::new(v, h, c).unwrap_err();
        assert!(refused(vec![0.0, 90.0, 80.0], vec![0.0], vec![1.0; 3]).contains("vertical angles must rise"));
        assert!(refused(vec![-90.0, 90.0], vec![0.0], vec![1.0; 2]).contains("found -90 to 90"));
        assert!(refused(vec![0.0, 90.0], vec![0.0, 45.0], vec![1.0; 4]).contains("found 0 to 45"));
        assert!(refused(vec![0.0, 90.0], vec![0.0], vec![1.0; 3]).contains("need 2 intensities, found 3"));
        assert!(refused(vec![0.0, 90.0], vec![0.0], vec![1.0, -1.0]).contains("-1 is no intensity"));
        assert!(refused(vec![], vec![0.0], vec![]).contains("no vertical angles"));
    }
}
