//! A Python that reads HDF5, for the tests that compare with h5py.

use crate::house::House;
use crate::step::finish;
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// Names a Python with numpy and h5py; tests that need one read it too.
pub const VARIABLE: &str = "ENFILADE_PYTHON";

/// The Python that [`VARIABLE`] names, else the system's if it has h5py, else one made below the target folder.
///
/// # Errors
/// On an unattended machine, when none can be had; elsewhere that is told, and `None`.
pub fn with_h5py(house: &House) -> Result<Option<PathBuf>, String> {
    if let Some(named) = std::env::var_os(VARIABLE) {
        let works = reads_hdf5(house, Path::new(&named));
        return if works { Ok(Some(named.into())) } else { Err(format!("{VARIABLE} names a Python that cannot import numpy and h5py")) };
    }
    match found_or_made(house) {
        Ok(python) => Ok(Some(python)),
        Err(reason) if House::unattended() => Err(reason),
        Err(reason) => {
            println!("   note: {reason}; comparisons with h5py are left out");
            Ok(None)
        }
    }
}

fn found_or_made(house: &House) -> Result<PathBuf, String> {
    let system = ["python3", "python"].map(PathBuf::from);
    if let Some(python) = system.iter().find(|python| reads_hdf5(house, python)) {
        return Ok(python.clone());
    }
    let folder = house.target()?.join("venv");
    let own = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    if reads_hdf5(house, &own) {
        return Ok(own);
    }
    let python = system.iter().find(|python| succeeds(house, python, "import venv")).ok_or("there is no Python with the module venv")?;
    let mut make = house.command(python, &["-m", "venv", "--clear"]);
    make.arg(&folder);
    finish(make).map_err(|error| format!("cannot make a virtual environment (on Debian, install python3-venv): {error}"))?;
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "numpy", "h5py"];
    finish(house.command(&own, &install)).map_err(|error| format!("cannot install numpy and h5py (is there a network?): {error}"))?;
    Ok(own)
}

fn reads_hdf5(house: &House, python: &Path) -> bool {
    succeeds(house, python, "import numpy, h5py")
}

fn succeeds(house: &House, python: &Path, code: &str) -> bool {
    let status = house.command(python, &["-c", code]).stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}
