//! Positions of the chunks of an image in its file.
//!
//! This walks the one form of HDF5 that images have, Hypersim's and ours: superblock 0, one dataset named `dataset` in the root
//! group, an object header of version 1, and the values as one run or as filtered chunks in a B-tree of version 1 ("HDF5 File Format
//! Specification Version 3.0", sections II.A, III.A, III.C, IV.A). A file of any other form gives `None`, and the HDF5 library reads it.

use super::array::Element;
use super::bytes::{FileBytes, u16_at, u32_at, u64_at, usize_at};
use super::chunk_tree::{self, ChunkSpan};
use super::chunks::{grid, three_axes};

/// HDF5's number of the deflate filter.
pub(super) const DEFLATE: u16 = 1;
/// HDF5's number of the shuffle filter.
pub(super) const SHUFFLE: u16 = 2;
/// The HDF Group's registered number of the LZ4 filter.
pub(super) const LZ4: u16 = 32004;

/// Levels of a group's tree and pieces of a header beyond which a file is taken for damaged.
pub(super) const MAX_DEPTH: usize = 8;

/// Bytes that a chunk of an image takes at least in the tree: length, filters, three offsets and address.
const CHUNK_ENTRY: u64 = 40;

/// The compression of a chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Codec {
    /// Deflate in zlib's framing.
    Deflate,
    /// LZ4 in the framing of HDF5's registered filter.
    Lz4,
    /// Not at all: the image is one run of bytes, one chunk of its own size.
    Stored,
}

/// An image in its file.
pub(super) struct ImageMap {
    pub element: Element,
    /// Height, width and, if they are an axis of their own, channels.
    pub shape: Vec<usize>,
    /// Height, width and channels of a chunk.
    pub chunk: [usize; 3],
    pub shuffled: bool,
    pub codec: Codec,
    /// By row, column and channel of chunks, channels innermost; none is of length 0.
    pub places: Vec<ChunkSpan>,
}

impl ImageMap {
    /// Height, width and channels of the image.
    pub fn axes(&self) -> [usize; 3] {
        image_axes(&self.shape)
    }

    /// Rows, columns and channels of chunks.
    pub fn grid(&self) -> [usize; 3] {
        grid(self.axes(), self.chunk)
    }

    /// `None` when the file is anything but a whole image in the known form.
    pub fn read(source: &mut FileBytes) -> Option<Self> {
        let header = dataset_header(source)?;
        let mut found = Description::default();
        messages(source, header, &mut |kind, body| found.take(kind, body))?;
        let (shape, element) = (found.shape?, found.element?);
        if let (Some((offset, length)), None) = (found.run, &found.filters) {
            return Self::of_run(source, shape, element, offset, length);
        }
        let (tree, sides) = found.chunks?;
        let (shuffled, codec) = match found.filters?.as_slice() {
            [DEFLATE] => (false, Codec::Deflate),
            [SHUFFLE, DEFLATE] => (true, Codec::Deflate),
            [SHUFFLE, LZ4] => (true, Codec::Lz4),
            [LZ4] => (false, Codec::Lz4),
            _ => return None,
        };
        let known = matches!(shape.len(), 2 | 3) && sides.len() == shape.len() + 1 && sides.last() == Some(&element.size());
        let sides = &sides[..shape.len().min(sides.len())];
        let bytes = shape.iter().try_fold(element.size(), |n, &axis| n.checked_mul(axis))?;
        let possible = bytes > 0 && bytes as u64 <= source.max_inflated();
        if !known || !possible || sides.iter().zip(&shape).any(|(side, axis)| !(1..=*axis).contains(side)) {
            return None;
        }
        let (axes, chunk) = (shape.len(), image_axes(sides));
        let mut map = Self { element, shape, chunk, shuffled, codec, places: Vec::new() };
        let grid = map.grid();
        let chunks: usize = grid.iter().product();
        if chunks as u64 > source.length / CHUNK_ENTRY {
            return None;
        }
        map.places = vec![ChunkSpan::default(); chunks];
        chunk_tree::enter(source, tree, &chunk[..axes], &grid[..axes], &mut map.places)?;
        map.places.iter().all(|place| place.length > 0).then_some(map)
    }

    /// The map of an image that is one run of `length` bytes.
    fn of_run(source: &FileBytes, shape: Vec<usize>, element: Element, offset: u64, length: u64) -> Option<Self> {
        let bytes = shape.iter().try_fold(element.size(), |n, &axis| n.checked_mul(axis))?;
        let whole = bytes > 0 && bytes as u64 == length && offset.checked_add(length).is_some_and(|end| end <= source.length);
        let known = matches!(shape.len(), 2 | 3) && whole;
        let chunk = if known { image_axes(&shape) } else { return None };
        Some(Self { element, shape, chunk, shuffled: false, codec: Codec::Stored, places: vec![ChunkSpan { offset, length: bytes }] })
    }
}

/// Height, width and channels, of which there is one where they are no axis.
fn image_axes(shape: &[usize]) -> [usize; 3] {
    match *shape {
        [height, width] => [height, width, 1],
        _ => three_axes(shape),
    }
}

/// The address of the object header of `dataset`, the only thing in the root group.
fn dataset_header(source: &mut FileBytes) -> Option<u64> {
    let superblock = source.bytes(0, 96)?;
    // Superblock 0 with addresses and lengths of 8 bytes from the file's beginning, and the root group's table in the scratch pad.
    let known = superblock.starts_with(b"\x89HDF\r\n\x1a\n\x00") && superblock[13..15] == [8, 8] && u64_at(&superblock, 24)? == 0;
    let cut_short = u64_at(&superblock, 40)? > source.length;
    if !known || cut_short || u32_at(&superblock, 72)? != 1 {
        return None;
    }
    let (tree, heap) = (u64_at(&superblock, 80)?, u64_at(&superblock, 88)?);
    let root = source.bytes(tree, 40)?;
    if !root.starts_with(b"TREE\x00\x00\x01\x00") {
        return None;
    }
    let table = source.bytes(u64_at(&root, 32)?, 48)?;
    if !table.starts_with(b"SNOD\x01\x00\x01\x00") {
        return None;
    }
    let heap = source.bytes(heap, 32)?;
    let name = u64_at(&heap, 24)?.checked_add(u64_at(&table, 8)?)?;
    let named = heap.starts_with(b"HEAP") && source.bytes(name, 8)? == b"dataset\0";
    if named { u64_at(&table, 16) } else { None }
}

/// Hands the messages of an object header of version 1 to `take`; `None` as soon as that gives `None`.
pub(super) fn messages(source: &mut FileBytes, header: u64, take: &mut impl FnMut(u16, &[u8]) -> Option<()>) -> Option<()> {
    const CONTINUATION: u16 = 0x10;
    const SHARED: u8 = 2;
    let start = source.bytes(header, 16)?;
    if start[0] != 1 {
        return None;
    }
    let mut pieces = vec![(header + 16, u32_at(&start, 8)? as usize)];
    let mut next = 0;
    while let Some(&(offset, length)) = pieces.get(next) {
        if next > MAX_DEPTH || length as u64 > source.length {
            return None;
        }
        let piece = source.bytes(offset, length)?;
        let mut at = 0;
        while at + 8 <= piece.len() {
            let (kind, size) = (u16_at(&piece, at)?, usize::from(u16_at(&piece, at + 2)?));
            let body = piece.get(at + 8..at + 8 + size)?;
            match kind {
                _ if piece[at + 4] & SHARED != 0 => return None,
                CONTINUATION => pieces.push((u64_at(body, 0)?, usize_at(body, 8)?)),
                _ => take(kind, body)?,
            }
            at += 8 + size;
        }
        next += 1;
    }
    Some(())
}

/// Contents of the messages of the dataset's header.
#[derive(Default)]
struct Description {
    shape: Option<Vec<usize>>,
    element: Option<Element>,
    /// Address of the tree of chunks, and a chunk's sides with the size of an element behind them.
    chunks: Option<(u64, Vec<usize>)>,
    /// Address and bytes of values that are not in chunks.
    run: Option<(u64, u64)>,
    /// Numbers of the filters, in the order in which they are applied in writing.
    filters: Option<Vec<u16>>,
}

impl Description {
    fn take(&mut self, kind: u16, body: &[u8]) -> Option<()> {
        match kind {
            // Dataspace.
            0x01 => {
                let rank = usize::from(*body.get(1)?);
                self.shape = Some((0..rank).map(|axis| usize_at(body, 8 + 8 * axis)).collect::<Option<_>>().filter(|_| body[0] == 1)?);
            }
            // Datatype.
            0x03 => self.element = Some(element(body)?),
            // Data layout: version 3, one run.
            0x08 if body.starts_with(&[3, 1]) => self.run = Some((u64_at(body, 2)?, u64_at(body, 10)?)),
            // Data layout: version 3, chunked.
            0x08 => {
                let axes = usize::from(*body.get(2)?);
                let sides = (0..axes).map(|axis| u32_at(body, 11 + 4 * axis).map(|side| side as usize)).collect::<Option<_>>()?;
                self.chunks = Some((u64_at(body, 3)?, sides)).filter(|_| body[..2] == [3, 2]);
                self.chunks.as_ref()?;
            }
            // Filter pipeline.
            0x0b => self.filters = Some(filters(body)?),
            // External files.
            0x07 => return None,
            _ => {}
        }
        Some(())
    }
}

/// The element type of a datatype message of version 1: IEEE 754 or two's complement, little-endian.
fn element(body: &[u8]) -> Option<Element> {
    const TYPES: [(Element, &[u8]); 6] = [
        (Element::F16, b"\x11\x20\x0f\0\x02\0\0\0\0\0\x10\0\x0a\x05\0\x0a\x0f\0\0\0"),
        (Element::F32, b"\x11\x20\x1f\0\x04\0\0\0\0\0\x20\0\x17\x08\0\x17\x7f\0\0\0"),
        (Element::F64, b"\x11\x20\x3f\0\x08\0\0\0\0\0\x40\0\x34\x0b\0\x34\xff\x03\0\0"),
        (Element::I16, b"\x10\x08\0\0\x02\0\0\0\0\0\x10\0"),
        (Element::I64, b"\x10\x08\0\0\x08\0\0\0\0\0\x40\0"),
        (Element::U8, b"\x10\0\0\0\x01\0\0\0\0\0\x08\0"),
    ];
    TYPES.iter().find(|(_, pattern)| body.starts_with(pattern)).map(|&(element, _)| element)
}

/// The numbers of the filters in a message of version 1.
pub(super) fn filters(body: &[u8]) -> Option<Vec<u16>> {
    let count = *body.get(1)?;
    let mut at = 8;
    let mut found = Vec::new();
    for _ in 0..count {
        let name = usize::from(u16_at(body, at + 2)?).next_multiple_of(8);
        let values = usize::from(u16_at(body, at + 6)?).next_multiple_of(2);
        found.push(u16_at(body, at)?);
        at += 8 + name + 4 * values;
    }
    Some(found).filter(|_| body[0] == 1)
}
