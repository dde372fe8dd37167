//! Doors, passages and windows in the walls of planned rooms.
//!
//! Doors are 0.76 m wide for wet rooms, 0.885 m for others and 1.01 m for the entrance (structural widths of DIN 18101, clear
//! passage about 60 mm less). Windows have at least an eighth of the floor where the wall is long enough; sills are low in living
//! rooms, above the worktop in kitchens and above eye level of a bather in bathrooms.

use super::search::{Site, Sketch, shared_wall};
use crate::room::{Filling, Opening, Room, Wall};
use enfilade_furniture::{Leaf, RoomKind};
use enfilade_math::Rng;

/// Height of the openings of doors, metres.
const DOOR_TOP: f32 = 2.06;
/// From a door's opening to a corner of the room: the casing and a little plaster.
const DOOR_MARGIN: f32 = 0.10;
/// From a window's opening to a corner of the room.
const WINDOW_MARGIN: f32 = 0.30;
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
        let Some((wall, span)) = shared_wall(&sketch.cells[from], &sketch.cells[into]) else { continue };
        let clear = [span[0] + rooms[from].inner_half(), span[1] - rooms[from].inner_half()];
        let open = clear[1] - clear[0] > 1.7 && rng.next_f32() < may_be_open(kinds[from], kinds[into]);
        if open {
            passage(rooms, from, into, wall, clear, rng);
        } else if needed {
            door(rooms, [from, into], wall, clear, rng);
        } else {
            continue;
        }
        ways.push(Doorway { from: Some(from), into, open });
    }
    ways
}

/// Probability that the wall between two kinds of rooms is left open.
fn may_be_open(a: RoomKind, b: RoomKind) -> f32 {
    use RoomKind::{Dining, Kitchen, Living};
    match (a, b) {
        (Living, Dining) | (Dining, Living) => 0.8,
        (Kitchen, Dining) | (Dining, Kitchen) => 0.6,
        (Kitchen, Living) | (Living, Kitchen) => 0.5,
        _ => 0.0,
    }
}

fn passage(rooms: &mut [Room], from: usize, into: usize, wall: Wall, clear: [f32; 2], rng: &mut Rng) {
    let length = clear[1] - clear[0];
    let width = (length * rng.range(0.5, 0.8)).clamp(1.1, 3.0).min(length - 0.3);
    let low = clear[0] + 0.15 + (length - 0.3 - width) * [0.0, 0.5, 1.0][rng.below(3)];
    let span = [low, low + width];
    let top = rooms[from].size.z - rng.range(0.22, 0.4);
    for (room, wall) in [(from, wall), (into, wall.turned(2))] {
        let x = rooms[room].along_wall(wall, span);
        rooms[room].openings.push(Opening { wall, x, z: [0.0, top], filling: Filling::Passage { lined: room == from } });
    }
}

fn door(rooms: &mut [Room], [from, into]: [usize; 2], wall: Wall, clear: [f32; 2], rng: &mut Rng) {
    let kind = rooms[into].kind;
    // The door of a small room swings out of it, so that someone who has fallen behind it can be reached.
    let (inside, outside) = if kind == RoomKind::Toilet { (from, into) } else { (into, from) };
    let side = |room: usize| if room == from { wall } else { wall.turned(2) };
    let width = if kind.wet() { 0.76f32 } else { 0.885 }.min(clear[1] - clear[0] - 2.0 * DOOR_MARGIN);
    let (first, last) = (clear[0] + DOOR_MARGIN, clear[1] - DOOR_MARGIN - width);
    let steps = (((last - first) / 0.1) as usize).min(40);
    let open_rad = [0.0, rng.range(0.35, 0.9), rng.range(1.2, 1.6), rng.range(1.3, 1.6)][rng.below(if kind.wet() { 3 } else { 4 })];
    let opening = |rooms: &[Room], low: f32, hinge: f32| {
        let x = rooms[inside].along_wall(side(inside), [low, low + width]);
        let leaf = Leaf { hinge, open_rad, back: rooms[from].inner_wall };
        Opening { wall: side(inside), x, z: [0.0, DOOR_TOP], filling: Filling::Door(leaf) }
    };
    let mut best: Option<(f32, f32, Opening)> = None;
    for low in (0..=steps).map(|k| first + (last - first) * k as f32 / steps.max(1) as f32) {
        for hinge in [-1.0, 1.0] {
            let here = opening(rooms, low, hinge);
            let there = Opening { wall: side(outside), x: rooms[outside].along_wall(side(outside), [low, low + width]), ..here };
            let to_corner = |room: &Room, o: &Opening| {
                let half = 0.5 * room.length(o.wall);
                (half + o.x[0]).min(half - o.x[1])
            };
            let hinge_gap = 0.5 * rooms[inside].length(here.wall) - hinge * here.center_x() - 0.5 * width;
            let cost = 10.0 * (rooms[inside].conflicts(&here) + rooms[outside].conflicts(&there))
                + 0.6 * hinge_gap
                + 0.3 * to_corner(&rooms[outside], &there);
            if best.is_none_or(|(known, ..)| cost < known) {
                best = Some((cost, low, here));
            }
        }
    }
    if let Some((_, low, here)) = best {
        let x = rooms[outside].along_wall(side(outside), [low, low + width]);
        rooms[inside].openings.push(here);
        rooms[outside].openings.push(Opening { wall: side(outside), x, z: here.z, filling: Filling::DoorBack });
    }
}

fn entrance(rooms: &mut [Room], sketch: &Sketch, site: Site, rng: &mut Rng) -> Doorway {
    let room = &mut rooms[sketch.hub];
    let fits = |w: Wall| room.outer[w as usize] && room.length(w) > ENTRANCE_WIDTH + 2.0 * DOOR_MARGIN;
    let mut walls: Vec<Wall> = Wall::ALL.into_iter().filter(|&w| fits(w)).collect();
    walls.sort_by_key(|&w| (w != site.entrance, site.open[w as usize]));
    if let Some(&wall) = walls.first() {
        let free = 0.5 * room.length(wall) - DOOR_MARGIN - 0.5 * ENTRANCE_WIDTH;
        let middle = if room.kind == RoomKind::Hall { 0.0 } else { free * if rng.below(2) == 0 { -0.9 } else { 0.9 } };
        let hinge = if middle == 0.0 { [-1.0, 1.0][rng.below(2)] } else { middle.signum() };
        let leaf = Leaf { hinge, open_rad: 0.0, back: room.thickness(wall) };
        let x = [middle - 0.5 * ENTRANCE_WIDTH, middle + 0.5 * ENTRANCE_WIDTH];
        room.openings.push(Opening { wall, x, z: [0.0, DOOR_TOP + 0.06], filling: Filling::Door(leaf) });
    }
    Doorway { from: None, into: sketch.hub, open: false }
}

/// Adds windows where rooms are along an open side of the home.
pub fn add_windows(room: &mut Room, site: Site, rng: &mut Rng) {
    use RoomKind::{Bathroom, Hall, Kitchen, Laundry, Living, Toilet};
    let mut walls: Vec<Wall> = Wall::ALL.into_iter().filter(|&w| room.outer[w as usize] && site.open[w as usize]).collect();
    walls.sort_by(|&a, &b| room.length(b).total_cmp(&room.length(a)));
    let head = room.size.z - rng.range(0.30, 0.36);
    let sill = match room.kind {
        Living => rng.range(0.45, 0.7),
        Kitchen => rng.range(1.06, 1.14),
        Bathroom | Toilet | Laundry => rng.range(1.2, 1.45),
        _ => rng.range(0.7, 0.92),
    };
    let mut wanted = 0.125 * room.size.x * room.size.y * rng.range(1.0, 1.6);
    for (k, wall) in walls.into_iter().enumerate() {
        let seldom = match room.kind {
            Hall | Laundry => 0.3,
            Bathroom | Toilet => 0.8,
            _ => 1.0,
        };
        if rng.next_f32() > seldom || (k > 0 && wanted <= 0.0 && rng.below(2) == 0) {
            continue;
        }
        let Some((low, high)) = free_run(room, wall) else { continue };
        let free = high - low - 2.0 * WINDOW_MARGIN;
        let width = match room.kind {
            Bathroom | Toilet | Laundry | Hall => rng.range(0.55, 0.9),
            Living if k == 0 => (free * rng.range(0.7, 0.85)).clamp(1.4, 3.2),
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

/// The longest piece of a wall without doors, along its x axis.
fn free_run(room: &Room, wall: Wall) -> Option<(f32, f32)> {
    let half = 0.5 * room.length(wall);
    let mut taken: Vec<[f32; 2]> = room.openings.iter().filter(|o| o.wall == wall).map(|o| o.x).collect();
    taken.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut from = -half;
    let mut runs = Vec::new();
    for [low, high] in taken {
        runs.push((from, low));
        from = high;
    }
    runs.push((from, half));
    runs.into_iter().filter(|(a, b)| b - a > 2.0 * WINDOW_MARGIN).max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)))
}
