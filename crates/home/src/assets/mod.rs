//! Models of a user's library, that stand in for our own furniture.
//!
//! Who reads files makes a [`Library`]; rooms ask it wherever they ask the catalogue for a family. A model is only taken where its
//! measures are those of such a thing, so that it can be placed, reached and walked around like one of ours.

mod body;
mod borrowed;
mod library;
mod model;
mod range;
mod surfaces;
mod textures;
mod words;

pub use body::{Body, BodyPart, Bulb};
pub use borrowed::Borrowed;
pub use library::Library;
pub use model::Model;
pub use range::believable;
pub(crate) use textures::repictured;
pub use words::families_of;
