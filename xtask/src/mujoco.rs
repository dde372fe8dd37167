//! `cargo xtask bench mujoco`: depth and segmentation of a stored run of MuJoCo, beside MuJoCo's own renderer.
//!
//! The comparison is a Python program, `xtask/python/bench_mujoco.py`, because MuJoCo is a Python package. It writes
//! `docs/benchmarks/mujoco.md`, `.json` and `.png`.

use crate::bop::with_program;
use crate::house::House;
use crate::python;
use crate::step::finish;

/// Compares the frames; `--program PATH` takes that binary instead of building one, `--help` lists the others.
///
/// # Errors
/// When something cannot be built, installed or drawn.
pub fn run(house: &House, words: &[&str]) -> Result<(), String> {
    let (program, words) = with_program(house, words)?;
    let mut command = house.command(python::with_mujoco(house)?, &["xtask/python/bench_mujoco.py"]);
    command.arg("--program").arg(program).arg("--work").arg(house.target()?.join("mujoco"));
    command.args(["--docs", "docs/benchmarks"]).args(words);
    finish(command).map(|_| ())
}
