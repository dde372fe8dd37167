//! A sample: layers as arrays, mask, K and pose; and which pixels of a layer have a value.

use enfilade_dataset::Window;
use enfilade_frame::{Layer, Pass, f16};

pub use enfilade_frame::Values;

/// Values of pixels, row by row from the top, channels innermost.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Rows.
    pub height: usize,
    /// Columns.
    pub width: usize,
    /// Values per pixel.
    pub channels: usize,
    /// The values, height × width × channels of them.
    pub values: Values,
}

/// Rows of a matrix.
pub type Matrix3 = [[f64; 3]; 3];
/// Rows of a matrix.
pub type Matrix4 = [[f64; 4]; 4];

/// A frame, or a part of it.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Name of the scene.
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
    /// The part of the frame that it shows, before resizing.
    pub window: Window,
    /// In the requested order.
    pub layers: Vec<(Layer, Image)>,
    /// 1 where every layer has a value, else 0: floating-point values are finite, and depths above zero.
    pub mask: Option<Image>,
    /// K of OpenCV's conventions for the sample's pixels, row by row; `None` for cameras that are no pinhole, and where it was not asked
    /// for.
    pub k: Option<Matrix3>,
    /// Camera to world in OpenCV's axes, row by row, metres; `None` if it was not requested.
    pub world_from_camera: Option<Matrix4>,
}

/// True for layers whose values may be averaged over an area.
pub(crate) fn is_averaged(layer: Layer) -> bool {
    matches!(layer.spec().pass, Pass::Final | Pass::Rendered | Pass::Guides | Pass::LightParts)
        || matches!(layer, Layer::BaseColor | Layer::EmittedRadiance)
}

/// Clears the mask where the layer has no value.
pub(crate) fn mask_out(mask: &mut [u8], layer: Layer, image: &Image) {
    let depth = matches!(layer, Layer::DepthMeters | Layer::DepthZMeters | Layer::DepthBehindMeters | Layer::DepthBeyondMeters);
    match &image.values {
        // Finite, and above zero for depths: the bits of positive finite numbers lie between those of zero and of infinity.
        Values::F16(v) if depth => keep(mask, v, 1, |v| (1..f16::INFINITY.to_bits()).contains(&v.to_bits())),
        Values::F16(v) => keep(mask, v, image.channels, |v| v.to_bits() & 0x7c00 != 0x7c00),
        Values::F32(v) if depth => keep(mask, v, 1, |v| v > 0.0 && v.is_finite()),
        Values::F32(v) => keep(mask, v, image.channels, f32::is_finite),
        Values::I16(_) | Values::U8(_) => {}
    }
}

fn keep<T: Copy>(mask: &mut [u8], values: &[T], channels: usize, has_value: impl Fn(T) -> bool) {
    for (mask, pixel) in mask.iter_mut().zip(values.chunks_exact(channels)) {
        *mask &= u8::from(pixel.iter().all(|&value| has_value(value)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_is_masked_where_a_layer_has_no_value() {
        let mut mask = vec![1; 4];
        let image = |channels, values| Image { height: 2, width: 2, channels, values };
        let depth = [1.5, f32::NAN, 0.0, 2.0];
        mask_out(&mut mask, Layer::DepthMeters, &image(1, Values::F32(depth.to_vec())));
        assert_eq!(mask, [1, 0, 0, 1]);
        mask_out(&mut mask, Layer::DepthMeters, &image(1, Values::F16(depth.map(f16::from_f32).to_vec())));
        assert_eq!(mask, [1, 0, 0, 1]);
        let mut color = vec![f16::ZERO; 12];
        color[11] = f16::NEG_INFINITY;
        mask_out(&mut mask, Layer::Color, &image(3, Values::F16(color)));
        mask_out(&mut mask, Layer::Semantic, &image(1, Values::I16(vec![-1; 4])));
        assert_eq!(mask, [1, 0, 0, 0]);
    }
}
