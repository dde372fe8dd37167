//! Which parts of a scene are one body, and how it is held.
//!
//! - The bodies of the scene ([`Scene::bodies`]) keep their joints and limits. What the rest of their instance is bears them, and is fixed.
//! - Instances of the classes in [`BUILT_IN`] are fixed; other instances are free.
//! - Everything else is the structure, which is fixed.

use crate::model::{Joint, JointKind, PhysicsError};
use enfilade_compose::Moments;
use enfilade_math::DVec3;
use enfilade_scene::{Body, BodyStates, Labels, NYU40, PartId, Scene};
use std::collections::{BTreeMap, BTreeSet};

/// Gravity, m/s².
const GRAVITY: f64 = 9.81;
/// Classes of what is fixed to the building.
const BUILT_IN: [&str; 17] = [
    "wall",
    "floor",
    "ceiling",
    "door",
    "window",
    "picture",
    "counter",
    "blinds",
    "curtain",
    "mirror",
    "floormat",
    "showercurtain",
    "whiteboard",
    "toilet",
    "sink",
    "bathtub",
    "otherstructure",
];
/// Share of its weight with which a joint resists to be moved, and that with which one whose axis is not plumb holds what gravity would turn.
const RESISTS: f64 = 0.05;
const HOLDS: f64 = 1.1;
/// Damping of joints, as a share of their weight: they stop in about a second.
const DAMPS: f64 = 0.1;

/// How a body is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Hold {
    Fixed,
    Free,
    Hinge { point: DVec3, axis: DVec3, limits: Option<[f64; 2]> },
    Slide { axis: DVec3, limits: Option<[f64; 2]> },
}

/// Parts that are one body.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    pub name: String,
    pub parts: Vec<PartId>,
    /// The group that it is joined to; `None`: the world.
    pub parent: Option<usize>,
    pub joint: Hold,
    /// Whether it is one of [`Scene::bodies`].
    pub is_body: bool,
    /// The group with which it shares an instance: what bears a joint.
    pub bearer: Option<usize>,
    /// How far it is lowered onto what is below it, metres, world.
    pub shift: DVec3,
}

/// The groups of a scene, parents first, and notes.
pub(crate) fn groups(scene: &Scene, labels: &Labels) -> Result<(Vec<Group>, Vec<String>), PhysicsError> {
    let of_body = scene.body_of_parts();
    let label = |part: u32| labels.parts.get(part as usize).filter(|label| label.instance > 0);
    let loose = || (0..scene.parts.len() as u32).filter(|part| of_body[*part as usize].is_none());
    let mut instances: BTreeMap<i16, Vec<PartId>> = BTreeMap::new();
    loose()
        .filter_map(|part| Some((label(part)?.instance, part)))
        .for_each(|(instance, part)| instances.entry(instance).or_default().push(part));
    let fixed = |name: &str, parts: Vec<PartId>| Group {
        name: name.into(),
        parts,
        parent: None,
        joint: Hold::Fixed,
        is_body: false,
        bearer: None,
        shift: DVec3::ZERO,
    };
    let mut groups = vec![fixed("structure", loose().filter(|part| label(*part).is_none()).collect())];
    let mut numbers = BTreeMap::new();
    for (instance, parts) in instances {
        let class = label(parts[0]).and_then(|label| NYU40.get(usize::try_from(label.semantic - 1).ok()?));
        let mut group = fixed(&name_of(scene, parts[0]), parts);
        if !class.is_some_and(|class| BUILT_IN.contains(&class.name)) {
            group.joint = Hold::Free;
        }
        numbers.insert(instance, groups.len());
        groups.push(group);
    }
    let mut notes = Vec::new();
    if groups.len() == 1 && scene.bodies.is_empty() {
        notes.push("nothing tells things apart, so everything is fixed; label instances with `enfilade annotate`".into());
    }
    add_bodies(scene, &mut groups, |part| numbers.get(&label(part)?.instance).copied())?;
    rename(&mut groups);
    Ok((groups, notes))
}

/// Adds the bodies of the scene. What bears one of a hinge or slide stands fixed.
fn add_bodies(scene: &Scene, groups: &mut Vec<Group>, instance: impl Fn(PartId) -> Option<usize>) -> Result<(), PhysicsError> {
    let mut numbers = Vec::new();
    // Those on which something with parts stands; lights and cameras alone are nothing to a simulator.
    let mut bears: BTreeSet<u32> = BTreeSet::new();
    for (id, body) in scene.bodies.iter().enumerate().rev() {
        if !body.parts.is_empty() || bears.contains(&(id as u32)) {
            bears.extend(body.parent);
        }
    }
    for (body, id) in scene.bodies.iter().zip(0..) {
        if body.parts.is_empty() && !bears.contains(&id) {
            numbers.push(None);
            continue;
        }
        let joint = hold(body);
        let on = body.parent.and_then(|parent| numbers[parent as usize]);
        if let (Hold::Free, Some(parent)) = (joint, body.parent) {
            return Err(PhysicsError::FreeOnAnother { body: body.name.clone(), parent: scene.bodies[parent as usize].name.clone() });
        }
        let bearer = if joint == Hold::Free { None } else { body.parts.iter().find_map(|part| instance(*part)) };
        if let Some(bearer) = bearer {
            groups[bearer].joint = Hold::Fixed;
        }
        numbers.push(Some(groups.len()));
        groups.push(Group {
            name: body.name.clone(),
            parts: body.parts.clone(),
            parent: on,
            joint,
            is_body: true,
            bearer,
            shift: DVec3::ZERO,
        });
    }
    Ok(())
}

fn hold(body: &Body) -> Hold {
    match body.motion.states {
        BodyStates::Free { .. } => Hold::Free,
        BodyStates::Hinge { point, axis, .. } => Hold::Hinge { point, axis, limits: body.limits },
        BodyStates::Slide { axis, .. } => Hold::Slide { axis, limits: body.limits },
    }
}

/// Puts parents before what hangs on them, and keeps the order otherwise.
pub(crate) fn in_order(groups: &mut Vec<Group>) {
    let depth = |mut number: usize| {
        let mut depth = 0;
        while let Some(parent) = groups[number].parent {
            (number, depth) = (parent, depth + 1);
        }
        depth
    };
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by_key(|number| depth(*number));
    let mut new = vec![0; groups.len()];
    order.iter().zip(0..).for_each(|(old, number)| new[*old] = number);
    let moved = |old: &usize| {
        let group = groups[*old].clone();
        Group { parent: group.parent.map(|parent| new[parent]), bearer: group.bearer.map(|bearer| new[bearer]), ..group }
    };
    *groups = order.iter().map(moved).collect();
}

/// The name of the object that a part belongs to, or its own.
fn name_of(scene: &Scene, part: PartId) -> String {
    let part = &scene.parts[part as usize];
    part.object.map_or(&part.name, |object| &scene.objects[object as usize].name).clone()
}

/// Names without blanks and signs, each once.
fn rename(groups: &mut [Group]) {
    let mut taken = BTreeSet::new();
    for group in groups {
        let plain: String = group.name.chars().map(|c| if c.is_alphanumeric() || "_-.".contains(c) { c } else { '_' }).collect();
        let plain = if plain.is_empty() { "body".to_string() } else { plain };
        let mut names = std::iter::once(plain.clone()).chain((2..).map(|n| format!("{plain}_{n}")));
        group.name = names.find(|name| taken.insert(name.clone())).unwrap_or(plain);
    }
}

impl Group {
    /// The names of its parts, at most five.
    pub fn names(&self, scene: &Scene) -> String {
        let names: Vec<String> = self.parts.iter().take(5).map(|part| format!("{:?}", scene.parts[*part as usize].name)).collect();
        if names.is_empty() { "none".into() } else { names.join(", ") }
    }

    /// The origin of its body: a point of the hinge, the centre of mass of what moves otherwise, that of the world for what is fixed to it.
    pub fn origin(&self, center: Option<DVec3>) -> DVec3 {
        match self.joint {
            // The point of the axis beside the centre of mass.
            Hold::Hinge { point, axis, .. } => point + axis * center.map_or(0.0, |center| (center - point).dot(axis)),
            Hold::Fixed if self.parent.is_none() => DVec3::ZERO,
            _ => center.unwrap_or_default(),
        }
    }
}

impl Hold {
    /// The joint of a body with this origin and these moments.
    pub fn joint(self, origin: DVec3, moments: Option<Moments>) -> Joint {
        let weight = moments.map_or(0.0, |m| m.mass_kg * GRAVITY);
        match self {
            Self::Fixed => Joint::FIXED,
            Self::Free => Joint::FREE,
            Self::Slide { axis, limits } => {
                let friction = weight * (RESISTS + HOLDS * axis.z.abs());
                Joint { kind: JointKind::Slide(axis), limits, friction, damping: DAMPS * weight }
            }
            Self::Hinge { axis, limits, .. } => {
                let arm = moments.map_or(0.0, |m| (m.center - origin).cross(axis).length());
                let friction = weight * arm * (RESISTS + HOLDS * (1.0 - axis.z * axis.z).max(0.0).sqrt());
                Joint { kind: JointKind::Hinge(axis), limits, friction, damping: DAMPS * weight * arm }
            }
        }
    }
}
