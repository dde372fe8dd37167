//! Where a person can go in a finished home.

use super::{family_of, object_of};
use crate::Home;
use crate::place::BODY;
use enfilade_math::{Vec2, Vec3};

/// Edge of a grid cell, metres.
const CELL: f32 = 0.05;
/// What lies lower is stepped over, what hangs higher is walked under.
const HEIGHTS: [f32; 2] = [0.12, 1.9];
/// Cells decide by their middle.
const TOLERANCE: f32 = 0.04;

struct Grid {
    min: Vec2,
    columns: usize,
    rows: usize,
}

impl Grid {
    fn cell(&self, p: Vec2) -> Option<usize> {
        let q = (p - self.min) / CELL;
        let inside = q.cmpge(Vec2::ZERO).all() && (q.x as usize) < self.columns && (q.y as usize) < self.rows;
        inside.then(|| q.y as usize * self.columns + q.x as usize)
    }

    fn place(&self, cell: usize) -> Vec2 {
        self.min + CELL * (Vec2::new((cell % self.columns) as f32, (cell / self.columns) as f32) + 0.5)
    }
}

/// Rooms that nobody can walk into from the entrance, if only objects stand there of which `stays` is true. Doors do not count: people
/// open them.
pub fn unreachable(home: &Home, stays: impl Fn(&str) -> bool) -> Vec<usize> {
    let plan = &home.plan;
    let margin = 0.5;
    let min = plan.whole.min - margin;
    let size = ((plan.whole.max + margin - min) / CELL).ceil();
    let grid = Grid { min, columns: size.x as usize, rows: size.y as usize };
    let blocked = widened(&grid, &solid(&grid, home, stays));
    let entered = plan.doorways.first().map_or(0, |way| way.into);
    let start = plan.rooms.get(entered).and_then(|room| {
        let way = room.openings.iter().find(|o| o.is_way() && room.outer[o.wall as usize])?;
        grid.cell(room.before(way.wall, way.center_x(), BODY + 0.08))
    });
    let mut seen = vec![false; blocked.len()];
    let mut stack: Vec<usize> = start.into_iter().filter(|&s| !blocked[s]).collect();
    while let Some(cell) = stack.pop() {
        if !std::mem::replace(&mut seen[cell], true) {
            let (x, y) = (cell % grid.columns, cell / grid.columns);
            let ways = [
                (x > 0, cell.wrapping_sub(1)),
                (x + 1 < grid.columns, cell + 1),
                (y > 0, cell.wrapping_sub(grid.columns)),
                (y + 1 < grid.rows, cell + grid.columns),
            ];
            stack.extend(ways.into_iter().filter(|&(there, next)| there && !blocked[next] && !seen[next]).map(|(_, next)| next));
        }
    }
    let entered = |i: &usize| {
        let room = &plan.rooms[*i];
        let half = 0.5 * room.size.truncate();
        (0..seen.len()).any(|c| seen[c] && (grid.place(c) - room.center).abs().cmplt(half).all())
    };
    (0..plan.rooms.len()).filter(|i| !entered(i)).collect()
}

/// Cells that something stands in which `stays`, at the height of a body.
fn solid(grid: &Grid, home: &Home, stays: impl Fn(&str) -> bool) -> Vec<bool> {
    let mut cells = vec![false; grid.columns * grid.rows];
    for part in &home.scene.parts {
        let object = object_of(&part.name);
        if family_of(object) == "door" || !stays(object) {
            continue;
        }
        let mesh = &home.scene.meshes[part.mesh as usize];
        let world: Vec<Vec3> = mesh.positions.iter().map(|p| part.world_from_mesh.transform_point3(p.as_dvec3()).as_vec3()).collect();
        for triangle in &mesh.triangles {
            let corners = triangle.map(|i| world[i as usize]);
            let (low, high) = (corners[0].min(corners[1]).min(corners[2]), corners[0].max(corners[1]).max(corners[2]));
            if high.z < HEIGHTS[0] || low.z > HEIGHTS[1] {
                continue;
            }
            // Large triangles are those of walls, whose boxes are as thin as they are.
            let steps = ((high - low).truncate() / CELL).ceil();
            for j in 0..=steps.y as usize {
                for i in 0..=steps.x as usize {
                    let p = low.truncate() + (high - low).truncate() * Vec2::new(i as f32, j as f32) / steps.max(Vec2::ONE);
                    if let Some(cell) = grid.cell(p) {
                        cells[cell] = true;
                    }
                }
            }
        }
    }
    cells
}

/// Every solid cell widened by half a body.
fn widened(grid: &Grid, solid: &[bool]) -> Vec<bool> {
    let reach = ((BODY - TOLERANCE) / CELL) as isize;
    let mut blocked = vec![false; solid.len()];
    for cell in (0..solid.len()).filter(|&c| solid[c]) {
        let (x, y) = ((cell % grid.columns) as isize, (cell / grid.columns) as isize);
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let (i, j) = (x + dx, y + dy);
                let inside = i >= 0 && j >= 0 && i < grid.columns as isize && j < grid.rows as isize;
                if inside && dx * dx + dy * dy <= reach * reach {
                    blocked[j as usize * grid.columns + i as usize] = true;
                }
            }
        }
    }
    blocked
}
