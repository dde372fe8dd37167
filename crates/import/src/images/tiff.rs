//! TIFF of floating-point numbers, of which `image` reads colours alone; all other TIFF is left to it.

use super::float_picture::{FloatPicture, check_size};
use std::io::Cursor;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

/// The number for floats in the tag of the sample format.
const FLOATS: u16 = 3;
/// The number for channels that are stored one after the other.
const PLANAR: u16 = 2;

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
