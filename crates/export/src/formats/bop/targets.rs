//! The objects of a scene whose poses are exported.

use enfilade_math::{DMat3, DVec3};
use std::collections::BTreeMap;

/// Where a model is in the world, metres.
#[derive(Clone, Copy)]
pub(super) struct Pose {
    pub rotation: DMat3,
    pub translation: DVec3,
}

/// Number of the object, and pose, by number of the instance.
pub(super) type Targets = BTreeMap<i16, (u32, Pose)>;
