//! Where chunks lie: B-trees of version 1 ("HDF5 File Format Specification Version 3.0", section III.A.1).

use super::bytes::{Source, u16_at, u32_at, u64_at, usize_at};
use super::image_map::DEEPEST;

/// Bytes of a chunk in the file.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    pub offset: u64,
    /// 0 where the chunk was never written.
    pub length: usize,
}

/// Enters all chunks of the tree at `root` into `places`, by row of the grid of chunks, last axis fastest. `chunk` and `grid` have the axes
/// of the array: elements of a chunk, and chunks. `None` when the file is damaged or a chunk leaves out filters.
pub(super) fn enter(source: &mut Source, root: u64, chunk: &[usize], grid: &[usize], places: &mut [Place]) -> Option<()> {
    walk(source, root, 0, chunk, grid, places)
}

/// Enters the chunks of a node, and of those below it.
fn walk(source: &mut Source, node: u64, depth: usize, chunk: &[usize], grid: &[usize], places: &mut [Place]) -> Option<()> {
    source.walk(node)?;
    let start = source.bytes(node, 24)?;
    if depth > DEEPEST || !start.starts_with(b"TREE\x01") {
        return None;
    }
    let (level, entries, key) = (start[5], usize::from(u16_at(&start, 6)?), 8 + 8 * (chunk.len() + 1));
    let body = source.bytes(node.checked_add(24)?, entries * (key + 8))?;
    for entry in body.chunks_exact(key + 8) {
        let child = u64_at(entry, key)?;
        if level > 0 {
            walk(source, child, depth + 1, chunk, grid, places)?;
            continue;
        }
        let (length, unfiltered) = (u32_at(entry, 0)? as usize, u32_at(entry, 4)?);
        let mut index = 0;
        for axis in 0..chunk.len() {
            let first = usize_at(entry, 8 + 8 * axis)?;
            if first % chunk[axis] != 0 || first / chunk[axis] >= grid[axis] {
                return None;
            }
            index = index * grid[axis] + first / chunk[axis];
        }
        if unfiltered != 0 || child.checked_add(length as u64).is_none_or(|end| end > source.length) {
            return None;
        }
        *places.get_mut(index)? = Place { offset: child, length };
    }
    Some(())
}
