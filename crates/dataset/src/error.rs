//! Errors of a dataset on disk, with the file and what to do about it.

use std::io;
use std::path::{Path, PathBuf};

/// Why something on disk could not be read or written: which file, what was found, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum DatasetError {
    /// The operating system refused.
    #[error("cannot {action} {}: {source}; {}", path.display(), advice(source))]
    Io {
        /// "read", "write", "create", …
        action: &'static str,
        /// Which file or folder.
        path: PathBuf,
        /// The operating system's error.
        source: io::Error,
    },
    /// An HDF5 file that cannot be read, or does not contain what its name promises.
    #[error("{}: {problem}", path.display())]
    Hdf5 {
        /// Which file.
        path: PathBuf,
        /// What was found, what was expected, what to do.
        problem: String,
    },
    /// A CSV or JSON file that cannot be understood.
    #[error("{}: {problem}", path.display())]
    Text {
        /// Which file.
        path: PathBuf,
        /// Where in it, what was found, what was expected.
        problem: String,
    },
    /// A folder that is no dataset.
    #[error("{} is not a dataset: {problem}", root.display())]
    NotADataset {
        /// The folder.
        root: PathBuf,
        /// What is missing, and what to do.
        problem: String,
    },
    /// A dataset that another process works on.
    #[error("another process ({holder}) is working on {}; wait until it has finished, or choose another folder", root.display())]
    Busy {
        /// The dataset.
        root: PathBuf,
        /// Name of the other process.
        holder: String,
    },
    /// There is no table of cameras.
    #[error(
        "there is no table of cameras at {}; Hypersim's comes apart from its archives: put metadata_camera_parameters.csv of \
        github.com/apple/ml-hypersim (contrib/mikeroberts3000) into the dataset's folder or the one above, or name it with --cameras-csv; \
        for a dataset of ours run the plan stage again",
        path.display()
    )]
    NoCameraTable {
        /// The path where it was expected.
        path: PathBuf,
    },
    /// A name that cannot be part of a path.
    #[error(
        "{what} {name:?} cannot be used: names consist of 1 to 200 of a to z, A to Z, 0 to 9, '_', '-' and '.', and do not begin with '.'; rename it"
    )]
    Name {
        /// "scene name" or "camera name".
        what: &'static str,
        /// The name.
        name: String,
    },
    /// Data that cannot be stored in Hypersim's format.
    #[error("{what} cannot be stored: {problem}")]
    Unstorable {
        /// The thing to be written.
        what: String,
        /// The limit that prevents it, and what to do.
        problem: String,
    },
}

/// Advice about a refusal of the operating system.
fn advice(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "free some space on the disk, then run again: finished frames are kept"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "make the folder readable and writable for this user, or choose another output folder"
        }
        io::ErrorKind::NotFound => "check the path; if the dataset was moved or cut short, run the stage that makes this file again",
        io::ErrorKind::NotADirectory | io::ErrorKind::IsADirectory | io::ErrorKind::AlreadyExists => {
            "something else is at this path; move it away or choose another output folder"
        }
        _ => "check the disk, then run again: finished frames are kept",
    }
}

impl DatasetError {
    /// An error of the operating system at `path` while doing `action`.
    pub(crate) fn io(action: &'static str, path: &Path, source: io::Error) -> Self {
        Self::Io { action, path: path.to_path_buf(), source }
    }

    /// For `map_err`: as [`DatasetError::io`].
    pub(crate) fn at(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::io(action, path, source)
    }

    /// A CSV or JSON file with unexpected content.
    pub(crate) fn text(path: &Path, problem: impl Into<String>) -> Self {
        Self::Text { path: path.to_path_buf(), problem: problem.into() }
    }

    /// An array that is not what its name promises.
    pub(crate) fn hdf5(path: &Path, problem: impl Into<String>) -> Self {
        Self::Hdf5 { path: path.to_path_buf(), problem: problem.into() }
    }

    /// True when the cause is a file that does not exist.
    pub fn is_not_found(&self) -> bool {
        matches!(self, Self::NoCameraTable { .. }) || matches!(self, Self::Io { source, .. } if source.kind() == io::ErrorKind::NotFound)
    }
}
