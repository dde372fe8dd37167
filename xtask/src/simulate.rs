//! `cargo xtask simulate`: a job of Hypersim's size on up to 10,000 nodes, as a simulation of discrete events.
//!
//! A Python program without further packages; it writes `docs/benchmarks/simulation.md`, `.json` and `.svg`.

use crate::house::House;
use crate::step::finish;

/// Simulates, in some minutes.
///
/// # Errors
/// When there is no Python 3, or something cannot be written.
pub fn run(house: &House) -> Result<(), String> {
    finish(house.command("python3", &["xtask/python/simulate.py", "docs/benchmarks"])).map(|_| ())
}
