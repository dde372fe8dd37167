//! The header of a KTX 2 file: how its texels are stored, and where.

use super::super::layout::{BGRA, Layout, RGBA};
use ktx2::{ColorModel, KeyValueDataIterator, SupercompressionScheme, TransferFunction};

/// Position of the index of levels, and size of an entry, in bytes.
const LEVEL: usize = ktx2::Header::LENGTH;
const ENTRY: usize = 24;

/// The forms that are read, for messages.
const KNOWN: &str = "save it as PNG, or with texels of 8 or 16 bits, floats, BC1 to BC7, ETC1S or UASTC";

/// The storage of texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Texels {
    Plain(Layout),
    /// Blocks of 4×4 texels that refer to palettes of the whole file.
    Etc1s,
    /// Blocks of 4×4 texels, a subset of ASTC.
    Uastc,
}

/// The additional packing of a level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Packing {
    None,
    BasisLz,
    Zstandard,
    Zlib,
}

/// The content of the header.
#[derive(Debug)]
pub(super) struct Header {
    pub width: u32,
    pub height: u32,
    pub texels: Texels,
    pub packing: Packing,
    /// True when texels are in sRGB.
    pub srgb: bool,
    /// Content of Basis Universal's channels: 0 colours, 3 red, 4 green and so on.
    pub channels: [Option<u8>; 2],
    /// Pictures in the file: of all levels, layers and faces.
    pub pictures: u64,
    /// Position and length of global data, such as the palettes of ETC1S, in bytes.
    pub global: (u64, u64),
    /// True when the first row is the bottom.
    pub bottom_up: bool,
    /// Sources of red, green, blue and alpha: `r`, `g`, `b`, `a`, `0` or `1`.
    pub swizzle: Option<[u8; 4]>,
}

impl Header {
    /// Reads the header of a file that begins with the magic.
    ///
    /// # Errors
    /// When it is cut short, or its texels are not known, as the rest of a sentence.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, String> {
        let fixed = bytes.first_chunk().filter(|_| bytes.len() >= LEVEL + ENTRY);
        let fixed = fixed.ok_or("is a KTX2 that is cut short in its header; copy or export it again")?;
        let stored =
            ktx2::Header::from_bytes(fixed).map_err(|e| format!("is a KTX2 with a damaged header ({e}); copy or export it again"))?;
        let packing = match stored.supercompression_scheme {
            None => Packing::None,
            Some(SupercompressionScheme::BasisLZ) => Packing::BasisLz,
            Some(SupercompressionScheme::Zstandard) => Packing::Zstandard,
            Some(SupercompressionScheme::ZLIB) => Packing::Zlib,
            Some(other) => return Err(format!("is a KTX2 packed in scheme {}, which is not read; {KNOWN}", other.value())),
        };
        let [model, transfer, first, second] = descriptor(bytes, &stored.index);
        let [layers, faces, levels] = [stored.layer_count, stored.face_count, stored.level_count].map(|count| u64::from(count.max(1)));
        let note = |key: &str| metadata(bytes, &stored.index, key);
        let swizzle = note("KTXswizzle").and_then(|value| value.first_chunk::<4>().copied());
        Ok(Self {
            // Pictures of one row may state no height.
            width: stored.pixel_width,
            height: stored.pixel_height.max(1),
            texels: texels(stored.format.map_or(0, |format| format.value()), model.unwrap_or(0), packing)?,
            packing,
            srgb: transfer == Some(TransferFunction::SRGB.value()),
            channels: [first, second],
            pictures: layers.saturating_mul(faces).saturating_mul(levels),
            global: (stored.index.sgd_byte_offset, stored.index.sgd_byte_length),
            bottom_up: note("KTXorientation").is_some_and(|value| value.get(1) == Some(&b'u')),
            swizzle: swizzle.filter(|s| s != b"rgba" && s.iter().all(|c| b"rgba01".contains(c))),
        })
    }

    /// The bytes of the largest level.
    ///
    /// # Errors
    /// When they are not there, as the rest of a sentence.
    pub(super) fn level<'b>(&self, bytes: &'b [u8]) -> Result<&'b [u8], String> {
        let long = |at: usize| bytes.get(at..).and_then(<[u8]>::first_chunk).map_or(0, |b| u64::from_le_bytes(*b));
        let (start, length, found) = (long(LEVEL), long(LEVEL + 8), bytes.len());
        part(bytes, start, length)
            .ok_or_else(|| format!("is a KTX2 whose picture has bytes {start} to {start}+{length} of {found}: it is cut short or damaged"))
    }
}

/// Colour model, transfer function, and content of the first two channels, from the data format descriptor; `None` where it ends before
/// them.
///
/// The crate reads descriptors too, but refuses files whose descriptor is damaged where it does not count, and panics on some.
fn descriptor(bytes: &[u8], index: &ktx2::Index) -> [Option<u8>; 4] {
    let block = part(bytes, index.dfd_byte_offset.into(), index.dfd_byte_length.into()).unwrap_or_default();
    let byte = |at: usize| block.get(at).copied();
    let channel = |at: usize| byte(at + 3).map(|kind| kind & 15);
    [byte(12), byte(14), channel(28), channel(44)]
}

/// The storage of texels, by Vulkan's number of their format, the colour model if that is 0, and the packing.
fn texels(format: u32, model: u8, packing: Packing) -> Result<Texels, String> {
    let [etc1s, uastc] = [ColorModel::ETC1S, ColorModel::UASTC].map(|of| of.value() == model);
    match (format, model, packing) {
        (0, _, Packing::BasisLz) if etc1s => Ok(Texels::Etc1s),
        (0, _, Packing::None | Packing::Zstandard | Packing::Zlib) if uastc => Ok(Texels::Uastc),
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

/// The value of a key.
fn metadata<'b>(bytes: &'b [u8], index: &ktx2::Index, key: &str) -> Option<&'b [u8]> {
    let entries = part(bytes, index.kvd_byte_offset.into(), index.kvd_byte_length.into())?;
    KeyValueDataIterator::new(entries).find(|(found, _)| *found == key).map(|(_, value)| value)
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
