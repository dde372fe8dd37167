//! Embree, which the hierarchy is compared with. Only the measurement loads it.

use crate::house::House;
use crate::python;
use std::path::PathBuf;

/// Names the library's file; the measurement reads it too.
pub const VARIABLE: &str = "ENFILADE_EMBREE";

/// Package that contains the library, in the version that was measured.
const PACKAGE: &str = "embreex==4.4.0.post1";
/// Prints the library's file within that package.
const FIND: &str = "import importlib.metadata as m; print(next(f.locate() for f in m.files('embreex') if 'libembree' in f.name))";

/// The library that [`VARIABLE`] names, else one fetched from the Python package index into a virtual environment below the target
/// folder.
///
/// # Errors
/// When there is no Python, or no network.
pub fn made(house: &House) -> Result<PathBuf, String> {
    if let Some(named) = std::env::var_os(VARIABLE) {
        return Ok(named.into());
    }
    let python = python::made(house, "venv-embree", "import embreex", &[PACKAGE])?;
    let output = house.command(python, &["-c", FIND]).output().map_err(|error| format!("cannot look for Embree: {error}"))?;
    let file = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
    if file.is_file() { Ok(file) } else { Err(format!("{PACKAGE} carries no library for this platform; name one by {VARIABLE}")) }
}
