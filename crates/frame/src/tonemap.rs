//! Hypersim's tone map: one exposure per image, then a gamma curve.
//!
//! The exposure takes the 90th percentile of brightness over the pixels that see the scene to 0.8 in the result. The same
//! scale shows illumination and residual, so that the pictures of one frame can be compared with each other.

use crate::{Frame, Layer};
use enfilade_math::quantile;
use serde::{Deserialize, Serialize};

/// The power of the displayed curve.
pub const GAMMA: f64 = 1.0 / 2.2;
/// The share of the pixels that are darker than what the exposure goes by.
pub const PERCENTILE: f64 = 0.9;
const BRIGHTNESS_OF_PERCENTILE: f64 = 0.8;
/// Below this brightness a picture counts as black.
pub const BLACK: f64 = 1e-4;

/// The exposure of one image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ToneMap {
    /// Multiplies radiance before the gamma curve.
    pub scale: f64,
}

/// Shows radiance 1 as white.
impl Default for ToneMap {
    fn default() -> Self {
        Self { scale: 1.0 }
    }
}

impl ToneMap {
    /// Fits the scale to the brightness (see [`brightness`]) of the valid pixels; see [`ToneMap::of_percentile`].
    pub fn fit(valid_brightness: Vec<f64>) -> Self {
        Self::of_percentile(percentile(valid_brightness))
    }

    /// The scale that shows this brightness at 0.8: 1 when there is none, 0 when it is practically black.
    pub fn of_percentile(brightness: Option<f64>) -> Self {
        let scale = match brightness {
            None => 1.0,
            Some(p) if p < BLACK => 0.0,
            Some(p) => BRIGHTNESS_OF_PERCENTILE.powf(1.0 / GAMMA) / p,
        };
        Self { scale }
    }

    /// Fits the scale to a frame's colour; `None` without `color` or `render_entity_id`.
    pub fn of_frame(frame: &Frame) -> Option<Self> {
        valid_brightness(frame).map(Self::fit)
    }

    /// Linear radiance to a displayed value on `[0,1]`.
    pub fn apply(&self, radiance: f64) -> f64 {
        encode(self.scale * radiance)
    }

    /// The radiance that is displayed as a value on `[0,1]`; infinite where everything is black.
    pub fn radiance(&self, displayed: f64) -> f64 {
        displayed.powf(1.0 / GAMMA) / self.scale
    }
}

/// The brightness of every pixel that sees the scene; `None` without `color` or `render_entity_id`.
pub fn valid_brightness(frame: &Frame) -> Option<Vec<f64>> {
    let (color, ids) = (frame.get(Layer::Color)?, frame.get(Layer::RenderEntityId)?);
    let valid = (0..frame.pixels()).filter(|&i| ids.get(i) != -1.0);
    Some(valid.map(|i| brightness([0, 1, 2].map(|c| color.get(3 * i + c)))).collect())
}

/// The brightness that the exposure goes by; `None` without pixels. NaN is left out.
pub fn percentile(mut brightness: Vec<f64>) -> Option<f64> {
    brightness.retain(|b| !b.is_nan());
    quantile(&mut brightness, PERCENTILE)
}

/// Brightness as the toolkit weighs it.
pub fn brightness([r, g, b]: [f64; 3]) -> f64 {
    0.3 * r + 0.59 * g + 0.11 * b
}

/// The gamma curve alone: linear to displayed, clipped to `[0,1]`; NaN gives 0.
pub fn encode(linear: f64) -> f64 {
    linear.max(0.0).powf(GAMMA).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ninetieth_percentile_is_shown_at_eight_tenths() {
        let tone = ToneMap::fit((0..=10).map(f64::from).collect());
        assert!((tone.apply(9.0) - 0.8).abs() < 1e-12);
        assert!((tone.scale - 0.8f64.powf(2.2) / 9.0).abs() < 1e-15);
        assert!((tone.radiance(tone.apply(3.0)) - 3.0).abs() < 1e-12);
        assert_eq!((tone.apply(1e9), tone.apply(-1.0), tone.apply(f64::NAN)), (1.0, 0.0, 0.0));
    }

    #[test]
    fn scale_is_one_without_pixels_and_zero_when_black() {
        assert_eq!(ToneMap::fit(vec![]).scale, 1.0);
        assert_eq!(ToneMap::fit(vec![9e-5; 10]).scale, 0.0);
        assert!(ToneMap::fit(vec![1.1e-4; 10]).scale > 1000.0);
    }
}
