//! Learning the tables from names that people have labelled: what `data/` was made with, open to tables of your own.
//!
//! [`read_names`] reads a table of labelled names, [`group`] puts those of a scene together that differ in their numbers only,
//! [`learn`] finds the weights, and [`held_out`] asks models about scenes that they have not seen.

mod folds;
mod groups;
mod pairs;
mod train;

pub use folds::{HeldOut, Split, held_out};
pub use groups::{NameGroup, NamedObject, group, read_names, with_curtains};
pub use pairs::{Pair, learn_shares};
pub use train::{LearnConfig, learn};
