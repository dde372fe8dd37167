//! Frames: finished pictures as named layers with unit, dtype, space and validity.
//!
//! [`LAYERS`] is the one table of layers. The renderer's outputs, file names, dtypes, documentation and verification all follow
//! it. A [`Frame`] holds values exactly as they are stored.

mod channels;
mod compose;
mod noise;
mod spec;
pub mod tonemap;

pub use channels::vector;
pub use compose::{Composed, F16_LIMIT, compose};
pub use half::f16;
pub use noise::{NOISE_FLOOR, picture_noise};
pub use spec::{DENOISED, Dtype, LAYERS, LIGHT_BY_PATH, LIGHT_BY_SOURCE, Layer, LayerSpec, Pass, Validity, traits};

use std::collections::BTreeMap;

/// Values of one layer, row by row from the top, channels innermost.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Half precision.
    F16(Vec<f16>),
    /// Single precision.
    F32(Vec<f32>),
    /// Signed 16-bit integers.
    I16(Vec<i16>),
    /// Bytes.
    U8(Vec<u8>),
}

impl Values {
    /// Number of values (pixels × channels).
    pub fn len(&self) -> usize {
        match self {
            Self::F16(v) => v.len(),
            Self::F32(v) => v.len(),
            Self::I16(v) => v.len(),
            Self::U8(v) => v.len(),
        }
    }

    /// True when there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The type in which they are stored.
    pub fn dtype(&self) -> Dtype {
        match self {
            Self::F16(_) => Dtype::F16,
            Self::F32(_) => Dtype::F32,
            Self::I16(_) => Dtype::I16,
            Self::U8(_) => Dtype::U8,
        }
    }

    /// Value `index` as a double; exact for every dtype.
    #[inline]
    pub fn get(&self, index: usize) -> f64 {
        match self {
            Self::F16(v) => half_to_f64(v[index]),
            Self::F32(v) => f64::from(v[index]),
            Self::I16(v) => f64::from(v[index]),
            Self::U8(v) => f64::from(v[index]),
        }
    }

    /// Little-endian bytes, as in the file.
    pub fn as_bytes(&self) -> &[u8] {
        match self {
            Self::F16(v) => bytemuck::cast_slice(v),
            Self::F32(v) => bytemuck::cast_slice(v),
            Self::I16(v) => bytemuck::cast_slice(v),
            Self::U8(v) => v,
        }
    }
}

/// The number as float64, as [`f16::to_f64`] gives it, which however asks at every value whether the processor has an instruction for it.
#[inline]
fn half_to_f64(value: f16) -> f64 {
    const EXPONENT: u16 = 0x7C00;
    /// 2^1008, by which the exponents of the two types are apart.
    const APART: f64 = f64::from_bits((1023 + 1008) << 52);
    let bits = value.to_bits();
    if bits & EXPONENT == EXPONENT {
        return value.to_f64();
    }
    f64::from_bits(u64::from(bits & 0x8000) << 48 | u64::from(bits & 0x7FFF) << 42) * APART
}

/// A finished picture: any subset of the layers, all of one size.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    layers: BTreeMap<Layer, Values>,
    fixtures: Vec<FixtureLayers>,
}

/// The most fixtures of a scene: the weakest lamps beyond count as one.
pub const MAX_FIXTURES: usize = 40;

/// The light of one fixture: color = the sum over fixtures of diffuse_reflectance × diffuse_illumination + residual, as it was rendered, but
/// for the rounding of each.
#[derive(Clone, Debug, PartialEq)]
pub struct FixtureLayers {
    /// The fixture's part of `diffuse_illumination`, float16; 0 where `diffuse_reflectance` is.
    pub diffuse_illumination: Values,
    /// The fixture's part of `residual`, float16.
    pub residual: Values,
}

impl Frame {
    /// A frame without layers.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, layers: BTreeMap::new(), fixtures: Vec::new() }
    }

    /// Adds or replaces a layer.
    ///
    /// # Panics
    /// When the values are not what the layer's spec and the frame's size call for.
    pub fn insert(&mut self, layer: Layer, values: Values) {
        let spec = layer.spec();
        let expected = self.width as usize * self.height as usize * spec.channels;
        assert_eq!((values.len(), values.dtype()), (expected, spec.dtype), "layer {} of {}x{}", spec.name, self.width, self.height);
        self.layers.insert(layer, values);
    }

    /// The values of a layer, if the frame has it.
    pub fn get(&self, layer: Layer) -> Option<&Values> {
        self.layers.get(&layer)
    }

    /// The layers present, in the order of [`LAYERS`].
    pub fn iter(&self) -> impl Iterator<Item = (Layer, &Values)> {
        self.layers.iter().map(|(&layer, values)| (layer, values))
    }

    /// Adds the light of one more fixture.
    ///
    /// # Panics
    /// When the values are not three float16 per pixel.
    pub fn push_fixture(&mut self, fixture: FixtureLayers) {
        for values in [&fixture.diffuse_illumination, &fixture.residual] {
            assert_eq!(
                (values.len(), values.dtype()),
                (3 * self.pixels(), Dtype::F16),
                "light of a fixture of {}x{}",
                self.width,
                self.height
            );
        }
        self.fixtures.push(fixture);
    }

    /// The light of each fixture, where it is kept apart.
    pub fn fixtures(&self) -> &[FixtureLayers] {
        &self.fixtures
    }

    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_float16_is_read_exactly() {
        let all = Values::F16((0..=u16::MAX).map(f16::from_bits).collect());
        let Values::F16(halves) = &all else { panic!("{:?}", all.dtype()) };
        for (i, half) in halves.iter().enumerate() {
            assert_eq!(all.get(i).to_bits(), half.to_f64().to_bits(), "{i:#06x}");
        }
    }
}
