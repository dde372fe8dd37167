//! The trait of every piece of furniture: its size, the space it needs, the surfaces for things on it, and how it is built.
//!
//! It lives in a space of its own, see [`crate::pieces`]; its family is a row of the catalogue.

use super::Surface;
use crate::builder::Builder;
use enfilade_math::{DAffine3, Rng, Vec3};

/// A family of things that a home can have; its fields are what varies.
pub trait Furniture {
    /// Draws one of the many variants of the piece.
    fn random(rng: &mut Rng) -> Self
    where
        Self: Sized;

    /// Width (x), depth (y) and height (z) of the box around it.
    fn size(&self) -> Vec3;

    /// Free depth before its front that people need to use it, metres.
    fn reach(&self) -> f32 {
        0.0
    }

    /// Fits what reaches up to the ceiling to a room of this height, metres.
    fn fit(&mut self, _height: f32) {}

    /// Surfaces on which small things can stand, in its own space.
    fn surfaces(&self) -> Vec<Surface> {
        Vec::new()
    }

    /// Adds its parts. `rng` decides what the fields leave open: creases, tilts, grain.
    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng);
}
