//! Things that are put down: on tables, seats and beds, on top of cupboards, and on floors beside, below and along what stands there.

use super::stage::{Bundle, Stage, middle};
use super::table::At;
use super::wish::Wish;
use crate::place::Floor;
use crate::room::{Footprint, Room};
use enfilade_furniture::meet::Body;
use enfilade_furniture::touch::is_soft;
use enfilade_furniture::{family_of, object_of, pose};
use enfilade_math::{Bounds3, DAffine3, DVec3, Rng, Vec2};
use std::f32::consts::{FRAC_PI_2, TAU};

/// Random places that are tried for each thing.
const TRIES: usize = 160;
/// Unevenness on which things lie, metres: hard things, soft things, and hard things on cushions and beds.
const UNEVEN: [f32; 3] = [0.006, 0.05, 0.02];
/// Free height over things, metres.
const AIR: f32 = 0.012;
/// Things are let go this far above what they are to lie on, metres.
const ABOVE: f32 = 0.012;
/// Things beside a piece are at most this far from it, metres.
const BESIDE: f32 = 0.45;
/// Things along walls are at most this far from them, metres.
const ALONG: f32 = 0.18;
/// Families with cushions or covers that give way below hard things.
const GIVES: [&str; 12] = [
    "bed",
    "sofa",
    "corner_sofa",
    "chesterfield",
    "day_bed",
    "armchair",
    "club_chair",
    "upholstered_chair",
    "office_chair",
    "pouf",
    "bench",
    "floor_cushion",
];

/// The rectangle that a thing fills in its own space, and its height.
#[derive(Clone, Copy)]
struct Extent {
    middle: Vec2,
    half: Vec2,
    height: f32,
}

/// Puts a thing down where its row says, if there is a place.
pub fn lay(stage: &mut Stage, floors: &mut [Floor], wish: &Wish, bundle: Bundle) {
    let mut rng = wish.rng.clone();
    let soft = bundle.parts.iter().all(|part| is_soft(object_of(&part.name)));
    let bounds = stage.bodies_of(&bundle, DAffine3::IDENTITY).iter().fold(Bounds3::EMPTY, |all, body| all.union(body.bounds));
    let extent = Extent { middle: middle(&bounds), half: 0.5 * bounds.extent().truncate(), height: bounds.max.z };
    for _ in 0..TRIES {
        let Some((place, level)) = place(stage, &floors[wish.room], wish, extent, soft, &mut rng) else { continue };
        let at = place.center - Vec2::from_angle(place.yaw).rotate(extent.middle);
        let pose = pose(f64::from(at.x), f64::from(at.y), f64::from(level + ABOVE), f64::from(place.yaw));
        let bodies: Vec<Body> = stage.bodies_of(&bundle, pose);
        let Some(by) = stage.lowered(&bodies, &[]) else { continue };
        if on_floor(wish.row.at) && !floors[wish.room].leave(&place, extent.height, matches!(wish.row.at, At::Under(_))) {
            continue;
        }
        stage.put(bundle, DAffine3::from_translation(DVec3::Z * f64::from(by)) * pose);
        return;
    }
}

/// True where it lies on the floor of the room.
pub fn on_floor(at: At) -> bool {
    matches!(at, At::Under(_) | At::Beside(_) | At::AlongWalls | At::Anywhere)
}

/// A random place that is level and free, and its height.
fn place(stage: &mut Stage, floor: &Floor, wish: &Wish, extent: Extent, soft: bool, rng: &mut Rng) -> Option<(Footprint, f32)> {
    let host = wish.host.as_deref();
    let on_floor = on_floor(wish.row.at);
    let (room, high) = (floor.room(), matches!(wish.row.at, At::Above(_)));
    let turn = room.grain + FRAC_PI_2 * rng.below(4) as f32;
    let yaw = if rng.below(3) == 0 { rng.range(0.0, TAU) } else { turn + rng.range(-0.4, 0.4) };
    let window = if on_floor { None } else { Some(stage.over(host?, high)?.window()) };
    let place = match (wish.row.at, window) {
        (At::AlongWalls, _) => along_wall(room, extent.half, rng),
        (_, Some(window)) => Footprint { center: within(window, rng), half: extent.half, yaw },
        _ => Footprint { center: floor_point(stage, room, wish, extent.half, rng)?, half: extent.half, yaw },
    };
    let gives = host.is_some_and(|host| GIVES.contains(&family_of(host)));
    let uneven = match (soft, gives && !on_floor) {
        (true, _) => UNEVEN[1],
        (_, true) => UNEVEN[2],
        _ => UNEVEN[0],
    };
    let ground = if on_floor { stage.floor(wish.room) } else { stage.over(host?, high) };
    let level = ground?.level(&place, extent.height + AIR).filter(|level| level.spread <= uneven)?;
    Some((place, level.top))
}

/// A random place before a wall, for something that leans on it or stands by it.
fn along_wall(room: &Room, half: Vec2, rng: &mut Rng) -> Footprint {
    let walls = room.walls();
    let wall = walls[rng.below(walls.len())];
    let x = 0.5 * room.length(wall) * rng.range(-1.0, 1.0);
    let turn = rng.range(-0.25, 0.25);
    let deep = half.y + half.x * turn.abs() + rng.range(0.015, ALONG);
    Footprint { center: room.before(wall, x, deep), half, yaw: room.yaw(wall) + turn }
}

/// A random point of a rectangle.
pub fn within([min, max]: [Vec2; 2], rng: &mut Rng) -> Vec2 {
    min + (max - min) * Vec2::new(rng.next_f32(), rng.next_f32())
}

/// A random point of the floor where a row has its things, of which half the width and depth are `half`.
pub fn floor_point(stage: &Stage, room: &Room, wish: &Wish, half: Vec2, rng: &mut Rng) -> Option<Vec2> {
    let size = 0.5 * room.size.truncate();
    let anywhere = within([room.box_center - size, room.box_center + size], rng);
    let bounds = wish.host.as_deref().and_then(|host| stage.body(host)).map(|body| body.bounds);
    let point = match wish.row.at {
        At::Beside(_) => Some(around(&bounds?, half, rng)),
        At::Under(_) => {
            let bounds = bounds?;
            Some(within([bounds.min.truncate(), bounds.max.truncate()], rng))
        }
        _ => Some(anywhere),
    };
    point.filter(|&point| room.contains(point, 0.0))
}

/// A random point around a box, at most [`BESIDE`] away.
fn around(bounds: &Bounds3, half: Vec2, rng: &mut Rng) -> Vec2 {
    let reach = 0.5 * bounds.extent().truncate() + half.max_element() + rng.range(0.0, BESIDE);
    let side = Vec2::new(rng.range(-1.0, 1.0), if rng.below(2) == 0 { 1.0 } else { -1.0 });
    let side = if rng.below(2) == 0 { side } else { side.perp() };
    middle(bounds) + side * reach
}
