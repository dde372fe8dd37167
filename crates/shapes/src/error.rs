//! Why shapes cannot be read or compared.

use std::io;
use std::path::{Path, PathBuf};

/// Why shapes could not be read or compared: what was found, what was expected, what to do.
#[derive(Debug, thiserror::Error)]
pub enum ShapesError {
    /// A file cannot be read or written.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// "read" or "write".
        action: &'static str,
        /// Which file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A file does not have the format that its name states.
    #[error("{}: {problem}", path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// The problem found, what was expected, and what to do.
        problem: String,
    },
    /// Values that no shape can have.
    #[error("{0}")]
    Value(String),
}

impl ShapesError {
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { action, path: path.to_path_buf(), source }
    }

    pub(crate) fn file(path: &Path, problem: impl Into<String>) -> Self {
        Self::File { path: path.to_path_buf(), problem: problem.into() }
    }

    /// True when a file is missing.
    pub fn is_not_found(&self) -> bool {
        matches!(self, Self::Io { source, .. } if source.kind() == io::ErrorKind::NotFound)
    }
}
