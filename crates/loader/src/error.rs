use enfilade_dataset::DatasetError;

/// Why samples cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum LoaderError {
    /// A file is missing or damaged.
    #[error(transparent)]
    Dataset(#[from] DatasetError),
    /// What was asked for does not fit the dataset.
    #[error("{0}")]
    Request(String),
}
