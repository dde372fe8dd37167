//! An array of a volume, of any number of axes, and the boxes of elements that are read of it.

use super::bytes::FileBytes;
use super::chunk_tree::ChunkSpan;
use super::chunks::unshuffle;
use crate::DatasetError;
use libdeflater::Decompressor;
use std::path::PathBuf;

/// The address of what has no place in the file.
pub(super) const NOWHERE: u64 = u64::MAX;
/// Message about a file whose pieces do not fit each other: the fault, and what to do.
pub(super) const DAMAGED: &str = "the file is damaged or cut short; copy or download it again";

/// The numbers that an array has; little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Number {
    U8,
    U16,
    F32,
    F64,
    /// Addresses of other objects of the file.
    Reference,
}

/// An array of a [`Volume`](super::Volume).
#[derive(Debug)]
pub struct VolumeArray {
    pub(super) path: PathBuf,
    pub(super) base: u64,
    /// For messages.
    pub(super) name: String,
    /// Kind of its elements.
    pub number: Number,
    /// Length of each axis, slowest first.
    pub shape: Vec<usize>,
    pub(super) layout: Layout,
}

/// The storage of the elements in the file.
#[derive(Debug)]
pub(super) enum Layout {
    Compact(Vec<u8>),
    /// At this address.
    Contiguous(u64),
    Chunked {
        chunk: Vec<usize>,
        shuffled: bool,
        deflated: bool,
        /// By the chunk's place in the grid of chunks, last axis fastest; chunks that were never written have no length.
        places: Vec<ChunkSpan>,
    },
}

impl Number {
    /// Bytes per element.
    pub const fn size(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 => 2,
            Self::F32 => 4,
            Self::F64 | Self::Reference => 8,
        }
    }

    /// The type of a datatype message of version 1: unsigned, IEEE 754, or references to objects, little-endian.
    pub(super) fn of(body: &[u8]) -> Option<Self> {
        const TYPES: [(Number, &[u8]); 5] = [
            (Number::U8, b"\x10\0\0\0\x01\0\0\0\0\0\x08\0"),
            (Number::U16, b"\x10\0\0\0\x02\0\0\0\0\0\x10\0"),
            (Number::F32, b"\x11\x20\x1f\0\x04\0\0\0\0\0\x20\0\x17\x08\0\x17\x7f\0\0\0"),
            (Number::F64, b"\x11\x20\x3f\0\x08\0\0\0\0\0\x40\0\x34\x0b\0\x34\xff\x03\0\0"),
            (Number::Reference, b"\x17\0\0\0\x08\0\0\0"),
        ];
        TYPES.iter().find(|(_, pattern)| body.starts_with(pattern)).map(|&(number, _)| number)
    }
}

impl VolumeArray {
    /// Little-endian bytes of the elements from `first`, `count` along each axis, last axis fastest.
    ///
    /// # Errors
    /// When the file is damaged or cannot be read.
    ///
    /// # Panics
    /// When that leaves the array.
    pub fn read(&self, first: &[usize], count: &[usize]) -> Result<Vec<u8>, DatasetError> {
        read_box(self, first, count).ok_or_else(|| DatasetError::hdf5(&self.path, format!("array {:?}: {DAMAGED}", self.name)))
    }

    /// All its elements.
    ///
    /// # Errors
    /// As [`VolumeArray::read`].
    pub fn read_all(&self) -> Result<Vec<u8>, DatasetError> {
        self.read(&vec![0; self.shape.len()], &self.shape)
    }
}

/// Number of chunks along each axis.
pub(super) fn grid(shape: &[usize], chunk: &[usize]) -> Vec<usize> {
    shape.iter().zip(chunk).map(|(axis, side)| axis.div_ceil(*side)).collect()
}

/// The bytes of a box; `None` when the file is damaged.
///
/// # Panics
/// When the box leaves the array.
fn read_box(array: &VolumeArray, first: &[usize], count: &[usize]) -> Option<Vec<u8>> {
    let shape = &array.shape;
    let fits = first.len() == shape.len() && count.len() == shape.len();
    let inside = fits && (0..shape.len()).all(|axis| first[axis].checked_add(count[axis]).is_some_and(|end| end <= shape[axis]));
    assert!(inside, "a box from {first:?} of {count:?} leaves an array of {shape:?}");
    let size = array.number.size();
    let mut out = vec![0; count.iter().product::<usize>() * size];
    if out.is_empty() {
        return Some(out);
    }
    let open = || Some(FileBytes::open(&array.path)?.based_at(array.base));
    match &array.layout {
        Layout::Compact(bytes) if bytes.len() < shape.iter().product::<usize>() * size => return None,
        Layout::Compact(bytes) => {
            let (from, to) = (Region { shape, first }, Region { shape: count, first: &vec![0; count.len()] });
            copy(bytes, from, &mut out, to, count, size);
        }
        // What was never written is zero.
        Layout::Contiguous(NOWHERE) => {}
        Layout::Contiguous(address) => contiguous(&mut open()?, *address, array, first, count, &mut out)?,
        Layout::Chunked { .. } => chunked(&mut open()?, array, first, count, &mut out)?,
    }
    Some(out)
}

/// A part of an array: the array's shape, and where the part begins.
#[derive(Clone, Copy)]
struct Region<'a> {
    shape: &'a [usize],
    first: &'a [usize],
}

impl Region<'_> {
    /// Elements before the element at `place` of the part.
    fn element(self, place: &[usize]) -> usize {
        (0..place.len()).fold(0, |index, axis| index * self.shape[axis] + self.first[axis] + place[axis])
    }
}

/// Copies a box of `extent` elements of `size` bytes from one array into another.
fn copy(source: &[u8], from: Region, target: &mut [u8], to: Region, extent: &[usize], size: usize) {
    let run = extent.last().map_or(1, |&n| n) * size;
    let mut place = vec![0; extent.len()];
    loop {
        let (start, end) = (from.element(&place) * size, to.element(&place) * size);
        target[end..end + run].copy_from_slice(&source[start..start + run]);
        // The next place, in all axes but the last, along which a run goes.
        let next = (0..extent.len().saturating_sub(1)).rev().find(|&axis| place[axis] + 1 < extent[axis]);
        let Some(axis) = next else { return };
        place[axis] += 1;
        place[axis + 1..].fill(0);
    }
}

/// Reads the run of bytes from the box's first element to its last.
fn contiguous(source: &mut FileBytes, address: u64, array: &VolumeArray, first: &[usize], count: &[usize], out: &mut [u8]) -> Option<()> {
    let (size, whole, origin) = (array.number.size(), Region { shape: &array.shape, first }, vec![0; count.len()]);
    let last: Vec<usize> = count.iter().map(|count| count - 1).collect();
    let (start, end) = (whole.element(&origin), whole.element(&last) + 1);
    let run = source.bytes(address.checked_add((start * size) as u64)?, (end - start) * size)?;
    // The run begins at the box's first element, so positions are relative to the box.
    copy(&run, Region { shape: &array.shape, first: &origin }, out, Region { shape: count, first: &origin }, count, size);
    Some(())
}

/// Decodes the chunks that the box touches.
fn chunked(source: &mut FileBytes, array: &VolumeArray, first: &[usize], count: &[usize], out: &mut [u8]) -> Option<()> {
    let Layout::Chunked { chunk, shuffled, deflated, places } = &array.layout else { return None };
    let (size, axes) = (array.number.size(), count.len());
    let grid = grid(&array.shape, chunk);
    let touched: Vec<_> = (0..axes).map(|axis| first[axis] / chunk[axis]..(first[axis] + count[axis]).div_ceil(chunk[axis])).collect();
    let (mut inflate, mut raw) = (Decompressor::new(), vec![0; chunk.iter().product::<usize>() * size]);
    let mut at: Vec<usize> = touched.iter().map(|range| range.start).collect();
    loop {
        let place = places[(0..axes).fold(0, |index, axis| index * grid[axis] + at[axis])];
        if place.length > 0 {
            decode(source, place, &mut inflate, *deflated, shuffled.then_some(size), &mut raw)?;
            let start = |axis: usize| (at[axis] * chunk[axis]).max(first[axis]);
            let end = |axis: usize| ((at[axis] + 1) * chunk[axis]).min(first[axis] + count[axis]);
            let within: Vec<usize> = (0..axes).map(|axis| start(axis) - at[axis] * chunk[axis]).collect();
            let target: Vec<usize> = (0..axes).map(|axis| start(axis) - first[axis]).collect();
            let extent: Vec<usize> = (0..axes).map(|axis| end(axis) - start(axis)).collect();
            copy(&raw, Region { shape: chunk, first: &within }, out, Region { shape: count, first: &target }, &extent, size);
        }
        let Some(axis) = (0..axes).rev().find(|&axis| at[axis] + 1 < touched[axis].end) else { return Some(()) };
        at[axis] += 1;
        (axis + 1..axes).for_each(|axis| at[axis] = touched[axis].start);
    }
}

/// Fills `raw` with the elements of a chunk; `shuffled` is the size of an element where bytes are shuffled.
fn decode(
    source: &mut FileBytes,
    place: ChunkSpan,
    inflate: &mut Decompressor,
    deflated: bool,
    shuffled: Option<usize>,
    raw: &mut [u8],
) -> Option<()> {
    let stored = source.bytes(place.offset, place.length)?;
    let length = if deflated {
        inflate.zlib_decompress(&stored, raw).ok()?
    } else {
        raw.get_mut(..stored.len())?.copy_from_slice(&stored);
        stored.len()
    };
    if length != raw.len() {
        return None;
    }
    if let Some(size) = shuffled {
        let shuffled = raw.to_vec();
        unshuffle(&shuffled, size, raw);
    }
    Some(())
}
