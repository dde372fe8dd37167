//! Bodies in memory, as every format for simulators has them.

use crate::looks::{Looks, Visual};
use enfilade_compose::{Moments, Solid};
use enfilade_math::DVec3;

/// A scene for simulators.
#[derive(Clone, Debug)]
pub struct Model {
    /// A body comes after its parent. The first one is the structure: what belongs to no thing.
    pub bodies: Vec<Rigid>,
    /// Pairs of bodies between which contacts do not count: joints, and what they touch at rest.
    pub excluded: Vec<[usize; 2]>,
    /// Meshes and materials.
    pub looks: Looks,
    /// Guesses, and what the model has otherwise than the scene.
    pub notes: Vec<String>,
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Rigid {
    /// Unique in the model; letters, digits, `_`, `-` and `.`.
    pub name: String,
    /// The body that it is joined to; `None`: the world.
    pub parent: Option<usize>,
    /// How it is joined.
    pub joint: Joint,
    /// Origin of the body, world, at rest. A hinge passes through it.
    pub origin: DVec3,
    /// What touches others, relative to the origin.
    pub pieces: Vec<Piece>,
    /// What is seen.
    pub visuals: Vec<Visual>,
}

/// A joint of a body with its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// What it leaves free.
    pub kind: JointKind,
    /// The least and the greatest state from rest: radians of a hinge, metres of a slide; `None` without end.
    pub limits: Option<[f64; 2]>,
    /// Force or torque that begins to move it: newtons of a slide, newton metres of a hinge.
    pub friction: f64,
    /// Viscous resistance: N·s/m of a slide, N·m·s/rad of a hinge.
    pub damping: f64,
}

/// What a joint leaves free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointKind {
    /// Nothing.
    Fixed,
    /// Everything.
    Free,
    /// Turning about an axis through the body's origin; unit length, counter-clockwise seen against it.
    Hinge(DVec3),
    /// Sliding along an axis of unit length.
    Slide(DVec3),
}

/// A convex piece of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The convex surface.
    pub solid: Solid,
    /// Kilograms.
    pub mass_kg: f64,
}

/// Why a scene cannot be written for simulators.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PhysicsError {
    /// A body without any mass.
    #[error("body {body:?} moves, but nothing of it has a volume: its parts are {parts}; give it a part that is no line or point")]
    NoVolume {
        /// The body.
        body: String,
        /// The names of its parts.
        parts: String,
    },
    /// A free body on another.
    #[error("body {body:?} moves freely on {parent:?}, which simulators do not have; take its parent away, or give it a hinge or a slide")]
    FreeOnAnother {
        /// The body.
        body: String,
        /// The body that bears it.
        parent: String,
    },
}

impl Joint {
    /// One that leaves nothing free.
    pub const FIXED: Self = Self { kind: JointKind::Fixed, limits: None, friction: 0.0, damping: 0.0 };
    /// One that leaves everything free.
    pub const FREE: Self = Self { kind: JointKind::Free, limits: None, friction: 0.0, damping: 0.0 };
}

impl Rigid {
    /// Mass, centre (relative to the origin) and inertia; `None` without mass.
    pub fn moments(&self) -> Option<Moments> {
        Moments::joined(&self.pieces.iter().map(|piece| piece.solid.moments(piece.mass_kg)).collect::<Vec<_>>())
    }
}
