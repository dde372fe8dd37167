//! Models of a user's library that replace our own furniture.
//!
//! The caller reads files into a [`Library`]; wherever a room takes a family from the catalogue, the library may give a model instead.
//! Only models with the size of such a thing are given, so that they can be placed, reached and walked around like ours.

mod borrowed;
mod library;
mod range;
mod words;

pub use borrowed::Borrowed;
pub use library::Library;
pub use words::families_of;
