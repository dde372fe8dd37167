//! The voxels that a surface touches.

use super::overlap::OverlapTest;
use super::{BLOCK, VoxelGrid, for_each_cell};
use enfilade_math::{DVec3, Vec3};
use enfilade_parallel::each;
use std::sync::atomic::Ordering::Relaxed;

/// Boxes are grown by this many voxels in overlap tests, so that a wall on the border of two voxels occupies both whatever the
/// rounding of its vertices (10 µm at voxels of 0.1 m).
const SLACK: f64 = 1e-4;

/// Large triangles are tested against cubes of this many voxels per edge first.
const BRICK: i32 = 4;

impl VoxelGrid {
    /// Marks every voxel that a triangle touches as occupied.
    pub(crate) fn occupy(&self, triangles: &[[Vec3; 3]]) {
        each(triangles, |corners| self.occupy_triangle(corners.map(|p| self.cells(p.as_dvec3()))));
    }

    fn occupy_triangle(&self, corners: [DVec3; 3]) {
        // The cells of the box around the triangle, within the domain.
        let slack = DVec3::splat(SLACK);
        let lowest = (corners[0].min(corners[1]).min(corners[2]) - slack).floor().to_array();
        let highest = (corners[0].max(corners[1]).max(corners[2]) + slack).floor().to_array();
        let first: [i32; 3] = std::array::from_fn(|a| (lowest[a] as i32).max(self.low[a]));
        let last: [i32; 3] = std::array::from_fn(|a| (highest[a] as i32).min(self.high[a] - 1));
        if (0..3).any(|a| first[a] > last[a]) {
            return;
        }

        // A triangle within one voxel, the usual case, needs no test.
        if first == last && lowest == highest {
            return self.occupy_row(first, 1);
        }

        // Others are tested voxel by voxel, in bricks that are tested first when the triangle is large.
        let test = OverlapTest::new(corners);
        let touches = |cell: [i32; 3], edge: i32| {
            let half = DVec3::splat(0.5 * f64::from(edge));
            test.touches(DVec3::from(cell.map(f64::from)) + half, half + slack)
        };
        let is_small = (0..3).all(|a| last[a] - first[a] < BRICK);
        for_each_cell(first.map(|c| c / BRICK), last.map(|c| c / BRICK), |brick| {
            let corner = brick.map(|c| c * BRICK);
            if !is_small && !touches(corner, BRICK) {
                return;
            }
            let from: [i32; 3] = std::array::from_fn(|a| corner[a].max(first[a]));
            let to: [i32; 3] = std::array::from_fn(|a| (corner[a] + BRICK - 1).min(last[a]));
            for z in from[2]..=to[2] {
                for y in from[1]..=to[1] {
                    let bits = (from[0]..=to[0]).filter(|x| touches([*x, y, z], 1)).fold(0, |bits, x| bits | 1 << (x - from[0]));
                    self.occupy_row([from[0], y, z], bits);
                }
            }
        });
    }

    /// Occupies the cells of a row from `first` on whose bits are set; they belong to one block.
    pub(super) fn occupy_row(&self, first: [i32; 3], bits: u32) {
        if bits == 0 {
            return;
        }
        let (index, offset) = self.address(first);
        if let Some(block) = self.block_or_new(index) {
            let (word, bits) = (&block.occupied[offset / BLOCK], bits << (offset % BLOCK));
            if bits & !word.load(Relaxed) != 0 {
                word.fetch_or(bits, Relaxed);
            }
        }
    }
}
