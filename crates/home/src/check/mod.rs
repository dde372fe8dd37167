//! Whether a home could be: nothing runs into anything, nothing floats, everything has a name, and people can go everywhere.
//!
//! All is judged from the finished triangles, not from what placed them.

pub(crate) mod contact;
pub(crate) mod meet;
pub(crate) mod walk;

use crate::Home;
use crate::shell::is_shell_family;
use contact::Contacts;
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

impl Fault {
    /// The same in families instead of objects, to be counted.
    pub fn kind(&self) -> String {
        match self {
            Self::Meets(a, b) => format!("{} runs into {}", family_of(a), family_of(b)),
            Self::Floats(a) => format!("{} floats", family_of(a)),
            other => other.to_string(),
        }
    }
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
fn of_bodies(bodies: &[Body]) -> Vec<Fault> {
    let contacts = Contacts::new(bodies);
    let name = |i: usize| bodies[i].name.clone();
    let carried = contacts.carried(bodies, |_| true);
    let meets = contacts.meeting.iter().map(|&(a, b)| Fault::Meets(name(a), name(b)));
    meets.chain((0..bodies.len()).filter(|&i| !carried[i]).map(|i| Fault::Floats(name(i)))).collect()
}

/// The object that a part belongs to: its name up to the slash.
pub fn object_of(part: &str) -> &str {
    part.split('/').next().unwrap_or(part)
}

/// The objects of a home, by name.
pub(crate) fn bodies(home: &Home) -> Vec<Body> {
    let scene = &home.scene;
    let mut bodies: BTreeMap<&str, Body> = BTreeMap::new();
    for part in &scene.parts {
        let mesh: &Mesh = &scene.meshes[part.mesh as usize];
        let world: Vec<Vec3> = scene.world_positions(part).collect();
        let triangles = mesh.triangles.iter().map(|t| t.map(|i| world[i as usize])).collect();
        let name = object_of(&part.name);
        bodies.entry(name).or_insert_with(|| Body::new(name)).push(triangles);
    }
    bodies.into_values().collect()
}

/// The family of an object: its name without its number.
pub fn family_of(object: &str) -> &str {
    match object.rsplit_once('_') {
        Some((family, number)) if !number.is_empty() && number.bytes().all(|c| c.is_ascii_digit()) => family,
        _ => object,
    }
}

/// Pieces of the shell reach into each other, and carry everything else.
pub(crate) fn is_shell(object: &str) -> bool {
    is_shell_family(family_of(object))
}

/// True when the boxes come nearer than `margin`.
pub(crate) fn overlap(a: &Bounds3, b: &Bounds3, margin: f32) -> bool {
    a.min.cmple(b.max + margin).all() && b.min.cmple(a.max + margin).all()
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
