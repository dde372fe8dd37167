//! Places for objects: tries until one stays where it was put.

use crate::draw::uniform;
use crate::model::Model;
use crate::shapes::pose;
use crate::surfaces::{Spot, Surfaces};
use crate::world::World;
use crate::{ObjectGroup, Pose, Turn};
use enfilade_math::{DAffine3, DQuat, DVec3, Rng};
use enfilade_scene::PartId;
use rapier3d_f64::parry::shape::SharedShape;
use std::fmt;

/// Places tried for an object before it is given up.
const TRIES: usize = 60;
/// Space left below an object that is set down, metres.
const GAP_M: f64 = 0.001;
/// Time in which something must come to rest, seconds.
const SETTLE_S: f64 = 4.0;
/// Cosine of the angle by which upright things may lean.
const UPRIGHT_COS: f64 = 0.984_807_753;
/// Depth to which a new thing may be in others, metres.
const DEEPEST_M: f64 = 0.0005;
/// How far above a board the next one may be for something to be inside, metres.
const SHELF_M: f64 = 1.0;

/// An object of the simulation.
pub struct Placed<'a> {
    /// Model that is placed.
    pub model: &'a Model,
    /// Size over that of the file.
    pub scale: f64,
    /// What it may rest on.
    pub surfaces: &'a Surfaces,
    /// It stays upright.
    pub is_upright: bool,
}

/// Why places did not do, and how often.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Failures {
    taken: usize,
    restless: usize,
    fell: usize,
    leant: usize,
    disturbed: usize,
}

impl fmt::Display for Failures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = [
            (self.taken, "without free space of its size"),
            (self.fell, "from which it fell"),
            (self.leant, "where it toppled"),
            (self.disturbed, "where it pushed others off"),
            (self.restless, "where it did not come to rest"),
        ];
        let said: Vec<String> = counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
        write!(f, "no place found; tried {TRIES}: {}", said.join(", "))
    }
}

/// Puts an object on a surface of its group. It is the last of `world` and `placed` afterwards.
///
/// # Errors
/// Why no place did.
pub fn place<'a>(
    world: &mut World,
    placed: &mut Vec<Placed<'a>>,
    object: Placed<'a>,
    group: &ObjectGroup,
    rng: &mut Rng,
) -> Result<(), Failures> {
    let shape = object.model.shape(object.scale);
    let mut failures = Failures::default();
    placed.push(object);
    for _ in 0..TRIES {
        if try_place(world, placed, &shape, group, rng, &mut failures) {
            return Ok(());
        }
    }
    placed.pop();
    Err(failures)
}

/// One try with the last of `placed`.
fn try_place(
    world: &mut World,
    placed: &[Placed<'_>],
    shape: &SharedShape,
    group: &ObjectGroup,
    rng: &mut Rng,
    failures: &mut Failures,
) -> bool {
    let Some(object) = placed.last() else { return false };
    let turn = turned(group.turn(), rng);
    let drop = if group.pose == Pose::Dropped { uniform(group.drop_height_m, rng) } else { GAP_M };
    let spot = object.surfaces.draw(rng).filter(|spot| is_covered(world, object.surfaces, spot));
    let Some(Spot { at, .. }) = spot else {
        failures.taken += 1;
        return false;
    };
    let lift = at.z - object.model.lowest(turn, object.scale) + drop;
    let middle = object.model.middle(turn, object.scale);
    let start = pose(turn, DVec3::new(at.x - middle.x, at.y - middle.y, lift));
    if world.is_taken(shape, &start) {
        failures.taken += 1;
        return false;
    }
    let before = world.poses();
    let number = world.add(shape.clone(), start);
    let fault = if world.settle(SETTLE_S) { fault(world, placed, number) } else { Some(Fault::Restless) };
    let Some(fault) = fault else { return true };
    *match fault {
        Fault::Restless => &mut failures.restless,
        Fault::Fell => &mut failures.fell,
        Fault::Leant => &mut failures.leant,
        Fault::Disturbed => &mut failures.disturbed,
    } += 1;
    world.remove_last();
    world.restore(&before);
    false
}

/// What is wrong with a new object at rest.
enum Fault {
    Restless,
    Fell,
    Leant,
    Disturbed,
}

/// What is wrong after object `number` came to rest, if anything is.
fn fault(world: &World, placed: &[Placed<'_>], number: usize) -> Option<Fault> {
    let supported = world.supported(&|number, part: PartId| placed[number].surfaces.carries(part));
    let leans = |number: usize| placed[number].is_upright && (world.placement(number).matrix3 * DVec3::Z).z < UPRIGHT_COS;
    if !supported.contains(&number) {
        Some(Fault::Fell)
    } else if leans(number) {
        Some(Fault::Leant)
    } else if supported.len() < world.len() || (0..number).any(leans) || world.depth(number) > DEEPEST_M {
        Some(Fault::Disturbed)
    } else {
        None
    }
}

/// Whether a spot is below another part of its thing, where the group wants that, and open, where it does not.
fn is_covered(world: &World, surfaces: &Surfaces, spot: &Spot) -> bool {
    let thing = &surfaces.things[spot.thing];
    let above = world.above(spot.at + DVec3::Z * GAP_M, SHELF_M);
    above.is_some_and(|(part, _)| thing.parts.contains(&part)) == thing.is_shelf
}

/// A rotation of the model.
fn turned(turn: Turn, rng: &mut Rng) -> DQuat {
    match turn {
        Turn::None => DQuat::IDENTITY,
        Turn::Z => DQuat::from_rotation_z(rng.next_f64() * std::f64::consts::TAU),
        // Shoemake, "Uniform random rotations", Graphics Gems III, 1992.
        Turn::Free => {
            let (u, a, b) = (rng.next_f64(), rng.next_f64() * std::f64::consts::TAU, rng.next_f64() * std::f64::consts::TAU);
            let (low, high) = ((1.0 - u).sqrt(), u.sqrt());
            DQuat::from_xyzw(low * a.sin(), low * a.cos(), high * b.sin(), high * b.cos())
        }
    }
}

/// How far the corners of an object's box are from where they were, at most, metres.
pub fn moved(object: &Placed<'_>, before: &DAffine3, after: &DAffine3) -> f64 {
    let corners = object.model.corners(object.scale);
    corners.iter().map(|corner| before.transform_point3(*corner).distance(after.transform_point3(*corner))).fold(0.0, f64::max)
}
