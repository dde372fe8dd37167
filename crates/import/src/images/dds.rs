//! DirectDraw surfaces: the first picture of a file, whole or compressed in blocks (BC1 to BC7).
//!
//! The layout is that of Microsoft's "Programming Guide for DDS"; blocks are decoded by `bcdec_rs`. Of cube maps, arrays, volumes and
//! smaller copies (mipmaps) the first and largest picture is read. BC5 holds the x and y of normals, to which z is added.

use super::float_picture::{FloatPicture, check_size};
use half::f16;

/// The first bytes of every file.
pub(super) const MAGIC: &[u8] = b"DDS ";

/// Bytes of the magic and the header, and with the extension of Direct3D 10.
const HEADER: usize = 128;
const HEADER_10: usize = 148;

/// A decoded picture.
#[derive(Debug, PartialEq)]
pub(super) enum Surface {
    Bytes { width: u32, height: u32, texels: Vec<[u8; 4]> },
    Floats(FloatPicture),
}

/// How texels are stored.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Layout {
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
    /// Whole numbers of so many bytes, of which masks cut out red, green, blue and alpha.
    Masked {
        bytes: usize,
        masks: [u32; 4],
    },
    /// So many channels of floats or of whole numbers of 16 bits.
    Half(usize),
    Float(usize),
    Unorm16(usize),
}

/// Decodes a file.
///
/// # Errors
/// What is wrong with it, as the rest of a sentence that begins with its name.
pub(super) fn decode(bytes: &[u8]) -> Result<Surface, String> {
    let word = |at: usize| bytes.get(at..at + 4).map_or(0, |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    if bytes.len() < HEADER || word(4) != 124 {
        return Err("is a DDS that is cut short in its header; copy or export it again".into());
    }
    let (height, width) = (word(12), word(16));
    check_size(width, height)?;
    let (layout, start) = layout(&word)?;
    let size = layout.bytes(width, height);
    let found = bytes.len().saturating_sub(start);
    if width == 0 || height == 0 || (found as u64) < size {
        let problem =
            format!("is a DDS of {width}x{height} pixels with {found} bytes of them, expected {size}: it is cut short or damaged");
        return Err(problem);
    }
    Ok(layout.decode(&bytes[start..start + size as usize], width, height))
}

/// How texels are stored by the header, and where they begin.
fn layout(word: &dyn Fn(usize) -> u32) -> Result<(Layout, usize), String> {
    let code = word(84).to_le_bytes();
    let (flags, bits, masks) = (word(80), word(88), [word(92), word(96), word(100), word(104)]);
    let unknown = |what: String| format!("is a DDS whose pixels are {what}, which is not read; save it as PNG, or as BC1 to BC7");
    if flags & 4 != 0 {
        if &code == b"DX10" {
            let format = word(128);
            return of_dxgi(format).map(|layout| (layout, HEADER_10)).ok_or_else(|| unknown(format!("in DXGI format {format}")));
        }
        return of_code(code).map(|layout| (layout, HEADER)).ok_or_else(|| unknown(format!("{:?}", String::from_utf8_lossy(&code))));
    }
    let with_alpha = |masks: [u32; 4]| if flags & 1 != 0 { masks } else { [masks[0], masks[1], masks[2], 0] };
    let masks = match flags {
        f if f & 0x40 != 0 => with_alpha(masks),
        // Luminance.
        f if f & 0x2_0000 != 0 => with_alpha([masks[0], masks[0], masks[0], masks[3]]),
        // Alpha alone is read as a grey.
        f if f & 2 != 0 => [masks[3], masks[3], masks[3], 0],
        _ => return Err(unknown(format!("of the kind {flags:#x}"))),
    };
    match bits {
        8 | 16 | 24 | 32 => Ok((Layout::Masked { bytes: bits as usize / 8, masks }, HEADER)),
        _ => Err(unknown(format!("of {bits} bits"))),
    }
}

/// Red, green, blue and alpha of 8 bits each, in this order of bytes or with blue first.
const RGBA: Layout = Layout::Masked { bytes: 4, masks: [0xff, 0xff00, 0xff_0000, 0xff00_0000] };
const BGRA: Layout = Layout::Masked { bytes: 4, masks: [0xff_0000, 0xff00, 0xff, 0xff00_0000] };
const BGRX: Layout = Layout::Masked { bytes: 4, masks: [0xff_0000, 0xff00, 0xff, 0] };

fn of_code(code: [u8; 4]) -> Option<Layout> {
    Some(match &code {
        b"DXT1" => Layout::Bc1,
        b"DXT2" | b"DXT3" => Layout::Bc2,
        b"DXT4" | b"DXT5" => Layout::Bc3,
        b"ATI1" | b"BC4U" => Layout::Bc4 { signed: false },
        b"BC4S" => Layout::Bc4 { signed: true },
        b"ATI2" | b"BC5U" => Layout::Bc5 { signed: false },
        b"BC5S" => Layout::Bc5 { signed: true },
        // Numbers of Direct3D 9.
        _ => match u32::from_le_bytes(code) {
            36 => Layout::Unorm16(4),
            111 => Layout::Half(1),
            113 => Layout::Half(4),
            114 => Layout::Float(1),
            116 => Layout::Float(4),
            _ => return None,
        },
    })
}

fn of_dxgi(format: u32) -> Option<Layout> {
    Some(match format {
        2 => Layout::Float(4),
        6 => Layout::Float(3),
        10 => Layout::Half(4),
        11 => Layout::Unorm16(4),
        27..=29 => RGBA,
        41 => Layout::Float(1),
        54 => Layout::Half(1),
        56 => Layout::Unorm16(1),
        60 | 61 => Layout::Masked { bytes: 1, masks: [0xff, 0xff, 0xff, 0] },
        70..=72 => Layout::Bc1,
        73..=75 => Layout::Bc2,
        76..=78 => Layout::Bc3,
        79..=81 => Layout::Bc4 { signed: format == 81 },
        82..=84 => Layout::Bc5 { signed: format == 84 },
        85 => Layout::Masked { bytes: 2, masks: [0xf800, 0x7e0, 0x1f, 0] },
        87 | 90 | 91 => BGRA,
        88 | 92 | 93 => BGRX,
        94..=96 => Layout::Bc6 { signed: format == 96 },
        97..=99 => Layout::Bc7,
        _ => return None,
    })
}

impl Layout {
    /// Bytes of a block, for layouts in blocks.
    fn block(self) -> Option<usize> {
        match self {
            Self::Bc1 | Self::Bc4 { .. } => Some(8),
            Self::Bc2 | Self::Bc3 | Self::Bc5 { .. } | Self::Bc6 { .. } | Self::Bc7 => Some(16),
            _ => None,
        }
    }

    fn bytes(self, width: u32, height: u32) -> u64 {
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
    fn decode(self, bytes: &[u8], width: u32, height: u32) -> Surface {
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
fn normal([x, y]: [u8; 2]) -> [u8; 4] {
    let component = |v: u8| f32::from(v) / 127.5 - 1.0;
    let z = (1.0 - component(x).powi(2) - component(y).powi(2)).max(0.0).sqrt();
    [x, y, ((z + 1.0) * 127.5).round() as u8, 255]
}

/// The texels of a picture of blocks of 4×4, row by row.
fn of_blocks<T: Copy + Default>(bytes: &[u8], size: usize, width: u32, height: u32, decode: impl Fn(&[u8], &mut [T; 16])) -> Vec<T> {
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

/// Colours of so many channels a texel: of one it is grey, and a fourth is left out.
fn rgb(values: impl Iterator<Item = f32>, channels: usize) -> Vec<[f32; 3]> {
    let values: Vec<f32> = values.collect();
    values.chunks_exact(channels).map(|t| if channels < 3 { [t[0]; 3] } else { [t[0], t[1], t[2]] }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of these pixels; words of the pixel format from its flags on.
    fn file(width: u32, height: u32, format: [u32; 7], dxgi: Option<u32>, pixels: &[u8]) -> Vec<u8> {
        let mut words = [0u32; 32];
        words[0] = u32::from_le_bytes(*b"DDS ");
        (words[1], words[3], words[4], words[19]) = (124, height, width, 32);
        words[20..27].copy_from_slice(&format);
        let mut bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
        bytes.extend(dxgi.into_iter().flat_map(|format| [format, 3, 0, 1, 0]).flat_map(u32::to_le_bytes));
        bytes.extend(pixels);
        bytes
    }

    fn coded(code: &[u8; 4]) -> [u32; 7] {
        [4, u32::from_le_bytes(*code), 0, 0, 0, 0, 0]
    }

    fn texels(file: &[u8]) -> Vec<[u8; 4]> {
        match decode(file).unwrap_or_else(|e| panic!("{e}")) {
            Surface::Bytes { texels, .. } => texels,
            Surface::Floats(_) => panic!("floats"),
        }
    }

    #[test]
    fn whole_pixels_are_cut_out_by_their_masks() {
        let bgra = [0x41, 0, 32, 0xff_0000, 0xff00, 0xff, 0xff00_0000];
        assert_eq!(texels(&file(2, 1, bgra, None, &[3, 2, 1, 9, 30, 20, 10, 90])), [[1, 2, 3, 9], [10, 20, 30, 90]]);
        let five_six_five = [0x40, 0, 16, 0xf800, 0x7e0, 0x1f, 0];
        assert_eq!(texels(&file(1, 1, five_six_five, None, &0xf81fu16.to_le_bytes())), [[255, 0, 255, 255]]);
        let grey = [0x2_0000, 0, 8, 0xff, 0, 0, 0];
        assert_eq!(texels(&file(1, 2, grey, None, &[7, 200])), [[7, 7, 7, 255], [200, 200, 200, 255]]);
        assert_eq!(texels(&file(1, 1, coded(b"DX10"), Some(28), &[1, 2, 3, 4])), [[1, 2, 3, 4]]);
    }

    #[test]
    fn blocks_fill_pictures_of_any_size() {
        // Two colours of 5, 6 and 5 bits, red and blue, and two bits a texel: the first row is red, the rest blue.
        let block = [0x00, 0xf8, 0x1f, 0x00, 0x00, 0x55, 0x55, 0x55];
        let found = texels(&file(5, 2, coded(b"DXT1"), None, &[block, block].concat()));
        let (red, blue) = ([255, 0, 0, 255], [0, 0, 255, 255]);
        assert_eq!(found, [[red; 5], [blue; 5]].concat());
        // Sharp alpha of 4 bits, here a third, in front of the same block.
        let with_alpha = texels(&file(1, 1, coded(b"DXT3"), None, &[[0x55; 8], block].concat()));
        assert_eq!(with_alpha, [[255, 0, 0, 0x55]]);
        // Both channels in the middle: the normal is +z.
        let middle = [128, 128, 0, 0, 0, 0, 0, 0];
        for code in [*b"ATI2", *b"BC5U"] {
            assert_eq!(texels(&file(1, 1, coded(&code), None, &[middle, middle].concat())), [[128, 128, 255, 255]]);
        }
        assert_eq!(texels(&file(1, 1, coded(b"DX10"), Some(80), &[77, 77, 0, 0, 0, 0, 0, 0])), [[77, 77, 77, 255]]);
    }

    #[test]
    fn floats_stay_floats() {
        let pixels: Vec<u8> = [4.0, 2.0, 0.5, 1.0].iter().flat_map(|v| f16::from_f32(*v).to_le_bytes()).collect();
        let expected = Surface::Floats(FloatPicture { width: 1, height: 1, texels: vec![[4.0, 2.0, 0.5]] });
        assert_eq!(decode(&file(1, 1, [4, 113, 0, 0, 0, 0, 0], None, &pixels)), Ok(expected));
    }

    #[test]
    fn damage_and_unknown_pixels_are_told() {
        let error = |bytes: &[u8]| decode(bytes).unwrap_err();
        assert!(error(b"DDS ").contains("cut short in its header"));
        assert!(error(&file(8, 8, coded(b"DXT1"), None, &[0; 8])).contains("with 8 bytes of them, expected 32"));
        assert!(error(&file(1 << 20, 1 << 20, coded(b"DXT1"), None, &[])).contains("pixels, expected at most"));
        assert!(error(&file(1, 1, coded(b"XYZ1"), None, &[0; 8])).contains("\"XYZ1\", which is not read; save it as PNG"));
        assert!(error(&file(1, 1, coded(b"DX10"), Some(200), &[0; 8])).contains("DXGI format 200"));
        assert!(error(&file(0, 4, coded(b"DXT1"), None, &[0; 8])).contains("0x4 pixels"));
    }
}
