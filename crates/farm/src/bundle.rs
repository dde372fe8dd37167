//! The files of a frame in one object: a tar archive, which depends on nothing but their names and contents.

use crate::FarmError;
use enfilade_dataset::write_bytes;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// A file by its path within the dataset's folder, and its content.
pub(crate) type PackedFile = (PathBuf, Vec<u8>);

/// Reads `files`, paths relative to `folder`.
pub(crate) fn read(folder: &Path, files: &[PathBuf]) -> Result<Vec<PackedFile>, FarmError> {
    let read = |path: &PathBuf| {
        let full = folder.join(path);
        let bytes = std::fs::read(&full).map_err(|source| FarmError::io("read", &full, source))?;
        Ok((path.clone(), bytes))
    };
    files.iter().map(read).collect()
}

/// Packs files in the order in which they are to be written.
pub(crate) fn pack(files: &[PackedFile]) -> Result<Vec<u8>, FarmError> {
    let mut archive = tar::Builder::new(Vec::new());
    for (path, bytes) in files {
        let mut header = tar::Header::new_ustar();
        header.set_size(bytes.len() as u64);
        header.set_mode(0o644);
        header.set_mtime(0);
        archive.append_data(&mut header, path, bytes.as_slice()).map_err(|source| FarmError::io("pack", path, source))?;
    }
    archive.into_inner().map_err(|source| FarmError::io("pack", Path::new("a frame"), source))
}

/// Unpacks the files of a frame into `folder`, each aside first, in the order of the archive; `place` names the archive in errors.
///
/// # Errors
/// When it is no archive of files within the folder, or they cannot be written.
pub fn unpack(bytes: &[u8], folder: &Path, place: &str) -> Result<(), FarmError> {
    unpacked(bytes, place)?.iter().try_for_each(|(path, content)| Ok(write_bytes(&folder.join(path), content)?))
}

/// The files in an archive; `place` names it in errors.
pub(crate) fn unpacked(bytes: &[u8], place: &str) -> Result<Vec<PackedFile>, FarmError> {
    let mut files = Vec::new();
    let damaged = |problem: String| FarmError::Damaged { place: place.into(), problem };
    let mut archive = tar::Archive::new(bytes);
    for entry in archive.entries().map_err(|error| damaged(error.to_string()))? {
        let mut entry = entry.map_err(|error| damaged(error.to_string()))?;
        let path = entry.path().map_err(|error| damaged(error.to_string()))?.into_owned();
        if !entry.header().entry_type().is_file() || path.components().any(|part| !matches!(part, Component::Normal(_))) {
            return Err(damaged(format!("holds {}, which is no file of a dataset", path.display())));
        }
        let mut content = Vec::new();
        entry.read_to_end(&mut content).map_err(|error| damaged(error.to_string()))?;
        files.push((path, content));
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_come_back_and_the_archive_depends_on_nothing_else() {
        let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
        let files = [PathBuf::from("a/one.txt"), PathBuf::from("b")];
        let archives = folders.each_ref().map(|folder| {
            files.iter().for_each(|file| write_bytes(&folder.path().join(file), file.to_string_lossy().as_bytes()).unwrap());
            pack(&read(folder.path(), &files).unwrap()).unwrap()
        });
        assert_eq!(archives[0], archives[1]);
        let out = tempfile::tempdir().unwrap();
        unpack(&archives[0], out.path(), "x").unwrap();
        assert_eq!(std::fs::read_to_string(out.path().join("a/one.txt")).unwrap(), "a/one.txt");
    }

    #[test]
    fn archives_that_would_write_elsewhere_are_refused() {
        let mut archive = tar::Builder::new(Vec::new());
        let mut header = tar::Header::new_ustar();
        header.as_ustar_mut().unwrap().name[..5].copy_from_slice(b"../up");
        header.set_size(1);
        header.set_entry_type(tar::EntryType::Regular);
        header.set_cksum();
        archive.append(&header, &b"x"[..]).unwrap();
        let out = tempfile::tempdir().unwrap();
        let error = unpack(&archive.into_inner().unwrap(), out.path(), "frames/x.tar").unwrap_err();
        assert!(error.to_string().starts_with("frames/x.tar: holds ../up"), "{error}");
        assert!(unpack(&[1; 700], out.path(), "y").is_err());
    }
}
