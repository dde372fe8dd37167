//! Numbers about the free voxels, and random places among them.

use super::{BLOCK, Block, VoxelGrid};
use enfilade_geometry::VoxelKey;
use enfilade_math::{DVec3, Rng};
use enfilade_parallel::{flat_map, flat_map_up_to};
use std::sync::atomic::Ordering::Relaxed;

impl VoxelGrid {
    /// Number of free and of occupied voxels.
    pub(crate) fn counts(&self) -> (u64, u64) {
        let occupied = |block: &Block| block.occupied.iter().map(|row| u64::from(row.load(Relaxed).count_ones())).sum::<u64>();
        let counts = flat_map(&self.blocks, |block| block.get().map(|b| (u64::from(b.free_count.load(Relaxed)), occupied(b))));
        counts.into_iter().fold((0, 0), |a, b| (a.0 + b.0, a.1 + b.1))
    }

    /// Number of voxels in the domain.
    pub(crate) fn domain_voxels(&self) -> u64 {
        (0..3).map(|a| (self.high[a] - self.low[a]) as u64).product()
    }

    /// A point uniform in the free voxels; `None` when there are none.
    pub(crate) fn random_free(&self, rng: &mut Rng) -> Option<DVec3> {
        let counts: Vec<u64> = self.blocks.iter().map(|block| block.get().map_or(0, |b| b.free_count.load(Relaxed).into())).collect();
        let free: u64 = counts.iter().sum();
        if free == 0 {
            return None;
        }
        let mut rank = rng.below(free as usize) as u64;
        let (index, _) = counts.iter().enumerate().find(|(_, count)| take(&mut rank, **count))?;
        let rows = &self.block(index)?.free;
        let (row, bits) = rows.iter().map(|row| row.load(Relaxed)).enumerate().find(|(_, row)| take(&mut rank, row.count_ones().into()))?;
        let bit = (0..rank).fold(bits, |bits, _| bits & (bits - 1)).trailing_zeros() as usize;
        let cell = self.cell(index, [bit, row % BLOCK, row / BLOCK]);
        // Not quite at the voxel's faces, so that rounding cannot put the point into a neighbour.
        let jitter = DVec3::from([0; 3].map(|_| 0.01 + 0.98 * rng.next_f64()));
        Some(self.key(cell).corner(self.voxel_m) + self.voxel_m * jitter)
    }

    /// The first and the last free cell along each axis; `None` when there are none.
    pub(crate) fn free_bounds(&self) -> Option<(VoxelKey, VoxelKey)> {
        let bounds_of = |index: usize| {
            let block = self.block(index)?;
            let (mut low, mut high) = ([BLOCK; 3], [0; 3]);
            for (row, bits) in block.free.iter().enumerate() {
                let bits = bits.load(Relaxed);
                if bits != 0 {
                    let (first, last) = (bits.trailing_zeros() as usize, BLOCK - 1 - bits.leading_zeros() as usize);
                    let yz = [row % BLOCK, row / BLOCK];
                    low = [low[0].min(first), low[1].min(yz[0]), low[2].min(yz[1])];
                    high = [high[0].max(last), high[1].max(yz[0]), high[2].max(yz[1])];
                }
            }
            (low[0] < BLOCK).then(|| (self.cell(index, low), self.cell(index, high)))
        };
        let union = |a: ([i32; 3], [i32; 3]), b: ([i32; 3], [i32; 3])| {
            (std::array::from_fn(|i| a.0[i].min(b.0[i])), std::array::from_fn(|i| a.1[i].max(b.1[i])))
        };
        let bounds = flat_map_up_to(self.blocks.len(), bounds_of).into_iter().reduce(union)?;
        Some((self.key(bounds.0), self.key(bounds.1)))
    }

    /// The cell with this place in a block.
    pub(super) fn cell(&self, index: usize, place: [usize; 3]) -> [i32; 3] {
        let block = [index % self.size[0], index / self.size[0] % self.size[1], index / self.size[0] / self.size[1]];
        std::array::from_fn(|a| (BLOCK * block[a] + place[a]) as i32)
    }

    pub(super) fn key(&self, cell: [i32; 3]) -> VoxelKey {
        VoxelKey(std::array::from_fn(|a| self.base[a] + cell[a] as u16))
    }
}

/// Is the element of this rank among the next `count`? If not, the rank is lowered by them.
fn take(rank: &mut u64, count: u64) -> bool {
    let here = *rank < count;
    *rank -= if here { 0 } else { count };
    here
}
