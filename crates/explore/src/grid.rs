use crate::ExploreError;
use crate::overlap::OverlapTest;
use enfilade_geometry::{OccupancyTree, TREE_LEVELS, Voxel, VoxelKey};
use enfilade_math::{DVec3, Rng};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Voxels along the edge of a brick: 4³ = 64 voxels are one machine word per state.
const BRICK: usize = 4;
const BRICK_LEVEL: u32 = 2;

/// More than this much memory for the grid is refused.
const MAX_BYTES: u64 = 4 << 30;

/// Boxes are grown by this many voxels in overlap tests, so that a wall on the border of two voxels occupies both whatever the
/// rounding of its vertices (10 µm at voxels of 0.1 m).
const SLACK: f64 = 1e-4;

/// Two bits for every voxel of a box in the octree's key space. Bricks of 4³ voxels are aligned to multiples of four keys, so that
/// each is a node of the octree. Bits are only ever added, in any order and from any thread, so the result does not depend on
/// either.
pub(crate) struct VoxelGrid {
    voxel_m: f64,
    /// Key of the first voxel of the first brick.
    base: [u16; 3],
    /// The domain in cells (voxels counted from `base`): first, and one past the last.
    low: [i32; 3],
    high: [i32; 3],
    size: [usize; 3],
    bricks: Vec<Brick>,
}

#[derive(Default)]
struct Brick {
    occupied: AtomicU64,
    free: AtomicU64,
}

/// How a walk along a ray ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WalkEnd {
    /// Before an occupied voxel.
    Occupied,
    /// At the border of the domain.
    Left,
}

impl VoxelGrid {
    /// An unknown grid over the voxels that overlap the box from `min` to `max`.
    pub(crate) fn new(min: DVec3, max: DVec3, voxel_m: f64) -> Result<Self, ExploreError> {
        let (Some(first), Some(last)) = (VoxelKey::at(min, voxel_m), VoxelKey::at(max, voxel_m)) else {
            return Err(ExploreError::OutOfKeySpace { min, max, voxel_m });
        };
        let base = first.0.map(|k| k - k % BRICK as u16);
        let low = std::array::from_fn(|a| i32::from(first.0[a] - base[a]));
        let high: [i32; 3] = std::array::from_fn(|a| i32::from(last.0[a] - base[a]) + 1);
        let size = high.map(|h| (h as usize).div_ceil(BRICK));
        let bricks: u64 = size.iter().map(|n| *n as u64).product();
        let bytes = bricks * size_of::<Brick>() as u64;
        if bytes > MAX_BYTES {
            let voxels = bricks << (3 * BRICK_LEVEL);
            return Err(ExploreError::TooManyVoxels { voxels, voxel_m, mib: bytes >> 20, limit_mib: MAX_BYTES >> 20 });
        }
        let bricks = (0..bricks).map(|_| Brick::default()).collect();
        Ok(Self { voxel_m, base, low, high, size, bricks })
    }

    /// World coordinates in cells.
    #[inline]
    fn cells(&self, p: DVec3) -> DVec3 {
        p / self.voxel_m - DVec3::from(self.base.map(|k| f64::from(k) - f64::from(1 << (TREE_LEVELS - 1))))
    }

    #[inline]
    fn inside(&self, cell: [i32; 3]) -> bool {
        (0..3).all(|a| self.low[a] <= cell[a] && cell[a] < self.high[a])
    }

    #[inline]
    fn address(&self, cell: [i32; 3]) -> (usize, u32) {
        let [x, y, z] = cell.map(|c| c as usize);
        let index = ((z / BRICK) * self.size[1] + y / BRICK) * self.size[0] + x / BRICK;
        (index, ((x % BRICK) | ((y % BRICK) << 2) | ((z % BRICK) << 4)) as u32)
    }

    /// Marks every voxel that a triangle touches as occupied.
    pub(crate) fn occupy(&self, triangles: &[[enfilade_math::Vec3; 3]]) {
        triangles.par_iter().with_min_len(256).for_each(|corners| self.occupy_triangle(corners.map(|p| self.cells(p.as_dvec3()))));
    }

    fn occupy_triangle(&self, corners: [DVec3; 3]) {
        let slack = DVec3::splat(SLACK);
        let lowest = (corners[0].min(corners[1]).min(corners[2]) - slack).floor().to_array();
        let highest = (corners[0].max(corners[1]).max(corners[2]) + slack).floor().to_array();
        let first: [i32; 3] = std::array::from_fn(|a| (lowest[a] as i32).max(self.low[a]));
        let last: [i32; 3] = std::array::from_fn(|a| (highest[a] as i32).min(self.high[a] - 1));
        if (0..3).any(|a| first[a] > last[a]) {
            return;
        }
        if first == last && lowest == highest {
            let (index, bit) = self.address(first);
            self.bricks[index].occupied.fetch_or(1 << bit, Relaxed);
            return;
        }
        let test = OverlapTest::new(corners);
        let touches = |cell: [i32; 3], edge: i32| {
            let half = DVec3::splat(0.5 * f64::from(edge));
            test.touches(DVec3::from(cell.map(f64::from)) + half, half + slack)
        };
        let brick = BRICK as i32;
        for_each_cell(first.map(|c| c / brick), last.map(|c| c / brick), |b| {
            let corner = b.map(|c| c * brick);
            if !touches(corner, brick) {
                return;
            }
            let mut bits = 0u64;
            let from = std::array::from_fn(|a| corner[a].max(first[a]));
            let to = std::array::from_fn(|a| (corner[a] + brick - 1).min(last[a]));
            for_each_cell(from, to, |cell| {
                if touches(cell, 1) {
                    bits |= 1 << self.address(cell).1;
                }
            });
            self.bricks[self.address(corner).0].occupied.fetch_or(bits, Relaxed);
        });
    }

    /// Frees every voxel along a ray until the first occupied one or the end of the domain. The origin must lie in the domain.
    ///
    /// Every voxel that the ray passes is visited, one face at a time (Amanatides & Woo 1987), so no ray slips through where
    /// occupied voxels share only an edge.
    pub(crate) fn walk(&self, origin: DVec3, direction: DVec3) -> WalkEnd {
        let p = self.cells(origin);
        let start = p.floor().to_array().map(|c| c as i32);
        if !self.inside(start) {
            return WalkEnd::Left;
        }
        let strides = [1, self.size[0], self.size[0] * self.size[1]];
        let (p, d) = (p.to_array(), direction.to_array());
        let (mut next_t, mut step_t, mut left) = ([f64::INFINITY; 3], [f64::INFINITY; 3], [0i32; 3]);
        for a in 0..3 {
            let border = f64::from(start[a] + i32::from(d[a] > 0.0));
            if d[a] != 0.0 {
                (next_t[a], step_t[a]) = ((border - p[a]) / d[a], 1.0 / d[a].abs());
            }
            left[a] = if d[a] > 0.0 { self.high[a] - 1 - start[a] } else { start[a] - self.low[a] };
        }
        let (mut index, mut bit) = self.address(start);
        let mut occupied = self.bricks[index].occupied.load(Relaxed);
        let mut seen = 0u64;
        loop {
            if (occupied >> bit) & 1 != 0 {
                self.free(index, seen);
                return WalkEnd::Occupied;
            }
            seen |= 1 << bit;

            // Step across the nearest face.
            let a = if next_t[0] < next_t[1] {
                if next_t[0] < next_t[2] { 0 } else { 2 }
            } else if next_t[1] < next_t[2] {
                1
            } else {
                2
            };
            if left[a] == 0 {
                self.free(index, seen);
                return WalkEnd::Left;
            }
            left[a] -= 1;
            next_t[a] += step_t[a];

            // Two bits of the voxel's place in its brick belong to the axis; all ones or zeros means the face is the brick's.
            let (one, local) = (1u32 << (2 * a), 3u32 << (2 * a));
            let up = d[a] > 0.0;
            let crosses = bit & local == if up { local } else { 0 };
            if !crosses {
                bit = if up { bit + one } else { bit - one };
                continue;
            }
            self.free(index, seen);
            seen = 0;
            bit ^= local;
            index = if up { index + strides[a] } else { index - strides[a] };
            occupied = self.bricks[index].occupied.load(Relaxed);
        }
    }

    #[inline]
    fn free(&self, index: usize, bits: u64) {
        let free = &self.bricks[index].free;
        if bits & !free.load(Relaxed) != 0 {
            free.fetch_or(bits, Relaxed);
        }
    }

    /// The state at a point of the world; unknown outside the domain.
    pub(crate) fn state(&self, p: DVec3) -> Voxel {
        let cell = self.cells(p).floor().to_array().map(|c| c as i32);
        if !self.inside(cell) {
            return Voxel::Unknown;
        }
        let (index, bit) = self.address(cell);
        let has = |word: &AtomicU64| (word.load(Relaxed) >> bit) & 1 != 0;
        match (has(&self.bricks[index].occupied), has(&self.bricks[index].free)) {
            (true, _) => Voxel::Occupied,
            (false, true) => Voxel::Free,
            (false, false) => Voxel::Unknown,
        }
    }

    /// Number of free and of occupied voxels.
    pub(crate) fn counts(&self) -> (u64, u64) {
        let ones = |word: &AtomicU64| u64::from(word.load(Relaxed).count_ones());
        self.bricks.par_iter().map(|b| (ones(&b.free), ones(&b.occupied))).reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1))
    }

    /// A point uniform in the free voxels, of which there are `free` (see [`VoxelGrid::counts`]); `None` when there are none.
    pub(crate) fn random_free(&self, free: u64, rng: &mut Rng) -> Option<DVec3> {
        if free == 0 {
            return None;
        }
        let mut rank = rng.below(free as usize) as u64;
        for (index, brick) in self.bricks.iter().enumerate() {
            let mut bits = brick.free.load(Relaxed);
            let here = u64::from(bits.count_ones());
            if rank >= here {
                rank -= here;
                continue;
            }
            for _ in 0..rank {
                bits &= bits - 1;
            }
            let bit = bits.trailing_zeros() as usize;
            let brick = [index % self.size[0], index / self.size[0] % self.size[1], index / self.size[0] / self.size[1]];
            let key = std::array::from_fn(|a| self.base[a] + (BRICK * brick[a] + ((bit >> (2 * a)) & 3)) as u16);
            // A hair inside the voxel, so that rounding cannot put the point into its neighbour.
            let jitter = DVec3::from([0; 3].map(|_| 0.01 + 0.98 * rng.next_f64()));
            return Some(VoxelKey(key).corner(self.voxel_m) + self.voxel_m * jitter);
        }
        None
    }

    /// The octree with the same states.
    pub(crate) fn to_tree(&self) -> OccupancyTree {
        OccupancyTree::from_states(self.voxel_m, |key, level| {
            let edge = 1i64 << level;
            let corner: [i64; 3] = std::array::from_fn(|a| i64::from(key.0[a]) - i64::from(self.base[a]));
            if (0..3).any(|a| corner[a] + edge <= 0 || corner[a] >= (self.size[a] * BRICK) as i64) {
                return Some(Voxel::Unknown);
            }
            if level > BRICK_LEVEL {
                return None;
            }
            let (index, bit) = self.address(corner.map(|c| c as i32));
            let mask = [1u64, 0x0033_0033, u64::MAX][level as usize] << if level == BRICK_LEVEL { 0 } else { bit };
            let brick = &self.bricks[index];
            let occupied = brick.occupied.load(Relaxed) & mask;
            match (occupied, brick.free.load(Relaxed) & mask) {
                (0, 0) => Some(Voxel::Unknown),
                (0, free) if free == mask => Some(Voxel::Free),
                (occupied, 0) if occupied == mask => Some(Voxel::Occupied),
                _ => None,
            }
        })
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Vec3;

    fn random_point(rng: &mut Rng, low: f64, high: f64) -> DVec3 {
        DVec3::from([0; 3].map(|_| low + (high - low) * rng.next_f64()))
    }

    /// A grid of about 30 voxels per edge, not aligned to bricks, with small triangles here and there.
    fn cluttered(rng: &mut Rng) -> VoxelGrid {
        let grid = VoxelGrid::new(DVec3::splat(-1.33), DVec3::splat(1.57), 0.1).unwrap();
        let triangles: Vec<[Vec3; 3]> = (0..60)
            .map(|_| {
                let p = random_point(rng, -1.4, 1.6);
                [0; 3].map(|_| (p + random_point(rng, -0.1, 0.1)).as_vec3())
            })
            .collect();
        grid.occupy(&triangles);
        grid
    }

    #[test]
    fn a_walk_frees_what_the_ray_passes_before_the_first_occupied_voxel() {
        let mut rng = Rng::new(8);
        let grid = cluttered(&mut rng);
        let mut ends = [0, 0];
        for _ in 0..200 {
            let (origin, direction) = (random_point(&mut rng, -1.0, 1.0), random_point(&mut rng, -1.0, 1.0).normalize());
            let end = grid.walk(origin, direction);
            ends[end as usize] += 1;
            for step in 0..200_000 {
                let p = origin + direction * (f64::from(step) * 2e-5);
                let Some(key) = VoxelKey::at(p, 0.1) else { break };
                let inside = (0..3).all(|a| (32768 - 14..32768 + 16).contains(&key.0[a]));
                match (inside, grid.state(p)) {
                    (false, _) => {
                        assert_eq!(end, WalkEnd::Left);
                        break;
                    }
                    (true, Voxel::Occupied) => {
                        assert_eq!(end, WalkEnd::Occupied);
                        break;
                    }
                    (true, state) => assert_eq!(state, Voxel::Free, "{p} on the way from {origin} along {direction}"),
                }
            }
        }
        assert!(ends.iter().all(|n| *n > 20), "{ends:?}");
    }

    #[test]
    fn the_octree_has_the_states_of_the_grid() {
        let mut rng = Rng::new(9);
        let grid = cluttered(&mut rng);
        for k in 0..3000 {
            grid.walk(DVec3::splat(0.05), enfilade_math::warp::fibonacci_sphere(k, 3000));
        }
        let tree = grid.to_tree();
        let (free, occupied) = grid.counts();
        assert_eq!((tree.count(Voxel::Free), tree.count(Voxel::Occupied)), (free, occupied));
        assert!(free > 1000 && occupied > 60, "{free} {occupied}");
        for _ in 0..20_000 {
            let p = random_point(&mut rng, -1.8, 2.0);
            assert_eq!(tree.state(p), grid.state(p), "{p}");
        }
    }

    #[test]
    fn random_free_points_are_uniform_over_the_free_voxels() {
        let grid = VoxelGrid::new(DVec3::splat(-0.05), DVec3::splat(0.35), 0.1).unwrap();
        for k in 0..2000 {
            grid.walk(DVec3::splat(0.15), enfilade_math::warp::fibonacci_sphere(k, 2000));
        }
        let (free, _) = grid.counts();
        assert_eq!(free, 125);
        let mut rng = Rng::new(2);
        let mut counts = std::collections::BTreeMap::new();
        let n = 100_000;
        for _ in 0..n {
            let p = grid.random_free(free, &mut rng).unwrap();
            assert_eq!(grid.state(p), Voxel::Free);
            *counts.entry(VoxelKey::at(p, 0.1).unwrap().0).or_insert(0u32) += 1;
        }
        let expected = f64::from(n) / 125.0;
        let chi_square: f64 = counts.values().map(|c| (f64::from(*c) - expected).powi(2) / expected).sum();
        // 124 degrees of freedom: beyond 198 once in 30,000 times.
        assert!(counts.len() == 125 && chi_square < 198.0, "{} voxels, chi-square {chi_square}", counts.len());
        assert!(grid.random_free(0, &mut rng).is_none());
    }

    #[test]
    fn grids_too_large_or_too_far_are_refused() {
        let error = |min, max, voxel_m| VoxelGrid::new(min, max, voxel_m).err().unwrap();
        assert!(matches!(error(DVec3::ZERO, DVec3::splat(5e4), 0.1), ExploreError::OutOfKeySpace { .. }));
        assert!(matches!(error(DVec3::ZERO, DVec3::splat(3000.0), 0.1), ExploreError::TooManyVoxels { .. }));
    }
}
