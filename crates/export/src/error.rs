//! Why an export cannot be made: the dataset, the selection, the folder, or the format.

use crate::Format;
use enfilade_dataset::DatasetError;
use std::io;
use std::path::{Path, PathBuf};

/// Why a dataset could not be exported: what was found, what was expected, what to do.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The dataset cannot be read.
    #[error(transparent)]
    Dataset(#[from] DatasetError),
    /// A file of the export cannot be written.
    #[error("cannot {action} {}: {source}; make room or choose another output folder", path.display())]
    Io {
        /// "write", "create the folder", …
        action: &'static str,
        /// Which file or folder.
        path: PathBuf,
        /// The operating system's error.
        source: io::Error,
    },
    /// The output folder cannot be used.
    #[error("{} cannot be the output folder: {problem}", path.display())]
    Place {
        /// The folder.
        path: PathBuf,
        /// The obstacle, and what to do.
        problem: String,
    },
    /// Nothing is left of the dataset, or a name is unknown.
    #[error("{0}")]
    Selection(String),
    /// The format cannot store what the dataset has, or the dataset lacks what the format needs.
    #[error("{place} cannot be exported as {}: {problem}", format.spec().name)]
    Unsuitable {
        /// Scene, camera and frame.
        place: String,
        /// The layout.
        format: Format,
        /// What was found, what was expected, what to do.
        problem: String,
    },
}

impl ExportError {
    /// For `map_err`: an error of the operating system at `path`.
    pub(crate) fn at(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { action, path: path.to_path_buf(), source }
    }

    /// True when the command must change and not the dataset.
    pub fn is_usage(&self) -> bool {
        matches!(self, Self::Place { .. } | Self::Selection(_))
    }
}
