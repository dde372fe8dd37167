//! Objects: the things that a scene's file groups, and their nesting.
//!
//! A node with its primitives is an object, a prim with its subsets, an instance of a prototype, a group. Siblings are separate objects,
//! and the node that contains them is their parent.

use serde::{Deserialize, Serialize};

/// Index into [`Scene::objects`](crate::Scene::objects).
pub type ObjectId = u32;

/// A thing that the scene's file names as one, or a group of such things.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Object {
    /// The object's name in the file, without its parents; others may have the same name.
    pub name: String,
    /// The object that contains it, which comes before it in [`Scene::objects`](crate::Scene::objects).
    pub parent: Option<ObjectId>,
}
