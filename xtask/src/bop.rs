//! `cargo xtask bench bop`: ten models in heaps as BOP, beside BlenderProc's published recipe, as lines, time and memory.
//!
//! The comparison is a Python program, `xtask/python/bench_bop.py`, because Blender and BlenderProc are Python packages. It writes
//! `docs/benchmarks/bop.md`, `.json` and `.jpg`, or below the target folder when it is about some scenes or another size.

use crate::house::House;
use crate::python;
use crate::step::finish;
use std::path::PathBuf;

/// Measures the scenes of these names, or all; `--program PATH` takes that binary instead of building one, `--help` lists the others.
///
/// # Errors
/// When something cannot be built, installed or made.
pub fn run(house: &House, words: &[&str]) -> Result<(), String> {
    let (program, words) = with_program(house, words)?;
    let mut command = house.command(python::with_blenderproc(house)?, &["xtask/python/bench_bop.py"]);
    command.arg("--program").arg(program).arg("--work").arg(house.target()?.join("bop"));
    command.args(["--docs", "docs/benchmarks"]).args(words);
    finish(command).map(|_| ())
}

/// The binary that `--program PATH` names before the other words, else the release binary, which is built.
///
/// # Errors
/// When it cannot be built.
pub fn with_program<'a>(house: &House, words: &'a [&'a str]) -> Result<(PathBuf, &'a [&'a str]), String> {
    match words {
        ["--program", path, words @ ..] => Ok((PathBuf::from(path), words)),
        ["--program"] => Err("--program names no file".into()),
        words => Ok((built(house)?, words)),
    }
}

/// The release binary.
fn built(house: &House) -> Result<PathBuf, String> {
    finish(house.cargo(&["build", "--release", "--locked", "--quiet", "--package", "enfilade", "--bin", "enfilade"]))?;
    Ok(house.target()?.join("release").join(format!("enfilade{}", std::env::consts::EXE_SUFFIX)))
}
