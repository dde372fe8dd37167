//! Why samples cannot be read: the dataset, a missing partition, or a request that does not fit it.

use enfilade_dataset::DatasetError;
use std::path::PathBuf;

/// Why samples cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum LoaderError {
    /// A file is missing or damaged.
    #[error(transparent)]
    Dataset(#[from] DatasetError),
    /// A side of the partition was requested, but there is no file that lists its frames.
    #[error(
        "there is no partition at {}; Hypersim's comes apart from its archives: put metadata_images_split_scene_v1.csv of \
        github.com/apple/ml-hypersim (evermotion_dataset/analysis) into the dataset's folder; for a dataset of ours run `enfilade partition`",
        path.display()
    )]
    NoPartition {
        /// Path at which it was expected.
        path: PathBuf,
    },
    /// The request does not fit the dataset.
    #[error("{0}")]
    Request(String),
}
