//! The grid that carving works on: two bits, occupied and free, for every voxel of a box in the octree's key space.

mod cells;
mod count;
mod leaps;
mod occupy;
mod overlap;
mod sample;
mod walk;

#[cfg(test)]
mod tests;

pub(crate) use cells::Cube;
pub(crate) use leaps::Leaps;
pub(crate) use walk::WalkEnd;

use crate::ExploreError;
use enfilade_geometry::{OccupancyTree, TREE_LEVELS, Voxel, VoxelKey};
use enfilade_math::DVec3;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering::Relaxed};

/// Voxels along the edge of a block: a row of them is one machine word per state.
const BLOCK: usize = 1 << BLOCK_LEVEL;
const BLOCK_LEVEL: u32 = 5;
/// Rows in a block.
const ROWS: usize = BLOCK * BLOCK;
/// Voxels in a block.
const VOLUME: usize = ROWS * BLOCK;

/// A grid that needs more memory than this is refused, bytes.
const MAX_BYTES: u64 = 4 << 30;

/// An octree that needs more than this is refused, bytes; while it grows it may for a moment take three times as much.
const MAX_TREE_BYTES: u64 = 2 << 30;

/// The grid. Blocks of 32³ voxels come into being when a surface or a ray first touches them, so that a large domain costs what is
/// seen of it; they are aligned to multiples of 32 keys, so that each is a node of the octree. Bits are only ever added, in any
/// order and from any thread, so the result does not depend on either.
pub(crate) struct VoxelGrid {
    voxel_m: f64,
    /// Key of the first voxel of the first block.
    base: [u16; 3],
    /// The domain in cells (voxels counted from `base`): first, and one past the last.
    low: [i32; 3],
    high: [i32; 3],
    /// Blocks along each axis.
    size: [usize; 3],
    blocks: Vec<OnceLock<Box<Block>>>,
    /// Blocks that exist.
    allocated: AtomicU64,
    /// A block was wanted that the memory limit forbids.
    overflow: AtomicBool,
}

/// Bit x of row y + 32 z belongs to the voxel (x, y, z) of the block.
struct Block {
    occupied: [AtomicU32; ROWS],
    free: [AtomicU32; ROWS],
    free_count: AtomicU32,
}

impl Block {
    fn new() -> Box<Self> {
        let unset = || std::array::from_fn(|_| AtomicU32::new(0));
        Box::new(Self { occupied: unset(), free: unset(), free_count: AtomicU32::new(0) })
    }
}

impl VoxelGrid {
    /// An unknown grid over the voxels that overlap the box from `min` to `max`.
    pub(crate) fn new(min: DVec3, max: DVec3, voxel_m: f64) -> Result<Self, ExploreError> {
        let (Some(first), Some(last)) = (VoxelKey::at(min, voxel_m), VoxelKey::at(max, voxel_m)) else {
            return Err(ExploreError::OutOfKeySpace { min, max, voxel_m });
        };
        let base = first.0.map(|k| k - k % BLOCK as u16);
        let low = std::array::from_fn(|a| i32::from(first.0[a] - base[a]));
        let high: [i32; 3] = std::array::from_fn(|a| i32::from(last.0[a] - base[a]) + 1);
        let size = high.map(|h| (h as usize).div_ceil(BLOCK));
        let count: u64 = size.iter().map(|n| *n as u64).product();
        let bytes = count * size_of::<OnceLock<Box<Block>>>() as u64;
        if bytes > MAX_BYTES / 4 {
            return Err(too_many_voxels(count, voxel_m, bytes));
        }
        let blocks = (0..count).map(|_| OnceLock::new()).collect();
        Ok(Self { voxel_m, base, low, high, size, blocks, allocated: AtomicU64::new(0), overflow: AtomicBool::new(false) })
    }

    /// Edge of a voxel, metres.
    pub(crate) fn voxel_m(&self) -> f64 {
        self.voxel_m
    }

    /// World coordinates in cells.
    #[inline]
    pub(crate) fn cells(&self, p: DVec3) -> DVec3 {
        p / self.voxel_m - DVec3::from(self.base.map(|k| f64::from(k) - f64::from(1 << (TREE_LEVELS - 1))))
    }

    /// Cells in world coordinates.
    fn world(&self, cells: DVec3) -> DVec3 {
        (cells + DVec3::from(self.base.map(|k| f64::from(k) - f64::from(1 << (TREE_LEVELS - 1))))) * self.voxel_m
    }

    #[inline]
    fn inside(&self, cell: [i32; 3]) -> bool {
        (0..3).all(|a| self.low[a] <= cell[a] && cell[a] < self.high[a])
    }

    /// The index of a cell's block, and its offset there: five bits each for x, y and z.
    #[inline]
    fn address(&self, cell: [i32; 3]) -> (usize, usize) {
        let [x, y, z] = cell.map(|c| c as usize);
        let index = ((z / BLOCK) * self.size[1] + y / BLOCK) * self.size[0] + x / BLOCK;
        (index, (x % BLOCK) | ((y % BLOCK) << BLOCK_LEVEL) | ((z % BLOCK) << (2 * BLOCK_LEVEL)))
    }

    #[inline]
    fn block(&self, index: usize) -> Option<&Block> {
        self.blocks[index].get().map(|block| &**block)
    }

    /// The block, made when it is not there; `None` beyond the memory limit, which [`VoxelGrid::check_memory`] reports.
    #[inline]
    fn block_or_new(&self, index: usize) -> Option<&Block> {
        match self.blocks[index].get() {
            Some(block) => Some(block),
            None => self.new_block(index),
        }
    }

    #[cold]
    fn new_block(&self, index: usize) -> Option<&Block> {
        if self.bytes() > MAX_BYTES {
            self.overflow.store(true, Relaxed);
            return None;
        }
        Some(self.blocks[index].get_or_init(|| {
            self.allocated.fetch_add(1, Relaxed);
            Block::new()
        }))
    }

    /// Memory in use, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.allocated.load(Relaxed) * size_of::<Block>() as u64 + self.blocks.len() as u64 * size_of::<OnceLock<Box<Block>>>() as u64
    }

    /// # Errors
    /// [`ExploreError::TooManyVoxels`] when a block could not be made; the grid is then incomplete.
    pub(crate) fn check_memory(&self) -> Result<(), ExploreError> {
        if self.overflow.load(Relaxed) { Err(too_many_voxels(self.allocated.load(Relaxed), self.voxel_m, self.bytes())) } else { Ok(()) }
    }

    /// Is the point of the world in the domain?
    pub(crate) fn contains(&self, p: DVec3) -> bool {
        self.inside(self.cells(p).floor().to_array().map(|c| c as i32))
    }

    /// The state at a point of the world; unknown outside the domain.
    pub(crate) fn state(&self, p: DVec3) -> Voxel {
        let cell = self.cells(p).floor().to_array().map(|c| c as i32);
        if self.inside(cell) { self.state_of(cell) } else { Voxel::Unknown }
    }

    /// The state of a cell of the domain.
    fn state_of(&self, cell: [i32; 3]) -> Voxel {
        let (index, offset) = self.address(cell);
        let Some(block) = self.block(index) else { return Voxel::Unknown };
        let has = |rows: &[AtomicU32; ROWS]| (rows[offset / BLOCK].load(Relaxed) >> (offset % BLOCK)) & 1 != 0;
        match (has(&block.occupied), has(&block.free)) {
            (true, _) => Voxel::Occupied,
            (false, true) => Voxel::Free,
            (false, false) => Voxel::Unknown,
        }
    }

    /// The octree with the same states, of voxels with edges of `resolution_m`.
    ///
    /// # Errors
    /// [`ExploreError::TooManyVoxels`] when it takes too much memory: rays far from where they start free single voxels here and there.
    pub(crate) fn to_tree(&self, resolution_m: f64) -> Result<OccupancyTree, ExploreError> {
        let tree = OccupancyTree::within_bytes(resolution_m, MAX_TREE_BYTES, |key, level| {
            let edge = 1i64 << level;
            let corner: [i64; 3] = std::array::from_fn(|a| i64::from(key.0[a]) - i64::from(self.base[a]));
            if (0..3).any(|a| corner[a] + edge <= 0 || corner[a] >= (self.size[a] * BLOCK) as i64) {
                return Some(Voxel::Unknown);
            }
            if level > BLOCK_LEVEL {
                return None;
            }
            let (index, offset) = self.address(corner.map(|c| c as i32));
            match self.block(index) {
                Some(block) => block.state_of_cube(offset, level),
                None => Some(Voxel::Unknown),
            }
        });
        tree.ok_or_else(|| too_many_voxels(self.allocated.load(Relaxed), self.voxel_m, self.bytes() + MAX_TREE_BYTES))
    }
}

impl Block {
    /// The state that all voxels of a cube of 2^`level` per edge have; `None` when they differ.
    fn state_of_cube(&self, offset: usize, level: u32) -> Option<Voxel> {
        let edge = 1usize << level;
        let mask = (u32::MAX >> (BLOCK - edge)) << (offset % BLOCK);
        let first = offset / BLOCK;
        let state = |row: usize| match (self.occupied[row].load(Relaxed) & mask, self.free[row].load(Relaxed) & mask) {
            (0, 0) => Some(Voxel::Unknown),
            (0, free) if free == mask => Some(Voxel::Free),
            (occupied, 0) if occupied == mask => Some(Voxel::Occupied),
            _ => None,
        };
        let all = state(first)?;
        (0..edge * edge).all(|i| state(first + i % edge + i / edge * BLOCK) == Some(all)).then_some(all)
    }
}

fn too_many_voxels(blocks: u64, voxel_m: f64, bytes: u64) -> ExploreError {
    ExploreError::TooManyVoxels { voxels: blocks * VOLUME as u64, voxel_m, mib: bytes >> 20, limit_mib: MAX_BYTES >> 20 }
}

fn for_each_cell(first: [i32; 3], last: [i32; 3], mut visit: impl FnMut([i32; 3])) {
    for z in first[2]..=last[2] {
        for y in first[1]..=last[1] {
            for x in first[0]..=last[0] {
                visit([x, y, z]);
            }
        }
    }
}
