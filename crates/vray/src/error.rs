//! Why something about V-Ray could not be done, in words for the person who will fix it.

use enfilade_dataset::DatasetError;

/// Why a scene, a job or an image of V-Ray could not be read, edited or written.
#[derive(Debug, thiserror::Error)]
pub enum VrayError {
    /// A request, a scene or an image that cannot be used as it is.
    #[error("{message}")]
    Usage {
        /// The problem found, and what was expected.
        message: String,
        /// What to do.
        hint: String,
    },
    /// A file or folder of the dataset or of the job.
    #[error(transparent)]
    Dataset(#[from] DatasetError),
}

impl VrayError {
    /// An error with what to do about it.
    pub(crate) fn usage(message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self::Usage { message: message.into(), hint: hint.into() }
    }
}
