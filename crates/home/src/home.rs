//! A finished home: its scene with labels and floor plan, and what was moved or removed to make it possible.

use crate::check::Fault;
use crate::plan::FloorPlan;
use enfilade_math::Vec3;
use enfilade_scene::{Labels, Scene};

/// A home and what its parts are called.
#[derive(Clone, Debug)]
pub struct Home {
    /// Valid by construction.
    pub scene: Scene,
    /// Every part has a class; all but walls, floor and ceiling belong to an instance.
    pub labels: Labels,
    /// Where its rooms are.
    pub plan: FloorPlan,
    /// Objects that could not stay where they had been put, and were removed.
    pub removed: Vec<Removal>,
    /// Objects that were moved a little so that they could stay.
    pub moved: Vec<Shift>,
    /// The models of others in the scene, with their files and licences; sorted, each once.
    pub credits: Vec<String>,
}

/// An object that was removed, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Removal {
    /// Its name.
    pub object: String,
    /// What was wrong with it.
    pub fault: Fault,
}

/// An object that was moved until it rested on something and ran into nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Shift {
    /// Its name.
    pub object: String,
    /// How far, metres.
    pub by: Vec3,
}
