//! What is open in a home, and how far.
//!
//! Furniture and doors declare their joints where they are built. Here each gets the range that is free in this home: the whole way is
//! tried, with everything else as it is made, and ends where what moves would run into something of another object. Then the states that
//! were asked for become the home's rest, which is what free space, captions and all else read.

use crate::check::bodies::{bodies_of, body_named};
use crate::check::moving::{Moving, movers};
use crate::states::States;
use crate::{Home, HomeJoint};
use enfilade_furniture::meet::Body;
use enfilade_math::Rng;
use enfilade_scene::{BodyId, PartId};

/// Shares of the way back that are tried where something that was opened before is in the way.
const BACK: usize = 20;
/// Least range of which shares are told, radians or metres.
const LEAST: f64 = 1e-6;

/// Finds the range of each joint, and brings all into the states that are asked for; what is not as asked is said.
pub(crate) fn open(home: &mut Home, states: &States, rng: &Rng) {
    let movers = movers(&home.scene, &home.joints);
    let mut bodies = bodies_of(&home.scene);
    let ranges = enfilade_parallel::map_up_to(movers.len(), |joint| range(&home.joints[joint], &movers[joint], &bodies));
    for ((joint, moving), (limits, limited_by)) in home.joints.iter_mut().zip(&movers).zip(ranges) {
        joint.limited_by = limited_by;
        let body = &mut home.scene.bodies[moving.body as usize];
        (body.limits, body.parts) = (Some(limits), moving.parts.clone());
    }
    let mut notes = states.unknown(home.joints.iter().map(|joint| (joint.body.as_str(), joint.kind)));
    for (number, moving) in movers.iter().enumerate() {
        let HomeJoint { body, kind, .. } = &home.joints[number];
        let Some(share) = states.of(body, *kind).share(*kind, &mut rng.fork(number as u64)) else { continue };
        let [closed, open] = home.scene.bodies[moving.body as usize].limits.unwrap_or_default();
        let asked = closed + share * (open - closed);
        let (state, in_the_way) = nearest(moving, asked, &bodies);
        if let Some(thing) = in_the_way {
            let got = (state - closed) / (open - closed).max(LEAST);
            notes.push(format!("{body} is open by {got:.2} of its range instead of {share:.2}: {thing} is in the way"));
        }
        set(home, number, moving.body, &moving.parts, state);
        for name in [moving.object()].into_iter().chain(moving.carries.iter().map(String::as_str)) {
            let changed = bodies.iter_mut().find(|body| body.name == name);
            changed.into_iter().for_each(|body| *body = body_named(&home.scene, name));
        }
    }
    home.state_notes = notes;
}

/// The range of a joint that is free, and what stops it.
fn range(joint: &HomeJoint, moving: &Moving, bodies: &[Body]) -> ([f64; 2], Option<String>) {
    if let Some(thing) = &moving.kept_by {
        return ([0.0; 2], Some(thing.clone()));
    }
    let others = moving.others(bodies);
    let [closed, open] = joint.built.map(|limit| moving.mover.reach(limit, &others));
    ([closed.state, open.state], open.stopped_by.or(closed.stopped_by))
}

/// The free state that is nearest to the one that is asked for, on the way there from that as made, and what is in the way of the latter.
fn nearest(moving: &Moving, asked: f64, bodies: &[Body]) -> (f64, Option<String>) {
    let others = moving.others(bodies);
    let Some(first) = moving.mover.hit(asked, &others).map(str::to_string) else { return (asked, None) };
    let back = (1..BACK).map(|k| asked * (1.0 - k as f64 / BACK as f64));
    (back.into_iter().find(|&state| moving.mover.hit(state, &others).is_none()).unwrap_or(0.0), Some(first))
}

/// Makes a state of the joint of this number the rest of what moves by it.
pub(crate) fn set(home: &mut Home, number: usize, body: BodyId, parts: &[PartId], state: f64) {
    let body = &mut home.scene.bodies[body as usize];
    let map = body.motion.states.map_to(state);
    body.limits = body.limits.map(|limits| limits.map(|limit| limit - state));
    for &part in parts {
        let placed = &mut home.scene.parts[part as usize].world_from_mesh;
        *placed = map * *placed;
    }
    let joint = &mut home.joints[number];
    (joint.made, joint.built) = (joint.made - state, joint.built.map(|limit| limit - state));
}
