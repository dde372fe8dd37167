//! A finished home: its scene with labels and floor plan, and what was moved or removed to make it possible.

use crate::fault::Fault;
use crate::joint::{HomeJoint, hang, listed};
use crate::plan::FloorPlan;
use enfilade_furniture::{family_of, object_of};
use enfilade_math::{DVec3, Vec3};
use enfilade_scene::{Labels, RoomThing, Rooms, Scene};
use std::collections::BTreeMap;

/// The front of a thing that looks up or down more than this share of a unit vector is none.
const UPRIGHT: f64 = 0.5;

/// A home and what its parts are called.
#[derive(Clone, Debug)]
pub struct Home {
    /// Valid by construction.
    pub scene: Scene,
    /// Every part has a class; all but walls, floor and ceiling belong to an instance.
    pub labels: Labels,
    /// The floor plan of its rooms.
    pub plan: FloorPlan,
    /// Directions of objects' fronts, by the objects' names; also of objects that were removed.
    pub fronts: BTreeMap<String, DVec3>,
    /// Objects that could not stay where they had been put, and were removed.
    pub removed: Vec<Removal>,
    /// Objects that were moved a little so that they could stay.
    pub moved: Vec<Shift>,
    /// The models of others in the scene, with their files and licences; sorted, each once.
    pub credits: Vec<String>,
    /// What of a drawn plan was left out, guessed or added, and what its rooms lack; empty for other homes.
    pub notes: Vec<String>,
    /// What can be opened, and how far; empty unless [`HomeConfig::states`](crate::HomeConfig::states) is given.
    pub joints: Vec<HomeJoint>,
    /// What is not as the states ask for, and names in them of nothing.
    pub state_notes: Vec<String>,
}

impl Home {
    /// The home's rooms, walls and openings, and what its instances are called.
    pub fn rooms(&self) -> Rooms {
        let parts = self.scene.parts.iter().zip(&self.labels.parts);
        let names: BTreeMap<i16, &str> =
            parts.filter(|(_, label)| label.instance >= 1).map(|(part, label)| (label.instance, object_of(&part.name))).collect();
        let thing = |(instance, name): (i16, &str)| {
            let front = self.fronts.get(name).map(|front| front.truncate()).filter(|front| front.length() > UPRIGHT);
            let front = front.map(|front| front.normalize().to_array());
            RoomThing { instance, name: name.into(), family: family_of(name).into(), front }
        };
        let joints = listed(&self.joints, &self.scene, &self.labels);
        let mut rooms = Rooms { things: names.into_iter().map(thing).collect(), joints, ..self.plan.to_rooms() };
        hang(&mut rooms.openings, &self.joints, &self.scene);
        rooms
    }
}

/// An object that was removed, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Removal {
    /// Name of the object.
    pub object: String,
    /// The fault of the object.
    pub fault: Fault,
}

/// An object that was moved until it rested on something and ran into nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Shift {
    /// Name of the object.
    pub object: String,
    /// The displacement, metres.
    pub by: Vec3,
}
