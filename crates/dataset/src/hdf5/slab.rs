//! Boxes of arrays of any number of axes.

use super::bytes::Source;
use super::chunk_tree::Place;
use super::chunks::unshuffle;
use super::volume::{Layout, NOWHERE, VolumeArray};
use libdeflater::Decompressor;

/// The bytes of a box; `None` when the file is damaged.
///
/// # Panics
/// When the box leaves the array.
pub(super) fn read(array: &VolumeArray, first: &[usize], count: &[usize]) -> Option<Vec<u8>> {
    let shape = &array.shape;
    let fits = first.len() == shape.len() && count.len() == shape.len();
    let inside = fits && (0..shape.len()).all(|axis| first[axis].checked_add(count[axis]).is_some_and(|end| end <= shape[axis]));
    assert!(inside, "a box from {first:?} of {count:?} leaves an array of {shape:?}");
    let size = array.number.size();
    let mut out = vec![0; count.iter().product::<usize>() * size];
    if out.is_empty() {
        return Some(out);
    }
    let open = || Some(Source::open(&array.path)?.based_at(array.base));
    match &array.layout {
        Layout::Compact(bytes) if bytes.len() < shape.iter().product::<usize>() * size => return None,
        Layout::Compact(bytes) => {
            let (from, to) = (Part { shape, first }, Part { shape: count, first: &vec![0; count.len()] });
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
struct Part<'a> {
    shape: &'a [usize],
    first: &'a [usize],
}

impl Part<'_> {
    /// Elements before the element at `place` of the part.
    fn element(self, place: &[usize]) -> usize {
        (0..place.len()).fold(0, |index, axis| index * self.shape[axis] + self.first[axis] + place[axis])
    }
}

/// Copies a box of `extent` elements of `size` bytes from one array into another.
fn copy(source: &[u8], from: Part, target: &mut [u8], to: Part, extent: &[usize], size: usize) {
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
fn contiguous(source: &mut Source, address: u64, array: &VolumeArray, first: &[usize], count: &[usize], out: &mut [u8]) -> Option<()> {
    let (size, whole, origin) = (array.number.size(), Part { shape: &array.shape, first }, vec![0; count.len()]);
    let last: Vec<usize> = count.iter().map(|count| count - 1).collect();
    let (start, end) = (whole.element(&origin), whole.element(&last) + 1);
    let run = source.bytes(address.checked_add((start * size) as u64)?, (end - start) * size)?;
    // The run begins at the box's first element, so that of the array's places the box's own remain.
    copy(&run, Part { shape: &array.shape, first: &origin }, out, Part { shape: count, first: &origin }, count, size);
    Some(())
}

/// Decodes the chunks that the box touches.
fn chunked(source: &mut Source, array: &VolumeArray, first: &[usize], count: &[usize], out: &mut [u8]) -> Option<()> {
    let Layout::Chunked { chunk, shuffled, deflated, places } = &array.layout else { return None };
    let (size, axes) = (array.number.size(), count.len());
    let grid: Vec<usize> = array.shape.iter().zip(chunk).map(|(axis, side)| axis.div_ceil(*side)).collect();
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
            copy(&raw, Part { shape: chunk, first: &within }, out, Part { shape: count, first: &target }, &extent, size);
        }
        let Some(axis) = (0..axes).rev().find(|&axis| at[axis] + 1 < touched[axis].end) else { return Some(()) };
        at[axis] += 1;
        (axis + 1..axes).for_each(|axis| at[axis] = touched[axis].start);
    }
}

/// Fills `raw` with the elements of a chunk; `shuffled` is the size of an element where bytes are shuffled.
fn decode(
    source: &mut Source,
    place: Place,
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
