//! Doors, passages and windows in the walls of planned rooms.
//!
//! Doors are 0.76 m wide for wet rooms, 0.885 m for others and 1.01 m for the entrance (structural widths of DIN 18101, clear
//! passage about 60 mm less). Windows have at least an eighth of the floor where the wall is long enough; sills are low in living
//! rooms, above the worktop in kitchens and above eye level of a bather in bathrooms.

use super::search::{Site, Sketch, shared_wall};
use crate::room::kind::{WindowWidth, Windows, row};
use crate::room::{Filling, Opening, Room, Side, Wall};
use enfilade_furniture::{Leaf, RoomKind};
use enfilade_math::Rng;

/// Height of the openings of doors, metres.
pub const DOOR_TOP: f32 = 2.06;
/// From a door's opening to a corner of the room: the casing and a little plaster.
const DOOR_MARGIN: f32 = 0.10;
/// From a window's opening to a corner of the room.
const WINDOW_MARGIN: f32 = 0.30;
/// Windows of a ribbon: from one to the next, the wall between them, and the usual width of a sash, metres.
const BAY: f32 = 2.7;
const PIER: f32 = 0.3;
const SASH: f32 = 1.1;
/// Width of the opening of the entrance, metres (DIN 18101).
const ENTRANCE_WIDTH: f32 = 1.01;

/// Two rooms with a way between them; `None` is the outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Doorway {
    /// The room that one comes from.
    pub from: Option<usize>,
    /// The room that one enters.
    pub into: usize,
    /// Wide and without a leaf.
    pub open: bool,
}

/// Adds the ways between rooms and the entrance.
pub fn add_doors(rooms: &mut [Room], sketch: &Sketch, kinds: &[RoomKind], site: Site, rng: &mut Rng) -> Vec<Doorway> {
    let mut ways = vec![entrance(rooms, sketch, site, rng)];
    let mut pairs = sketch.doors.clone();
    for i in 0..kinds.len() {
        for j in i + 1..kinds.len() {
            let known = pairs.iter().any(|&(a, b)| (a, b) == (i, j) || (a, b) == (j, i));
            if !known && may_be_open(kinds[i], kinds[j]) > 0.0 {
                pairs.push((i, j));
            }
        }
    }
    for (k, (from, into)) in pairs.into_iter().enumerate() {
        let needed = k < sketch.doors.len();
        let Some((side, span)) = shared_wall(&sketch.cells[from], &sketch.cells[into]) else { continue };
        let clear = [span[0] + rooms[from].inner_half(), span[1] - rooms[from].inner_half()];
        let open = clear[1] - clear[0] > 1.7 && rng.next_f32() < may_be_open(kinds[from], kinds[into]);
        let shared = Shared::between(rooms, [from, into], side, clear);
        if open {
            passage(rooms, &shared, rng);
        } else if needed {
            door(rooms, &shared, rng);
        } else {
            continue;
        }
        ways.push(Doorway { from: Some(from), into, open });
    }
    ways
}

/// Probability that the wall between two kinds of rooms is left open.
fn may_be_open(a: RoomKind, b: RoomKind) -> f32 {
    row(a).ways.open_to.iter().find(|(kind, _)| *kind == b).map_or(0.0, |(_, often)| *often)
}

/// A piece of wall between two rooms, along a line.
pub struct Shared {
    /// The room that one comes from, and the one that is entered.
    pub rooms: [usize; 2],
    /// Their walls.
    pub walls: [Wall; 2],
    /// The piece of the line.
    pub clear: [f32; 2],
    /// The point of the line at the middle of each wall.
    pub origins: [f32; 2],
    /// Whether the line runs along the x axis of each wall, 1, or against it, −1.
    pub signs: [f32; 2],
}

impl Shared {
    /// The piece between two rectangular rooms along the home's x or y; `side` is the first room's.
    fn between(rooms: &[Room], pair: [usize; 2], side: Side, clear: [f32; 2]) -> Self {
        let sides = [side, side.turned(2)];
        let origins = [0, 1].map(|k| rooms[pair[k]].center.dot(sides[k].along().abs()));
        Self { rooms: pair, walls: sides.map(Side::wall), clear, origins, signs: sides.map(|side| side.along().x + side.along().y) }
    }

    /// From a span of the line to the x axis of a wall.
    fn along(&self, k: usize, span: [f32; 2]) -> [f32; 2] {
        let x = span.map(|s| (s - self.origins[k]) * self.signs[k]);
        [x[0].min(x[1]), x[0].max(x[1])]
    }
}

/// Opens a wide way without a leaf between two rooms.
pub fn passage(rooms: &mut [Room], shared: &Shared, rng: &mut Rng) {
    let Shared { clear, rooms: [from, _], .. } = *shared;
    let length = clear[1] - clear[0];
    let width = (length * rng.range(0.5, 0.8)).clamp(1.1, 3.0).min(length - 0.3);
    let low = clear[0] + 0.15 + (length - 0.3 - width) * [0.0, 0.5, 1.0][rng.below(3)];
    let span = [low, low + width];
    let top = rooms[from].size.z - rng.range(0.22, 0.4);
    for k in [0, 1] {
        let (room, wall, x) = (shared.rooms[k], shared.walls[k], shared.along(k, span));
        rooms[room].openings.push(Opening { wall, x, z: [0.0, top], filling: Filling::Passage { lined: room == from } });
    }
}

/// Hangs a door between two rooms where it is least in the way of others.
pub fn door(rooms: &mut [Room], shared: &Shared, rng: &mut Rng) {
    let Shared { clear, rooms: [_, into], .. } = *shared;
    let kind = rooms[into].kind;
    // The door of a small room swings out of it, so that someone who has fallen behind it can be reached.
    let (inside, outside) = if row(kind).ways.swings_out { (0, 1) } else { (1, 0) };
    let width = if kind.wet() { 0.76f32 } else { 0.885 }.min(clear[1] - clear[0] - 2.0 * DOOR_MARGIN);
    let (first, last) = (clear[0] + DOOR_MARGIN, clear[1] - DOOR_MARGIN - width);
    let steps = (((last - first) / 0.1) as usize).min(40);
    let open_rad = [0.0, rng.range(0.35, 0.9), rng.range(1.2, 1.6), rng.range(1.3, 1.6)][rng.below(if kind.wet() { 3 } else { 4 })];
    let opening = |rooms: &[Room], low: f32, hinge: f32| {
        let x = shared.along(inside, [low, low + width]);
        let here = Opening { wall: shared.walls[inside], x, z: [0.0, DOOR_TOP], filling: Filling::DoorBack };
        let back = rooms[shared.rooms[inside]].thickness(&here);
        Opening { filling: Filling::Door(Leaf { hinge, open_rad, back }), ..here }
    };
    let there = |low: f32, here: &Opening| {
        let x = shared.along(outside, [low, low + width]);
        Opening { wall: shared.walls[outside], x, z: here.z, filling: here.filling }
    };
    let (inner, outer) = (shared.rooms[inside], shared.rooms[outside]);
    let mut best: Option<(f32, f32, Opening)> = None;
    for low in (0..=steps).map(|k| first + (last - first) * k as f32 / steps.max(1) as f32) {
        for hinge in [-1.0, 1.0] {
            let here = opening(rooms, low, hinge);
            let there = there(low, &here);
            let to_corner = |room: &Room, o: &Opening| {
                let half = 0.5 * room.length(o.wall);
                (half + o.x[0]).min(half - o.x[1])
            };
            let hinge_gap = 0.5 * rooms[inner].length(here.wall) - hinge * here.center_x() - 0.5 * width;
            let cost = 10.0 * (rooms[inner].conflicts(&here) + rooms[outer].conflicts(&there))
                + 0.6 * hinge_gap
                + 0.3 * to_corner(&rooms[outer], &there);
            if best.is_none_or(|(known, ..)| cost < known) {
                best = Some((cost, low, here));
            }
        }
    }
    if let Some((_, low, here)) = best {
        let there = Opening { filling: Filling::DoorBack, ..there(low, &here) };
        rooms[inner].openings.push(here);
        rooms[outer].openings.push(there);
    }
}

fn entrance(rooms: &mut [Room], sketch: &Sketch, site: Site, rng: &mut Rng) -> Doorway {
    let room = &mut rooms[sketch.hub];
    let fits = |side: Side| room.face(side.wall()).has_outside() && room.length(side.wall()) > ENTRANCE_WIDTH + 2.0 * DOOR_MARGIN;
    let mut sides: Vec<Side> = Side::ALL.into_iter().filter(|&side| fits(side)).collect();
    sides.sort_by_key(|&side| (side != site.entrance, site.open[side as usize]));
    if let Some(wall) = sides.first().map(|side| side.wall()) {
        let free = 0.5 * room.length(wall) - DOOR_MARGIN - 0.5 * ENTRANCE_WIDTH;
        let middle = if row(room.kind).ways.is_way { 0.0 } else { free * if rng.below(2) == 0 { -0.9 } else { 0.9 } };
        let hinge = if middle == 0.0 { [-1.0, 1.0][rng.below(2)] } else { middle.signum() };
        hang_entrance(room, wall, middle, hinge);
    }
    Doorway { from: None, into: sketch.hub, open: false }
}

/// Hangs the home's outer door in a wall, shut, with its middle at `x`.
pub fn hang_entrance(room: &mut Room, wall: Wall, x: f32, hinge: f32) {
    let opening =
        Opening { wall, x: [x - 0.5 * ENTRANCE_WIDTH, x + 0.5 * ENTRANCE_WIDTH], z: [0.0, DOOR_TOP + 0.06], filling: Filling::DoorBack };
    let leaf = Leaf { hinge, open_rad: 0.0, back: room.thickness(&opening) };
    room.openings.push(Opening { filling: Filling::Door(leaf), ..opening });
}

/// Adds windows to walls that look out.
pub fn add_windows(room: &mut Room, mut walls: Vec<Wall>, rng: &mut Rng) {
    let Windows { sill: [low, high], often, width: widths, .. } = row(room.kind).windows;
    walls.sort_by(|&a, &b| room.length(b).total_cmp(&room.length(a)));
    let head = room.size.z - rng.range(0.30, 0.36);
    let sill = rng.range(low, high);
    let mut wanted = 0.125 * room.area * rng.range(1.0, 1.6);
    for (k, wall) in walls.into_iter().enumerate() {
        if rng.next_f32() > often || (k > 0 && wanted <= 0.0 && rng.below(2) == 0) {
            continue;
        }
        let Some((low, high)) = free_run(room, wall, head + 0.05, 0.0) else { continue };
        let free = high - low - 2.0 * WINDOW_MARGIN;
        if widths == WindowWidth::Ribbon {
            if k == 0 || (k == 1 && rng.below(2) == 0) {
                ribbon(room, wall, [low, high], [sill, head]);
            }
            continue;
        }
        let width = match widths {
            WindowWidth::Small => rng.range(0.55, 0.9),
            WindowWidth::Wide if k == 0 => (free * rng.range(0.7, 0.85)).clamp(1.4, 3.2),
            _ => (wanted / (head - sill)).clamp(1.0, 2.4),
        };
        let width = ((width / 0.125).round() * 0.125).min(free);
        if width < 0.45 {
            continue;
        }
        let middle = 0.5 * (low + high) + (free - width).max(0.0) * rng.range(-0.18, 0.18);
        let sashes = if width < 0.95 { 1 } else { 1 + ((width - 0.15) / 1.05) as usize };
        let x = [middle - 0.5 * width, middle + 0.5 * width];
        room.openings.push(Opening { wall, x, z: [sill, head], filling: Filling::Window { sashes: sashes.min(4) } });
        wanted -= width * (head - sill);
    }
}

/// Windows over all of a piece of wall, with narrow pieces of wall between them.
fn ribbon(room: &mut Room, wall: Wall, [low, high]: [f32; 2], z: [f32; 2]) {
    let free = high - low - 2.0 * WINDOW_MARGIN + PIER;
    let count = (free / BAY).round().max(1.0);
    let step = free / count;
    for k in 0..count as usize {
        let x0 = low + WINDOW_MARGIN + step * k as f32;
        let x = [x0, x0 + step - PIER];
        let sashes = (((x[1] - x[0]) / SASH).round() as usize).max(1);
        room.openings.push(Opening { wall, x, z, filling: Filling::Window { sashes } });
    }
}

/// The longest piece of a wall along its x axis that has the outside behind it and no openings, where the ceiling is at least `height` high
/// in the wall and up to `depth` before it.
pub fn free_run(room: &Room, wall: Wall, height: f32, depth: f32) -> Option<(f32, f32)> {
    let half = 0.5 * room.length(wall);
    let inner = room.face(wall).backs.iter().filter(|back| !back.outer).map(|back| back.x);
    let mut taken: Vec<[f32; 2]> = room.openings.iter().filter(|o| o.wall == wall).map(|o| o.x).chain(inner).collect();
    taken.extend(room.low_spans(wall, [-room.outer_wall, depth], height));
    taken.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut from = -half;
    let mut runs = Vec::new();
    for [low, high] in taken {
        runs.push((from, low));
        from = if room.slopes.is_empty() { high } else { high.max(from) };
    }
    runs.push((from, half));
    runs.into_iter().filter(|(a, b)| b - a > 2.0 * WINDOW_MARGIN).max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)))
}
