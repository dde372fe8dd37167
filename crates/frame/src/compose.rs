//! The identity of the stored colours, in one place: color = reflectance × illumination + residual, to the last bit.

use crate::f16;

/// The largest finite float16.
pub const F16_LIMIT: f32 = 65504.0;

/// Numbers below this are rounded to a finite float16: it is halfway from the largest float16 to what would be the next.
const OVERFLOW: f32 = 65520.0;

/// One channel of one pixel as it is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Composed {
    /// Reflectance × illumination + residual, evaluated in float32 from the stored values and rounded to float16.
    pub color: f16,
    /// Rounded to float16, at most 65504.
    pub illumination: f16,
    /// Rounded to float16, at most what keeps `color` finite.
    pub residual: f16,
    /// True when a value is stored at the limit, or was reduced because the colour would exceed it, or is NaN. Then `color` is at the
    /// limit or, where rounding leaves nothing between, next below it; or `illumination` is at the limit.
    pub saturated: bool,
}

/// Rounds the parts of a channel to float16 first, and takes the colour from the rounded values. `illumination` and `residual`
/// are at least 0.
pub fn compose(reflectance: f16, illumination: f32, residual: f32) -> Composed {
    let stored = f16::from_f32(illumination.min(F16_LIMIT));
    let product = reflectance.to_f32() * stored.to_f32();
    let room = OVERFLOW - product;
    let nearest = f16::from_f32(residual.min(room).min(F16_LIMIT));
    // Rounding may go up, beyond what keeps the sum finite.
    let rest = if product + nearest.to_f32() < OVERFLOW { nearest } else { f16::from_bits(nearest.to_bits().saturating_sub(1)) };
    let color = f16::from_f32(product + rest.to_f32());
    let at_limit = [color, stored, rest].into_iter().any(|value| value >= f16::MAX);
    Composed { color, illumination: stored, residual: rest, saturated: at_limit || residual.is_nan() || residual >= room }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_marked() {
        let half = f16::from_f32(0.5);
        for (illumination, residual) in [(f32::NAN, 0.0), (1.0, f32::NAN), (f32::INFINITY, f32::NAN)] {
            let c = compose(half, illumination, residual);
            assert!(c.saturated && c.color.is_finite() && c.residual.is_finite(), "{illumination} {residual}: {c:?}");
        }
    }

    #[test]
    fn a_colour_beyond_the_limit_is_stored_as_the_limit_whatever_the_diffuse_light() {
        for (reflectance, illumination) in [(0.5, 2.66), (0.5, 0.01), (0.3, 60.0), (0.9, 31_000.0), (1.0, 1e9)] {
            for residual in [65_505.0, 1e6, f32::INFINITY] {
                let c = compose(f16::from_f32(reflectance), illumination, residual);
                assert!(c.saturated && c.color == f16::MAX, "{reflectance} × {illumination} + {residual}: {c:?}");
            }
        }
        for illumination in (0..0x7c00).map(|bits| f16::from_bits(bits).to_f32()) {
            let c = compose(f16::from_f32(0.5), illumination, 1e6);
            // If the sum is halfway between the two largest, it is rounded to the even one, and one step more would be infinite.
            let is_halfway = (16.0 - 0.5 * illumination).rem_euclid(32.0) < 0.01;
            assert!(c.saturated && (c.color == f16::MAX || (is_halfway && c.color.to_f32() == 65_472.0)), "{illumination}: {c:?}");
        }
    }

    #[test]
    fn a_residual_that_leaves_the_sum_finite_is_stored_as_it_is() {
        let c = compose(f16::ONE, 64_992.0, 520.0);
        assert_eq!((c.color, c.residual.to_f32(), c.saturated), (f16::MAX, 520.0, true));
        let c = compose(f16::ONE, 64_992.0, 480.0);
        assert_eq!((c.color.to_f32(), c.residual.to_f32(), c.saturated), (65_472.0, 480.0, false));
    }

    #[test]
    fn the_identity_holds_and_nothing_is_infinite_up_to_the_limit() {
        for reflectance in [0.0, 1e-4, 0.3, 0.999, 1.0].map(f16::from_f32) {
            for illumination in [0.0, 1e-7, 0.1, 3.7, 32_688.0, 65_000.0, 65_519.0, 1e9] {
                for residual in [0.0, 6e-8, 0.2, 511.3, 32_816.0, 65_503.0, 1e9] {
                    let c = compose(reflectance, illumination, residual);
                    let again = f16::from_f32(reflectance.to_f32() * c.illumination.to_f32() + c.residual.to_f32());
                    assert_eq!(again, c.color);
                    assert!(c.color.is_finite() && c.illumination.is_finite() && c.residual.is_finite());
                    assert!(!c.saturated || c.color >= f16::from_f32(65_000.0) || illumination > F16_LIMIT);
                }
            }
        }
    }
}
