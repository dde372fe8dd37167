//! Open Image Denoise, for what measures and tests denoising. The program itself only looks for it.

use crate::house::House;
use crate::step::finish;
use std::path::PathBuf;

/// Names the library's file or folder; tests and the program read it too.
pub const VARIABLE: &str = "ENFILADE_OIDN";

/// What carries the library, in the version that was measured.
pub const PACKAGE: &str = "pyoidn==2.5.1.0";
/// Prints the folder of the library within that package.
const FIND: &str = "import importlib.util, os, pathlib
package = pathlib.Path(importlib.util.find_spec('pyoidn').origin).parent
print(package / 'oidn' / ('bin' if os.name == 'nt' else 'lib'))";

/// The library that [`VARIABLE`] names, or that an earlier [`made`] has left below the target folder.
pub fn found(house: &House) -> Option<PathBuf> {
    if let Some(named) = std::env::var_os(VARIABLE) {
        return Some(named.into());
    }
    let output = house.command(python(house).ok()?, &["-c", FIND]).output().ok()?;
    let folder = PathBuf::from(String::from_utf8(output.stdout).ok()?.trim());
    (output.status.success() && folder.is_dir()).then_some(folder)
}

/// The library as by [`found`], or fetched from the Python package index into a virtual environment below the target folder.
///
/// # Errors
/// When there is no Python, or no network.
pub fn made(house: &House) -> Result<PathBuf, String> {
    if let Some(folder) = found(house) {
        return Ok(folder);
    }
    let mut make = house.command("python3", &["-m", "venv", "--clear"]);
    make.arg(environment(house)?);
    finish(make).map_err(|error| format!("cannot make a virtual environment (on Debian, install python3-venv): {error}"))?;
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", PACKAGE];
    finish(house.command(python(house)?, &install)).map_err(|error| format!("cannot install {PACKAGE} (is there a network?): {error}"))?;
    found(house).ok_or_else(|| format!("{PACKAGE} carries no library for this platform; name one by {VARIABLE}"))
}

fn environment(house: &House) -> Result<PathBuf, String> {
    Ok(house.target()?.join("oidn"))
}

fn python(house: &House) -> Result<PathBuf, String> {
    Ok(environment(house)?.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" }))
}
