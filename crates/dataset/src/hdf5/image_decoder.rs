//! Decoding an image, or only the chunks that a part of it touches.

use super::array::{Array, Elements};
use super::bytes::FileBytes;
use super::chunk_tree::ChunkSpan;
use super::chunks::unshuffle_into;
use super::image_map::{Codec, ImageMap};
use super::lz4;
use super::window::{Window, cut_shape};
use libdeflater::Decompressor;
use std::cell::RefCell;
use std::ops::Range;
use std::path::Path;

/// Reads the whole image; `None` when the file is no image in the known form, or is damaged.
pub(super) fn read_image(path: &Path) -> Option<Array> {
    let (mut source, map) = open(path)?;
    let [height, width, _] = map.axes();
    decode(&mut source, &map, Window { top: 0, left: 0, height, width })
}

/// The file and the positions of its chunks; `None` when it is no image in the known form.
pub(super) fn open(path: &Path) -> Option<(FileBytes, ImageMap)> {
    let mut source = FileBytes::open(path)?;
    let map = ImageMap::read(&mut source)?;
    Some((source, map))
}

/// Memory that is used again from image to image.
#[derive(Default)]
struct Scratch {
    inflate: Option<Decompressor>,
    /// Compressed bytes of a row of chunks.
    stored: Vec<u8>,
    /// The values of the chunks of one place, a channel chunk after the other.
    raw: Vec<u8>,
    /// Bytes of the block, shuffled.
    shuffled: Vec<u8>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// The elements of a window in the image; `None` when a chunk is damaged.
pub(super) fn decode(source: &mut FileBytes, map: &ImageMap, window: Window) -> Option<Array> {
    let channels = map.axes()[2];
    let mut values = Elements::zeroed(map.element, window.height * window.width * channels);
    if !values.is_empty() {
        let out = values.as_bytes_mut();
        SCRATCH.with_borrow_mut(|scratch| match map.element.size() {
            _ if map.codec == Codec::Stored => copy_run(source, map, window, &mut scratch.stored, out),
            1 => decode_sized::<1>(source, map, window, scratch, out),
            2 => decode_sized::<2>(source, map, window, scratch, out),
            4 => decode_sized::<4>(source, map, window, scratch, out),
            _ => decode_sized::<8>(source, map, window, scratch, out),
        })?;
    }
    Some(Array { shape: cut_shape(&map.shape, window), values })
}

/// [`decode`] of an image that is one run of bytes.
fn copy_run(source: &mut FileBytes, map: &ImageMap, window: Window, stored: &mut Vec<u8>, out: &mut [u8]) -> Option<()> {
    let [_, width, channels] = map.axes();
    let pixel = channels * map.element.size();
    let first = map.places[0].offset + ((window.top * width + window.left) * pixel) as u64;
    if window.width == width {
        return source.read(first, out);
    }
    let (row, run) = (width * pixel, window.width * pixel);
    let span = (window.height - 1) * row + run;
    if stored.len() < span {
        stored.resize(span, 0);
    }
    source.read(first, &mut stored[..span])?;
    out.chunks_exact_mut(run).zip(stored.chunks(row)).for_each(|(out, row)| out.copy_from_slice(&row[..run]));
    Some(())
}

/// [`decode`] for elements of `B` bytes.
fn decode_sized<const B: usize>(
    source: &mut FileBytes,
    map: &ImageMap,
    window: Window,
    scratch: &mut Scratch,
    out: &mut [u8],
) -> Option<()> {
    let ([_, columns, deep], [high, wide, _]) = (map.grid(), map.chunk);
    let touched = |first: usize, count: usize, side: usize| first / side..(first + count).div_ceil(side);
    let across = touched(window.left, window.width, wide);
    let out: &mut [[u8; B]] = bytemuck::cast_slice_mut(out);
    for row in touched(window.top, window.height, high) {
        let places = &map.places[(row * columns + across.start) * deep..(row * columns + across.end) * deep];
        let base = fetch(source, places, &mut scratch.stored)?;
        for (column, places) in across.clone().zip(places.chunks_exact(deep)) {
            inflate::<B>(map, places, base, scratch)?;
            let overlap = Overlap::of(map, window, [row, column]);
            overlap.copy::<B>(bytemuck::cast_slice(&scratch.raw), out);
        }
    }
    Some(())
}

/// Reads the bytes from the first to the last of `places` and gives the offset of the first; chunks of one row are adjacent in the files
/// that this is for. `None` when they are so far apart that reading them together gains nothing.
fn fetch(source: &mut FileBytes, places: &[ChunkSpan], stored: &mut Vec<u8>) -> Option<u64> {
    let first = places.iter().map(|place| place.offset).min()?;
    let last = places.iter().map(|place| place.offset + place.length as u64).max()?;
    let needed: usize = places.iter().map(|place| place.length).sum();
    let span = usize::try_from(last - first).ok().filter(|&span| span <= 4 * needed + (1 << 20))?;
    if stored.len() < span {
        stored.resize(span, 0);
    }
    source.read(first, &mut stored[..span])?;
    Some(first)
}

/// Decompresses the chunks of one place into `scratch.raw`, one channel chunk after the other.
fn inflate<const B: usize>(map: &ImageMap, places: &[ChunkSpan], base: u64, scratch: &mut Scratch) -> Option<()> {
    let bytes = map.chunk.iter().product::<usize>() * B;
    let Scratch { inflate, stored, raw, shuffled } = scratch;
    raw.resize(bytes * places.len(), 0);
    shuffled.resize(if map.shuffled { bytes } else { 0 }, 0);
    for (place, raw) in places.iter().zip(raw.chunks_exact_mut(bytes)) {
        let from = (place.offset - base) as usize;
        let stored = &stored[from..from + place.length];
        let target = if map.shuffled { &mut shuffled[..] } else { &mut *raw };
        let length = match map.codec {
            Codec::Deflate => inflate.get_or_insert_default().zlib_decompress(stored, target).ok()?,
            Codec::Lz4 => lz4::decompress(stored, target)?,
            Codec::Stored => return None,
        };
        if length != bytes {
            return None;
        }
        if map.shuffled {
            unshuffle_into::<B>(shuffled, raw);
        }
    }
    Some(())
}

/// The part of the window that the chunks of one place cover.
struct Overlap {
    /// Rows and columns within the chunk.
    rows: Range<usize>,
    columns: Range<usize>,
    /// Row and column in the window of the first of them.
    to: [usize; 2],
    /// Columns of the window.
    width: usize,
    /// Columns of the chunk.
    chunk_width: usize,
    /// Elements of a chunk.
    chunk_elements: usize,
    /// Channels of the image, and of a chunk.
    channels: [usize; 2],
}

impl Overlap {
    fn of(map: &ImageMap, window: Window, at: [usize; 2]) -> Self {
        let meet = |at: usize, side: usize, first: usize, count: usize| {
            let start = (at * side).max(first);
            let end = ((at + 1) * side).min(first + count);
            (start - at * side..end - at * side, start - first)
        };
        let (rows, top) = meet(at[0], map.chunk[0], window.top, window.height);
        let (columns, left) = meet(at[1], map.chunk[1], window.left, window.width);
        let channels = [map.axes()[2], map.chunk[2]];
        let (chunk_width, chunk_elements) = (map.chunk[1], map.chunk.iter().product());
        Self { rows, columns, to: [top, left], width: window.width, chunk_width, chunk_elements, channels }
    }

    /// Puts the values of the chunks, `raw`, to their places in the window, `out`.
    fn copy<const B: usize>(&self, raw: &[[u8; B]], out: &mut [[u8; B]]) {
        let [all, here] = self.channels;
        for (i, row) in self.rows.clone().enumerate() {
            let from = (row * self.chunk_width + self.columns.start) * here;
            let to = ((self.to[0] + i) * self.width + self.to[1]) * all;
            let target = &mut out[to..to + self.columns.len() * all];
            let source = |chunk: usize| &raw[chunk * self.chunk_elements + from..][..self.columns.len() * here];
            match (all, here) {
                _ if all == here => target.copy_from_slice(source(0)),
                (3, 1) => interleave(target, [source(0), source(1), source(2)]),
                _ => {
                    for first in (0..all).step_by(here) {
                        let (source, here) = (source(first / here), here.min(all - first));
                        for (target, source) in target.chunks_exact_mut(all).zip(source.chunks_exact(self.channels[1])) {
                            target[first..first + here].copy_from_slice(&source[..here]);
                        }
                    }
                }
            }
        }
    }
}

fn interleave<const B: usize>(target: &mut [[u8; B]], [a, b, c]: [&[[u8; B]]; 3]) {
    let (pixels, _) = target.as_chunks_mut::<3>();
    for (((pixel, a), b), c) in pixels.iter_mut().zip(a).zip(b).zip(c) {
        *pixel = [*a, *b, *c];
    }
}
