//! `cargo xtask bench cycles`: what pictures cost, beside Cycles, on homes that both read from glTF.
//!
//! The comparison is a Python program, `xtask/python/bench_cycles.py`, because Blender comes as a Python module too. It writes
//! `docs/benchmarks/cycles.md`, `.json`, `.svg` and `.jpg`, or below the target folder when it is about some views only.

use crate::house::House;
use crate::step::finish;
use crate::{bench, python};

/// Measures the views of these names, or all; `--help` lists what there is.
///
/// # Errors
/// When something cannot be built, installed or rendered.
pub fn run(house: &House, words: &[&str]) -> Result<(), String> {
    let packages = ["--package", "enfilade", "--bin", "enfilade", "--package", bench::PACKAGE];
    let mut build = house.cargo(&["build", "--release", "--locked", "--quiet"]);
    build.args(packages);
    finish(build)?;
    let target = house.target()?;
    let built = |name: &str| target.join("release").join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    let mut command = house.command(python::with_blender(house)?, &["xtask/python/bench_cycles.py"]);
    command.arg("--program").arg(built("enfilade")).arg("--bench").arg(built(bench::PACKAGE));
    command.arg("--work").arg(target.join("cycles")).args(["--docs", "docs/benchmarks"]).args(words);
    finish(command).map(|_| ())
}
