//! `cargo xtask bench homes`: what generated homes cost and what is in them, beside published numbers.
//!
//! An instrument of ours makes the homes, one process each, and writes `docs/benchmarks/homes.md` and `homes.json`.

use crate::bench::instrument;
use crate::house::House;
use crate::step::finish;

/// Measures homes: `[COUNT] [FIRST SEED]`, by default 200 from seed 0.
///
/// # Errors
/// When something cannot be built, or a home cannot be made.
pub fn run(house: &House, words: &[&str]) -> Result<(), String> {
    let work = house.target()?.join("homes");
    std::fs::create_dir_all(&work).map_err(|error| format!("cannot make {}: {error}", work.display()))?;
    let rows = work.join("rows.jsonl");
    let mut measure = instrument(house, "statistics");
    measure.arg("measure").arg(&rows).args(words);
    finish(measure)?;
    let mut report = instrument(house, "statistics");
    report.arg("report").arg(&rows).arg("docs/benchmarks");
    finish(report).map(|_| ())
}
