//! Everything in the workspace that reads bytes from outside, as one table of fuzz targets.
//!
//! [`TARGETS`] is the list. A target reads bytes by the same functions that the program uses and looks at nothing but that they come
//! back: a panic, a hang and memory without bound are mistakes, an error is an answer. `cargo xtask fuzz` searches for such bytes with
//! libFuzzer; the reader is fixed, and what was found stays in `regressions/<target>/`, and an ordinary test reads all of these.
//!
//! To add an importer, write one line `importer(…)` in [`TARGETS`], and put a small file or two into `seeds/<target>/`.

mod input;
mod seeds;
mod targets;

pub use input::{Run, Seed};
pub use targets::{Reads, TARGETS, Target};

/// Bytes of memory that a target may have at a time: what a picture of the largest size that is read takes, and some more.
pub const MAX_MEMORY: usize = 3 << 29;
