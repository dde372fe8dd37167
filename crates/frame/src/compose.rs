//! The identity of the stored colours, in one place: color = reflectance × illumination + residual, to the last bit.

use crate::f16;

/// The largest finite float16.
pub const F16_LIMIT: f32 = 65504.0;

/// One channel of one pixel as it is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Composed {
    /// Reflectance × illumination + residual, evaluated in float32 from the stored values and rounded to float16.
    pub color: f16,
    /// Rounded to float16, at most 65504.
    pub illumination: f16,
    /// Rounded to float16, at most what keeps `color` finite.
    pub residual: f16,
    /// True when a value was beyond float16, or no number, and is stored at the limit.
    pub saturated: bool,
}

/// Rounds the parts of a channel to float16 first, and takes the colour from the rounded values. `illumination` and `residual`
/// are at least 0.
pub fn compose(reflectance: f16, illumination: f32, residual: f32) -> Composed {
    let stored = f16::from_f32(illumination.min(F16_LIMIT));
    let product = reflectance.to_f32() * stored.to_f32();
    let room = F16_LIMIT - product;
    let nearest = f16::from_f32(residual);
    // Rounding may go up, beyond what keeps the sum finite.
    let rest = if nearest.to_f32() <= room { nearest } else { round_down(room) };
    Composed {
        color: f16::from_f32(product + rest.to_f32()),
        illumination: stored,
        residual: rest,
        saturated: illumination.is_nan() || illumination > F16_LIMIT || residual.is_nan() || residual > room,
    }
}

/// The largest float16 not above `v` ≥ 0.
fn round_down(v: f32) -> f16 {
    let h = f16::from_f32(v);
    if h.to_f32() > v { f16::from_bits(h.to_bits() - 1) } else { h }
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
