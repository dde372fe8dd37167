//! TIFF of floating-point numbers, of which `image` reads colours alone, of palettes, and of grey with alpha; all other TIFF is left to it.

use super::float_picture::{FloatPicture, check_size};
use std::io::Cursor;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

/// The number for floats in the tag of the sample format.
const FLOATS: u16 = 3;
/// The number for channels that are stored one after the other.
const PLANAR: u16 = 2;

/// The tag of what colours mean, and its values for grey from black on and for palettes (TIFF 6.0, pages 20 and 23).
const PHOTOMETRIC: u16 = 262;
const FROM_BLACK: u8 = 1;
const PALETTE: u16 = 3;

/// Width, height, and texels row by row.
pub(super) type Texels = (u32, u32, Vec<[u8; 4]>);

/// Width, height and texels of the first picture of a file if it has a palette or is grey with alpha, of eight bits a channel or fewer;
/// `None` of other files.
///
/// # Errors
/// As [`decode_floats`].
pub(super) fn decode_others(bytes: &[u8]) -> Result<Option<Texels>, String> {
    let undecodable = |e: TiffError| format!("cannot be decoded ({e})");
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(undecodable)?;
    let mut tag = |tag| decoder.find_tag_unsigned::<u16>(tag).map_err(undecodable);
    let (photometric, channels) = (tag(Tag::PhotometricInterpretation)?, tag(Tag::SamplesPerPixel)?.unwrap_or(1));
    let planes = tag(Tag::PlanarConfiguration)?;
    let bits = decoder.find_tag_unsigned_vec::<u16>(Tag::BitsPerSample).map_err(undecodable)?.unwrap_or_default();
    let bits = usize::from(bits.first().copied().unwrap_or(1));
    let map = decoder.find_tag_unsigned_vec::<u16>(Tag::ColorMap).map_err(undecodable)?;
    let map = map.filter(|map| photometric == Some(PALETTE) && channels == 1 && matches!(bits, 1 | 2 | 4 | 8) && map.len() == 3 << bits);
    let is_grey_with_alpha = photometric == Some(u16::from(FROM_BLACK)) && (channels, bits) == (2, 8) && planes != Some(PLANAR);
    if map.is_none() && !is_grey_with_alpha {
        return Ok(None);
    }
    // The library reads no indices of palettes, but it reads the same numbers as greys.
    let grey = map.as_ref().and_then(|_| as_grey(bytes));
    let mut decoder = Decoder::new(Cursor::new(grey.as_deref().unwrap_or(bytes))).map_err(undecodable)?;
    let (width, height) = decoder.dimensions().map_err(undecodable)?;
    check_size(width, height)?;
    let DecodingResult::U8(values) = decoder.read_image().map_err(undecodable)? else { return Ok(None) };
    let row_bytes = (width as usize * usize::from(channels) * bits).div_ceil(8).max(1);
    if values.len() != row_bytes * height as usize {
        return Err(format!("has {} bytes for {width}x{height} pixels of {bits} bits; it is damaged", values.len()));
    }
    let Some(map) = map else {
        return Ok(Some((width, height, values.chunks_exact(2).map(|t| [t[0], t[0], t[0], t[1]]).collect())));
    };
    let entry = |i: usize| [0, 1, 2].map(|channel| (map[(channel << bits) + i] >> 8) as u8);
    let texel = |row: &[u8], x: usize| {
        let at = x * bits;
        let [r, g, b] = entry(usize::from(row[at / 8] >> (8 - bits - at % 8)) & ((1 << bits) - 1));
        [r, g, b, u8::MAX]
    };
    let texels = values.chunks_exact(row_bytes).flat_map(|row| (0..width as usize).map(move |x| texel(row, x))).collect();
    Ok(Some((width, height, texels)))
}

/// The file with its first picture declared grey; `None` of BigTIFF.
fn as_grey(bytes: &[u8]) -> Option<Vec<u8>> {
    let is_little = bytes.starts_with(b"II*\0");
    let number = |at: usize, len: usize| -> Option<usize> {
        let digits = bytes.get(at..at.checked_add(len)?)?.iter();
        let join = |all: usize, digit: &u8| (all << 8) | usize::from(*digit);
        Some(if is_little { digits.rev().fold(0, join) } else { digits.fold(0, join) })
    };
    let list = number(4, 4).filter(|_| is_little || bytes.starts_with(b"MM\0*"))?;
    let mut entries = (0..number(list, 2)?).map(|i| list + 2 + 12 * i);
    let at = entries.find(|at| number(*at, 2) == Some(usize::from(PHOTOMETRIC)))? + 8;
    let mut grey = bytes.to_vec();
    *grey.get_mut(if is_little { at } else { at + 1 })? = FROM_BLACK;
    Some(grey)
}

/// The first picture of a file; `None` where its numbers are whole.
///
/// # Errors
/// The fault, as the rest of a sentence that begins with its name.
pub(super) fn decode_floats(bytes: &[u8]) -> Result<Option<FloatPicture>, String> {
    let undecodable = |e: TiffError| format!("cannot be decoded ({e})");
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(undecodable)?;
    let formats = decoder.find_tag_unsigned_vec::<u16>(Tag::SampleFormat).map_err(undecodable)?;
    if formats.is_none_or(|formats| formats.first() != Some(&FLOATS)) {
        return Ok(None);
    }
    let (width, height) = decoder.dimensions().map_err(undecodable)?;
    check_size(width, height)?;
    let channels = match decoder.colortype().map_err(undecodable)? {
        ColorType::Gray(_) => 1,
        ColorType::GrayA(_) => 2,
        ColorType::RGB(_) => 3,
        ColorType::RGBA(_) => 4,
        other => return Err(format!("has floating-point channels of the kind {other:?}, which are not read; save it as RGB")),
    };
    let planes = decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration).map_err(undecodable)?;
    if channels > 1 && planes == Some(PLANAR) {
        return Err("has its channels one after the other, which is not read; save it with interleaved channels".into());
    }
    let values: Vec<f32> = match decoder.read_image().map_err(undecodable)? {
        DecodingResult::F16(values) => values.into_iter().map(half::f16::to_f32).collect(),
        DecodingResult::F32(values) => values,
        DecodingResult::F64(values) => values.into_iter().map(|v| v as f32).collect(),
        _ => return Err("has floating-point numbers of a size that is not read; save it with 32 bits".into()),
    };
    if values.len() != width as usize * height as usize * channels {
        return Err(format!("has {} numbers for {width}x{height} pixels of {channels} channels; it is damaged", values.len()));
    }
    let texels = values.chunks_exact(channels).map(|t| if channels < 3 { [t[0]; 3] } else { [t[0], t[1], t[2]] }).collect();
    Ok(Some(FloatPicture { width, height, texels }))
}
