//! People's own models in a scene.
//!
//! Each [`ObjectGroup`] tells which models are taken, how many, where they are put and how they lie. [`compose`] draws them, finds
//! surfaces for them, and lets them come to rest: `world` is a rigid-body simulation in which the parts of the scene do not move. Models
//! are simulated as the convex pieces that `pieces` cuts them into. What cannot be placed is left out with the reason, or refused.
//!
//! `solid`, `unrest` and `passage` offer convex pieces, the simulation and what is in the way to what writes scenes for simulators.
//!
//! What moves in a scene by `[[motion]]` is in `motion`, what opens by its joints in `joints`.
//!
//! The result is a function of the scene, the groups and the seed: the simulation runs on one thread, in double precision, with an
//! arithmetic that is the same on every processor.

mod compose;
mod draw;
mod error;
mod group;
mod joints;
mod materials;
mod model;
mod motion;
mod passage;
mod pieces;
mod place;
mod rest;
mod shapes;
mod solid;
mod surfaces;
#[cfg(test)]
mod tests;
mod unrest;
mod words;
mod world;

pub use compose::{Composed, Models, compose};
pub use error::ComposeError;
pub use group::{Files, Materials, Missing, ObjectGroup, Pose, Turn};
pub use motion::{MotionGroup, with_motion};
pub use passage::Passage;
pub use rest::moved_again;
pub use solid::{Moments, SHEET_M, Solid, convex_solid, solids};
pub use unrest::{Thing, Way, overlaps, unrest};
pub use words::{ClassWord, Extent, Many, Number};
pub use world::{FRICTION, SOLVER};
