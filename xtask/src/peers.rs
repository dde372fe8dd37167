//! `cargo xtask oracle` and `cargo xtask bench render`: our renderer beside Mitsuba 3, on the same scenes.
//!
//! The comparisons are Python programs in `xtask/python`, because Mitsuba is a Python package. Here our side is built and they
//! are started. They write tables and figures to `docs/benchmarks`, or below the target folder when they are about some scenes only.

use crate::house::House;
use crate::step::finish;
use crate::{bench, python};

/// Names the folder of real rooms.
const SCENES: &str = "ENFILADE_SCENES";

/// Runs `xtask/python/<program>.py`; `words` are passed to it (`--help` lists them).
///
/// # Errors
/// When something cannot be built or installed, or the program finds a difference that nothing explains.
pub fn run(house: &House, program: &str, words: &[&str]) -> Result<(), String> {
    let mut build = house.cargo(&["build", "--release", "--locked", "--quiet"]);
    build.args(["--package", bench::PACKAGE]);
    if program == "bench_render" {
        build.args(["--package", "enfilade", "--bin", "enfilade"]);
    }
    finish(build)?;
    let target = house.target()?;
    let built = |name: &str| target.join("release").join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    let mut command = house.command(python::with_peers(house)?, &[]);
    command.arg(format!("xtask/python/{program}.py"));
    command.arg("--bench").arg(built(bench::PACKAGE));
    command.arg("--work").arg(target.join("peers")).args(["--docs", "docs/benchmarks"]);
    if let Some(scenes) = std::env::var_os(SCENES) {
        let scenes = std::path::absolute(scenes).map_err(|error| format!("{SCENES}: {error}"))?;
        command.arg("--scenes").arg(scenes);
    }
    if program == "bench_render" {
        command.arg("--program").arg(built("enfilade"));
    }
    command.args(words);
    finish(command).map(|_| ())
}
