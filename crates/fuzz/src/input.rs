//! Inputs: bytes with a name, and the functions that read them.

use std::path::{Path, PathBuf};

/// Reads an input.
pub type Run = Box<dyn FnMut(&[u8])>;

/// A file to begin with, or one that was found.
pub struct Seed {
    /// Name of the file.
    pub name: String,
    /// Content of the file.
    pub bytes: Vec<u8>,
}

impl Seed {
    /// The files of a folder by name; none where there is no folder.
    ///
    /// # Panics
    /// When a file cannot be read.
    pub(crate) fn of_folder(folder: &Path) -> Vec<Self> {
        let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("a folder that can be listed").path()).collect();
        paths.sort();
        let read = |path: PathBuf| Self {
            name: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            bytes: std::fs::read(&path).expect("a file that can be read"),
        };
        paths.into_iter().map(read).collect()
    }
}
