//! The search for a floor plan: simulated annealing over slicing plans, areas and the shape of the whole.

use super::slicing::{Cell, Slicing};
use crate::room::Side;
use crate::room::kind::{Daylight, Ways, access, norm, row};
use enfilade_furniture::RoomKind;
use enfilade_math::{Rng, Vec2};

/// Shortest piece of wall that two rooms share where a door between them has room for its casings.
const DOOR_WALL: f32 = 1.2;
/// Shortest outer wall that a window fits into.
const WINDOW_WALL: f32 = 1.5;
/// Cells reach to the middle of walls; rooms lose this much of their width.
const WALLS: f32 = 0.13;
/// Cost of breaking a rule: more than all wishes together.
const BROKEN: f32 = 20.0;
/// Edges nearer than this are the same edge, metres: cells are cut on a grid of 10 mm.
const SAME: f32 = 1e-3;
/// Changes that one search tries.
const STEPS: usize = 3000;

/// The surroundings of a home: which of its sides look out, south, east, north, west.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Site {
    /// Sides with windows; the others have neighbours or the stairs behind them.
    pub open: [bool; 4],
    /// The side that one enters from.
    pub entrance: Side,
}

/// Rooms in their cells, how good that is, and which rooms have doors to which.
#[derive(Clone, Debug)]
pub struct Sketch {
    /// Cells of the rooms, one for each.
    pub cells: Vec<Cell>,
    /// Cell of the whole home.
    pub whole: Cell,
    /// Pairs (from, into) such that every room but the first of them is entered once.
    pub doors: Vec<(usize, usize)>,
    /// The room that one enters first.
    pub hub: usize,
    /// The smaller the better; below [`Sketch::FINE`] nothing is broken.
    pub cost: f32,
}

impl Sketch {
    /// A sketch that costs less breaks no rule.
    pub const FINE: f32 = BROKEN;
}

/// The piece of wall between two cells: the wall of the first, and from where to where along x or y.
pub fn shared_wall(a: &Cell, b: &Cell) -> Option<(Side, [f32; 2])> {
    for (wall, axis, touch) in [
        (Side::South, 0, a.min.y - b.max.y),
        (Side::East, 1, a.max.x - b.min.x),
        (Side::North, 0, a.max.y - b.min.y),
        (Side::West, 1, a.min.x - b.max.x),
    ] {
        let span = [a.min[axis].max(b.min[axis]), a.max[axis].min(b.max[axis])];
        if touch.abs() < SAME && span[1] > span[0] + SAME {
            return Some((wall, span));
        }
    }
    None
}

/// True if `cell` touches this side of the whole.
pub fn on_side(cell: &Cell, whole: &Cell, wall: Side) -> bool {
    let gap = match wall {
        Side::South => cell.min.y - whole.min.y,
        Side::East => whole.max.x - cell.max.x,
        Side::North => whole.max.y - cell.max.y,
        Side::West => cell.min.x - whole.min.x,
    };
    gap.abs() < SAME
}

/// Length of a cell's side.
pub fn side_length(cell: &Cell, wall: Side) -> f32 {
    if wall.along().x == 0.0 { cell.size().y } else { cell.size().x }
}

#[derive(Clone)]
struct State {
    slicing: Slicing,
    areas: Vec<f32>,
    aspect: f32,
}

/// The best of many plans for rooms of these kinds.
pub fn search(kinds: &[RoomKind], site: Site, rng: &mut Rng) -> Sketch {
    let mut state = first(kinds, rng);
    let wished = state.areas.clone();
    let mut now = judge(kinds, site, &state, &wished);
    let mut best = now.clone();
    for step in 0..STEPS {
        let heat = 2.5 * (0.004f32).powf(step as f32 / STEPS as f32);
        let next = moved(&state, kinds, rng);
        let found = judge(kinds, site, &next, &wished);
        if found.cost < now.cost || rng.next_f32() < ((now.cost - found.cost) / heat).exp() {
            (state, now) = (next, found);
        }
        if now.cost < best.cost {
            best = now.clone();
        }
    }
    best
}

/// Rows of rooms on both sides of the room that one enters.
fn first(kinds: &[RoomKind], rng: &mut Rng) -> State {
    let hub = hub(kinds);
    let mut others: Vec<usize> = (0..kinds.len()).filter(|&i| i != hub).collect();
    rng.shuffle(&mut others);
    let (front, back) = others.split_at(others.len() / 2);
    let slicing = Slicing::rows(&[front.to_vec(), vec![hub], back.to_vec()]);
    let areas = kinds.iter().map(|kind| gross(norm(*kind).area, rng.next_f32())).collect();
    State { slicing, areas, aspect: rng.range(1.0, 1.6) }
}

/// Area with its share of the walls.
fn gross(area: [f32; 2], t: f32) -> f32 {
    1.08 * (area[0] + (area[1] - area[0]) * t)
}

fn moved(state: &State, kinds: &[RoomKind], rng: &mut Rng) -> State {
    let mut next = state.clone();
    match rng.below(8) {
        0 => next.aspect = (next.aspect * rng.range(0.9, 1.1)).clamp(0.8, 1.8),
        1 | 2 => {
            let i = rng.below(kinds.len());
            let area = norm(kinds[i]).area;
            next.areas[i] = (next.areas[i] * rng.range(0.85, 1.18)).clamp(gross(area, 0.0), gross(area, 1.0));
        }
        _ => next.slicing = next.slicing.changed(rng),
    }
    next
}

/// The room that one enters first: the hall, else the living room or what is in its place in other buildings, else the first.
fn hub(kinds: &[RoomKind]) -> usize {
    let first = |is_one: fn(&Ways) -> bool| kinds.iter().position(|&kind| is_one(&row(kind).ways));
    first(|ways| ways.is_way).or_else(|| first(|ways| ways.entrance <= 1)).unwrap_or(0)
}

fn judge(kinds: &[RoomKind], site: Site, state: &State, wished: &[f32]) -> Sketch {
    let area: f32 = state.areas.iter().sum();
    let half = 0.5 * Vec2::new((area * state.aspect).sqrt(), (area / state.aspect).sqrt());
    let half = (half * 50.0).round() / 50.0;
    let whole = Cell { min: -half, max: half };
    let cells = state.slicing.cells(whole, &state.areas);
    let hub = hub(kinds);
    let mut cost: f32 = state.areas.iter().zip(wished).map(|(area, wish)| 3.0 * (area / wish).ln().powi(2)).sum();
    for (kind, cell) in kinds.iter().zip(&cells) {
        cost += shape_cost(*kind, cell) + daylight_cost(*kind, cell, &whole, site);
    }
    if !Side::ALL.into_iter().any(|w| on_side(&cells[hub], &whole, w) && side_length(&cells[hub], w) > DOOR_WALL + 0.25) {
        cost += BROKEN;
    } else if !on_side(&cells[hub], &whole, site.entrance) {
        cost += 1.5;
    }
    let (doors, access) = doors(kinds, &cells, hub);
    cost += access + neighbour_cost(kinds, &cells);
    Sketch { cells, whole, doors, hub, cost }
}

fn shape_cost(kind: RoomKind, cell: &Cell) -> f32 {
    let (norm, clear) = (norm(kind), cell.size() - WALLS);
    let (width, length) = (clear.min_element(), clear.max_element());
    let narrow = ((norm.width - width) / norm.width).max(0.0);
    let long = (length / width.max(0.1) / norm.aspect - 1.0).max(0.0);
    let broken = if width < norm.width { BROKEN } else { 0.0 };
    // A hall is a way, not a room: as narrow as it may be.
    let wide = if row(kind).ways.is_way { 1.2 * (width - 1.75).max(0.0) } else { 0.0 };
    broken + 40.0 * narrow + 6.0 * long + wide
}

fn daylight_cost(kind: RoomKind, cell: &Cell, whole: &Cell, site: Site) -> f32 {
    let wall = |w: Side| if site.open[w as usize] && on_side(cell, whole, w) { side_length(cell, w) } else { 0.0 };
    let (longest, all) = Side::ALL.into_iter().map(wall).fold((0.0f32, 0.0f32), |(l, a), w| (l.max(w), a + w));
    match row(kind).windows.daylight {
        _ if norm(kind).window && longest < WINDOW_WALL => 1.5 * BROKEN - 2.0 * longest,
        Daylight::Wide => 0.5 * (4.5 - longest).max(0.0) - 0.05 * all,
        // Halls, stores and toilets leave the façades to others.
        Daylight::Shuns(cost) => cost * all,
        Daylight::Usual => 0.2 * (2.4 - longest).max(0.0),
    }
}

/// The cheapest tree of doors (Prim), and what it costs.
fn doors(kinds: &[RoomKind], cells: &[Cell], hub: usize) -> (Vec<(usize, usize)>, f32) {
    let mut inside = vec![hub];
    let (mut tree, mut cost) = (Vec::new(), 0.0);
    while inside.len() < kinds.len() {
        let mut next = (f32::MAX, 0, 0);
        for &from in &inside {
            for into in (0..kinds.len()).filter(|i| !inside.contains(i)) {
                let Some((_, [low, high])) = shared_wall(&cells[from], &cells[into]) else { continue };
                let short = if high - low < DOOR_WALL { 1.5 * BROKEN } else { 0.0 };
                let access = access(kinds[into], kinds[from]) + short;
                if access < next.0 {
                    next = (access, from, into);
                }
            }
        }
        let (access, from, into) = next;
        if access == f32::MAX {
            return (tree, cost + 10.0 * BROKEN);
        }
        inside.push(into);
        tree.push((from, into));
        cost += access * access * 1.5;
    }
    (tree, cost)
}

/// Cost of rooms that are not beside those that they belong with.
fn neighbour_cost(kinds: &[RoomKind], cells: &[Cell]) -> f32 {
    use RoomKind::{Dining, Kitchen, Living};
    let has = |kind| kinds.contains(&kind);
    let touch = |a: RoomKind, b: RoomKind| {
        let all = |kind| (0..kinds.len()).filter(move |&i| kinds[i] == kind);
        all(a).any(|i| all(b).any(|j| shared_wall(&cells[i], &cells[j]).is_some_and(|(_, [low, high])| high - low > 1.8)))
    };
    let mut cost = 0.0;
    for (a, b, worth) in [(Dining, Kitchen, 1.2), (Living, Dining, 1.0), (Living, Kitchen, if has(Dining) { 0.0 } else { 1.0 })] {
        if has(a) && has(b) && !touch(a, b) {
            cost += worth;
        }
    }
    let wet: Vec<usize> = (0..kinds.len()).filter(|&i| kinds[i].wet() || kinds[i] == Kitchen).collect();
    for (k, &i) in wet.iter().enumerate() {
        if wet.len() > 1 && !wet.iter().enumerate().any(|(m, &j)| m != k && shared_wall(&cells[i], &cells[j]).is_some()) {
            cost += 0.25;
        }
    }
    cost
}
