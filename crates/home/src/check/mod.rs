//! Whether a home could be: nothing runs into anything, nothing floats, everything has a name, and people can go everywhere.
//!
//! All is judged from the finished triangles, not from what placed them.

mod meet;
mod walk;

use crate::Home;
use enfilade_geometry::Mesh;
use enfilade_math::{Bounds3, Vec3};
use enfilade_scene::{NYU40, is_stuff};
use meet::Body;
use std::collections::BTreeMap;
use std::fmt;

/// Something that cannot be.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// Two objects run into each other deeper than they may.
    Meets(String, String),
    /// Nothing carries the object.
    Floats(String),
    /// The part has no class, or its object no instance.
    Nameless(String),
    /// Nobody can walk into the room, by its number in the plan.
    Unreachable(usize),
    /// A start camera stands too near to a part.
    Camera(String),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Meets(a, b) => write!(f, "{a} runs into {b}"),
            Self::Floats(a) => write!(f, "{a} floats"),
            Self::Nameless(part) => write!(f, "{part} has no label"),
            Self::Unreachable(room) => write!(f, "room {room} cannot be reached"),
            Self::Camera(name) => write!(f, "camera {name} is not in free space"),
        }
    }
}

/// Objects may sink this far into each other: feet into a rug's pile, screws into a wall, metres.
const SINK: f32 = 0.004;
/// The same for cloth and cushions, which give way.
const SOFT_SINK: f32 = 0.03;
/// What lies in folds over or in something else: it follows what it lies on, and is not asked how deep.
const DRAPED: [&str; 6] = ["throw", "blanket", "clothes", "towel", "napkin", "crumpled_paper"];
/// What is nearer than this touches.
const TOUCH: f32 = 0.0025;
/// The same for what is soft: cloth hangs and lies in waves.
const SOFT_TOUCH: f32 = 0.02;
/// Families of soft things.
const SOFT: [&str; 13] = [
    "crumpled_paper",
    "pillow",
    "cushion",
    "throw",
    "blanket",
    "towel",
    "clothes",
    "curtain",
    "bedding",
    "plush_toy",
    "bag",
    "shower_curtain",
    "garment",
];
/// What the shell is made of: its pieces reach into each other, and carry everything else.
const SHELL: [&str; 9] = ["wall_", "floor_", "ceiling_", "skirting_", "window_", "door_", "passage_", "skirting", "radiator_"];

/// Everything that is wrong with a home; empty when nothing is.
pub fn faults(home: &Home) -> Vec<Fault> {
    let bodies = bodies(home);
    let mut faults = unlabelled(home);
    faults.extend(of_bodies(&bodies));
    faults.extend(walk::unreachable(home).into_iter().map(Fault::Unreachable));
    faults.extend(blocked_cameras(home, &bodies));
    faults
}

/// What is wrong with where things are: they run into each other, or float.
pub(crate) fn of_things(home: &Home) -> Vec<Fault> {
    of_bodies(&bodies(home))
}

fn of_bodies(bodies: &[Body]) -> Vec<Fault> {
    meetings(bodies).into_iter().chain(floating(bodies)).collect()
}

/// The object that a part belongs to: its name up to the slash.
pub(crate) fn object_of(part: &str) -> &str {
    part.split('/').next().unwrap_or(part)
}

fn bodies(home: &Home) -> Vec<Body> {
    let scene = &home.scene;
    let mut bodies: BTreeMap<&str, Body> = BTreeMap::new();
    for part in &scene.parts {
        let mesh: &Mesh = &scene.meshes[part.mesh as usize];
        let world: Vec<Vec3> = mesh.positions.iter().map(|p| part.world_from_mesh.transform_point3(p.as_dvec3()).as_vec3()).collect();
        let triangles = mesh.triangles.iter().map(|t| t.map(|i| world[i as usize])).collect();
        let name = object_of(&part.name);
        bodies.entry(name).or_insert_with(|| Body::new(name)).push(triangles);
    }
    bodies.into_values().collect()
}

pub(crate) fn is_shell(name: &str) -> bool {
    SHELL.iter().any(|family| name.starts_with(family))
}

fn is_soft(name: &str) -> bool {
    SOFT.iter().any(|family| name.starts_with(family))
}

fn is_draped(name: &str) -> bool {
    DRAPED.iter().any(|family| name.starts_with(family))
}

/// Pairs of bodies whose boxes come nearer than `margin`, the first of each with the smaller number.
fn near(bodies: &[Body], margin: f32) -> Vec<(usize, usize)> {
    let mut order: Vec<usize> = (0..bodies.len()).collect();
    order.sort_by(|&a, &b| bodies[a].bounds.min.x.total_cmp(&bodies[b].bounds.min.x));
    let mut pairs = Vec::new();
    for (k, &a) in order.iter().enumerate() {
        for &b in order[k + 1..].iter().take_while(|&&b| bodies[b].bounds.min.x <= bodies[a].bounds.max.x + margin) {
            if overlap(&bodies[a].bounds, &bodies[b].bounds, margin) {
                pairs.push((a.min(b), a.max(b)));
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

fn overlap(a: &Bounds3, b: &Bounds3, margin: f32) -> bool {
    a.min.cmple(b.max + margin).all() && b.min.cmple(a.max + margin).all()
}

/// The six ways along the axes.
const WAYS: [Vec3; 6] = [Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y];

fn meetings(bodies: &[Body]) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (a, b) in near(bodies, 0.0) {
        let (a, b) = (&bodies[a], &bodies[b]);
        if is_shell(&a.name) && is_shell(&b.name) || !a.meets(b, Vec3::ZERO) {
            continue;
        }
        if is_draped(&a.name) || is_draped(&b.name) {
            continue;
        }
        // Those that a small step sets free do not go deeper than that step; soft ones are freed by their giving way on all sides.
        let yields = |x: &Body| is_soft(&x.name).then(|| x.shrunk(SOFT_SINK));
        let (soft_a, soft_b) = (yields(a), yields(b));
        let soft = soft_a.is_some() || soft_b.is_some();
        let still = soft_a.as_ref().unwrap_or(a).meets(soft_b.as_ref().unwrap_or(b), Vec3::ZERO);
        if still && (soft || WAYS.iter().all(|way| a.meets(b, *way * SINK))) {
            faults.push(Fault::Meets(a.name.clone(), b.name.clone()));
        }
    }
    faults
}

fn floating(bodies: &[Body]) -> Vec<Fault> {
    let mut carried: Vec<bool> = bodies.iter().map(|b| is_shell(&b.name)).collect();
    let touch = |a: &Body, b: &Body| if is_soft(&a.name) || is_soft(&b.name) { SOFT_TOUCH } else { TOUCH };
    let touching: Vec<(usize, usize)> = near(bodies, SOFT_TOUCH)
        .into_iter()
        .filter(|&(a, b)| !(carried[a] && carried[b]))
        .filter(|&(a, b)| {
            let (a, b) = (&bodies[a], &bodies[b]);
            a.meets(b, Vec3::ZERO) || WAYS.iter().any(|way| a.meets(b, *way * touch(a, b)))
        })
        .collect();
    loop {
        let before = carried.iter().filter(|&&c| c).count();
        for &(a, b) in &touching {
            let any = carried[a] || carried[b];
            (carried[a], carried[b]) = (any, any);
        }
        if carried.iter().filter(|&&c| c).count() == before {
            break;
        }
    }
    bodies.iter().zip(&carried).filter(|(_, c)| !**c).map(|(b, _)| Fault::Floats(b.name.clone())).collect()
}

fn unlabelled(home: &Home) -> Vec<Fault> {
    let (parts, labels) = (&home.scene.parts, &home.labels.parts);
    let named = |i: usize| {
        labels.get(i).is_some_and(|l| (1..=NYU40.len() as i16).contains(&l.semantic) && (l.instance == -1) == is_stuff(l.semantic))
    };
    (0..parts.len()).filter(|&i| !named(i)).map(|i| Fault::Nameless(parts[i].name.clone())).collect()
}

fn blocked_cameras(home: &Home, bodies: &[Body]) -> Vec<Fault> {
    let boxes: Vec<Bounds3> = bodies.iter().flat_map(Body::boxes).collect();
    let least = crate::cameras::CLEARANCES[1] - 0.002;
    let free = |eye: Vec3| boxes.iter().all(|b| eye.distance(eye.clamp(b.min, b.max)) >= least);
    let cameras = home.scene.cameras.iter();
    cameras.filter(|c| !free(c.position.as_vec3())).map(|c| Fault::Camera(c.name.clone())).collect()
}
