//! Rooms on both sides of a corridor, as in offices and schools.
//!
//! The rooms of a side are equally deep, so that the corridor is straight; which rooms are on which side, how long the corridor is and how
//! large each room, is the best of many tries by the widths and proportions that rooms need.

use super::search::Sketch;
use super::slicing::Cell;
use crate::room::kind::{norm, row};
use enfilade_furniture::RoomKind;
use enfilade_math::{Rng, Vec2};

/// Plans that are tried.
const TRIES: usize = 1500;
/// Lengths of corridors, metres.
const LENGTH: [f32; 2] = [5.0, 28.0];
/// Widths of corridors, metres: two people pass each other, and somebody opens a locker.
const WIDTH: [f32; 2] = [1.8, 2.7];
/// Cells reach to the middle of walls; rooms lose this much of their width, metres.
const WALLS: f32 = 0.13;
/// Shortest piece of a corridor's wall that has room for a door and its casings, metres.
const DOOR_WALL: f32 = 1.3;
/// Cost of a room below which nothing is wrong with it.
pub(super) const FINE: f32 = 1.0;
/// Area of a cell over that of its room.
const GROSS: f32 = 1.06;

/// Rooms along a corridor, which is the first of `kinds` that is a way; other ways are rooms like all others.
pub(super) fn along(kinds: &[RoomKind], rng: &mut Rng) -> Sketch {
    let corridor = kinds.iter().position(|&kind| row(kind).ways.is_way).unwrap_or(0);
    let mut best = tried(kinds, corridor, rng);
    for _ in 1..TRIES {
        let next = tried(kinds, corridor, rng);
        if next.cost < best.cost {
            best = next;
        }
    }
    best
}

/// A plan at random, with its cost.
fn tried(kinds: &[RoomKind], corridor: usize, rng: &mut Rng) -> Sketch {
    let mut rooms: Vec<usize> = (0..kinds.len()).filter(|&room| room != corridor).collect();
    rng.shuffle(&mut rooms);
    let split = rng.below(rooms.len() + 1);
    let areas: Vec<f32> = kinds
        .iter()
        .map(|&kind| {
            let [least, most] = norm(kind).area;
            GROSS * rng.range(least, most)
        })
        .collect();
    let (length, width) = (on_grid(rng.range(LENGTH[0], LENGTH[1])), on_grid(rng.range(WIDTH[0], WIDTH[1])));
    let sides = [&rooms[..split], &rooms[split..]];
    let depths = sides.map(|side| on_grid(side.iter().map(|&room| areas[room]).sum::<f32>() / length));
    let half = 0.5 * Vec2::new(length, depths[0] + width + depths[1]);
    let half = half.map(on_grid);
    let whole = Cell { min: -half, max: half };
    let passage = [whole.min.y + depths[0], whole.max.y - depths[1]];
    let mut cells = vec![whole; kinds.len()];
    cells[corridor] = Cell { min: Vec2::new(whole.min.x, passage[0]), max: Vec2::new(whole.max.x, passage[1]) };
    for (side, y) in sides.into_iter().zip([[whole.min.y, passage[0]], [passage[1], whole.max.y]]) {
        let total: f32 = side.iter().map(|&room| areas[room]).sum();
        let (mut sum, mut from) = (0.0, whole.min.x);
        for (k, &room) in side.iter().enumerate() {
            sum += areas[room];
            let to = if k + 1 == side.len() { whole.max.x } else { on_grid(whole.min.x + 2.0 * half.x * sum / total) };
            cells[room] = Cell { min: Vec2::new(from, y[0]), max: Vec2::new(to, y[1]) };
            from = to;
        }
    }
    let cost = rooms.iter().map(|&room| cost_of(kinds[room], &cells[room])).sum();
    let doors = rooms.iter().map(|&room| (corridor, room)).collect();
    Sketch { cells, whole, doors, hub: corridor, cost }
}

fn on_grid(length: f32) -> f32 {
    (length * 50.0).round() / 50.0
}

/// Cost of a room's width and proportions.
fn cost_of(kind: RoomKind, cell: &Cell) -> f32 {
    let (norm, clear) = (norm(kind), cell.size() - WALLS);
    let (width, length) = (clear.min_element(), clear.max_element());
    let narrow = ((norm.width - width) / norm.width).max(0.0);
    let long = (length / width.max(0.1) / norm.aspect - 1.0).max(0.0);
    let no_door = (DOOR_WALL - clear.x).max(0.0);
    40.0 * narrow + 6.0 * long + 40.0 * no_door + 0.3 * (length / width.max(0.1) - 1.3).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_room_has_a_door_to_the_corridor_and_its_usual_proportions() {
        use RoomKind::{Classroom, Corridor, Meeting, Office, OpenOffice};
        let programmes =
            [vec![Corridor, Classroom, Classroom], vec![Office, Corridor, Office, Office, Meeting, OpenOffice], vec![Corridor, Office]];
        for (kinds, seed) in programmes.iter().flat_map(|kinds| (0..20).map(move |seed| (kinds, seed))) {
            let sketch = along(kinds, &mut Rng::new(seed));
            let hub = &sketch.cells[sketch.hub];
            assert!(sketch.cost < FINE * kinds.len() as f32, "{kinds:?} {seed}: {}", sketch.cost);
            assert_eq!((kinds[sketch.hub], sketch.doors.len()), (Corridor, kinds.len() - 1));
            for (kind, cell) in kinds.iter().zip(&sketch.cells).filter(|(kind, _)| **kind != Corridor) {
                let touches = (cell.max.y - hub.min.y).abs() < 1e-3 || (cell.min.y - hub.max.y).abs() < 1e-3;
                let width = cell.size().min_element() - WALLS;
                assert!(touches && width > 0.93 * norm(*kind).width, "{kinds:?} {seed}: {kind:?} {cell:?}");
            }
        }
    }
}
