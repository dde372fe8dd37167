//! Positions of chunks: B-trees of version 1 ("HDF5 File Format Specification Version 3.0", section III.A.1).

use super::bytes::{FileBytes, u16_at, u32_at, u64_at, usize_at};
use std::collections::HashSet;

/// Position and length of a chunk in the file, in bytes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ChunkSpan {
    pub offset: u64,
    /// 0 where the chunk was never written.
    pub length: usize,
}

/// Receives a chunk's index in the grid of chunks (row by row, last axis fastest), its position, and the filters that it leaves out, a bit
/// each. `None` ends the walk.
pub(super) type Take<'a> = dyn FnMut(usize, ChunkSpan, u32) -> Option<()> + 'a;

/// Writes the positions of all chunks of the tree at `root` into `places`, in the order of the grid of chunks (row by row, last axis
/// fastest). `chunk` and `grid` have the axes of the array: elements of a chunk, and chunks. `None` when the file is damaged or a chunk
/// leaves out filters.
pub(super) fn enter(source: &mut FileBytes, root: u64, chunk: &[usize], grid: &[usize], places: &mut [ChunkSpan]) -> Option<()> {
    walk(source, root, chunk, grid, &mut |index, place, left_out| {
        *places.get_mut(index).filter(|_| left_out == 0)? = place;
        Some(())
    })
}

/// Hands all chunks of the tree at `root` to `take`. `None` when `take` returned it, or the tree is damaged: it leads to something that is
/// no node of a lower level, or twice to the same node, or a chunk is outside of the array or the file.
pub(super) fn walk(source: &mut FileBytes, root: u64, chunk: &[usize], grid: &[usize], take: &mut Take<'_>) -> Option<()> {
    /// Above all levels, which are bytes.
    const ABOVE: u16 = 256;
    node(source, root, ABOVE, chunk, grid, take)
}

/// True when two entries of inner nodes, anywhere in `bytes`, lead to the same node: a reader that does not remember where it was takes
/// twice as long for each level below. How long entries are depends on the array's rank, which is not known here: every rank is tried.
pub(super) fn meet_again(bytes: &[u8]) -> bool {
    const MAX_AXES: usize = 32;
    const NODE: &[u8] = b"TREE\x01";
    let is_node = |address: usize| bytes.get(address..).is_some_and(|rest| rest.starts_with(NODE));
    let inner: Vec<usize> = (0..bytes.len().saturating_sub(24)).filter(|&at| is_node(at) && bytes[at + 5] > 0).collect();
    (1..=MAX_AXES).any(|axes| {
        let key = 8 + 8 * (axes + 1);
        let mut met = HashSet::new();
        inner.iter().any(|&at| {
            let entries = usize::from(u16_at(bytes, at + 6).unwrap_or(0));
            let children = (0..entries).map_while(|entry| usize_at(bytes, at + 24 + entry * (key + 8) + key));
            children.filter(|&child| is_node(child)).any(|child| !met.insert(child))
        })
    })
}

/// [`walk`] from the node at `address`, which is below that level.
fn node(source: &mut FileBytes, address: u64, above: u16, chunk: &[usize], grid: &[usize], take: &mut Take<'_>) -> Option<()> {
    source.walk(address)?;
    let start = source.bytes(address, 24)?;
    let level = u16::from(start[5]);
    if level >= above || !start.starts_with(b"TREE\x01") {
        return None;
    }
    let (entries, key) = (usize::from(u16_at(&start, 6)?), 8 + 8 * (chunk.len() + 1));
    let body = source.bytes(address.checked_add(24)?, entries * (key + 8))?;
    for entry in body.chunks_exact(key + 8) {
        let child = u64_at(entry, key)?;
        if level > 0 {
            node(source, child, level, chunk, grid, take)?;
            continue;
        }
        let (length, left_out) = (u32_at(entry, 0)? as usize, u32_at(entry, 4)?);
        let mut index = 0_usize;
        for axis in 0..chunk.len() {
            let first = usize_at(entry, 8 + 8 * axis)?;
            if first % chunk[axis] != 0 || first / chunk[axis] >= grid[axis] {
                return None;
            }
            // Where the grid has places for all chunks, this is less than their number.
            index = index.wrapping_mul(grid[axis]).wrapping_add(first / chunk[axis]);
        }
        if child.checked_add(length as u64).is_none_or(|end| end > source.length) {
            return None;
        }
        take(index, ChunkSpan { offset: child, length }, left_out)?;
    }
    Some(())
}
