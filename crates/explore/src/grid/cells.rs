//! Cubes of 4³ voxels, the unit in which space is judged to be inside or outside.

use super::{BLOCK, BLOCK_LEVEL, VoxelGrid};
use enfilade_math::DVec3;
use std::sync::atomic::Ordering::Relaxed;

/// Voxels along the edge of a cube.
const EDGE: usize = 4;
const PER_BLOCK: usize = BLOCK / EDGE;

/// The place of a cube in the grid, in cubes.
pub(crate) type Cube = [i32; 3];

impl VoxelGrid {
    /// The cube that contains a point.
    pub(crate) fn cube_at(&self, p: DVec3) -> Cube {
        (self.cells(p) / EDGE as f64).floor().to_array().map(|c| c as i32)
    }

    /// The middle of a cube, metres.
    pub(crate) fn cube_center(&self, cube: Cube) -> DVec3 {
        self.world((DVec3::from(cube.map(f64::from)) + 0.5) * EDGE as f64)
    }

    /// The free voxels of a cube: bit x + 4 y + 16 z.
    pub(crate) fn free_in(&self, cube: Cube) -> u64 {
        let Some((index, offset)) = self.cube_address(cube) else { return 0 };
        let Some(block) = self.block(index) else { return 0 };
        let row = |i: usize| u64::from((block.free[offset / BLOCK + i % EDGE + i / EDGE * BLOCK].load(Relaxed) >> (offset % BLOCK)) & 0xf);
        (0..EDGE * EDGE).fold(0, |bits, i| bits | (row(i) << (EDGE * i)))
    }

    /// The middle of a voxel of a cube, metres.
    pub(crate) fn voxel_center(&self, cube: Cube, bit: u32) -> DVec3 {
        let place = [bit % 4, bit / 4 % 4, bit / 16];
        let cell: [f64; 3] = std::array::from_fn(|a| f64::from(EDGE as i32 * cube[a]) + f64::from(place[a]) + 0.5);
        self.world(DVec3::from(cell))
    }

    /// Makes free voxels of a cube unknown again.
    pub(crate) fn forget(&self, cube: Cube, voxels: u64) {
        let Some((index, offset)) = self.cube_address(cube) else { return };
        let Some(block) = self.block(index) else { return };
        for i in 0..EDGE * EDGE {
            let bits = ((voxels >> (EDGE * i)) & 0xf) as u32;
            let bits = bits << (offset % BLOCK);
            let before = block.free[offset / BLOCK + i % EDGE + i / EDGE * BLOCK].fetch_and(!bits, Relaxed);
            block.free_count.fetch_sub((before & bits).count_ones(), Relaxed);
        }
    }

    /// All cubes with a free voxel, block by block.
    pub(crate) fn cubes(&self) -> impl Iterator<Item = Cube> + '_ {
        let seen = (0..self.blocks.len()).filter(|index| self.block(*index).is_some_and(|block| block.free_count.load(Relaxed) > 0));
        let places =
            |index| (0..PER_BLOCK.pow(3)).map(move |i| (index, [i % PER_BLOCK, i / PER_BLOCK % PER_BLOCK, i / PER_BLOCK / PER_BLOCK]));
        let cubes = seen.flat_map(places).map(|(index, place)| self.cell(index, place.map(|p| p * EDGE)).map(|c| c / EDGE as i32));
        cubes.filter(|cube| self.free_in(*cube) != 0)
    }

    /// The block of a cube and the place of its first voxel there; `None` outside the grid.
    fn cube_address(&self, cube: Cube) -> Option<(usize, usize)> {
        let inside = (0..3).all(|a| 0 <= cube[a] && cube[a] < (self.size[a] * PER_BLOCK) as i32);
        inside.then(|| self.address(cube.map(|c| c * EDGE as i32)))
    }
}

const _: () = assert!(BLOCK.is_multiple_of(EDGE) && BLOCK_LEVEL > 2);
