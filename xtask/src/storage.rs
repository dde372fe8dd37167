//! `cargo xtask bench storage`: the files of layers beside Hypersim's, read by plain h5py.
//!
//! An instrument of ours renders frames and stores their layers in several ways; a Python program reads them and writes
//! `docs/benchmarks/storage.md` and `storage.json`.

use crate::bench::instrument;
use crate::house::House;
use crate::python;
use crate::step::finish;

/// Stores and measures, with frames of the datasets in these folders or else with frames that are rendered for it.
///
/// # Errors
/// When something cannot be built, rendered or read, or there is no Python with h5py.
pub fn run(house: &House, datasets: &[&str]) -> Result<(), String> {
    let work = house.target()?.join("storage");
    let mut store = instrument(house, "storage");
    store.arg(&work).args(datasets);
    finish(store)?;
    let python = python::with_h5py(house)?.ok_or("there is no Python with h5py to read with")?;
    let mut read = house.command(python, &["xtask/python/bench_storage.py"]);
    read.arg(&work).arg("docs/benchmarks");
    finish(read).map(|_| ())
}
