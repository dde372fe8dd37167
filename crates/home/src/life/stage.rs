//! The home while life comes into it: its objects as bodies that know of each other, and what is put among them.

use super::ground::Ground;
use crate::check::bodies::{bodies_of, body_named, triangles};
use crate::check::contact::{Contacts, runs_into, touches};
use crate::gravity::height_between;
use crate::shell::is_shell;
use crate::{Home, open};
use enfilade_furniture::meet::{Body, Triangle, overlap};
use enfilade_furniture::{family_of, object_of};
use enfilade_math::{Bounds3, DAffine3, Vec2, Vec3};
use enfilade_scene::{BodyId, Part, PartId, PartLabel};
use std::collections::{BTreeMap, BTreeSet};

/// Distance that is left between what has been put down and what it lies on, metres: contact without faces in one plane.
const REST: f32 = 0.0005;
/// Greatest height from which things are put down, metres.
const DROP: f32 = 0.08;
/// Upper sides of things are looked for below this height, metres: on tables and seats, not on wardrobes.
const REACHABLE: f32 = 1.3;
/// Families that lie flat on floors, which things may lie on too.
const FLAT: [&str; 4] = ["rug", "bath_mat", "exercise_mat", "door_mat"];

/// Parts of objects that are to be put somewhere, in a space of their own.
pub struct Bundle {
    /// The parts.
    pub parts: Vec<Part>,
    /// Labels of the parts.
    pub labels: Vec<PartLabel>,
}

/// A home and the bodies in it.
pub struct Stage<'a> {
    /// The home.
    pub home: &'a mut Home,
    /// The bodies of its objects.
    pub bodies: Vec<Body>,
    number: BTreeMap<String, usize>,
    grounds: BTreeMap<String, Ground>,
    /// How objects were moved that stood in the home, by what they were moved with.
    nudged: Vec<(Vec<String>, DAffine3)>,
}

impl<'a> Stage<'a> {
    /// The home as it is.
    pub fn new(home: &'a mut Home) -> Self {
        let bodies = bodies_of(&home.scene);
        let number = bodies.iter().enumerate().map(|(i, body)| (body.name.clone(), i)).collect();
        Self { home, bodies, number, grounds: BTreeMap::new(), nudged: Vec::new() }
    }

    /// The body of an object.
    pub fn body(&self, object: &str) -> Option<&Body> {
        self.number.get(object).map(|&i| &self.bodies[i])
    }

    /// The upper side of an object.
    pub fn over(&mut self, object: &str, high: bool) -> Option<&Ground> {
        let host = *self.number.get(object)?;
        if !self.grounds.contains_key(object) {
            let bounds = self.bodies[host].bounds;
            let limit = if high { f32::INFINITY } else { REACHABLE };
            let others = self.bodies.iter().enumerate().filter(|(i, body)| *i != host && overlap(&body.bounds, &tall(&bounds), 0.0));
            let window = [bounds.min.truncate(), bounds.max.truncate()];
            let ground = Ground::new(window, &[&self.bodies[host]], others.map(|(_, body)| body), limit);
            self.grounds.insert(object.into(), ground);
        }
        self.grounds.get(object)
    }

    /// The floor of a room, with what lies flat on it.
    pub fn floor(&mut self, room: usize) -> Option<&Ground> {
        let key = format!("floor {room}");
        if !self.grounds.contains_key(&key) {
            let room = self.home.plan.rooms.get(room)?;
            let half = 0.5 * room.size.truncate();
            let window = [room.box_center - half, room.box_center + half];
            let bounds = Bounds3 { min: window[0].extend(-0.2), max: window[1].extend(1.0) };
            let lies = |body: &&Body| {
                family_of(&body.name).starts_with("floor_") && body.bounds.max.z < 0.05 || FLAT.contains(&family_of(&body.name))
            };
            let (carriers, others): (Vec<&Body>, Vec<&Body>) =
                self.bodies.iter().filter(|body| overlap(&body.bounds, &bounds, 0.0)).partition(lies);
            let ground = Ground::new(window, &carriers, others.into_iter(), 0.05);
            self.grounds.insert(key.clone(), ground);
        }
        self.grounds.get(&key)
    }

    /// The triangles of all bodies in a window.
    pub fn triangles(&self, window: &Bounds3) -> Vec<Triangle> {
        let near = self.bodies.iter().filter(|body| overlap(&body.bounds, window, 0.0));
        near.flat_map(|body| body.within(window)).copied().collect()
    }

    /// The bodies of a bundle in a pose.
    pub fn bodies_of(&self, bundle: &Bundle, pose: DAffine3) -> Vec<Body> {
        let mut bodies: Vec<Body> = Vec::new();
        for part in &bundle.parts {
            let name = object_of(&part.name);
            let world = pose * part.world_from_mesh;
            let mesh = &self.home.scene.meshes[part.mesh as usize];
            let corners: Vec<Vec3> = mesh.positions.iter().map(|p| world.transform_point3(p.as_dvec3()).as_vec3()).collect();
            if bodies.last().is_none_or(|body| body.name != name) {
                bodies.push(Body::new(name));
            }
            let triangles = mesh.triangles.iter().map(|t| t.map(|i| corners[i as usize])).collect();
            bodies.last_mut().expect("just pushed").push(triangles);
        }
        bodies
    }

    /// How far `group`, which is in the air, can be lowered until it lies on something, and whether it is free there.
    pub fn lowered(&self, group: &[Body], ignored: &[usize]) -> Option<f32> {
        let around = group.iter().fold(Bounds3::EMPTY, |all, body| all.union(body.bounds));
        let window = Bounds3 { min: around.min - Vec3::new(0.02, 0.02, DROP), max: around.max + 0.02 };
        let near: Vec<&Body> = self
            .bodies
            .iter()
            .enumerate()
            .filter(|(i, body)| !ignored.contains(i) && overlap(&body.bounds, &window, 0.0))
            .map(|(_, body)| body)
            .collect();
        let mut lowest = DROP;
        for body in group {
            let above: Vec<Triangle> = body.parts().flatten().copied().collect();
            for other in &near {
                let column = Bounds3 { min: body.bounds.min - Vec3::Z * lowest, max: body.bounds.max };
                let below: Vec<Triangle> = other.within(&column).copied().collect();
                lowest = height_between(&above, &below, lowest).unwrap_or(lowest);
            }
        }
        let by = -(lowest - REST).max(0.0);
        let down = Vec3::Z * by;
        let free = near.iter().all(|other| group.iter().all(|body| !runs_into(body, other, down)));
        let held = group.iter().all(|body| {
            near.iter().any(|other| touches(body, other, down))
                || group.iter().any(|other| other.name != body.name && touches(body, other, Vec3::ZERO))
        });
        // Not by each other alone.
        let carried = group.iter().any(|body| near.iter().any(|other| touches(body, other, down)));
        (lowest < DROP && free && held && carried).then_some(by)
    }

    /// Puts a bundle into the home in a pose.
    pub fn put(&mut self, bundle: Bundle, pose: DAffine3) {
        let bodies = self.bodies_of(&bundle, pose);
        for body in &bodies {
            if let Some(front) = self.home.fronts.get_mut(&body.name) {
                *front = pose.transform_vector3(*front);
            }
        }
        let placed = bundle.parts.into_iter().map(|part| Part { world_from_mesh: pose * part.world_from_mesh, ..part });
        self.home.scene.parts.extend(placed);
        self.home.labels.parts.extend(bundle.labels);
        for body in bodies {
            self.grounds.values_mut().for_each(|ground| ground.put(&body));
            self.number.insert(body.name.clone(), self.bodies.len());
            self.bodies.push(body);
        }
    }

    /// Moves objects that are in the home, turned about the vertical through `pivot` and then shifted, if they are free and carried there
    /// by what is around them; `settle` lowers them first. True where they have moved.
    pub fn nudge(&mut self, objects: &[String], turn: DAffine3, settle: bool) -> bool {
        let group: Vec<usize> = objects.iter().filter_map(|object| self.number.get(object).copied()).collect();
        let moved: Vec<Body> = group.iter().map(|&i| turned(&self.bodies[i], turn)).collect();
        let by = if settle {
            self.lowered(&moved, &group)
        } else {
            let around = |body: &Body| {
                self.bodies
                    .iter()
                    .enumerate()
                    .filter(|(i, other)| !group.contains(i) && overlap(&other.bounds, &body.bounds, 0.03))
                    .map(|(_, other)| other)
                    .collect::<Vec<_>>()
            };
            let free = moved.iter().all(|body| around(body).iter().all(|other| !runs_into(body, other, Vec3::ZERO)));
            let held = moved.first().is_some_and(|body| around(body).iter().any(|other| touches(body, other, Vec3::ZERO)));
            (free && held).then_some(0.0)
        };
        let Some(by) = by.filter(|_| self.can_spare(&group)) else { return false };
        let pose = DAffine3::from_translation(Vec3::new(0.0, 0.0, by).as_dvec3()) * turn;
        self.shift(objects, pose);
        self.nudged.push((objects.to_vec(), pose));
        true
    }

    /// True when all that touches bodies of a group is carried by others too, and stays where it is without them.
    fn can_spare(&self, group: &[usize]) -> bool {
        let others = || self.bodies.iter().enumerate().filter(|(i, _)| !group.contains(i));
        let touching =
            |(_, body): &(usize, &Body)| !is_shell(&body.name) && group.iter().any(|&g| touches(&self.bodies[g], body, Vec3::ZERO));
        others().filter(touching).all(|(i, body)| others().any(|(j, other)| i != j && touches(body, other, Vec3::ZERO)))
    }

    /// Moves objects wherever that leads.
    fn shift(&mut self, objects: &[String], pose: DAffine3) {
        let is_moved = |name: &str| objects.iter().any(|object| object_of(name) == object);
        for part in self.home.scene.parts.iter_mut().filter(|part| is_moved(&part.name)) {
            part.world_from_mesh = pose * part.world_from_mesh;
        }
        for object in objects {
            if let Some(front) = self.home.fronts.get_mut(object) {
                *front = pose.transform_vector3(*front);
            }
            if let Some(&i) = self.number.get(object) {
                self.bodies[i] = turned(&self.bodies[i], pose);
            }
        }
        for body in &mut self.home.scene.bodies {
            if is_moved(&body.name)
                && let Some(carried) = body.carried(&pose)
            {
                *body = carried;
            }
        }
        self.grounds.clear();
    }

    /// Lets what moves by the joint of this number, whose body and parts these are, be made in a state.
    pub fn open(&mut self, joint: usize, body: BodyId, parts: &[PartId], state: f64) {
        open::set(self.home, joint, body, parts, state);
        self.home.joints[joint].made = 0.0;
        let object = object_of(&self.home.joints[joint].body);
        if let Some(&i) = self.number.get(object) {
            self.bodies[i] = body_named(&self.home.scene, object);
        }
        self.grounds.clear();
    }

    /// Names of the objects that were moved, the first of each move.
    pub fn moved(&self) -> impl Iterator<Item = &String> {
        self.nudged.iter().filter_map(|(objects, _)| objects.first())
    }

    /// Moves an object that was moved back, with what was moved with it.
    pub fn put_back(&mut self, object: &str) {
        if let Some(at) = self.nudged.iter().position(|(objects, _)| objects.first().is_some_and(|first| first == object)) {
            let (objects, pose) = self.nudged.remove(at);
            self.shift(&objects, pose.inverse());
        }
    }

    /// The objects among those that `may` fall that nothing carries.
    pub fn fallen(&self, may: impl Fn(&str) -> bool) -> BTreeSet<String> {
        let held = Contacts::of_touch(&self.bodies).carried(&self.bodies, |_| true);
        let loose = self.bodies.iter().zip(held).filter(|(body, held)| !held && may(&body.name));
        loose.map(|(body, _)| body.name.clone()).collect()
    }

    /// Takes parts out of the home whose names `gone` names.
    pub fn remove(&mut self, gone: impl Fn(&str) -> bool) {
        let parts = self.home.scene.parts.iter().zip(0..).filter(|(part, _)| gone(&part.name)).map(|(_, id)| id).collect();
        let mut id = 0..;
        self.home.labels.parts.retain(|_| id.next().is_none_or(|id| !BTreeSet::contains(&parts, &id)));
        self.home.scene.remove_parts(&parts);
        self.renew(|_| true);
    }

    /// Makes the bodies of the objects of which `changed` is true again, and forgets those that have no parts any more.
    pub fn renew(&mut self, changed: impl Fn(&str) -> bool) {
        let mut found: BTreeMap<&str, Vec<u32>> = BTreeMap::new();
        for (part, id) in self.home.scene.parts.iter().zip(0..) {
            found.entry(object_of(&part.name)).or_default().push(id);
        }
        self.bodies.retain(|body| found.contains_key(body.name.as_str()));
        for body in self.bodies.iter_mut().filter(|body| changed(&body.name)) {
            let parts = &found[body.name.as_str()];
            if parts.len() != body.parts().count() {
                *body = Body::new(&body.name);
                parts.iter().for_each(|&id| body.push(triangles(&self.home.scene, id)));
            }
        }
        self.number = self.bodies.iter().enumerate().map(|(i, body)| (body.name.clone(), i)).collect();
        self.grounds.clear();
    }
}

/// A body in another pose.
fn turned(body: &Body, pose: DAffine3) -> Body {
    let mut moved = Body::new(&body.name);
    for part in body.parts() {
        moved.push(part.iter().map(|t| t.map(|p| pose.transform_point3(p.as_dvec3()).as_vec3())).collect());
    }
    moved
}

/// The box from below a body to well above it.
fn tall(bounds: &Bounds3) -> Bounds3 {
    Bounds3 { min: bounds.min, max: bounds.max + Vec3::Z }
}

/// The middle of a box from above.
pub fn middle(bounds: &Bounds3) -> Vec2 {
    bounds.center().truncate()
}
