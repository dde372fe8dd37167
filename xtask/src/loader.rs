//! `cargo xtask bench loader`: the Python module's reading of layers beside h5py's, on the same files.
//!
//! The measurement is a Python program, `xtask/python/bench_loader.py`, which writes `docs/benchmarks/loader.md` and `loader.json`.

use crate::house::House;
use crate::python;
use crate::step::finish;
use std::path::Path;

/// Measures with frames of the datasets in these folders, or else with frames that are rendered for it.
///
/// # Errors
/// When something cannot be built, rendered or read, the readers differ, or there is no Python with h5py.
pub fn run(house: &House, datasets: &[&str]) -> Result<(), String> {
    let work = house.target()?.join("loader");
    let module = work.join("module");
    assemble(house, &module)?;
    let python = python::with_h5py(house)?.ok_or("there is no Python with h5py to compare with")?;
    let mut measure = house.command(python, &["xtask/python/bench_loader.py"]);
    measure.arg(&work).arg("docs/benchmarks").args(datasets).env("PYTHONPATH", &module);
    finish(measure).map(|_| ())
}

/// Builds the module in release and puts the package `enfilade` together in `folder`.
fn assemble(house: &House, folder: &Path) -> Result<(), String> {
    finish(house.cargo(&["build", "--release", "--locked", "--package", "enfilade-python"]))?;
    let package = folder.join("enfilade");
    std::fs::create_dir_all(&package).map_err(|error| format!("cannot make {}: {error}", package.display()))?;
    let library = format!("{}enfilade_python{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let own = if cfg!(windows) { "_native.pyd" } else { "_native.abi3.so" };
    let copy = |from: &Path, to: &Path| {
        std::fs::copy(from, to).map(|_| ()).map_err(|error| format!("cannot copy {} to {}: {error}", from.display(), to.display()))
    };
    let sources = house.root.join("crates/python/enfilade");
    let unreadable = |error| format!("cannot list {}: {error}", sources.display());
    for entry in std::fs::read_dir(&sources).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        if entry.path().extension().is_some_and(|extension| extension == "py") {
            copy(&entry.path(), &package.join(entry.file_name()))?;
        }
    }
    copy(&house.target()?.join("release").join(library), &package.join(own))
}
