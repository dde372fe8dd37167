//! The noise of a whole picture as one number: the target of rendering, the value in a frame's record, and what `verify` measures.

use crate::{Frame, Layer, f16};
use enfilade_math::Rgb;

/// Share of the picture's mean luminance that is added to a pixel's own before its error is divided by it: a relative error in the dark is
/// invisible.
pub const NOISE_FLOOR: f64 = 0.2;

/// The root mean square, over a picture's pixels, of the standard error over (luminance + [`NOISE_FLOOR`] × the mean luminance).
///
/// Takes each pixel's linear colour and the standard error of its luminance (Rec. 709), as they are stored. `None` when that is no number:
/// there are no pixels, or the errors are not known.
///
/// ```
/// use enfilade_frame::{f16, picture_noise};
///
/// let pixel = |luminance: f32, error: f32| ([f16::from_f32(luminance); 3], f16::from_f32(error));
/// // 0.12 / (1 + 0.2 × 1) in both pixels.
/// let noise = picture_noise([pixel(1.0, 0.12); 2].into_iter()).unwrap();
/// assert!((noise - 0.1).abs() < 1e-4);
/// assert_eq!(picture_noise([pixel(1.0, f32::NAN)].into_iter()), None);
/// ```
pub fn picture_noise(pixels: impl ExactSizeIterator<Item = ([f16; 3], f16)> + Clone) -> Option<f64> {
    let luminance = |color: [f16; 3]| f64::from(Rgb::from(color.map(f16::to_f32)).luminance());
    let count = pixels.len() as f64;
    let floor = NOISE_FLOOR * pixels.clone().map(|(color, _)| luminance(color)).sum::<f64>() / count;
    let square =
        |(color, error): ([f16; 3], f16)| if error == f16::ZERO { 0.0 } else { (error.to_f64() / (luminance(color) + floor)).powi(2) };
    let noise = (pixels.map(square).sum::<f64>() / count).sqrt();
    noise.is_finite().then_some(noise)
}

impl Frame {
    /// [`picture_noise`] of the frame as it was rendered, by denoised color where what was rendered is not kept; `None` without color or
    /// its standard error.
    pub fn noise(&self) -> Option<f64> {
        let (color, error) = (self.get(Layer::ColorRendered).or_else(|| self.get(Layer::Color))?, self.get(Layer::ColorStandardError)?);
        let half = |value: f64| f16::from_f64(value);
        let pixel = |i: usize| ([0, 1, 2].map(|channel| half(color.get(3 * i + channel))), half(error.get(i)));
        picture_noise((0..self.pixels()).map(pixel))
    }
}
