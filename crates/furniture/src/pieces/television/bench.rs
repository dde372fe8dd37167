//! What is drawn of a cabinet for a television: its build and measures, and the set on it.

use super::set_kind::TelevisionSet;
use crate::materials::Finish;

/// The build of a cabinet for a television.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BenchStyle {
    /// Two doors, and an open compartment between them; white or wooden fronts.
    Doors(bool),
    /// Two or three drawers side by side below an open compartment.
    Drawers(Finish),
    /// A board on runners of metal with a shelf below.
    Open(Finish),
    /// Three panes on metal posts.
    Glass,
}

/// A low cabinet, and perhaps a television set on it.
#[derive(Clone, Copy, Debug)]
pub struct TelevisionBench {
    /// The build of the cabinet.
    pub style: BenchStyle,
    /// Width of the cabinet.
    pub width: f32,
    /// Depth of the cabinet.
    pub depth: f32,
    /// Height of its top.
    pub top: f32,
    /// The set on it.
    pub set: Option<TelevisionSet>,
}
