//! What is not quite where it belongs: chairs pulled out and turned, cushions and pillows askew, pictures that hang a little crooked.

use super::stage::{Stage, middle};
use super::table::interpolated;
use crate::place::Floor;
use crate::room::Footprint;
use enfilade_furniture::family_of;
use enfilade_math::{DAffine3, DVec3, Rng, Vec2, Vec3, hash_text};

/// A family that is moved, and how.
struct Habit {
    families: &'static [&'static str],
    /// Probability at ½ and at 1.
    often: [f32; 2],
    /// Greatest shift back, and to either side, metres.
    shift: [f32; 2],
    /// Greatest turn about the vertical, radians.
    turn: f32,
    /// How it is carried.
    sort: Sort,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Sort {
    /// It stands on the floor, where people walk.
    Standing,
    /// It lies on something, and sinks into place.
    Lying,
    /// It hangs on a wall: shifts are upwards and to the side, and it turns about the wall's normal.
    Hanging,
}

/// Seats that people pull out, cushions that they lean on, pictures that nobody straightens.
static HABITS: [Habit; 4] = [
    Habit {
        families: &["chair", "spindle_chair", "upholstered_chair", "shell_chair", "stacking_chair", "bar_stool", "toy_chair"],
        often: [0.4, 0.85],
        shift: [0.24, 0.07],
        turn: 0.6,
        sort: Sort::Standing,
    },
    Habit { families: &["office_chair"], often: [0.7, 0.95], shift: [0.22, 0.12], turn: 1.2, sort: Sort::Standing },
    Habit { families: &["cushion", "pillow"], often: [0.6, 0.95], shift: [0.05, 0.14], turn: 0.5, sort: Sort::Lying },
    Habit { families: &["picture"], often: [0.5, 0.8], shift: [0.12, 0.1], turn: 0.022, sort: Sort::Hanging },
];

/// Moves that are tried for each thing, each smaller than the one before.
const TRIES: usize = 6;
/// How far above its place a thing is let go that lies on something, metres.
const LIFT: f32 = 0.02;

/// Moves what people have moved.
pub fn move_about(stage: &mut Stage, floors: &mut [Floor], rng: &Rng, lived_in: f32) {
    for habit in &HABITS {
        let named = stage.bodies.iter().filter(|body| habit.families.contains(&family_of(&body.name)));
        let objects: Vec<String> = named.map(|body| body.name.clone()).collect();
        for object in objects {
            let mut rng = rng.fork(hash_text(&object)).fork(hash_text("askew"));
            if rng.next_f32() < interpolated(lived_in, habit.often) {
                shift(stage, floors, habit, &object, &mut rng);
            }
        }
    }
}

fn shift(stage: &mut Stage, floors: &mut [Floor], habit: &Habit, object: &str, rng: &mut Rng) {
    let Some(front) = stage.home.fronts.get(object).copied() else { return };
    let front = front.truncate().as_vec2().normalize_or(Vec2::Y);
    let [back, aside, turn] =
        [rng.range(0.3, 1.0) * habit.shift[0], rng.range(-1.0, 1.0) * habit.shift[1], rng.range(-1.0, 1.0) * habit.turn];
    for k in 0..TRIES {
        let share = 1.0 - k as f32 / TRIES as f32;
        let Some(body) = stage.body(object) else { return };
        let (pivot, bounds) = (body.bounds.center(), body.bounds);
        let by = match habit.sort {
            Sort::Standing => (-front * back + front.perp() * aside).extend(0.0),
            Sort::Lying => (front.perp() * aside).extend(LIFT / share),
            Sort::Hanging => (front.perp() * aside).extend(back * if rng.below(2) == 0 { 1.0 } else { -1.2 }),
        };
        let axis = if habit.sort == Sort::Hanging { front.extend(0.0) } else { Vec3::Z };
        let place = |v: Vec3| DAffine3::from_translation(v.as_dvec3());
        let rotation = DAffine3::from_axis_angle(axis.as_dvec3().normalize_or(DVec3::Z), f64::from(share * turn));
        let pose = place(pivot + share * by) * rotation * place(-pivot);
        let group = if habit.sort == Sort::Standing { with_load(stage, object) } else { vec![object.to_string()] };
        if habit.sort == Sort::Standing {
            let at = middle(&bounds) + share * by.truncate();
            let Some(floor) = floors.iter_mut().find(|floor| floor.room().contains(at, 0.0)) else { return };
            let place = Footprint { center: at, half: 0.5 * bounds.extent().truncate(), yaw: 0.0 };
            if !floor.leave(&place, bounds.extent().z, true) {
                continue;
            }
        }
        if stage.nudge(&group, pose, habit.sort == Sort::Lying) {
            return;
        }
    }
}

/// A seat, and what lies on it.
fn with_load(stage: &Stage, seat: &str) -> Vec<String> {
    let Some(body) = stage.body(seat) else { return Vec::new() };
    let (low, high) = (body.bounds.min, body.bounds.max);
    let lies = |at: Vec3| {
        at.z > low.z + 0.25
            && at.z < high.z + 0.3
            && at.truncate().cmpge(low.truncate()).all()
            && at.truncate().cmple(high.truncate()).all()
    };
    let small = |name: &str| ["cushion", "bench_cushion", "throw", "blanket", "clothes"].contains(&family_of(name));
    let load = stage.bodies.iter().filter(|other| small(&other.name) && lies(other.bounds.center()));
    [seat.to_string()].into_iter().chain(load.map(|other| other.name.clone())).collect()
}
