//! Distances that a ray may leap without looking at voxels: a byte for every voxel of the blocks in which something is free.
//!
//! A voxel whose neighbours up to a distance of 1, 2, 4, 8 or 16 voxels along each axis are all known to be free has a leap of that
//! length: walking through them would change nothing. The field is a copy of what was known when it was last refreshed. Voxels freed
//! since then only lack leaps; nothing else about them is wrong.

use super::{BLOCK, BLOCK_LEVEL, ROWS, VOLUME, VoxelGrid};
use enfilade_math::DVec3;
use enfilade_parallel::map;
use std::sync::atomic::Ordering::Relaxed;

/// Codes of a byte. Leaps of 2^(code − [`FREE`] − 1) follow [`FREE`].
pub(super) const UNKNOWN: u8 = 0;
pub(super) const OCCUPIED: u8 = 1;
pub(super) const FREE: u8 = 2;

/// Voxels on each side of a block that are looked at.
const HALO: usize = 16;
/// Rows of the window around a block, and voxels in a row: 16 + 32 + 16.
const WINDOW: usize = 64;

/// No more blocks than this get leaps, enough for a cube of 400 voxels; rays walk step by step through the others. Beyond that,
/// keeping the field up to date would cost more than it saves.
const MAX_BLOCKS: usize = 2048;

pub(super) type Codes = [u8; VOLUME];

/// The field; empty before the first refresh.
#[derive(Default)]
pub(crate) struct Leaps {
    codes: Vec<Option<Box<Codes>>>,
    /// Free voxels of every block at the last refresh.
    free: Vec<u32>,
}

impl Leaps {
    /// Brings the field up to date where anything was freed.
    pub(crate) fn refresh(&mut self, grid: &VoxelGrid) {
        // Blocks in whose neighbourhood anything was freed since the last time.
        let free: Vec<u32> = grid.blocks.iter().map(|block| block.get().map_or(0, |b| b.free_count.load(Relaxed))).collect();
        self.codes.resize_with(grid.blocks.len(), || None);
        self.free.resize(grid.blocks.len(), 0);
        let changed = |index: usize| grid.around(index).into_iter().flatten().any(|other| free[other] != self.free[other]);
        let stale: Vec<usize> = (0..free.len()).filter(|&index| free[index] > 0 && changed(index)).collect();

        // Of those without a field yet, only as many as there is room for.
        let room = MAX_BLOCKS - self.codes.iter().flatten().count();
        let new = stale.iter().filter(|index| self.codes[**index].is_none()).take(room).count();
        let stale: Vec<usize> = stale
            .into_iter()
            .scan(new, |left, index| Some((index, self.codes[index].is_some() || std::mem::replace(left, left.saturating_sub(1)) > 0)))
            .filter_map(|(index, fits)| fits.then_some(index))
            .collect();

        // Their fields, from the grid.
        let made: Vec<Box<Codes>> = map(&stale, |&index| codes(grid, index));
        for (index, codes) in stale.into_iter().zip(made) {
            self.codes[index] = Some(codes);
        }
        self.free = free;
    }

    #[inline]
    pub(super) fn block(&self, index: usize) -> Option<&Codes> {
        self.codes.get(index)?.as_deref()
    }

    /// A parameter up to which all rays from `p` (in cells) within a cone pass only voxels that are known to be free, if they do so up
    /// to `from_t`. `tan` is the tangent of the cone's half angle around the unit vector `axis`.
    pub(crate) fn clear_until(&self, grid: &VoxelGrid, p: DVec3, axis: DVec3, tan: f64, from_t: f64) -> f64 {
        /// Well above rounding errors, in voxels.
        const MARGIN: f64 = 1e-3;
        /// Shorter leaps cost more than they save.
        const SHORTEST: f64 = 0.5;
        let spread = axis.abs().max_element() + tan;
        let mut t = from_t;
        loop {
            let cell = (p + axis * t).floor().to_array().map(|c| c as i32);
            if !grid.inside(cell) {
                return t;
            }
            let (index, offset) = grid.address(cell);
            let code = self.block(index).map_or(UNKNOWN, |codes| codes[offset]);
            if code <= FREE {
                return t;
            }
            let step = (leap(code) - t * tan - MARGIN) / spread;
            if step >= SHORTEST {
                t += step;
            } else {
                return t;
            }
        }
    }
}

/// The leap of a code above [`FREE`].
#[inline]
pub(super) fn leap(code: u8) -> f64 {
    f64::from(1u32 << (code - FREE - 1))
}

impl VoxelGrid {
    /// The 27 blocks around a block and itself, x fastest; `None` outside the grid.
    fn around(&self, index: usize) -> [Option<usize>; 27] {
        let place = [index % self.size[0], index / self.size[0] % self.size[1], index / self.size[0] / self.size[1]];
        std::array::from_fn(|i| {
            let shift = [i % 3, i / 3 % 3, i / 9];
            let mut other = [0; 3];
            for a in 0..3 {
                other[a] = (place[a] + shift[a]).checked_sub(1).filter(|c| *c < self.size[a])?;
            }
            Some((other[2] * self.size[1] + other[1]) * self.size[0] + other[0])
        })
    }
}

/// Rows of 64 voxels of the window, row y + 64 z.
type Window = [u64; WINDOW * WINDOW];

/// The codes of a block.
fn codes(grid: &VoxelGrid, index: usize) -> Box<Codes> {
    // Eight voxels' codes in one word: each pass adds to the bytes of those voxels that it is about.
    let mut sums = [0u64; VOLUME / 8];
    let mut window = free_window(grid, index);
    let mut spare = Box::new([0; WINDOW * WINDOW]);
    let block = grid.block(index);
    for row in 0..ROWS {
        let occupied = block.map_or(0, |b| b.occupied[row].load(Relaxed));
        add(&mut sums, row, occupied, OCCUPIED);
    }

    // A free voxel has the code FREE, and one more for every length of leap whose cube around it is free.
    add_center(&mut sums, &window, FREE);
    erode(&mut window, &mut spare, 1, true);
    add_center(&mut sums, &window, 1);
    for radius in [1, 2, 4, 8] {
        erode(&mut window, &mut spare, radius, false);
        add_center(&mut sums, &window, 1);
    }

    let mut codes = Box::new([UNKNOWN; VOLUME]);
    for (bytes, sum) in codes.chunks_exact_mut(8).zip(&sums) {
        bytes.copy_from_slice(&sum.to_le_bytes());
    }
    codes
}

/// The free bits of a block and of 16 voxels around it.
fn free_window(grid: &VoxelGrid, index: usize) -> Box<Window> {
    let blocks = grid.around(index).map(|other| other.and_then(|other| grid.block(other)));
    let mut window = Box::new([0; WINDOW * WINDOW]);
    for z in 0..WINDOW {
        for y in 0..WINDOW {
            // Half a block is skipped at the beginning of the neighbours.
            let (y_in, z_in) = (y + HALO, z + HALO);
            let row = y_in % BLOCK + z_in % BLOCK * BLOCK;
            let first = 3 * (y_in / BLOCK) + 9 * (z_in / BLOCK);
            let bits = |i: usize| blocks[first + i].map_or(0, |b| u64::from(b.free[row].load(Relaxed)));
            window[y + WINDOW * z] = (bits(0) >> HALO) | (bits(1) << HALO) | (bits(2) << (HALO + BLOCK));
        }
    }
    window
}

/// Keeps the bits whose neighbours `radius` away on both sides along each axis are set, and with `middle` only those set themselves.
///
/// With `middle` and a radius of 1 this is an erosion by one voxel. On bits that were eroded by `radius` before, the two sides overlap in
/// the middle, and without it this is an erosion by `radius` more.
fn erode(window: &mut Window, spare: &mut Window, radius: usize, middle: bool) {
    let keep = |w: u64| if middle { w } else { u64::MAX };
    for w in window.iter_mut() {
        *w = (*w << radius) & (*w >> radius) & keep(*w);
    }
    let last = window.len();
    for stride in [radius, radius * WINDOW] {
        spare.fill(0);
        for i in stride..last - stride {
            spare[i] = window[i - stride] & window[i + stride] & keep(window[i]);
        }
        window.copy_from_slice(spare);
    }
}

/// Adds `value` to the bytes of the voxels of the middle block whose bits are set in the window.
fn add_center(sums: &mut [u64; VOLUME / 8], window: &Window, value: u8) {
    for row in 0..ROWS {
        let (y, z) = (row % BLOCK + HALO, row / BLOCK + HALO);
        add(sums, row, (window[y + WINDOW * z] >> HALO) as u32, value);
    }
}

/// Adds `value` to the bytes of a row where its bits are set.
#[inline]
fn add(sums: &mut [u64; VOLUME / 8], row: usize, bits: u32, value: u8) {
    if bits == 0 {
        return;
    }
    for (byte, sum) in bits.to_le_bytes().into_iter().zip(&mut sums[row * BLOCK / 8..]) {
        *sum += SPREAD[byte as usize] * u64::from(value);
    }
}

/// The bits of a byte as bytes of 0 and 1.
static SPREAD: [u64; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut bit = 0;
        while bit < 8 {
            table[byte] |= ((byte as u64 >> bit) & 1) << (8 * bit);
            bit += 1;
        }
        byte += 1;
    }
    table
};

const _: () = assert!(BLOCK == 1 << BLOCK_LEVEL && HALO + BLOCK + HALO == WINDOW);
