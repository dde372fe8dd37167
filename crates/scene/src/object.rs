//! Objects: what a scene's file says is one thing, and what lies within what.
//!
//! A node with its primitives is an object, a prim with its subsets, an instance of a prototype, a group. Siblings are objects of their own,
//! and what holds them is their parent.

use serde::{Deserialize, Serialize};

/// Index into [`Scene::objects`](crate::Scene::objects).
pub type ObjectId = u32;

/// Something that the scene's file names as one, or that holds such things.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Object {
    /// What the file calls it, without its parents; others may have the same name.
    pub name: String,
    /// The object that it lies in, which stands before it in [`Scene::objects`](crate::Scene::objects).
    pub parent: Option<ObjectId>,
}
