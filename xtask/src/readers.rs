//! `cargo xtask readers FOLDER`: our readers of scene files beside other programs', on public files.
//!
//! The comparison is a Python program, `xtask/python/readers.py`, because the other readers are Python packages. It writes
//! `docs/benchmarks/readers.md`; with `--only TEXT`, for files with this in their path, below the target folder.

use crate::house::House;
use crate::python;
use crate::step::finish;

/// Other readers, at the versions that the explanations were verified with; then their optional dependencies.
const PACKAGES: [&str; 12] = [
    "usd-core==26.11",
    "trimesh==5.2.0",
    "mitsuba==3.9.1",
    "impasse==5.4.2",
    "cmeel-assimp==6.0.5",
    "DracoPy",
    "charset-normalizer",
    "lxml",
    "pycollada",
    "numpy",
    "pillow",
    "scipy",
];

/// Reads and compares the files below the folder that is named first; the other words are passed to the program (`--help` lists them).
///
/// # Errors
/// When something cannot be built or installed, or readers differ where nothing explains it.
pub fn run(house: &House, words: &[&str]) -> Result<(), String> {
    let [folder, rest @ ..] = words else { return Err("expected a folder with files of scenes: cargo xtask readers FOLDER".into()) };
    let folder = std::path::absolute(folder).map_err(|error| format!("{folder}: {error}"))?;
    finish(house.cargo(&["build", "--release", "--locked", "--quiet", "--package", "enfilade", "--bin", "enfilade"]))?;
    let python =
        python::made(house, "venv-scenes", "import pxr, trimesh, mitsuba, cmeel, collada, DracoPy, numpy, scipy, lxml, PIL", &PACKAGES)?;
    let target = house.target()?;
    let mut compare = house.command(python, &["xtask/python/readers.py"]);
    compare.arg(folder).args(rest);
    compare.arg("--program").arg(target.join("release").join(format!("enfilade{}", std::env::consts::EXE_SUFFIX)));
    compare.arg("--work").arg(target.join("readers")).args(["--docs", "docs/benchmarks"]);
    compare.args(["--explanations", "xtask/readers/explanations.json"]);
    finish(compare).map(|_| ())
}
