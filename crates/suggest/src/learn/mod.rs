//! Learning the tables from names that people have labelled. `data/` was made with it, and you can use it for your own tables.
//!
//! [`read_names`] reads a table of labelled names, [`group`] groups names of a scene that differ only in their numbers, [`learn`] finds the
//! weights, and [`held_out`] tests models on scenes that they have not seen.

mod folds;
mod groups;
mod pairs;
mod train;

pub use folds::{HeldOut, Split, held_out};
pub use groups::{NameGroup, NamedObject, group, read_names, with_curtains};
pub use pairs::{Pair, learn_shares};
pub use train::{LearnConfig, learn};
