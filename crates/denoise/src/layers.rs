//! From rendered layers to denoised ones.
//!
//! The guides of each part were chosen by measurement, see `docs/benchmarks/denoise.md`. Diffuse light contains no texture of the first
//! surface's reflectance, so a reflectance among its guides would only leave traces in it: there it is white, and the exact reflectance is
//! multiplied in afterwards. The residual shows what is mirrored and what is behind glass, so its guides are the normals and the reflectance
//! of that. All guides are means over the samples of the colours, with which they agree at edges and where lens or motion blur.

use crate::DenoiseError;
use enfilade_frame::{Frame, Layer, Values, compose, f16};

/// The layers that every frame must have to be denoised.
pub const INPUTS: [Layer; 4] = [Layer::DiffuseIllumination, Layer::Residual, Layer::DiffuseReflectance, Layer::NormalBumpWorld];

/// The layers that guide denoising. Frames of earlier versions are without them: there `normal_bump_world` takes their place, which is of
/// point samples and gets the filter of the colours.
pub const GUIDES: [Layer; 3] = [Layer::NormalFilteredWorld, Layer::NormalBeyondWorld, Layer::ReflectanceBeyond];

/// The layers that denoising reads of a frame: [`INPUTS`], and of [`GUIDES`] those that it has.
pub fn inputs_of(has: impl Fn(Layer) -> bool) -> Vec<Layer> {
    INPUTS.into_iter().chain(GUIDES.into_iter().filter(|layer| has(*layer))).collect()
}

/// A tent of one pixel's radius over values that are constant within pixels: the share of each neighbour in a row or column.
const NEIGHBOUR: f32 = 0.125;

/// A noisy picture and its guides: three values per pixel, row by row from the top.
#[derive(Clone, Copy, Debug)]
pub struct Noisy<'a> {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear radiance, finite and not negative.
    pub color: &'a [f32],
    /// Reflectance, 0 to 1, of the texture that `color` shows.
    pub albedo: &'a [f32],
    /// Normals in the world, at most of unit length, 0 where nothing is hit.
    pub normal: &'a [f32],
}

/// `color`, `diffuse_illumination` and `residual` of `frame` without noise, and no other layers.
/// `filter` denoises one picture.
///
/// # Errors
/// When the frame lacks one of [`INPUTS`].
pub fn denoise(frame: &Frame, mut filter: impl FnMut(&Noisy<'_>) -> Vec<f32>) -> Result<Frame, DenoiseError> {
    let [illumination, residual, reflectance, normal] = INPUTS.map(|layer| values(frame, layer));
    let (illumination, residual, reflectance, normal) = (illumination?, residual?, reflectance?, normal?);
    let white = vec![1.0; normal.len()];
    let [filtered, beyond, reflectance_beyond] = match GUIDES.map(|layer| values(frame, layer)) {
        [Ok(filtered), Ok(beyond), Ok(reflectance_beyond)] => [filtered, beyond, reflectance_beyond],
        _ => {
            let filtered = filtered(&normal, frame.width as usize);
            [filtered.clone(), filtered, white.clone()]
        }
    };
    let (width, height) = (frame.width, frame.height);
    let illumination = filter(&Noisy { width, height, color: &illumination, albedo: &white, normal: &filtered });
    let residual = filter(&Noisy { width, height, color: &residual, albedo: &reflectance_beyond, normal: &beyond });
    Ok(composed(frame, &reflectance, &illumination, &residual))
}

/// Puts the parts together as they are stored. What a filter leaves below zero, or not a number, is 0.
fn composed(frame: &Frame, reflectance: &[f32], illumination: &[f32], residual: &[f32]) -> Frame {
    let mut layers: [Vec<f16>; 3] = Default::default();
    for ((&a, &s), &r) in reflectance.iter().zip(illumination).zip(residual) {
        let channel = compose(f16::from_f32(a), s.max(0.0), r.max(0.0));
        for (layer, value) in layers.iter_mut().zip([channel.color, channel.illumination, channel.residual]) {
            layer.push(value);
        }
    }
    let mut out = Frame::new(frame.width, frame.height);
    let names = [Layer::Color, Layer::DiffuseIllumination, Layer::Residual];
    names.into_iter().zip(layers).for_each(|(layer, values)| out.insert(layer, Values::F16(values)));
    out
}

/// A layer in single precision, NaN (the sentinel of normals) as 0.
fn values(frame: &Frame, layer: Layer) -> Result<Vec<f32>, DenoiseError> {
    let values = frame.get(layer).ok_or(DenoiseError::MissingLayer { layer: layer.spec().name })?;
    let number = |v: f32| if v.is_nan() { 0.0 } else { v };
    Ok((0..values.len()).map(|i| number(values.get(i) as f32)).collect())
}

/// Point samples, three per pixel, filtered as the colours are; the image ends with copies of its border.
fn filtered(values: &[f32], width: usize) -> Vec<f32> {
    let rows: Vec<f32> = values.chunks(3 * width).flat_map(|row| weighted(row, 3)).collect();
    weighted(&rows, 3 * width).collect()
}

/// Every value with its neighbours `step` before and after it.
fn weighted(values: &[f32], step: usize) -> impl Iterator<Item = f32> + '_ {
    let last = values.len().saturating_sub(step);
    values.iter().enumerate().map(move |(i, &v)| {
        let before = if i < step { v } else { values[i - step] };
        let after = if i >= last { v } else { values[i + step] };
        (1.0 - 2.0 * NEIGHBOUR) * v + NEIGHBOUR * (before + after)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_between_two_walls_is_shared_by_the_pixels_on_both_sides() {
        // Two rows of three pixels; the left pixel faces x, the others face y.
        let row = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0];
        let expected = [0.875, 0.125, 0.0, 0.125, 0.875, 0.0, 0.0, 1.0, 0.0];
        assert_eq!(filtered(&[row, row].concat(), 3), [expected, expected].concat());
        let (up, down) = ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
        assert_eq!(filtered(&[up, up, down].concat(), 1), [0.0, 0.0, 1.0, 0.0, 0.0, 0.75, 0.0, 0.0, -0.75]);
        assert_eq!(filtered(&up, 1), up);
    }
}
