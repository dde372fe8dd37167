//! What moves by the joints of a home, what goes along, and whether the whole way is free.

use super::bodies::{bodies_of, triangles};
use super::contact::Contacts;
use super::sweep::Mover;
use crate::{Home, HomeJoint};
use enfilade_furniture::meet::Body;
use enfilade_furniture::object_of;
use enfilade_math::DAffine3;
use enfilade_scene::{BodyId, BodyStates, PartId, Scene};
use std::collections::{BTreeMap, BTreeSet};

/// Two states nearer than this are the same, radians or metres.
const SAME: f64 = 1e-6;
/// Least cosine between the axis of a hinge and the vertical for what stands on the thing to stay there when it turns.
const UPRIGHT: f64 = 0.99;

/// What moves by a joint, and what goes along.
pub struct Moving {
    /// The body that has the joint.
    pub body: BodyId,
    /// All parts that move, in ascending order.
    pub parts: Vec<PartId>,
    /// The triangles that move, and how.
    pub mover: Mover,
    /// Names of the objects that it carries.
    pub carries: BTreeSet<String>,
    /// The object on a lid or flap, which keeps it where it is.
    pub kept_by: Option<String>,
}

impl Moving {
    /// Name of the object.
    pub fn object(&self) -> &str {
        self.mover.name()
    }

    /// All bodies but that of the object that moves and of what it carries.
    pub fn others<'a>(&self, bodies: &'a [Body]) -> Vec<&'a Body> {
        bodies.iter().filter(|body| body.name != self.object() && !self.carries.contains(&body.name)).collect()
    }
}

/// What moves by each joint, in a scene in which all is at rest.
pub fn movers(scene: &Scene, joints: &[HomeJoint]) -> Vec<Moving> {
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

/// By part: the map of the world that takes it to where it is as the home is made; `None` of parts without joint.
pub fn as_made(home: &Home) -> Vec<Option<DAffine3>> {
    let made: BTreeMap<&str, f64> = home.joints.iter().map(|joint| (joint.body.as_str(), joint.made)).collect();
    let mut maps = vec![None; home.scene.parts.len()];
    for body in &home.scene.bodies {
        if let Some(&state) = made.get(body.name.as_str()).filter(|state| **state != 0.0) {
            let map = body.motion.states.map_to(state);
            body.parts.iter().for_each(|&part| maps[part as usize] = Some(map));
        }
    }
    maps
}

/// Joints whose range is not free, with what is in the way, while all else is as it is made.
pub fn blocked(home: &Home) -> Vec<(String, String)> {
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
