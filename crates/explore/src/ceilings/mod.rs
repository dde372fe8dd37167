//! The ceilings of a building, room by room, and where lamps hang from them.
//!
//! A grid of plumb lines goes through the scene. Where one of them runs free for a metre or more below a surface, that surface is a
//! ceiling; neighbouring pieces at about one height belong together unless a wall is between them right below the ceiling, above all
//! doors. Surfaces as low or as small as a cupboard are no ceilings.

mod lamps;

pub use lamps::LampPlace;

use enfilade_geometry::Bvh;
use enfilade_math::{Ray, Vec3};
use enfilade_parallel::map_up_to;
use enfilade_scene::WorldMesh;
use std::collections::VecDeque;

/// Plumb lines along the longer side of the scene, at most, and the least distance between them, metres.
const MAX_LINES: f32 = 256.0;
const MIN_SPACING_M: f32 = 0.1;
/// Surfaces looked through along one line.
const MAX_SURFACES: usize = 64;
/// Free heights below a ceiling, metres: over furniture, and in a hall. Under a sky of triangles it is more.
const FREE_M: std::ops::RangeInclusive<f32> = 1.0..=15.0;
/// Free height that a ceiling has above at least one place, so that people can stand there, metres.
const HEADROOM_M: f32 = 1.9;
/// Neighbouring pieces of one ceiling differ in height by at most this, metres.
const STEP_M: f32 = 0.3;
/// Walls are looked for this far below the ceiling, metres.
const BELOW_M: f32 = 0.12;
/// The least area of a ceiling, square metres.
const MIN_AREA_M2: f64 = 1.5;

/// A ceiling, over one room or over several that are open to each other.
#[derive(Clone, Debug)]
pub struct Ceiling {
    pieces: Vec<Piece>,
    spacing_m: f32,
}

/// The ceiling at one plumb line.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// Column of the grid.
    column: [u32; 2],
    /// Point where the line meets the ceiling, metres.
    at: Vec3,
    /// Free height below, metres.
    free_m: f32,
}

impl Ceiling {
    /// Area of all pieces, square metres.
    pub fn area_m2(&self) -> f64 {
        self.pieces.len() as f64 * f64::from(self.spacing_m).powi(2)
    }

    /// Points `eye_m` above what is below the ceiling, where that leaves headroom; at most `count`, spread over the room.
    pub fn eyes(&self, count: usize, eye_m: f32) -> Vec<Vec3> {
        let high: Vec<&Piece> = self.pieces.iter().filter(|piece| piece.free_m >= HEADROOM_M).collect();
        let step = high.len().div_ceil(count.max(1)).max(1);
        high.iter().skip(step / 2).step_by(step).map(|piece| piece.at - Vec3::Z * (piece.free_m - eye_m)).collect()
    }

    /// Points half-way between the ceiling and what is below it, at most `count`, spread over the room.
    pub fn midpoints(&self, count: usize) -> Vec<Vec3> {
        let step = self.pieces.len().div_ceil(count.max(1)).max(1);
        self.pieces.iter().skip(step / 2).step_by(step).map(|piece| piece.at - Vec3::Z * (0.5 * piece.free_m)).collect()
    }
}

/// The ceilings of a scene, in the order of their westernmost pieces.
pub fn ceilings(world: &WorldMesh, bvh: &Bvh) -> Vec<Ceiling> {
    let grid = Grid::over(world);
    let columns: Vec<Vec<Piece>> = map_up_to(grid.columns() as usize, |i| pieces(world, bvh, grid.column(i as u32), &grid));
    // Numbers of the pieces, column by column.
    let first: Vec<usize> = columns.iter().scan(0, |next, column| Some(std::mem::replace(next, *next + column.len()))).collect();
    let all: Vec<Piece> = columns.iter().flatten().copied().collect();
    let joined = |i: usize| neighbours(bvh, &grid, &columns, &first, &all[i]);
    let neighbours: Vec<Vec<usize>> = map_up_to(all.len(), joined);
    let groups = connected(&neighbours).into_iter();
    let ceilings = groups.map(|group| Ceiling { pieces: group.into_iter().map(|i| all[i]).collect(), spacing_m: grid.spacing_m });
    ceilings.filter(|c| c.area_m2() >= MIN_AREA_M2 && c.pieces.iter().any(|piece| piece.free_m >= HEADROOM_M)).collect()
}

/// The plumb lines.
struct Grid {
    low: Vec3,
    top_m: f32,
    spacing_m: f32,
    size: [u32; 2],
}

impl Grid {
    fn over(world: &WorldMesh) -> Self {
        let (low, size) = if world.bounds.is_empty() { (Vec3::ZERO, Vec3::ZERO) } else { (world.bounds.min, world.bounds.extent()) };
        let spacing_m = (size.x.max(size.y) / MAX_LINES).max(MIN_SPACING_M);
        let lines = |length: f32| (length / spacing_m).ceil() as u32;
        Self { low, top_m: low.z + size.z + 1.0, spacing_m, size: [lines(size.x), lines(size.y)] }
    }

    fn columns(&self) -> u32 {
        self.size[0] * self.size[1]
    }

    fn column(&self, index: u32) -> [u32; 2] {
        [index / self.size[1], index % self.size[1]]
    }

    fn index(&self, [x, y]: [u32; 2]) -> usize {
        (x * self.size[1] + y) as usize
    }

    fn place(&self, [x, y]: [u32; 2], z: f32) -> Vec3 {
        let along = |i: u32, low: f32| low + self.spacing_m * (i as f32 + 0.5);
        Vec3::new(along(x, self.low.x), along(y, self.low.y), z)
    }
}

/// The ceilings of one column, the uppermost first.
fn pieces(world: &WorldMesh, bvh: &Bvh, column: [u32; 2], grid: &Grid) -> Vec<Piece> {
    let mut found = Vec::new();
    let (mut from, mut above) = (grid.place(column, grid.top_m), None::<Vec3>);
    for _ in 0..MAX_SURFACES {
        let Some(hit) = bvh.closest(&Ray::new(from, Vec3::NEG_Z)) else { break };
        let surface = from - Vec3::Z * hit.t;
        if let Some(at) = above.filter(|at| FREE_M.contains(&(at.z - surface.z))) {
            found.push(Piece { column, at, free_m: at.z - surface.z });
        }
        // A wall that the line runs along is no ceiling, and neither is anything that it hides.
        let [a, b, c] = world.corners[hit.triangle as usize];
        above = ((b - a).cross(c - a).normalize_or_zero().z.abs() > 0.1).then_some(surface);
        from = surface - Vec3::Z * 1e-3;
    }
    found
}

/// Numbers of the pieces beside one that belong to the same ceiling.
fn neighbours(bvh: &Bvh, grid: &Grid, columns: &[Vec<Piece>], first: &[usize], piece: &Piece) -> Vec<usize> {
    let [x, y] = piece.column;
    let beside = [(x.wrapping_sub(1), y), (x + 1, y), (x, y.wrapping_sub(1)), (x, y + 1)];
    let beside = beside.into_iter().filter(|(x, y)| *x < grid.size[0] && *y < grid.size[1]).map(|(x, y)| grid.index([x, y]));
    let pieces = beside.flat_map(|column| columns[column].iter().enumerate().map(move |(i, other)| (first[column] + i, other)));
    pieces.filter(|(_, other)| is_one(bvh, piece, other)).map(|(number, _)| number).collect()
}

fn is_one(bvh: &Bvh, a: &Piece, b: &Piece) -> bool {
    // From the same end whichever is asked for, so that both answers are the same.
    let (a, b) = if a.column < b.column { (a, b) } else { (b, a) };
    let height = a.at.z.min(b.at.z) - BELOW_M;
    let level = |p: Vec3| Vec3::new(p.x, p.y, height);
    let ray = Ray { t_max: 1.0, ..Ray::new(level(a.at), level(b.at) - level(a.at)) };
    (a.at.z - b.at.z).abs() <= STEP_M && !bvh.occluded(&ray)
}

/// Groups of numbers that are connected, each in rising order, in the order of their first.
fn connected(neighbours: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut is_seen = vec![false; neighbours.len()];
    let mut groups = Vec::new();
    for start in 0..neighbours.len() {
        if std::mem::replace(&mut is_seen[start], true) {
            continue;
        }
        let (mut group, mut next) = (vec![start], VecDeque::from([start]));
        while let Some(i) = next.pop_front() {
            for &other in &neighbours[i] {
                if !std::mem::replace(&mut is_seen[other], true) {
                    group.push(other);
                    next.push_back(other);
                }
            }
        }
        group.sort_unstable();
        groups.push(group);
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testroom::{Room, cuboid};
    use enfilade_math::DVec3;

    /// Two rooms of 4 m x 3 m x 2.5 m side by side, with a door 2 m high in the wall of 10 cm between them.
    fn two_rooms() -> Vec<[Vec3; 3]> {
        let mut corners = cuboid(DVec3::ZERO, DVec3::new(8.1, 3.0, 2.5), true);
        corners.extend(cuboid(DVec3::new(4.0, 0.0, 0.0), DVec3::new(4.1, 1.0, 2.5), false));
        corners.extend(cuboid(DVec3::new(4.0, 2.0, 0.0), DVec3::new(4.1, 3.0, 2.5), false));
        corners.extend(cuboid(DVec3::new(4.0, 1.0, 2.0), DVec3::new(4.1, 2.0, 2.5), false));
        corners
    }

    #[test]
    fn rooms_are_apart_where_a_wall_reaches_the_ceiling() {
        let room = Room::from_corners(two_rooms());
        let found = ceilings(&room.world, &room.bvh);
        let areas: Vec<f64> = found.iter().map(Ceiling::area_m2).collect();
        assert_eq!(areas.len(), 2, "{areas:?}");
        assert!(areas.iter().all(|area| (area - 12.0).abs() < 0.6), "{areas:?}");
    }

    #[test]
    fn cupboards_tables_and_the_open_have_no_ceiling() {
        let mut corners = cuboid(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), true);
        // A wardrobe of sheets, a table, and a slab outside with nothing above.
        corners.extend(cuboid(DVec3::new(0.1, 0.1, 0.1), DVec3::new(0.7, 2.1, 2.1), false));
        corners.extend(cuboid(DVec3::new(2.0, 1.0, 0.7), DVec3::new(3.5, 2.0, 0.75), false));
        corners.extend(cuboid(DVec3::new(5.0, 0.0, -0.1), DVec3::new(9.0, 3.0, 0.0), false));
        let room = Room::from_corners(corners);
        let found = ceilings(&room.world, &room.bvh);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].pieces.iter().all(|piece| (piece.at.z - 2.5).abs() < 1e-4));
    }

    #[test]
    fn a_scene_without_triangles_has_no_ceiling() {
        let room = Room::from_corners(Vec::new());
        assert!(ceilings(&room.world, &room.bvh).is_empty());
    }
}
