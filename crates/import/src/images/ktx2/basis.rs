//! Basis Universal's two forms of texels, by `basisu`.
//!
//! Only the parts of that library that unpack blocks are called: its tables for the formats of graphics cards do not come along.

use super::super::layout::{normal, of_blocks};
use super::header::{Header, part};
use basisu::basislz::etc1s::Etc1sTranscoder;
use basisu::uastc::unpack::unpack_uastc;
use std::panic::catch_unwind;

/// Content of a channel of ETC1S.
const ETC1S_RED: u8 = 3;
const ETC1S_GREEN: u8 = 4;

/// Content of the channels of UASTC.
const UASTC_RED_AND_ALPHA: u8 = 5;
const UASTC_RED_AND_GREEN: u8 = 6;

/// Bytes of the header of the palettes, and of each picture's entry behind it.
const PALETTES: usize = 20;
const PICTURE: usize = 20;

/// The texels of a level of UASTC.
///
/// # Errors
/// When a block makes no sense, as the rest of a sentence.
pub(super) fn uastc(level: &[u8], header: &Header) -> Result<Vec<[u8; 4]>, String> {
    let broken = std::cell::Cell::new(false);
    let block = |bytes: &[u8], out: &mut [[u8; 4]; 16]| {
        let bytes = bytes.first_chunk::<16>();
        match bytes.and_then(|bytes| unpack_uastc(bytes, header.srgb)) {
            Some(colors) => *out = colors.map(|color| color.c),
            None => broken.set(true),
        }
    };
    let mut texels = of_blocks(level, 16, header.width, header.height, block);
    if broken.get() {
        return Err("is a KTX2 with a block that is not UASTC; it is damaged, so save it again".into());
    }
    match header.channels[0] {
        Some(UASTC_RED_AND_ALPHA) => texels.iter_mut().for_each(|t| *t = normal([t[0], t[3]])),
        Some(UASTC_RED_AND_GREEN) => texels.iter_mut().for_each(|t| *t = normal([t[0], t[1]])),
        _ => {}
    }
    Ok(texels)
}

/// The texels of a level of ETC1S, whose palettes are elsewhere in the file.
///
/// # Errors
/// When something is damaged, as the rest of a sentence.
pub(super) fn etc1s(file: &[u8], level: &[u8], header: &Header) -> Result<Vec<[u8; 4]>, String> {
    let damaged = || "is a KTX2 of ETC1S whose palettes or blocks are damaged; copy or export it again".to_string();
    // The library relies on some properties of a file without checking, such as sums within 32 bits.
    let texels = catch_unwind(|| try_etc1s(file, level, header)).ok().flatten().ok_or_else(damaged)?;
    let mut texels: Vec<[u8; 4]> = texels.as_chunks::<4>().0.to_vec();
    if let (Some(ETC1S_RED), Some(ETC1S_GREEN)) = header.channels.into() {
        texels.iter_mut().for_each(|t| *t = normal([t[0], t[3]]));
    }
    Ok(texels)
}

/// Red, green, blue and alpha of all texels; `None` for damage.
fn try_etc1s(file: &[u8], level: &[u8], header: &Header) -> Option<Vec<u8>> {
    let global = part(file, header.global.0, header.global.1)?;
    let word = |at: usize| global.get(at..).and_then(<[u8]>::first_chunk).map(|b| u32::from_le_bytes(*b));
    let counts = word(0)?;
    let [endpoints, selectors, tables] = [word(4)?, word(8)?, word(12)?].map(|length| length as usize);
    let entries = usize::try_from(header.pictures.checked_mul(PICTURE as u64)?).ok()?;
    let (endpoints, rest) = global.get(PALETTES.checked_add(entries)?..)?.split_at_checked(endpoints)?;
    let (selectors, rest) = rest.split_at_checked(selectors)?;
    let mut transcoder = Etc1sTranscoder::new();
    let is_read = transcoder.decode_palettes(counts & 0xffff, endpoints, counts >> 16, selectors);
    if !is_read || !transcoder.decode_tables(rest.get(..tables)?) {
        return None;
    }
    let slice = |at: usize| part(level, word(at)?.into(), word(at + 4)?.into());
    let (color, alpha) = (slice(PALETTES + 4)?, slice(PALETTES + 12)?);
    let (width, height) = (header.width, header.height);
    let (across, down) = (width.div_ceil(4), height.div_ceil(4));
    let mut texels = vec![0; 4 * width as usize * height as usize];
    if header.channels[1].is_none() || alpha.is_empty() {
        transcoder.transcode_slice_rgba32(color, across, down, width, height, None, &mut texels)?;
    } else {
        transcoder.transcode_image_rgba32(color, alpha, across, down, width, height, None, &mut texels)?;
    }
    Some(texels)
}
