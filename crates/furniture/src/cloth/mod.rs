//! Cloth that falls on things and comes to rest: garments, towels, blankets, duvets.
//!
//! A [`Sheet`] is a grid of points with distances that stay (position-based dynamics: Müller et al. 2007, "Position based dynamics"). It
//! falls on a [`Solid`], the distances to the surfaces of things, keeps its own thickness from them and from itself, and becomes a mesh
//! with two sides.

mod apart;
mod block;
mod fall;
mod mesh;
mod sheet;
mod solid;

pub use sheet::{Cut, Sheet, Textile};
pub use solid::Solid;
