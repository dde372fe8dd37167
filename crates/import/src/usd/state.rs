//! What a prim inherits, and the pieces of its mesh.

use super::bind::Bindings;
use super::constants::Constants;
use super::deform::{Deform, Rig};
use super::polygons::Corner;
use super::primvar::Sizes;
use super::stretch::Stretch;
use super::things::Thing;
use crate::assembly::FileLabel;
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{BodyId, ObjectId};
use std::rc::Rc;

/// The state that a prim inherits from those above it.
#[derive(Clone)]
pub(super) struct State {
    pub file_from_parent: DAffine3,
    /// The body that it belongs to.
    pub body: Option<BodyId>,
    pub label: FileLabel,
    pub bindings: Bindings,
    /// Constant primvars, which all prims below inherit.
    pub constants: Constants,
    /// True for the purposes `guide` and `proxy`.
    pub hidden: bool,
    /// Goes before the names of parts, so that instances of one prototype have different names.
    pub prefix: String,
    /// The object that it is in.
    pub object: Option<ObjectId>,
    /// The thing that it is a piece of.
    pub thing: Option<Thing>,
    pub rig: Rig,
    /// The prims that it is in and that no body can be.
    pub stretch: Option<Stretch>,
}

/// A piece of a mesh: some faces as a scene mesh, the subset's name, and what it binds.
#[derive(Clone)]
pub(super) struct Piece {
    pub mesh: u32,
    pub name: String,
    pub bindings: Bindings,
    /// The class that the subset states.
    pub semantic: Option<i16>,
    /// How its points change, and what its vertices were made of.
    pub deform: Option<(Rc<Deform>, Rc<[Corner]>)>,
}

/// The pieces of a prim's mesh, and its sizes.
#[derive(Clone)]
pub(super) struct Shape {
    pub pieces: Vec<Piece>,
    /// The point from which positions count.
    pub origin: DVec3,
    pub sizes: Sizes,
    /// True for subdivision surfaces.
    pub smooth: bool,
}
