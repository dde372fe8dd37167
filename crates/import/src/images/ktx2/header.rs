//! The header of a KTX 2 file: how its texels are stored, and where.

use super::super::layout::{BGRA, Layout, RGBA};

/// Bytes before the index of levels, and of an entry there.
const FIXED: usize = 80;

/// What is read, for messages.
const KNOWN: &str = "save it as PNG, or with texels of 8 or 16 bits, floats, BC1 to BC7, ETC1S or UASTC";

/// Colour models of the data format descriptor.
const MODEL_ETC1S: u8 = 163;
const MODEL_UASTC: u8 = 166;

/// How texels are stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Texels {
    Plain(Layout),
    /// Blocks of 4×4 texels that refer to palettes of the whole file.
    Etc1s,
    /// Blocks of 4×4 texels, a subset of ASTC.
    Uastc,
}

/// How a level is packed besides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Packing {
    None,
    BasisLz,
    Zstandard,
    Zlib,
}

/// What the header says.
#[derive(Debug)]
pub(super) struct Header {
    pub width: u32,
    pub height: u32,
    pub texels: Texels,
    pub packing: Packing,
    /// True when texels are in sRGB.
    pub srgb: bool,
    /// What Basis Universal's channels hold: 0 colours, 3 red, 4 green and the like.
    pub channels: [Option<u8>; 2],
    /// Pictures in the file: of all levels, layers and faces.
    pub pictures: u64,
    /// Where the palettes of ETC1S and the like lie.
    pub global: (u64, u64),
    /// True when the first row is the bottom.
    pub bottom_up: bool,
    /// What red, green, blue and alpha are read from: `r`, `g`, `b`, `a`, `0` or `1`.
    pub swizzle: Option<[u8; 4]>,
}

impl Header {
    /// Reads the header of a file that begins with the magic.
    ///
    /// # Errors
    /// When it is cut short, or its texels are not known, as the rest of a sentence.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, String> {
        if bytes.len() < FIXED + 24 {
            return Err("is a KTX2 that is cut short in its header; copy or export it again".into());
        }
        let word = |at: usize| bytes.get(at..).and_then(<[u8]>::first_chunk).map_or(0, |b| u32::from_le_bytes(*b));
        let long = |at: usize| bytes.get(at..).and_then(<[u8]>::first_chunk).map_or(0, |b| u64::from_le_bytes(*b));
        let descriptor = word(48) as usize;
        let [model, _, transfer, _] = word(descriptor.saturating_add(12)).to_le_bytes();
        let packing = match word(44) {
            0 => Packing::None,
            1 => Packing::BasisLz,
            2 => Packing::Zstandard,
            3 => Packing::Zlib,
            other => return Err(format!("is a KTX2 packed in scheme {other}, which is not read; {KNOWN}")),
        };
        let channel = |at: usize| Some((word(descriptor.saturating_add(at)) >> 24) as u8 & 15);
        let second = if word(52) >= 60 { channel(44) } else { None };
        let [layers, faces, levels] = [32, 36, 40].map(|at| u64::from(word(at).max(1)));
        let note = |key: &[u8]| metadata(bytes, word(56) as usize, word(60) as usize, key);
        let swizzle = note(b"KTXswizzle").and_then(|value| value.first_chunk::<4>().copied());
        Ok(Self {
            // Pictures of one row may state no height.
            width: word(20),
            height: word(24).max(1),
            texels: texels(word(12), model, packing)?,
            packing,
            srgb: transfer == 2,
            channels: [channel(28), second],
            pictures: layers.saturating_mul(faces).saturating_mul(levels),
            global: (long(64), long(72)),
            bottom_up: note(b"KTXorientation").is_some_and(|value| value.get(1) == Some(&b'u')),
            swizzle: swizzle.filter(|s| s != b"rgba" && s.iter().all(|c| b"rgba01".contains(c))),
        })
    }

    /// The bytes of the largest level.
    ///
    /// # Errors
    /// When they are not there, as the rest of a sentence.
    pub(super) fn level<'b>(&self, bytes: &'b [u8]) -> Result<&'b [u8], String> {
        let long = |at: usize| bytes.get(at..).and_then(<[u8]>::first_chunk).map_or(0, |b| u64::from_le_bytes(*b));
        part(bytes, long(FIXED), long(FIXED + 8)).filter(|_| self.width > 0).ok_or_else(|| {
            let (start, length, found) = (long(FIXED), long(FIXED + 8), bytes.len());
            format!("is a KTX2 whose picture has bytes {start} to {start}+{length} of {found}: it is cut short or damaged")
        })
    }
}

/// How texels are stored, by Vulkan's number of their format, the colour model where that is 0, and how they are packed.
fn texels(format: u32, model: u8, packing: Packing) -> Result<Texels, String> {
    match (format, model, packing) {
        (0, MODEL_ETC1S, Packing::BasisLz) => Ok(Texels::Etc1s),
        (0, MODEL_UASTC, Packing::None | Packing::Zstandard | Packing::Zlib) => Ok(Texels::Uastc),
        (0, ..) => Err(format!("is a KTX2 of colour model {model}, packed as {packing:?}, which is not read; {KNOWN}")),
        (_, _, Packing::BasisLz) => Err(format!("is a KTX2 of Vulkan's format {format} packed as BasisLZ; it is damaged")),
        _ => layout(format).map(Texels::Plain).ok_or_else(|| format!("is a KTX2 of Vulkan's format {format}, which is not read; {KNOWN}")),
    }
}

/// A part of a file, where it has that.
pub(super) fn part(bytes: &[u8], start: u64, length: u64) -> Option<&[u8]> {
    let end = start.checked_add(length)?;
    bytes.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?)
}

/// The value of a key: entries are the length, the key, a zero and the value, each at a multiple of four bytes.
fn metadata<'b>(bytes: &'b [u8], start: usize, length: usize, key: &[u8]) -> Option<&'b [u8]> {
    let mut rest = part(bytes, start as u64, length as u64)?;
    loop {
        let (length, behind) = rest.split_first_chunk::<4>()?;
        let length = u32::from_le_bytes(*length) as usize;
        let entry = behind.get(..length)?;
        if let Some(value) = entry.strip_prefix(key).and_then(|rest| rest.strip_prefix(b"\0")) {
            return Some(value);
        }
        rest = behind.get(length.next_multiple_of(4)..)?;
    }
}

/// The layout of texels by Vulkan's number of their format.
fn layout(format: u32) -> Option<Layout> {
    let masked = |bytes, masks| Layout::Masked { bytes, masks };
    Some(match format {
        // One channel is read as a grey.
        9 | 15 => masked(1, [0xff, 0xff, 0xff, 0]),
        16 | 22 => masked(2, [0xff, 0xff00, 0, 0]),
        23 | 29 => masked(3, [0xff, 0xff00, 0xff_0000, 0]),
        30 | 36 => masked(3, [0xff_0000, 0xff00, 0xff, 0]),
        37 | 43 => RGBA,
        44 | 50 => BGRA,
        70 => Layout::Unorm16(1),
        84 => Layout::Unorm16(3),
        91 => Layout::Unorm16(4),
        76 => Layout::Half(1),
        90 => Layout::Half(3),
        97 => Layout::Half(4),
        100 => Layout::Float(1),
        106 => Layout::Float(3),
        109 => Layout::Float(4),
        131..=134 => Layout::Bc1,
        135 | 136 => Layout::Bc2,
        137 | 138 => Layout::Bc3,
        139 | 140 => Layout::Bc4 { signed: format == 140 },
        141 | 142 => Layout::Bc5 { signed: format == 142 },
        143 | 144 => Layout::Bc6 { signed: format == 144 },
        145 | 146 => Layout::Bc7,
        _ => return None,
    })
}
