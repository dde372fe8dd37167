//! Whether a home is possible: nothing runs into anything, nothing floats, everything has a label, people can go everywhere, and what has
//! joints can go as far as its range says.
//!
//! The finished triangles are judged, not what placed them.

pub(crate) mod bodies;
pub(crate) mod contact;
pub(crate) mod moving;
pub(crate) mod sweep;
pub(crate) mod walk;

pub use crate::fault::Fault;

use crate::Home;
use crate::cameras::{CLEARANCES, Obstacle};
use bodies::bodies_of;
use contact::Contacts;
use enfilade_furniture::meet::Body;
use enfilade_math::Vec3;
use enfilade_scene::{NYU40, is_stuff};

/// Slack for rounding, metres: cameras keep their distance from boxes that are computed in another way than those here.
const ROUNDING: f32 = 0.002;

/// Everything that is wrong with a home; empty when nothing is.
pub fn faults(home: &Home) -> Vec<Fault> {
    let bodies = bodies(home);
    let mut faults = unlabelled(home);
    faults.extend(of_bodies(&bodies));
    faults.extend(walk::unreachable(home).into_iter().map(Fault::Unreachable));
    faults.extend(blocked_cameras(home));
    faults.extend(moving::blocked(home).into_iter().map(|(joint, by)| Fault::Blocked(joint, by)));
    faults
}

/// Faults in the positions of bodies: they run into each other, or float.
fn of_bodies(bodies: &[Body]) -> Vec<Fault> {
    let contacts = Contacts::new(bodies);
    let name = |i: usize| bodies[i].name.clone();
    let carried = contacts.carried(bodies, |_| true);
    let meets = contacts.meeting.iter().map(|&(a, b)| Fault::Meets(name(a), name(b)));
    meets.chain((0..bodies.len()).filter(|&i| !carried[i]).map(|i| Fault::Floats(name(i)))).collect()
}

/// The objects of a home, by name.
pub(crate) fn bodies(home: &Home) -> Vec<Body> {
    bodies_of(&home.scene)
}

fn unlabelled(home: &Home) -> Vec<Fault> {
    let (parts, labels) = (&home.scene.parts, &home.labels.parts);
    let named = |i: usize| {
        labels.get(i).is_some_and(|l| (1..=NYU40.len() as i16).contains(&l.semantic) && (l.instance == -1) == is_stuff(l.semantic))
    };
    (0..parts.len()).filter(|&i| !named(i)).map(|i| Fault::Nameless(parts[i].name.clone())).collect()
}

fn blocked_cameras(home: &Home) -> Vec<Fault> {
    let boxes = Obstacle::all(&home.scene, &home.plan);
    let clearance = CLEARANCES[1] - ROUNDING;
    let free = |eye: Vec3| boxes.iter().all(|b| b.distance(eye) >= clearance);
    let cameras = home.scene.cameras.iter();
    cameras.filter(|c| !free(c.position.as_vec3())).map(|c| Fault::Camera(c.name.clone())).collect()
}
