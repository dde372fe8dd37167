//! Why views of a scene cannot be related.

use enfilade_dataset::DatasetError;
use std::path::PathBuf;

/// Why views of a scene could not be related: what was found, what was expected, what to do.
#[derive(Debug, thiserror::Error)]
pub enum MultiviewError {
    /// The dataset cannot be read or written.
    #[error(transparent)]
    Dataset(#[from] DatasetError),
    /// The scene package cannot be read, or is not the one that is needed.
    #[error("{}: {problem}", path.display())]
    Package {
        /// Which file.
        path: PathBuf,
        /// The problem found, and what to do.
        problem: String,
    },
}
