//! The tests in Python, run with the module that was built beside this program.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Puts the package together in `folder`, as `pip install` would.
fn assemble(folder: &Path) {
    let package = Path::new(env!("CARGO_MANIFEST_DIR")).join("enfilade");
    let target = folder.join("enfilade");
    std::fs::create_dir(&target).unwrap();
    for entry in std::fs::read_dir(package).unwrap().map(Result::unwrap).filter(|entry| entry.path().is_file()) {
        std::fs::copy(entry.path(), target.join(entry.file_name())).unwrap();
    }
    let end = if cfg!(windows) { "_native.pyd" } else { "_native.abi3.so" };
    std::fs::copy(library(), target.join(end)).unwrap();
}

/// The newest library of this crate among those of the profile that this test was built with.
fn library() -> PathBuf {
    let name = format!("{}enfilade_python{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let own = std::env::current_exe().unwrap();
    let built = own.ancestors().skip(1).take(2).map(|folder| folder.join(&name)).filter(|path| path.is_file());
    let newest = built.max_by_key(|path| path.metadata().unwrap().modified().unwrap());
    newest.unwrap_or_else(|| panic!("no {name} beside {}; build the crate enfilade-python", own.display()))
}

#[test]
fn the_tests_in_python_pass() {
    let Some(python) = std::env::var_os("ENFILADE_PYTHON") else {
        return eprintln!("skipped: ENFILADE_PYTHON names no python with h5py");
    };
    let new_enough = Command::new(&python).args(["-c", "import sys; assert sys.version_info >= (3, 11)"]).output().unwrap();
    if !new_enough.status.success() {
        return eprintln!("skipped: {} is older than 3.11, for which the module is built", Path::new(&python).display());
    }
    let folder = tempfile::tempdir().unwrap();
    assemble(folder.path());
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let found = Command::new(python)
        .args(["-m", "unittest", "discover", "--start-directory"])
        .arg(&tests)
        // The sources are in the folder that tests are started in, and Python would take them first.
        .current_dir(folder.path())
        .env("PYTHONPATH", folder.path())
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .unwrap();
    let said = format!("{}{}", String::from_utf8_lossy(&found.stdout), String::from_utf8_lossy(&found.stderr));
    assert!(found.status.success(), "{said}");
    // The last lines state how many tests ran, and which were left out.
    eprintln!("{said}");
}
