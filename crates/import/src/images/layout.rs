//! Storage of texels, uncompressed or in blocks, in both DDS and KTX2.
//!
//! Blocks are decoded by `bcdec_rs`. BC5 contains the x and y of normals, to which z is added.

use super::float_picture::FloatPicture;
use half::f16;

/// A decoded picture.
#[derive(Debug, PartialEq)]
pub(super) enum Surface {
    Bytes { width: u32, height: u32, texels: Vec<[u8; 4]> },
    Floats(FloatPicture),
}

/// The storage of texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Layout {
    /// Blocks of 4×4 texels; the bytes of each.
    Bc1,
    Bc2,
    Bc3,
    Bc4 {
        signed: bool,
    },
    Bc5 {
        signed: bool,
    },
    Bc6 {
        signed: bool,
    },
    Bc7,
    /// Whole numbers of `bytes` bytes, from which masks cut out red, green, blue and alpha.
    Masked {
        bytes: usize,
        masks: [u32; 4],
    },
    /// Channels of float16; the variants after it count those of float32 and of whole numbers of 16 bits.
    Half(usize),
    Float(usize),
    Unorm16(usize),
}

/// Red, green, blue and alpha of 8 bits each, in this order of bytes or with blue first.
pub(super) const RGBA: Layout = Layout::Masked { bytes: 4, masks: [0xff, 0xff00, 0xff_0000, 0xff00_0000] };
pub(super) const BGRA: Layout = Layout::Masked { bytes: 4, masks: [0xff_0000, 0xff00, 0xff, 0xff00_0000] };
pub(super) const BGRX: Layout = Layout::Masked { bytes: 4, masks: [0xff_0000, 0xff00, 0xff, 0] };

impl Layout {
    /// Bytes of a block, for layouts in blocks.
    fn block(self) -> Option<usize> {
        match self {
            Self::Bc1 | Self::Bc4 { .. } => Some(8),
            Self::Bc2 | Self::Bc3 | Self::Bc5 { .. } | Self::Bc6 { .. } | Self::Bc7 => Some(16),
            _ => None,
        }
    }

    /// Bytes of a picture.
    pub(super) fn bytes(self, width: u32, height: u32) -> u64 {
        let texels = u64::from(width) * u64::from(height);
        let blocks = u64::from(width.div_ceil(4)) * u64::from(height.div_ceil(4));
        match self {
            Self::Masked { bytes, .. } => texels * bytes as u64,
            Self::Half(channels) | Self::Unorm16(channels) => texels * 2 * channels as u64,
            Self::Float(channels) => texels * 4 * channels as u64,
            _ => blocks * self.block().unwrap_or(16) as u64,
        }
    }

    /// The picture in exactly its bytes.
    pub(super) fn decode(self, bytes: &[u8], width: u32, height: u32) -> Surface {
        let texels = |texels| Surface::Bytes { width, height, texels };
        let floats = |texels| Surface::Floats(FloatPicture { width, height, texels });
        match self {
            Self::Masked { bytes: size, masks } => texels(bytes.chunks_exact(size).map(|b| masked(b, masks)).collect()),
            Self::Unorm16(channels) => texels(bytes.chunks_exact(2 * channels).map(of_16_bits).collect()),
            Self::Half(channels) => floats(rgb(bytes.as_chunks::<2>().0.iter().map(|b| f16::from_le_bytes(*b).to_f32()), channels)),
            Self::Float(channels) => floats(rgb(bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)), channels)),
            Self::Bc6 { signed } => {
                let block = |block: &[u8], out: &mut [[f32; 3]; 16]| bcdec_rs::bc6h_float(block, out.as_flattened_mut(), 12, signed);
                floats(of_blocks(bytes, 16, width, height, block))
            }
            _ => texels(of_blocks(bytes, self.block().unwrap_or(16), width, height, |block, out| self.texels(block, out))),
        }
    }

    /// The texels of a block of bytes.
    fn texels(self, block: &[u8], out: &mut [[u8; 4]; 16]) {
        let flat = out.as_flattened_mut();
        match self {
            Self::Bc1 => bcdec_rs::bc1(block, flat, 16),
            Self::Bc2 => bcdec_rs::bc2(block, flat, 16),
            Self::Bc3 => bcdec_rs::bc3(block, flat, 16),
            Self::Bc4 { signed } => {
                let mut grey = [0u8; 16];
                bcdec_rs::bc4(block, &mut grey, 4, signed);
                *out = grey.map(|v| unsigned(v, signed)).map(|v| [v, v, v, 255]);
            }
            Self::Bc5 { signed } => {
                let mut pairs = [[0u8; 2]; 16];
                bcdec_rs::bc5(block, pairs.as_flattened_mut(), 8, signed);
                *out = pairs.map(|pair| normal(pair.map(|v| unsigned(v, signed))));
            }
            _ => bcdec_rs::bc7(block, flat, 16),
        }
    }
}

/// A number of −1 to 1 as one of 0 to 1.
fn unsigned(value: u8, signed: bool) -> u8 {
    if signed { (i16::from(value as i8) + 128) as u8 } else { value }
}

/// The normal of unit length with these x and y.
pub(super) fn normal([x, y]: [u8; 2]) -> [u8; 4] {
    let component = |v: u8| f32::from(v) / 127.5 - 1.0;
    let z = (1.0 - component(x).powi(2) - component(y).powi(2)).max(0.0).sqrt();
    [x, y, ((z + 1.0) * 127.5).round() as u8, 255]
}

/// The texels of a picture of blocks of 4×4, row by row.
pub(super) fn of_blocks<T: Copy + Default>(
    bytes: &[u8],
    size: usize,
    width: u32,
    height: u32,
    decode: impl Fn(&[u8], &mut [T; 16]),
) -> Vec<T> {
    let (width, height) = (width as usize, height as usize);
    let mut texels = vec![T::default(); width * height];
    let mut block = [T::default(); 16];
    for (i, bytes) in bytes.chunks_exact(size).enumerate() {
        decode(bytes, &mut block);
        let (left, top) = (4 * (i % width.div_ceil(4)), 4 * (i / width.div_ceil(4)));
        let columns = (width - left).min(4);
        for row in 0..(height - top).min(4) {
            let at = (top + row) * width + left;
            texels[at..at + columns].copy_from_slice(&block[4 * row..4 * row + columns]);
        }
    }
    texels
}

/// The channels that masks cut out of a number, each from 0 to 255. Without a mask a colour is 0 and alpha full.
fn masked(bytes: &[u8], masks: [u32; 4]) -> [u8; 4] {
    let value = bytes.iter().rev().fold(0u32, |value, b| value << 8 | u32::from(*b));
    let channel = |mask: u32| {
        let (part, largest) = ((value & mask) >> mask.trailing_zeros().min(31), mask >> mask.trailing_zeros().min(31));
        (f64::from(part) / f64::from(largest.max(1)) * 255.0).round() as u8
    };
    let [r, g, b, a] = masks;
    [channel(r), channel(g), channel(b), if a == 0 { 255 } else { channel(a) }]
}

fn of_16_bits(texel: &[u8]) -> [u8; 4] {
    let channel = |i: usize| texel.get(2 * i..2 * i + 2).map(|b| (f32::from(u16::from_le_bytes([b[0], b[1]])) / 257.0).round() as u8);
    let first = channel(0).unwrap_or(0);
    [first, channel(1).unwrap_or(first), channel(2).unwrap_or(first), channel(3).unwrap_or(255)]
}

/// Colours with this number of channels a texel: one is grey, and a fourth is left out.
fn rgb(values: impl Iterator<Item = f32>, channels: usize) -> Vec<[f32; 3]> {
    let values: Vec<f32> = values.collect();
    values.chunks_exact(channels).map(|t| if channels < 3 { [t[0]; 3] } else { [t[0], t[1], t[2]] }).collect()
}
