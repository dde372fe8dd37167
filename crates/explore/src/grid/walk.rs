//! Walking along rays, voxel by voxel (Amanatides & Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing"), with leaps through
//! what is known to be free.

use super::leaps::{FREE, Leaps, OCCUPIED, UNKNOWN, leap};
use super::{BLOCK, BLOCK_LEVEL, VOLUME, VoxelGrid};
use enfilade_math::DVec3;
use std::sync::atomic::Ordering::Relaxed;

/// The end of a walk along a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WalkEnd {
    /// Before an occupied voxel, or in the voxel of the surface.
    Blocked,
    /// At the border of the domain.
    Left,
}

/// Leaps shorter than this take as long as the steps.
const MIN_LEAP: u8 = FREE + 2;

impl VoxelGrid {
    /// Frees every voxel along a ray from `p` (in cells) until the first occupied one, the one in which the ray ends or the end of the
    /// domain.
    ///
    /// The ray ends at the parameter that `end` gives (in voxels, if `direction` is a unit vector); it is asked at most once, and only
    /// if the ray finds a voxel that is not free yet or leaves the domain. All voxels up to `from_t` must be known to be free (0 when
    /// nothing is known).
    ///
    /// Every voxel that the ray passes is visited, one face at a time, so no ray slips through where occupied voxels share only an
    /// edge. The parameter at which it crosses a face is a function of the ray and the face alone. So the voxels visited after a leap are
    /// exactly those that a walk without leaps would visit: where a leap lands, rounding may have put the cell one too far or one too
    /// short, and the faces' own parameters decide.
    pub(crate) fn walk(&self, leaps: &Leaps, p: DVec3, direction: DVec3, from_t: f64, end: impl Fn() -> f64) -> WalkEnd {
        // What depends on the ray alone.
        let (p, d) = (p.to_array(), direction.to_array());
        let inverse = d.map(|d| if d == 0.0 { 1.0 } else { 1.0 / d });
        let sign = d.map(|d| if d > 0.0 { 1i32 } else { -1 });

        // What a step along each axis adds to the offset in the block and to the block's index, and the offset bits of a block's last cell.
        let signed = |axis: usize, n: usize| if sign[axis] > 0 { n } else { n.wrapping_neg() };
        let step = [0, 1, 2].map(|a| signed(a, 1 << (BLOCK_LEVEL as usize * a)));
        let stride = [signed(0, 1), signed(1, self.size[0]), signed(2, self.size[0] * self.size[1])];
        let last = [0, 1, 2].map(|a| if sign[a] > 0 { LOCAL[a] } else { 0 });

        let mut end_t = None;
        let mut t = from_t;
        'land: loop {
            // Land at t. Per axis: the cell, the next face and the parameter at which the ray crosses it, and the steps left to the border.
            let (mut border, mut next_t, mut left, mut cell) = ([f64::INFINITY; 3], [f64::INFINITY; 3], [0i32; 3], [0i32; 3]);
            for a in 0..3 {
                let floor = (p[a] + d[a] * t).floor();
                cell[a] = floor as i32;
                if d[a] != 0.0 {
                    // The face behind, crossed later than t by its own parameter: the ray is still before it, in the cell before.
                    let back = if sign[a] > 0 { floor } else { floor + 1.0 };
                    let is_early = (back - p[a]) * inverse[a] > t;
                    border[a] = if is_early { back } else { back + f64::from(sign[a]) };
                    next_t[a] = (border[a] - p[a]) * inverse[a];
                    cell[a] -= if is_early { sign[a] } else { 0 };
                }
                left[a] = if sign[a] > 0 { self.high[a] - 1 - cell[a] } else { cell[a] - self.low[a] };
            }
            if !self.inside(cell) {
                return WalkEnd::Left;
            }

            // Step from cell to cell until a leap, an obstacle or the border.
            let (mut index, mut offset) = self.address(cell);
            let mut codes = leaps.block(index);
            loop {
                let code = codes.map_or(UNKNOWN, |codes| codes[offset % VOLUME]);
                // Everything around is known to be free: leap to where the ray leaves that cube.
                if code >= MIN_LEAP {
                    let leap = leap(code);
                    let exit = |a: usize| next_t[a] + leap * inverse[a].abs();
                    t = exit(0).min(exit(1)).min(exit(2)) - LANDING;
                    continue 'land;
                }
                // A surface, or a cell that must be looked at: the walk ends, or the cell becomes free.
                if code == OCCUPIED {
                    return WalkEnd::Blocked;
                }
                if code == UNKNOWN {
                    let leave_t = next_t[0].min(next_t[1]).min(next_t[2]);
                    if !self.pass(index, offset, || leave_t <= *end_t.get_or_insert_with(&end)) {
                        return WalkEnd::Blocked;
                    }
                }

                // Step across the nearest face, unless it is the border of the domain.
                let (near, t) = if next_t[0] < next_t[1] { (0, next_t[0]) } else { (1, next_t[1]) };
                let a = if t < next_t[2] { near } else { 2 };
                if left[a] == 0 {
                    let leaves = next_t[a] <= *end_t.get_or_insert_with(&end);
                    return if leaves { WalkEnd::Left } else { WalkEnd::Blocked };
                }
                left[a] -= 1;
                border[a] += f64::from(sign[a]);
                next_t[a] = (border[a] - p[a]) * inverse[a];

                // The offset has five bits for each axis. Unless they are those of the block's last cell, the step stays in the block.
                let local = LOCAL[a];
                if offset & local != last[a] {
                    offset = offset.wrapping_add(step[a]);
                    continue;
                }

                // Enter the neighbouring block at its other end.
                offset ^= local;
                index = index.wrapping_add(stride[a]);
                codes = leaps.block(index);
            }
        }
    }

    /// Looks at a voxel that the leaps know nothing about, and frees it if the ray gets through; false when the voxel stops the ray.
    #[inline]
    fn pass(&self, index: usize, offset: usize, mut reaches_its_end: impl FnMut() -> bool) -> bool {
        let (row, bit) = (offset / BLOCK, 1u32 << (offset % BLOCK));
        if let Some(block) = self.block(index) {
            if block.occupied[row].load(Relaxed) & bit != 0 {
                return false;
            }
            if block.free[row].load(Relaxed) & bit != 0 {
                return true;
            }
        }
        if !reaches_its_end() {
            return false;
        }
        self.block_or_new(index).is_some_and(|block| {
            if block.free[row].fetch_or(bit, Relaxed) & bit == 0 {
                block.free_count.fetch_add(1, Relaxed);
            }
            true
        })
    }
}

/// The bits of a voxel's offset in its block that belong to each axis.
const LOCAL: [usize; 3] = [BLOCK - 1, (BLOCK - 1) << BLOCK_LEVEL, (BLOCK - 1) << (2 * BLOCK_LEVEL)];

/// A leap ends this much before the border of what is known to be free, in voxels.
const LANDING: f64 = 1e-3;
