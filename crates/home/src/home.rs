//! A finished home: its scene with labels and floor plan, and what was moved or taken away before it could stand.

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
    /// What could not stay where it had been put, and why; it is not in the scene any more.
    pub removed: Vec<Removal>,
    /// What was moved a little so that it could stay.
    pub moved: Vec<Shift>,
    /// The models of others that are in it, with the files that they come from and their licences; sorted, each once.
    pub credits: Vec<String>,
}

/// An object that was taken away, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Removal {
    /// Its name.
    pub object: String,
    /// What was wrong with it.
    pub fault: Fault,
}

/// An object that was moved to where it is carried and free.
#[derive(Clone, Debug, PartialEq)]
pub struct Shift {
    /// Its name.
    pub object: String,
    /// How far, metres.
    pub by: Vec3,
}
