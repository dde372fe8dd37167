//! Joints of the formats that have them, as bodies with limits, and their states over time.
//!
//! [`joint`] is a joint and what it moves, [`graph`] grows trees of links from joints that name two of them, [`states`] reads tables of states.
//! [`urdf`] and [`elements`] read URDF, which collections have too.

pub(crate) mod elements;
pub(crate) mod graph;
pub(crate) mod joint;
pub(crate) mod states;
pub(crate) mod urdf;
