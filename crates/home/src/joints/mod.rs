//! Joints of a home: what can be opened, how far, and what is open.
//!
//! Furniture and doors declare their joints where they are built. Here each gets the range that is free in this home: the whole way is
//! tried, with everything else as it is made, and ends where what moves would run into something of another object. Then the states that
//! were asked for become the home's rest, which is what free space, captions and all else read.

mod states;
mod sweep;

pub use states::{State, StateWord, States};

use crate::Home;
use crate::check::bodies_of;
use crate::check::contact::Contacts;
use enfilade_furniture::meet::{Body, Triangle};
use enfilade_furniture::{JointKind, Jointed, object_of};
use enfilade_math::{DAffine3, Rng, Vec3};
use enfilade_scene::{BodyId, BodyStates, PartId, Scene};
use std::collections::{BTreeMap, BTreeSet};
use sweep::{Mover, to_state};

/// Shares of the way back that are tried where something that was opened before is in the way.
const BACK: usize = 20;
/// Two states nearer than this are the same, radians or metres.
const SAME: f64 = 1e-6;
/// Least cosine between the axis of a hinge and the vertical for what stands on the thing to stay there when it turns.
const UPRIGHT: f64 = 0.99;

/// A joint of a home. Its range is in the limits of the body of its name: closed and open, relative to the home's rest.
#[derive(Clone, Debug, PartialEq)]
pub struct HomeJoint {
    /// Name of the body: that of the object, `/`, and the name of what moves.
    pub body: String,
    /// The thing that moves.
    pub kind: JointKind,
    /// Its state as the home is made, relative to its rest, radians or metres.
    pub made: f64,
    /// Closed and open by its own measures, relative to the home's rest: what is around it may leave less.
    pub built: [f64; 2],
    /// The object that stops it before it is wide open, or before it is closed.
    pub limited_by: Option<String>,
}

impl HomeJoint {
    pub(crate) fn new(jointed: &Jointed, scene: &Scene) -> Option<Self> {
        let body = scene.bodies.iter().find(|body| body.name == jointed.body)?;
        Some(Self { body: jointed.body.clone(), kind: jointed.kind, made: 0.0, built: body.limits?, limited_by: None })
    }
}

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
            let got = (state - closed) / (open - closed).max(SAME);
            notes.push(format!("states: {body} is open by {got:.2} of its range instead of {share:.2}: {thing} is in the way"));
        }
        set(home, number, moving, state);
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

/// Makes a state the rest of what moves.
fn set(home: &mut Home, number: usize, moving: &Moving, state: f64) {
    let body = &mut home.scene.bodies[moving.body as usize];
    let map = to_state(&body.motion.states, state);
    body.limits = body.limits.map(|limits| limits.map(|limit| limit - state));
    for &part in &moving.parts {
        let placed = &mut home.scene.parts[part as usize].world_from_mesh;
        *placed = map * *placed;
    }
    let joint = &mut home.joints[number];
    (joint.made, joint.built) = (joint.made - state, joint.built.map(|limit| limit - state));
}

/// By part: the map of the world that takes it to where it is as the home is made; `None` of parts without joint.
pub(crate) fn as_made(home: &Home) -> Vec<Option<DAffine3>> {
    let made: BTreeMap<&str, f64> = home.joints.iter().map(|joint| (joint.body.as_str(), joint.made)).collect();
    let mut maps = vec![None; home.scene.parts.len()];
    for body in &home.scene.bodies {
        if let Some(&state) = made.get(body.name.as_str()).filter(|state| **state != 0.0) {
            let map = to_state(&body.motion.states, state);
            body.parts.iter().for_each(|&part| maps[part as usize] = Some(map));
        }
    }
    maps
}

/// Joints whose range is not free, with what is in the way, while all else is as it is made.
pub(crate) fn blocked(home: &Home) -> Vec<(String, String)> {
    let mut made = home.scene.clone();
    for (part, map) in made.parts.iter_mut().zip(as_made(home)) {
        part.world_from_mesh = map.unwrap_or(DAffine3::IDENTITY) * part.world_from_mesh;
    }
    let movers = movers(&made, &home.joints);
    let bodies = bodies_of(&made);
    enfilade_parallel::flat_map_up_to(movers.len(), |number| {
        let (joint, moving) = (&home.joints[number], &movers[number]);
        let limits = made.bodies[moving.body as usize].limits.unwrap_or_default();
        let others = moving.others(&bodies);
        let stop = |limit: f64| {
            let reach = moving.mover.reach(limit - joint.made, &others);
            reach.stopped_by.map(|thing| (joint.body.clone(), thing))
        };
        limits.into_iter().filter(|limit| (limit - joint.made).abs() > SAME).find_map(stop)
    })
}

/// What moves by a joint, and what goes along.
struct Moving {
    body: BodyId,
    /// All parts that move, in ascending order.
    parts: Vec<PartId>,
    mover: Mover,
    /// Names of the objects that it carries.
    carries: BTreeSet<String>,
    /// The object on a lid or flap, which keeps it where it is.
    kept_by: Option<String>,
}

impl Moving {
    fn object(&self) -> &str {
        self.mover.name()
    }

    /// All bodies but that of the object that moves and of what it carries.
    fn others<'a>(&self, bodies: &'a [Body]) -> Vec<&'a Body> {
        bodies.iter().filter(|body| body.name != self.object() && !self.carries.contains(&body.name)).collect()
    }
}

/// The triangles of a part in the world.
fn triangles(scene: &Scene, part: PartId) -> Vec<Triangle> {
    let part = &scene.parts[part as usize];
    let world: Vec<Vec3> = scene.world_positions(part).collect();
    scene.meshes[part.mesh as usize].triangles.iter().map(|t| t.map(|i| world[i as usize])).collect()
}

/// The object of this name.
fn body_named(scene: &Scene, name: &str) -> Body {
    let mut body = Body::new(name);
    let parts = scene.parts.iter().zip(0..).filter(|(part, _)| object_of(&part.name) == name);
    parts.for_each(|(_, part)| body.push(triangles(scene, part)));
    body
}

/// What moves by each joint, in a scene in which all is at rest.
fn movers(scene: &Scene, joints: &[HomeJoint]) -> Vec<Moving> {
    let numbers: BTreeMap<&str, BodyId> = scene.bodies.iter().zip(0..).map(|(body, id)| (body.name.as_str(), id)).collect();
    let bodies: Vec<BodyId> = joints.iter().filter_map(|joint| numbers.get(joint.body.as_str()).copied()).collect();
    let jointed: BTreeSet<&str> = joints.iter().map(|joint| object_of(&joint.body)).collect();
    let moving = |(&id, mut carries): (&BodyId, BTreeSet<String>)| {
        let body = &scene.bodies[id as usize];
        let own = object_of(&body.name);
        let level = matches!(&body.motion.states, BodyStates::Hinge { axis, .. } if axis.z.abs() < UPRIGHT);
        // Things that stand on a lid would fall, and what has joints itself does not ride on others.
        let kept_by = carries.iter().find(|object| level || jointed.contains(object.as_str())).cloned();
        if kept_by.is_some() {
            carries.clear();
        }
        carries.extend(body.parts.iter().map(|&part| object_of(&scene.parts[part as usize].name).to_string()));
        carries.remove(own);
        let on_it = scene.parts.iter().zip(0..).filter(|(part, _)| carries.contains(object_of(&part.name))).map(|(_, part)| part);
        let parts: BTreeSet<PartId> = body.parts.iter().copied().chain(on_it).collect();
        let mover = Mover::new(own, parts.iter().map(|&part| triangles(scene, part)).collect(), &body.motion.states);
        Moving { body: id, parts: parts.into_iter().collect(), mover, carries, kept_by }
    };
    bodies.iter().zip(carried(scene, &bodies)).map(moving).collect()
}

/// The objects that only what moves carries, by joint.
fn carried(scene: &Scene, bodies: &[BodyId]) -> Vec<BTreeSet<String>> {
    // The moving parts of each body apart, and of each object the rest.
    let mut pieces: Vec<Body> = bodies.iter().map(|&body| Body::new(object_of(&scene.bodies[body as usize].name))).collect();
    let number: BTreeMap<BodyId, usize> = bodies.iter().copied().zip(0..).collect();
    let mut rests: BTreeMap<&str, Body> = BTreeMap::new();
    for ((own, part), id) in scene.body_of_parts().into_iter().zip(&scene.parts).zip(0..) {
        let name = object_of(&part.name);
        match own.and_then(|body| number.get(&body)) {
            Some(&piece) => pieces[piece].push(triangles(scene, id)),
            None => rests.entry(name).or_insert_with(|| Body::new(name)).push(triangles(scene, id)),
        }
    }
    pieces.extend(rests.into_values());
    let contacts = Contacts::of_touch(&pieces);
    let all = contacts.carried(&pieces, |_| true);
    let goes_along = |moving: usize| {
        let without = contacts.carried(&pieces, |piece| piece != moving);
        let own = &pieces[moving].name;
        let fallen = (0..pieces.len()).filter(|&piece| piece != moving && all[piece] && !without[piece] && pieces[piece].name != *own);
        fallen.map(|piece| pieces[piece].name.clone()).collect()
    };
    enfilade_parallel::map_up_to(bodies.len(), goes_along)
}
