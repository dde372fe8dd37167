//! The inside of a building, without the free space that rays reached through a door, a missing wall or a window without a pane.
//!
//! A point is judged by the surfaces around it, whichever side of them it sees: by the share of the level directions that end at a surface,
//! and the share of the upward ones. Inside, nearly all directions end at a surface; outside, in front of a wall, only half of the level
//! ones do. The roof counts less than the walls, so that a room may lack its ceiling: space below the height of its walls is inside, space
//! above is not.
//!
//! The inside is then all that can be reached from the start cameras through enclosed points alone. So a courtyard or a shed that
//! is seen through the door is not inside, however enclosed.

use crate::grid::{Cube, VoxelGrid};
use crate::space::Leak;
use enfilade_geometry::Bvh;
use enfilade_math::{DVec3, Ray, Vec3};
use enfilade_parallel::map;
use std::collections::BTreeMap;

/// Level directions from which a place is judged.
const LEVEL: usize = 32;
/// Upward directions, 40 degrees and more above the horizon.
const UPWARD: usize = 16;

/// Weight of the share of upward directions that end at a surface; the share of level ones has weight 1.
const ROOF_WEIGHT: f32 = 0.25;
/// A place with less than this is outside. Under a roof 55 % of the level directions must end at a surface, without one 80 %.
const ENCLOSED: f32 = 0.8;

/// Leaks reported, at most.
const MAX_LEAKS: usize = 5;

/// The test whether a place is enclosed.
pub(super) struct Enclosure<'a> {
    bvh: &'a Bvh,
    directions: Vec<Vec3>,
    /// Surfaces beyond this do not enclose.
    reach_m: f32,
}

impl<'a> Enclosure<'a> {
    /// The test by surfaces up to `reach_m` away.
    pub(super) fn new(bvh: &'a Bvh, reach_m: f64) -> Self {
        let turn = std::f32::consts::TAU * 0.618_034;
        let direction = |k: usize, z: f32| {
            let (sin, cos) = (turn * k as f32).sin_cos();
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * cos, r * sin, z)
        };
        let lowest = 40f32.to_radians().sin();
        let level = (0..LEVEL).map(|k| direction(k, 0.0));
        let upward = (0..UPWARD).map(|k| direction(k, lowest + (1.0 - lowest) * (k as f32 + 0.5) / UPWARD as f32));
        Self { bvh, directions: level.chain(upward).collect(), reach_m: reach_m as f32 }
    }

    /// Whether surfaces enclose a point of the world.
    pub(super) fn encloses(&self, p: DVec3) -> bool {
        let ends = |direction: &Vec3| {
            let mut ray = Ray::new(p.as_vec3(), *direction);
            ray.t_max = self.reach_m;
            self.bvh.occluded(&ray)
        };
        let share = |directions: &[Vec3]| directions.iter().filter(|d| ends(d)).count() as f32 / directions.len() as f32;
        let (level, upward) = self.directions.split_at(LEVEL);
        let walls = share(level);
        walls >= ENCLOSED || (walls + ROOF_WEIGHT >= ENCLOSED && walls + ROOF_WEIGHT * share(upward) >= ENCLOSED)
    }
}

/// Free voxels that are inside, by cube. Cubes that were not reached are not in it.
pub(super) struct Inside(BTreeMap<Cube, u64>);

impl Inside {
    /// Floods the free space from `starts`; `None` when none of them is inside.
    pub(super) fn find(grid: &VoxelGrid, enclosure: &Enclosure, starts: &[DVec3]) -> Option<Self> {
        // Flood from the starts, cube by cube. A cube is judged by one point in it; the flood continues from those that are enclosed.
        let mut judged: BTreeMap<Cube, bool> = BTreeMap::new();
        let mut wave: Vec<Cube> = starts.iter().map(|start| grid.cube_at(*start)).filter(|cube| grid.free_in(*cube) != 0).collect();
        while !wave.is_empty() {
            wave.sort_unstable();
            wave.dedup();
            let enclosed: Vec<bool> = map(&wave, |cube| enclosure.encloses(middle_voxel(grid, *cube)));
            judged.extend(wave.iter().copied().zip(enclosed));
            let touching = |cube: Cube| {
                let beside = neighbours(cube).into_iter().enumerate();
                beside.filter(move |(side, other)| contact(grid.free_in(cube), grid.free_in(*other), *side) > 0).map(|(_, other)| other)
            };
            let reached = wave.iter().filter(|cube| judged[*cube]).flat_map(|cube| touching(*cube));
            wave = reached.filter(|cube| !judged.contains_key(cube)).collect();
        }
        judged.values().any(|enclosed| *enclosed).then(|| {
            // Where enclosed cubes and others meet, judge voxel by voxel.
            let cubes: Vec<(&Cube, &bool)> = judged.iter().collect();
            let at_border = |cube: &Cube, enclosed: bool| neighbours(*cube).iter().any(|other| judged.get(other) == Some(&!enclosed));
            let voxels = |&(cube, enclosed): &(&Cube, &bool)| {
                let free = grid.free_in(*cube);
                match (at_border(cube, *enclosed), *enclosed) {
                    (false, true) => free,
                    (false, false) => 0,
                    (true, _) => (0..64)
                        .filter(|bit| (free >> bit) & 1 != 0 && enclosure.encloses(grid.voxel_center(*cube, *bit)))
                        .fold(0, |b, i| b | 1 << i),
                }
            };
            let inside: Vec<u64> = map(&cubes, voxels);
            Self(cubes.into_iter().map(|(cube, _)| *cube).zip(inside).collect())
        })
    }

    /// Calls `visit` with every cube and its free voxels that are not inside, and returns their number.
    pub(super) fn for_outside(&self, grid: &VoxelGrid, mut visit: impl FnMut(Cube, u64)) -> u64 {
        let mut count = 0;
        for cube in grid.cubes() {
            let outside = grid.free_in(cube) & !self.0.get(&cube).copied().unwrap_or(0);
            if outside != 0 {
                count += u64::from(outside.count_ones());
                visit(cube, outside);
            }
        }
        count
    }

    /// The leaks between inside and outside: connected groups of cubes with faces between voxels of the two kinds, the largest first.
    pub(super) fn leaks(&self, grid: &VoxelGrid) -> Vec<Leak> {
        let inside = |cube: &Cube| self.0.get(cube).copied().unwrap_or(0);
        let outside = |cube: &Cube| grid.free_in(*cube) & !inside(cube);
        let faces = |cube: &Cube| {
            let beside = neighbours(*cube).iter().enumerate().map(|(side, other)| contact(inside(cube), outside(other), side)).sum::<u32>();
            beside + faces_within(inside(cube), outside(cube))
        };
        // Cubes with faces between inside and outside.
        let border = self.0.keys().map(|cube| (*cube, faces(cube)));
        let mut rest: BTreeMap<Cube, u32> = border.filter(|(_, faces)| *faces > 0).collect();

        // Group those that touch, even at a corner; each group is a leak.
        let mut leaks = Vec::new();
        while let Some(first) = rest.pop_first() {
            let (mut group, mut next) = (vec![first], 0);
            while next < group.len() {
                let cube = group[next].0;
                let around = (0..27).map(|i| [cube[0] + i % 3 - 1, cube[1] + i / 3 % 3 - 1, cube[2] + i / 9 - 1]);
                group.extend(around.filter_map(|other| rest.remove_entry(&other)));
                next += 1;
            }
            let position = group.iter().map(|(cube, _)| grid.cube_center(*cube)).sum::<DVec3>() / group.len() as f64;
            let faces: u32 = group.iter().map(|(_, faces)| faces).sum();
            leaks.push(Leak { position, area_m2: f64::from(faces) * grid.voxel_m().powi(2) });
        }
        leaks.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
        leaks.truncate(MAX_LEAKS);
        leaks
    }
}

/// The voxels of a cube at its end and at its beginning along each axis.
const END: [u64; 3] = [0x8888_8888_8888_8888, 0xf000_f000_f000_f000, 0xffff_0000_0000_0000];
const BEGINNING: [u64; 3] = [0x1111_1111_1111_1111, 0x000f_000f_000f_000f, 0xffff];
/// Distance from a voxel's bit to the next voxel's along each axis.
const STEP: [u32; 3] = [1, 4, 16];

/// Number of faces that voxels of a cube share with voxels of its neighbour on this side (the index in [`neighbours`]).
fn contact(voxels: u64, beside: u64, side: usize) -> u32 {
    let axis = side / 2;
    let shared = if side.is_multiple_of(2) {
        ((voxels & END[axis]) >> (3 * STEP[axis])) & beside
    } else {
        ((voxels & BEGINNING[axis]) << (3 * STEP[axis])) & beside
    };
    shared.count_ones()
}

/// Number of faces between voxels of two kinds in one cube.
fn faces_within(a: u64, b: u64) -> u32 {
    let along = |axis: usize| {
        let next = |voxels: u64| (voxels & !END[axis]) << STEP[axis];
        (next(a) & b).count_ones() + (next(b) & a).count_ones()
    };
    (0..3).map(along).sum()
}

/// The free voxel of a cube that is nearest to its middle.
fn middle_voxel(grid: &VoxelGrid, cube: Cube) -> DVec3 {
    let free = grid.free_in(cube);
    let places = (0..64).filter(|bit| (free >> bit) & 1 != 0).map(|bit| grid.voxel_center(cube, bit));
    let middle = grid.cube_center(cube);
    places.min_by(|a, b| a.distance_squared(middle).total_cmp(&b.distance_squared(middle))).unwrap_or(middle)
}

fn neighbours(cube: Cube) -> [Cube; 6] {
    std::array::from_fn(|i| {
        let mut other = cube;
        other[i / 2] += if i % 2 == 0 { 1 } else { -1 };
        other
    })
}
