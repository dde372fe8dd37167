//! The program at work: a small demo dataset, judged by itself and by a program that does not know us.

use crate::house::House;
use crate::python;
use crate::step::finish;
use std::path::{Path, PathBuf};

/// Names a Python program that is given a dataset's folder and ends with 0 when it is true.
const PROGRAM: &str = "ENFILADE_ACCEPT";

/// Makes the demo dataset small, again (which must change nothing), and verifies it.
///
/// # Errors
/// When the binary fails, or does something the second time.
pub fn demo(house: &House) -> Result<String, String> {
    let out = folder(house)?;
    if out.exists() {
        std::fs::remove_dir_all(&out).map_err(|error| format!("cannot remove the old demo dataset: {error}"))?;
    }
    let path = out.to_str().ok_or("the target folder's path is not UTF-8")?;
    let make = ["run", "--demo", path, "--frames", "2", "--size", "160x120", "--quality", "draft"];
    enfilade(house, &make)?;
    let frames = frames(&out)?;
    if frames.is_empty() {
        return Err(format!("no frame was written below {path}/scenes"));
    }
    let times = |paths: &[PathBuf]| paths.iter().map(|p| p.metadata().and_then(|m| m.modified()).ok()).collect::<Vec<_>>();
    let before = times(&frames);
    enfilade(house, &make)?;
    if times(&frames) != before {
        return Err("a second run wrote finished frames again".into());
    }
    enfilade(house, &["verify", path])
}

/// Runs the program that [`PROGRAM`] names on the demo dataset, or remarks that there is none.
///
/// # Errors
/// When it finds something wrong, or on an unattended machine when there is no Python for it.
pub fn independent(house: &House) -> Result<String, String> {
    let Some(program) = std::env::var_os(PROGRAM) else {
        return Ok(format!("left out, because {PROGRAM} names no program"));
    };
    let program = std::path::absolute(program).map_err(|error| format!("{PROGRAM}: {error}"))?;
    if !program.is_file() {
        return Err(format!("{PROGRAM} names {}, which is not a file", program.display()));
    }
    let Some(python) = python::with_h5py(house)? else {
        return Ok("left out, because there is no Python with h5py".into());
    };
    let mut command = house.command(python, &[]);
    command.arg(program).arg(folder(house)?);
    finish(command)
}

fn enfilade(house: &House, arguments: &[&str]) -> Result<String, String> {
    finish(house.command(house.tested("enfilade")?, arguments))
}

fn folder(house: &House) -> Result<PathBuf, String> {
    Ok(house.target()?.join("acceptance/demo"))
}

/// The arrays of all frames of a dataset.
fn frames(dataset: &Path) -> Result<Vec<PathBuf>, String> {
    let mut found = Vec::new();
    let mut open = vec![dataset.join("scenes")];
    while let Some(folder) = open.pop() {
        let entries = std::fs::read_dir(&folder).map_err(|error| format!("cannot list {}: {error}", folder.display()))?;
        for path in entries.filter_map(Result::ok).map(|entry| entry.path()) {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if path.is_dir() {
                open.push(path);
            } else if name.starts_with("frame.") && name.ends_with(".hdf5") {
                found.push(path);
            }
        }
    }
    Ok(found)
}
