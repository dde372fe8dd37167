//! Models that others have made: what is known of them, and what they look like.
//!
//! A model's body is read when it is first used, and brought into the space that furniture lives in.

mod body;
mod model;
mod surfaces;

pub use body::{Body, BodyPart, Bulb};
pub use model::Model;
