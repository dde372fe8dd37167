//! Levels of KTX 2 that are packed by a general method.

use super::header::Packing;
use flate2::read::ZlibDecoder;
use ruzstd::decoding::StreamingDecoder;
use std::borrow::Cow;
use std::io::Read;

/// A level may not unpack to more bytes: as much as the other decoders of pictures take.
const MOST: u64 = 512 << 20;

/// The first `size` bytes of a level, which are its first picture.
///
/// # Errors
/// When it has fewer or is damaged, as the rest of a sentence.
pub(super) fn inflate(packing: Packing, level: &[u8], size: u64) -> Result<Cow<'_, [u8]>, String> {
    if size > MOST {
        return Err(format!("is a KTX2 of {size} bytes, expected at most {MOST}; make the picture smaller"));
    }
    let damaged = |e: &dyn std::fmt::Display| format!("is a KTX2 whose picture cannot be unpacked ({e}); it is damaged");
    let mut unpacked = Vec::new();
    match packing {
        Packing::Zstandard => {
            let decoder = StreamingDecoder::new(level).map_err(|e| damaged(&e))?;
            decoder.take(size).read_to_end(&mut unpacked).map_err(|e| damaged(&e))?;
        }
        Packing::Zlib => {
            ZlibDecoder::new(level).take(size).read_to_end(&mut unpacked).map_err(|e| damaged(&e))?;
        }
        Packing::None | Packing::BasisLz => {
            let whole = level.get(..size as usize).map(Cow::Borrowed);
            return whole.ok_or_else(|| format!("is a KTX2 with {} bytes of its picture, expected {size}: it is cut short", level.len()));
        }
    }
    match unpacked.len() as u64 == size {
        true => Ok(Cow::Owned(unpacked)),
        false => Err(format!("is a KTX2 whose picture unpacks to {} bytes, expected {size}; it is damaged", unpacked.len())),
    }
}
