//! Walkability of a finished home: where a person can go, and which objects are in the way.

use super::moving::as_made;
use crate::Home;
use crate::place::BODY;
use crate::plan::FloorPlan;
use crate::shell::is_shell;
use enfilade_furniture::{family_of, object_of};
use enfilade_math::{Vec2, Vec3};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Edge of a grid cell, metres.
const CELL: f32 = 0.05;
/// Heights between which things are obstacles, metres: people step over lower things and walk under higher ones.
const HEIGHTS: [f32; 2] = [0.12, 1.9];
/// Reduction of half the width of a body, metres, because cells are tested at their centres.
const TOLERANCE: f32 = 0.04;
/// Cost of removing a cubic metre of furniture, in cells of a detour.
const REMOVAL_COST: f32 = 10.0;

struct Grid {
    min: Vec2,
    columns: usize,
    rows: usize,
}

impl Grid {
    fn of(plan: &FloorPlan) -> Self {
        let margin = 0.5;
        let min = plan.whole.min - margin;
        let size = ((plan.whole.max + margin - min) / CELL).ceil();
        Self { min, columns: size.x as usize, rows: size.y as usize }
    }

    fn cell(&self, p: Vec2) -> Option<usize> {
        let q = (p - self.min) / CELL;
        let inside = q.cmpge(Vec2::ZERO).all() && (q.x as usize) < self.columns && (q.y as usize) < self.rows;
        inside.then(|| q.y as usize * self.columns + q.x as usize)
    }

    fn place(&self, cell: usize) -> Vec2 {
        self.min + CELL * (Vec2::new((cell % self.columns) as f32, (cell / self.columns) as f32) + 0.5)
    }

    /// The cells beside one.
    fn beside(&self, cell: usize) -> impl Iterator<Item = usize> {
        let (x, y, columns) = (cell % self.columns, cell / self.columns, self.columns);
        let ways = [
            (x > 0, cell.wrapping_sub(1)),
            (x + 1 < columns, cell + 1),
            (y > 0, cell.wrapping_sub(columns)),
            (y + 1 < self.rows, cell + columns),
        ];
        ways.into_iter().filter_map(|(there, next)| there.then_some(next))
    }

    /// Marks the cells that a triangle covers at the height of a body.
    fn mark(&self, corners: [Vec3; 3], cells: &mut [bool]) {
        if corners.iter().all(|p| p.z < HEIGHTS[0]) || corners.iter().all(|p| p.z > HEIGHTS[1]) {
            return;
        }
        // From the corner between the two shorter sides, so that slivers take few steps.
        let opposite = |i: usize| corners[(i + 1) % 3].distance_squared(corners[(i + 2) % 3]);
        let first = if opposite(0) >= opposite(1).max(opposite(2)) { 0 } else { 1 + usize::from(opposite(2) > opposite(1)) };
        let [a, b, c] = [0, 1, 2].map(|i| corners[(first + i) % 3]);
        let steps = |side: Vec3| (2.0 * side.length() / CELL).ceil().max(1.0) as usize;
        let (along_b, along_c) = (steps(b - a), steps(c - a));
        for i in 0..=along_b {
            let u = i as f32 / along_b as f32;
            for j in 0..=along_c {
                let v = (j as f32 / along_c as f32).min(1.0 - u);
                let p = a + u * (b - a) + v * (c - a);
                if let Some(cell) = self.cell(p.truncate()).filter(|_| (HEIGHTS[0]..=HEIGHTS[1]).contains(&p.z)) {
                    cells[cell] = true;
                }
            }
        }
    }

    /// The cells where a body cannot be because of solid ones.
    fn widened(&self, solid: &[bool]) -> Vec<usize> {
        let reach = ((BODY - TOLERANCE) / CELL) as isize;
        let mut blocked = vec![false; solid.len()];
        for cell in (0..solid.len()).filter(|&c| solid[c]) {
            let (x, y) = ((cell % self.columns) as isize, (cell / self.columns) as isize);
            for dy in -reach..=reach {
                for dx in -reach..=reach {
                    let (i, j) = (x + dx, y + dy);
                    let inside = i >= 0 && j >= 0 && i < self.columns as isize && j < self.rows as isize;
                    if inside && dx * dx + dy * dy <= reach * reach {
                        blocked[j as usize * self.columns + i as usize] = true;
                    }
                }
            }
        }
        (0..blocked.len()).filter(|&c| blocked[c]).collect()
    }
}

/// Something that a body cannot walk through.
struct Obstacle<'a> {
    object: &'a str,
    /// The cells in which it blocks the middle of a body.
    cells: Vec<usize>,
    /// Cost of removing it; `None` for the shell.
    cost: Option<u32>,
}

/// The floor of a home with everything that stands on it. Doors do not count: people open them. Other things that have joints count as
/// they are made: people close them.
pub struct Floor<'a> {
    plan: &'a FloorPlan,
    grid: Grid,
    start: Option<usize>,
    obstacles: Vec<Obstacle<'a>>,
}

/// The cheapest ways from the entrance to every cell.
struct Ways {
    /// Cost of the way, if there is one.
    cost: Vec<Option<u32>>,
    /// The cell before.
    from: Vec<usize>,
}

impl<'a> Floor<'a> {
    /// The floor of a home with all that stands on it.
    pub fn new(home: &'a Home) -> Self {
        let plan = &home.plan;
        let grid = Grid::of(plan);
        let entered = plan.doorways.first().map_or(0, |way| way.into);
        let start = plan.rooms.get(entered).and_then(|room| {
            let way = room.openings.iter().find(|o| o.is_way() && room.is_outer(o))?;
            grid.cell(room.before(way.wall, way.center_x(), BODY + 0.08))
        });
        let obstacles = obstacles(home, &grid);
        Self { plan, grid, start, obstacles }
    }

    /// Rooms that nobody can walk into from the entrance if only the objects of which `stays` is true stand there.
    pub fn unreachable(&self, stays: impl Fn(&str) -> bool) -> Vec<usize> {
        let ways = self.ways(stays);
        (0..self.plan.rooms.len()).filter(|&room| !self.within(room).any(|cell| ways.cost[cell] == Some(0))).collect()
    }

    /// Objects to remove so that people can walk into a room, as few and small as possible; none if walls are in the way.
    pub fn in_the_way(&self, room: usize, stays: impl Fn(&str) -> bool) -> Vec<&'a str> {
        let ways = self.ways(&stays);
        let nearest = self.within(room).filter(|&cell| ways.cost[cell].is_some()).min_by_key(|&cell| ways.cost[cell]);
        let path: Vec<usize> = std::iter::successors(nearest, |&cell| (ways.from[cell] != cell).then_some(ways.from[cell])).collect();
        let crossed = |o: &&Obstacle| stays(o.object) && path.iter().any(|cell| o.cells.binary_search(cell).is_ok());
        self.obstacles.iter().filter(crossed).map(|o| o.object).collect()
    }

    /// The cells of a room.
    fn within(&self, room: usize) -> impl Iterator<Item = usize> {
        let room = &self.plan.rooms[room];
        (0..self.grid.columns * self.grid.rows).filter(move |&c| room.contains(self.grid.place(c), 0.0))
    }

    /// Dijkstra's algorithm: the cost of a cell is the sum of its obstacles' costs.
    fn ways(&self, stays: impl Fn(&str) -> bool) -> Ways {
        let mut toll = vec![Some(0u32); self.grid.columns * self.grid.rows];
        for obstacle in self.obstacles.iter().filter(|o| stays(o.object)) {
            for &cell in &obstacle.cells {
                toll[cell] = toll[cell].and_then(|sum| Some(sum.saturating_add(obstacle.cost?)));
            }
        }
        let mut ways = Ways { cost: vec![None; toll.len()], from: (0..toll.len()).collect() };
        let mut queue: BinaryHeap<Reverse<(u32, usize, usize)>> = BinaryHeap::new();
        queue.extend(self.start.and_then(|start| Some(Reverse((toll[start]?, start, start)))));
        while let Some(Reverse((cost, cell, from))) = queue.pop() {
            if ways.cost[cell].is_some() {
                continue;
            }
            (ways.cost[cell], ways.from[cell]) = (Some(cost), from);
            let open = |next: usize| Some(Reverse((cost.saturating_add(toll[next]?), next, cell)));
            queue.extend(self.grid.beside(cell).filter(|&next| ways.cost[next].is_none()).filter_map(open));
        }
        ways
    }
}

/// Everything at the height of a body, in the order of names.
fn obstacles<'a>(home: &'a Home, grid: &Grid) -> Vec<Obstacle<'a>> {
    let mut solid: BTreeMap<&str, (Vec<bool>, Vec3, Vec3)> = BTreeMap::new();
    for (part, map) in home.scene.parts.iter().zip(as_made(home)) {
        let object = object_of(&part.name);
        if family_of(object) == "door" {
            continue;
        }
        let mesh = &home.scene.meshes[part.mesh as usize];
        let place = |p: Vec3| map.map_or(p, |map| map.transform_point3(p.as_dvec3()).as_vec3());
        let world: Vec<Vec3> = home.scene.world_positions(part).map(place).collect();
        let empty = || (vec![false; grid.columns * grid.rows], Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (cells, low, high) = solid.entry(object).or_insert_with(empty);
        for point in &world {
            (*low, *high) = (low.min(*point), high.max(*point));
        }
        mesh.triangles.iter().for_each(|triangle| grid.mark(triangle.map(|i| world[i as usize]), cells));
    }
    let obstacle = |(object, (cells, low, high)): (&'a str, (Vec<bool>, Vec3, Vec3))| {
        let cost = 1 + (REMOVAL_COST * (high - low).element_product()) as u32;
        Obstacle { object, cells: grid.widened(&cells), cost: (!is_shell(object)).then_some(cost) }
    };
    solid.into_iter().map(obstacle).filter(|o| !o.cells.is_empty()).collect()
}

/// Rooms of a finished home that nobody can walk into from the entrance.
pub fn unreachable(home: &Home) -> Vec<usize> {
    Floor::new(home).unreachable(|_| true)
}
