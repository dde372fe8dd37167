//! Drawers and doors of furniture that somebody has not quite closed.

use super::stage::Stage;
use super::table::interpolated;
use crate::Home;
use crate::check::bodies::triangles;
use crate::check::contact::touches;
use crate::check::sweep::Mover;
use crate::check::walk;
use crate::place::Floor;
use crate::room::Footprint;
use enfilade_furniture::meet::Body;
use enfilade_furniture::{JointKind, object_of};
use enfilade_math::{Rng, Vec3, hash_text};
use enfilade_scene::{BodyId, BodyStates, Part, PartId};

/// Share of the things with drawers and doors that are opened now and then, at ½ and at 1: the others have no inside.
pub const OPENED: [f32; 2] = [0.3, 0.55];
/// Probability that a drawer or door of these is ajar, at ½ and at 1.
const AJAR: [f32; 2] = [0.3, 0.55];
/// Least and greatest distance by which drawers and sliding doors are open, metres.
const DRAWN: [f32; 2] = [0.008, 0.13];
/// Least and greatest angle by which hinged doors are open, radians.
const TURNED: [f32; 2] = [0.04, 0.5];
/// Most of the range that is used.
const SHARE: f64 = 0.8;

/// What is to be opened, and how far.
struct Opening {
    body: BodyId,
    parts: Vec<PartId>,
    mover: Mover,
    by: f64,
}

/// Opens some drawers and doors a little, where they run into nothing and nothing lies on them. `chosen` is what tells the builder which
/// things have an inside.
pub fn leave_ajar(stage: &mut Stage, floors: &mut [Floor], rng: &Rng, chosen: &Rng, lived_in: f32) {
    let (often, opened) = (interpolated(lived_in, AJAR), interpolated(lived_in, OPENED));
    let closed = walk::unreachable(stage.home).len();
    let mut ajar = Vec::new();
    for number in 0..stage.home.joints.len() {
        let joint = &stage.home.joints[number];
        let mut rng = rng.fork(hash_text(&joint.body)).fork(hash_text("ajar"));
        let opens = matches!(joint.kind, JointKind::Drawer | JointKind::Cupboard);
        let is_chosen = enfilade_furniture::is_among(object_of(&joint.body), opened, chosen);
        if !opens || !is_chosen || rng.next_f32() >= often {
            continue;
        }
        let Some(opening) = opening(stage.home, &joint.body, &mut rng) else { continue };
        if is_free(stage, floors, &opening) {
            stage.open(number, opening.body, &opening.parts, opening.by);
            ajar.push((number, opening));
        }
    }
    if walk::unreachable(stage.home).len() > closed {
        for (number, opening) in ajar {
            stage.open(number, opening.body, &opening.parts, -opening.by);
        }
    }
}

/// How far what has this joint is open: mostly little.
fn opening(home: &Home, name: &str, rng: &mut Rng) -> Option<Opening> {
    let (number, body) = (0..).zip(&home.scene.bodies).find(|(_, body)| body.name == name)?;
    // What is its front alone would hang in the air.
    let stays = |(part, id): (&Part, PartId)| object_of(&part.name) == object_of(name) && !body.parts.contains(&id);
    if !home.scene.parts.iter().zip(0..).any(stays) {
        return None;
    }
    let states = &body.motion.states;
    let [least, most] = match states {
        BodyStates::Slide { .. } => DRAWN,
        BodyStates::Hinge { .. } => TURNED,
        BodyStates::Free { .. } | BodyStates::Deform { .. } => return None,
    };
    let [closed, open] = body.limits?;
    let share = rng.next_f32();
    let by = (closed + f64::from(least + (most - least) * share * share * share)).min(closed + SHARE * (open - closed));
    let parts = body.parts.clone();
    let mover = Mover::new(object_of(name), parts.iter().map(|&part| triangles(&home.scene, part)).collect(), states);
    Some(Opening { body: number, parts, mover, by })
}

/// True where it runs into nothing on its way, carries nothing, and leaves people their ways.
fn is_free(stage: &Stage, floors: &mut [Floor], opening: &Opening) -> bool {
    let (closed, own) = (opening.mover.at(0.0), opening.mover.name());
    let others: Vec<&Body> = stage.bodies.iter().filter(|body| body.name != own).collect();
    // What is smaller and touches it may hang or lie on it; what is larger stands beside it.
    if others.iter().any(|other| other.volume() < closed.volume() && touches(&closed, other, Vec3::ZERO)) {
        return false;
    }
    if opening.mover.reach(opening.by, &others).stopped_by.is_some() {
        return false;
    }
    let bounds = opening.mover.at(opening.by).bounds;
    let place = Footprint { center: bounds.center().truncate(), half: 0.5 * bounds.extent().truncate(), yaw: 0.0 };
    let floor = floors.iter_mut().find(|floor| floor.room().contains(place.center, 0.0));
    floor.is_some_and(|floor| floor.leave(&place, bounds.extent().z, true))
}
