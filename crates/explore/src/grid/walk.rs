//! Walking along rays: Amanatides & Woo 1987, with leaps through what is known to be free.

use super::leaps::{FREE, Leaps, OCCUPIED, UNKNOWN, leap};
use super::{BLOCK, BLOCK_LEVEL, VoxelGrid};
use enfilade_math::DVec3;
use std::sync::atomic::Ordering::Relaxed;

/// How a walk along a ray ended.
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
    /// if the ray finds a voxel that is not free yet. All voxels up to `from_t` must be known to be free (0 when nothing is known).
    ///
    /// Every voxel that the ray passes is visited, one face at a time, so no ray slips through where occupied voxels share only an
    /// edge. The parameter at which it crosses a face is a function of the ray and the face alone. So the voxels after a leap are those
    /// that a walk without leaps would visit, to the last bit: where a leap lands, crossings that come later are taken back, and those
    /// that are missing come next.
    pub(crate) fn walk(&self, leaps: &Leaps, p: DVec3, direction: DVec3, from_t: f64, end: impl Fn() -> f64) -> WalkEnd {
        let (p, d) = (p.to_array(), direction.to_array());
        let inverse = d.map(|d| if d == 0.0 { 1.0 } else { 1.0 / d });
        let sign = d.map(|d| if d > 0.0 { 1i32 } else { -1 });
        let mut end_t = None;
        let mut t = from_t;
        'land: loop {
            // The state of the walk at t.
            let (mut border, mut next_t, mut left, mut cell) = ([f64::INFINITY; 3], [f64::INFINITY; 3], [0i32; 3], [0i32; 3]);
            for a in 0..3 {
                let floor = (p[a] + d[a] * t).floor();
                cell[a] = floor as i32;
                if d[a] != 0.0 {
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
            let (mut index, mut offset) = self.address(cell);
            let mut codes = leaps.block(index);
            loop {
                let code = codes.map_or(UNKNOWN, |codes| codes[offset]);
                if code >= MIN_LEAP {
                    let leap = leap(code);
                    let exit = |a: usize| next_t[a] + leap * inverse[a].abs();
                    t = exit(0).min(exit(1)).min(exit(2)) - LANDING;
                    continue 'land;
                }
                if code == OCCUPIED {
                    return WalkEnd::Blocked;
                }
                if code == UNKNOWN {
                    let leave_t = next_t[0].min(next_t[1]).min(next_t[2]);
                    if !self.pass(index, offset, || leave_t <= *end_t.get_or_insert_with(&end)) {
                        return WalkEnd::Blocked;
                    }
                }

                // Step across the nearest face.
                let a = if next_t[0] < next_t[1] {
                    if next_t[0] < next_t[2] { 0 } else { 2 }
                } else if next_t[1] < next_t[2] {
                    1
                } else {
                    2
                };
                if left[a] == 0 {
                    return WalkEnd::Left;
                }
                left[a] -= 1;
                border[a] += f64::from(sign[a]);
                next_t[a] = (border[a] - p[a]) * inverse[a];

                // Five bits of the voxel's place in its block belong to the axis; all ones or zeros means the face is the block's.
                let shift = BLOCK_LEVEL as usize * a;
                let (one, local) = (1 << shift, (BLOCK - 1) << shift);
                let up = sign[a] > 0;
                if offset & local != if up { local } else { 0 } {
                    offset = if up { offset + one } else { offset - one };
                    continue;
                }
                offset ^= local;
                let stride = [1, self.size[0], self.size[0] * self.size[1]][a];
                index = if up { index + stride } else { index - stride };
                codes = leaps.block(index);
            }
        }
    }

    /// Looks at a voxel about which the leaps know nothing and frees it; false when it blocks the ray.
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
            block.free[row].fetch_or(bit, Relaxed);
            true
        })
    }
}

/// A leap ends this much before the last voxel that is known to be free, in voxels.
const LANDING: f64 = 1e-3;
