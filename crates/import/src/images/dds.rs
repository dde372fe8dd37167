//! DirectDraw surfaces: the first picture of a file, whole or compressed in blocks (BC1 to BC7).
//!
//! The layout follows Microsoft's "Programming Guide for DDS". Of cube maps, arrays, volumes and smaller copies (mipmaps) the first and
//! largest picture is read.

use super::float_picture::check_size;
use super::layout::{BGRA, BGRX, Layout, RGBA, Surface};

/// The first bytes of every file.
pub(super) const MAGIC: &[u8] = b"DDS ";

/// Bytes of the magic and the header, and with the extension of Direct3D 10.
const HEADER: usize = 128;
const HEADER_10: usize = 148;

/// Decodes a file.
///
/// # Errors
/// The fault, as the rest of a sentence that begins with its name.
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

/// The storage of texels by the header, and their position in bytes.
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

#[cfg(test)]
mod tests {
    use super::super::float_picture::FloatPicture;
    use super::*;
    use half::f16;

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
