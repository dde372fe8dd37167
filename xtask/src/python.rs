//! A Python that reads HDF5 and exports, for the tests that compare with other libraries, and those with the renderers that we compare
//! with.

use crate::house::House;
use crate::step::finish;
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// Names a Python with numpy and h5py; tests that need one read it too.
pub const VARIABLE: &str = "ENFILADE_PYTHON";

/// Names a Python with Mitsuba 3, Open Image Denoise, numpy and Pillow.
const PEERS_VARIABLE: &str = "ENFILADE_PEERS_PYTHON";

/// Package that contains the library of Open Image Denoise, in the version that was measured.
const DENOISER: &str = "pyoidn==2.5.1.0";

/// Names a Python with Blender's module, numpy and Pillow.
const BLENDER_VARIABLE: &str = "ENFILADE_BLENDER_PYTHON";

/// Blender's module, in the version that was measured.
const BLENDER: &str = "bpy==4.5.15";

/// Names a Python with Blender's module, BlenderProc, what it installs otherwise, and BOP's toolkit.
const BLENDERPROC_VARIABLE: &str = "ENFILADE_BLENDERPROC_PYTHON";

/// BlenderProc, the packages that it would install into Blender, and BOP's toolkit, which is in no index.
const BLENDERPROC: [&str; 13] = [
    "blenderproc==2.8.0",
    "numpy<2",
    "pillow",
    "trimesh==4.4.0",
    "pyrender==0.1.45",
    "imageio",
    "gitpython",
    "scikit-image",
    "scikit-learn",
    "scipy",
    "rich",
    "pypng",
    "bop_toolkit_lib @ git+https://github.com/thodan/bop_toolkit@cea62d651c7e395b2e1962b9749e4e89693c6ac4",
];

/// Names of interpreters; names with a version are for machines whose `python3` is too old for our module.
const PYTHONS: [&str; 6] = ["python3", "python", "python3.14", "python3.13", "python3.12", "python3.11"];

/// Succeeds in a Python for which our module is built, and that can make an environment.
const NEW_ENOUGH: &str = "import sys, venv, ensurepip; assert sys.version_info >= (3, 11)";

/// Succeeds in the one Python for which Blender's module is built, if it can make an environment.
const BLENDERS: &str = "import sys, venv, ensurepip; assert sys.version_info[:2] == (3, 11)";

/// Small packages that the tests of exports read files with, beside numpy and h5py; a test whose library is missing reports it.
const READERS: [&str; 4] = ["pillow", "pycocotools", "OpenEXR", "webdataset"];

/// The Python that [`VARIABLE`] names, else one made below the target folder with h5py and [`READERS`]; where these cannot be had, the
/// system's if it has h5py, else one made with only h5py.
///
/// # Errors
/// On an unattended machine, when none can be had; elsewhere that is reported, and `None`.
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
    let imports = format!("import numpy, h5py, PIL, {}", READERS[1..].join(", "));
    match made(house, "venv-readers", &imports, &[&["numpy", "h5py"], &READERS[..]].concat()) {
        Ok(python) => return Ok(python),
        Err(reason) => println!("   note: {reason}; some tests of exports are left out"),
    }
    if let Some(python) = PYTHONS.iter().find(|python| reads_hdf5(house, Path::new(python))) {
        return Ok(python.into());
    }
    made(house, "venv", "import numpy, h5py", &["numpy", "h5py"])
}

/// The Python that [`PEERS_VARIABLE`] names, else one with Mitsuba 3 and Open Image Denoise made below the target folder.
///
/// # Errors
/// When there is no Python, or no network to install from.
pub fn with_peers(house: &House) -> Result<PathBuf, String> {
    const IMPORTS: &str = "import mitsuba, pyoidn, numpy, PIL";
    match named(house, PEERS_VARIABLE, IMPORTS)? {
        Some(python) => Ok(python),
        None => made(house, "venv-peers", IMPORTS, &["mitsuba==3.9.1", DENOISER, "numpy", "pillow"]),
    }
}

/// The Python that [`BLENDER_VARIABLE`] names, else one with Blender's module made below the target folder.
///
/// # Errors
/// When there is no Python 3.11, or no network to install from.
pub fn with_blender(house: &House) -> Result<PathBuf, String> {
    in_blender(house, BLENDER_VARIABLE, "venv-blender", "import bpy, numpy, PIL", &[BLENDER, "numpy", "pillow"])
}

/// The Python that [`BLENDERPROC_VARIABLE`] names, else one with BlenderProc in Blender's module made below the target folder.
///
/// # Errors
/// When there is no Python 3.11, or no network to install from.
pub fn with_blenderproc(house: &House) -> Result<PathBuf, String> {
    const IMPORTS: &str = "import importlib.util, bpy, pyrender, bop_toolkit_lib.inout; assert importlib.util.find_spec('blenderproc')";
    in_blender(house, BLENDERPROC_VARIABLE, "venv-blenderproc", IMPORTS, &[&[BLENDER][..], &BLENDERPROC].concat())
}

/// The Python that [`VARIABLE`] names if it has MuJoCo, else one with it made below the target folder.
///
/// # Errors
/// When there is no Python, or no network to install from.
pub fn with_mujoco(house: &House) -> Result<PathBuf, String> {
    const IMPORTS: &str = "import mujoco, h5py, numpy, PIL";
    let named = std::env::var_os(VARIABLE).map(PathBuf::from).filter(|python| succeeds(house, python, IMPORTS));
    named.map_or_else(|| made(house, "venv-mujoco", IMPORTS, &["mujoco==4.0.0", "h5py", "numpy", "pillow"]), Ok)
}

/// The Python that `variable` names, else the one in `folder` below the target folder, made unless `imports` succeeds there.
fn in_blender(house: &House, variable: &str, folder: &str, imports: &str, packages: &[&str]) -> Result<PathBuf, String> {
    if let Some(python) = named(house, variable, imports)? {
        return Ok(python);
    }
    let (folder, own) = place(house, folder)?;
    if succeeds(house, &own, imports) {
        return Ok(own);
    }
    let python = system(house, BLENDERS).ok_or("Blender's module needs Python 3.11 with the module venv, and there is none")?;
    fill(house, python, &folder, &own, packages)
}

/// The Python that `variable` names, if it does.
fn named(house: &House, variable: &str, imports: &str) -> Result<Option<PathBuf>, String> {
    let Some(named) = std::env::var_os(variable) else { return Ok(None) };
    let works = succeeds(house, Path::new(&named), imports);
    if works { Ok(Some(named.into())) } else { Err(format!("{variable} names a Python that cannot {imports}")) }
}

/// A virtual environment below the target folder that `imports` succeeds in, made and filled with `packages` unless it is there. It is of
/// Python 3.11 or newer, which our module needs, unless there is only an older one.
///
/// # Errors
/// When there is no Python, or no network to install from.
pub fn made(house: &House, name: &str, imports: &str, packages: &[&str]) -> Result<PathBuf, String> {
    let (folder, own) = place(house, name)?;
    let new = system(house, NEW_ENOUGH);
    if succeeds(house, &own, imports) && (new.is_none() || succeeds(house, &own, NEW_ENOUGH)) {
        return Ok(own);
    }
    let python = new.or_else(|| system(house, "import venv")).ok_or("there is no Python with the module venv")?;
    fill(house, python, &folder, &own, packages)
}

/// Path of the virtual environment of that name, and of the Python in it.
fn place(house: &House, name: &str) -> Result<(PathBuf, PathBuf), String> {
    let folder = house.target()?.join(name);
    let own = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    Ok((folder, own))
}

/// The first Python of the system in which `code` succeeds.
fn system(house: &House, code: &str) -> Option<&'static str> {
    PYTHONS.into_iter().find(|python| succeeds(house, Path::new(python), code))
}

/// Makes a virtual environment anew and installs `packages` there; `own` is its Python.
fn fill(house: &House, python: &str, folder: &Path, own: &Path, packages: &[&str]) -> Result<PathBuf, String> {
    let mut make = house.command(python, &["-m", "venv", "--clear"]);
    make.arg(folder);
    finish(make).map_err(|error| format!("cannot make a virtual environment (on Debian, install python3-venv): {error}"))?;
    let mut install = house.command(own, &["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
    install.args(packages);
    finish(install).map_err(|error| format!("cannot install {} (is there a network?): {error}", packages.join(", ")))?;
    Ok(own.into())
}

fn reads_hdf5(house: &House, python: &Path) -> bool {
    succeeds(house, python, "import numpy, h5py")
}

fn succeeds(house: &House, python: &Path, code: &str) -> bool {
    let status = house.command(python, &["-c", code]).stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}
