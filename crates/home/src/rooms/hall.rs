//! The hall: where coats and shoes stay, and a last look into the mirror.

use super::Furnisher;
use super::furnisher::Standing;
use super::wishes::{by_door, centred, cornered, in_view, tucked_away};
use crate::place::{Piece, Spot};
use enfilade_furniture::{Furniture, Rug};
use enfilade_math::Vec2;
use std::f32::consts::FRAC_PI_2;

/// Width of a runner, metres.
const RUNNER: f32 = 0.66;
/// Lengths of the runner, the longest first, metres.
const LENGTHS: [f32; 4] = [2.4, 1.9, 1.5, 1.2];
/// Length of floor that a runner leaves free at its ends together, metres.
const BORDER: f32 = 0.5;
/// Halls from this length on have two ceiling lamps, metres.
const LONG: f32 = 3.2;
/// Distance between lamps and walls, metres.
const LAMP_AIR: f32 = 0.3;
/// Height of the middle of a mirror over a console.
const MIRROR: f32 = 1.55;

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    if f.hang_one(0.7, "coat_hooks", 1.65, by_door).is_none() {
        f.furnish("coat_stand", by_door);
    }
    let families = if f.chance(0.6) { ["console", "shoe_cabinet"] } else { ["shoe_cabinet", "console"] };
    let low = f.furnish(families[0], centred).or_else(|| f.furnish(families[1], centred));
    f.perhaps(0.7, "bench", by_door);
    let mirrored = low.is_some_and(|low| f.chance(0.75) && mirror_over(f, &low));
    if !mirrored && f.perhaps(0.5, "tall_mirror", in_view).is_none() {
        f.hang_one(0.8, "mirror", 1.5, in_view);
    }
    f.perhaps(0.7, "shoes", by_door);
    f.perhaps(0.5, "umbrella_stand", cornered);
    f.perhaps(0.6, "plant", tucked_away);
    f.art(3, in_view);
    f.mat("door_mat", |floor, s| floor.to_way(s.origin));
    if f.chance(0.8) {
        runner(f);
    }
    lamps(f);
}

/// A lamp in the middle, or one over each half of a long hall.
fn lamps(f: &mut Furnisher) {
    let size = f.room.size.truncate();
    let along = if size.x >= size.y { Vec2::X } else { Vec2::Y };
    let apart = 0.25 * size.max_element() * along;
    let [low, high] = [f.room.box_center - apart, f.room.box_center + apart];
    if size.max_element() < LONG || ![low, high].iter().all(|&p| f.room.contains(p, -LAMP_AIR)) {
        f.ceiling_lamp();
    } else {
        f.ceiling_lamps(&[low, high]);
    }
    f.hang_one(0.4, "wall_lamp", 1.75, in_view);
}

/// Hangs a mirror above a thing at a wall; false if there is no room for it.
fn mirror_over(f: &mut Furnisher, low: &Standing) -> bool {
    let (Some(wall), x) = (low.spot.wall, low.spot.x) else { return false };
    let Some(mirror) = f.any("mirror") else { return false };
    let above = |s: &Spot| if (s.x - x).abs() < 0.12 { (s.x - x).abs() } else { f32::INFINITY };
    f.hang(mirror.as_ref(), MIRROR, &[wall], |_, s| above(s)).is_some()
}

/// A long rug in the middle of the way, the longest that fits.
fn runner(f: &mut Furnisher) {
    let (size, center) = (f.room.size.truncate(), f.room.center);
    let yaw = if size.x >= size.y { 0.0 } else { FRAC_PI_2 };
    for length in LENGTHS.into_iter().filter(|length| *length <= size.max_element() - BORDER) {
        let rug = Rug { size: Vec2::new(length, RUNNER) };
        let piece = Piece { flat: true, ..Piece::standing(rug.size(), 0.0).at(0.0, 0.0, 0.0) };
        let spots = f.floor.everywhere(0.1, &[yaw]);
        if let Some((_, poses)) = f.floor.place(&[piece], spots, |_, s| s.origin.distance(center)) {
            return f.build(&rug, poses[0]);
        }
    }
}
