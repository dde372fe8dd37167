//! The uncertainty from rounding of stored values.
//!
//! Our distances and positions are float32, which the bounds of the laws allow for. Hypersim's are float16: a distance is off by up to
//! half a unit in its last place (3.9 mm from 8 m on), and each coordinate of a position too, in asset units (0.25 units from 512 on). Laws
//! about them count only what is beyond that.

use enfilade_frame::f16;
use enfilade_math::DVec3;

/// How the distances and positions of a frame were rounded.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rounding {
    /// True where distances are float16.
    pub distance: bool,
    /// Metres in the unit of positions where these are float16; `None` where they are not.
    pub position: Option<f64>,
}

impl Rounding {
    /// The most that a stored distance is off, metres.
    pub(super) fn of_distance(&self, metres: f64) -> f64 {
        if self.distance { half_step(metres) } else { 0.0 }
    }

    /// The most that each coordinate of a stored position is off, metres.
    pub(super) fn of_position(&self, p: DVec3) -> DVec3 {
        let step = |unit: f64| DVec3::from_array((p / unit).to_array().map(half_step)) * unit;
        self.position.map_or(DVec3::ZERO, step)
    }
}

/// Half a unit in the last place of float16 at `value`: the most that rounding changes it. What is not finite is off by any amount.
pub(super) fn half_step(value: f64) -> f64 {
    // Above the largest float16 the value is infinity.
    if value.is_nan() || value.abs() > f16::MAX.to_f64() {
        return f64::INFINITY;
    }
    // Below 2^-14 numbers are 2^-24 apart; above, 11 binary digits are kept.
    (value.abs().max(f16::MIN_POSITIVE.to_f64()).log2().floor() - 11.0).exp2()
}

/// The part of `error` beyond rounding.
pub(super) fn beyond(error: f64, rounding: f64) -> f64 {
    if rounding == f64::INFINITY { 0.0 } else { (error - rounding).max(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_steps_are_the_most_that_float16_is_off() {
        for (value, expected) in [(1.0, 2f64.powi(-11)), (10.0, 2f64.powi(-8)), (1000.0, 0.25), (-600.0, 0.25), (0.0, 2f64.powi(-25))] {
            assert_eq!(half_step(value), expected, "{value}");
        }
        let worst = (0..100_000).map(|i| 0.37 + 0.0131 * f64::from(i)).map(|v| (f16::from_f64(v).to_f64() - v).abs() / half_step(v));
        let worst = worst.fold(0.0, f64::max);
        assert!(worst < 1.0 + 1e-9 && worst > 0.99, "{worst}");
        assert_eq!([f64::INFINITY, f64::NAN, 7e4].map(half_step), [f64::INFINITY; 3]);
    }

    #[test]
    fn positions_are_rounded_in_their_own_units() {
        let inches = Rounding { distance: true, position: Some(0.0254) };
        let step = inches.of_position(DVec3::new(2.54, 0.0254, 25.4));
        assert!((step - DVec3::new(0.03125, 2f64.powi(-11), 0.25) * 0.0254).length() < 1e-12, "{step}");
        assert_eq!((Rounding::default().of_position(step), Rounding::default().of_distance(9.0)), (DVec3::ZERO, 0.0));
        assert_eq!((beyond(0.5, 0.2), beyond(0.1, 0.2), beyond(f64::INFINITY, f64::INFINITY)), (0.3, 0.0, 0.0));
    }
}
