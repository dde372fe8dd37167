//! Files that are complete or absent: written under a temporary name in the same folder, then renamed.

use crate::DatasetError;
use std::fs;
use std::path::{Path, PathBuf};

/// Suffix of temporary names. They also begin with a dot, so that no loader's pattern matches them.
const SUFFIX: &str = ".partial";

/// The temporary path of the content of `path` until it is complete.
pub(crate) fn temporary(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}{SUFFIX}"))
}

/// True for the name of a temporary file.
pub(crate) fn is_temporary(name: &str) -> bool {
    name.starts_with('.') && name.ends_with(SUFFIX)
}

/// Creates the parent folder of `path`.
pub(crate) fn create_parent(path: &Path) -> Result<(), DatasetError> {
    let parent = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(parent).map_err(DatasetError::at("create the folder", parent))
}

/// Replaces the file at `path` by what `write` puts at the temporary path it is given. Missing folders are made. When anything
/// fails, an older file stays as it was and the temporary file is removed.
///
/// # Errors
/// Those of `write`, and when the folder cannot be made or the file cannot be renamed.
pub fn replace_file(path: &Path, write: impl FnOnce(&Path) -> Result<(), DatasetError>) -> Result<(), DatasetError> {
    create_parent(path)?;
    let aside = temporary(path);
    let result = write(&aside).and_then(|()| rename(&aside, path));
    if result.is_err() {
        let _ = fs::remove_file(&aside);
    }
    result
}

/// Replaces the file at `path` by `bytes`, as [`replace_file`] does.
///
/// # Errors
/// When the file cannot be written.
pub fn write_bytes(path: &Path, bytes: impl AsRef<[u8]>) -> Result<(), DatasetError> {
    replace_file(path, |aside| fs::write(aside, bytes).map_err(DatasetError::at("write", path)))
}

/// Writes a file as [`write_bytes`] does, unless it has this text already.
///
/// # Errors
/// When the file cannot be written.
pub fn write_changed(path: &Path, text: &str) -> Result<(), DatasetError> {
    if fs::read(path).is_ok_and(|old| old == text.as_bytes()) {
        return Ok(());
    }
    write_bytes(path, text)
}

/// Replaces the file at `path` by `value` as indented JSON with a line break at the end.
///
/// # Errors
/// When the file cannot be written, or a map in `value` has keys other than text.
pub fn write_json(path: &Path, value: &impl serde::Serialize) -> Result<(), DatasetError> {
    write_bytes(path, json_text(path, value)?)
}

fn json_text(path: &Path, value: &impl serde::Serialize) -> Result<String, DatasetError> {
    Ok(serde_json::to_string_pretty(value).map_err(|error| DatasetError::io("write", path, error.into()))? + "\n")
}

/// Begins a folder of what is made by `settings`, which are kept at `path` in it. What is there of other settings is removed.
pub(crate) fn begin_folder(folder: &Path, path: &Path, settings: &impl serde::Serialize) -> Result<(), DatasetError> {
    let text = json_text(path, settings)?;
    if fs::read(path).is_ok_and(|old| old == text.as_bytes()) {
        return Ok(());
    }
    remove_folder(folder)?;
    write_bytes(path, text)
}

/// Puts a temporary file in its place.
pub(crate) fn rename(aside: &Path, path: &Path) -> Result<(), DatasetError> {
    fs::rename(aside, path).map_err(DatasetError::at("put in place", path))
}

/// Gives the file at `from` the second name `path`: a hard link, or a copy where the file system has none. What is there is replaced, unless
/// it is the same already.
pub(crate) fn link(from: &Path, path: &Path) -> Result<(), DatasetError> {
    if is_same(from, path) { Ok(()) } else { take_file(from, path) }
}

/// Gives the file at `from` the second name `path`, in place of what is there: a hard link, or a copy where the file system has none.
/// Files are replaced and never changed, so neither name shows what later becomes of the other.
///
/// # Errors
/// When the name cannot be given.
pub fn take_file(from: &Path, path: &Path) -> Result<(), DatasetError> {
    replace_file(path, |aside| {
        remove_if_there(aside)?;
        fs::hard_link(from, aside).or_else(|_| fs::copy(from, aside).map(drop)).map_err(DatasetError::at("write", path))
    })
}

/// Makes the file at `path` a second name of the one at `from`, where both have the same bytes; returns whether they have.
///
/// # Errors
/// When a file cannot be read, or the name cannot be given.
pub fn share_file(from: &Path, path: &Path) -> Result<bool, DatasetError> {
    let (Ok(of_from), Ok(of_path)) = (fs::metadata(from), fs::metadata(path)) else { return Ok(false) };
    if is_one(&of_from, &of_path) {
        return Ok(true);
    }
    let read = |path: &Path| fs::read(path).map_err(DatasetError::at("read", path));
    if of_from.len() != of_path.len() || read(from)? != read(path)? {
        return Ok(false);
    }
    take_file(from, path).map(|()| true)
}

/// True when both are about one file.
#[cfg(unix)]
fn is_one(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

/// False: here it is not known.
#[cfg(not(unix))]
fn is_one(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    false
}

/// True when both paths lead to one file, or to files of the same bytes.
fn is_same(a: &Path, b: &Path) -> bool {
    let (Ok(of_a), Ok(of_b)) = (fs::metadata(a), fs::metadata(b)) else { return false };
    if is_one(&of_a, &of_b) {
        return true;
    }
    of_a.len() == of_b.len() && fs::read(a).is_ok_and(|bytes| fs::read(b).is_ok_and(|other| other == bytes))
}

/// Removes a file that may not exist.
///
/// # Errors
/// When it is there and cannot be removed.
pub fn remove_if_there(path: &Path) -> Result<(), DatasetError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(DatasetError::io("remove", path, error)),
        _ => Ok(()),
    }
}

/// Removes a folder with all that is in it, which may not exist.
///
/// # Errors
/// When something in it cannot be removed.
pub fn remove_folder(path: &Path) -> Result<(), DatasetError> {
    match fs::remove_dir_all(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(DatasetError::io("remove", path, error)),
        _ => Ok(()),
    }
}
