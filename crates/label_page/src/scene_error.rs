//! Why a scene cannot be annotated.

use enfilade_import::Format;
use std::path::PathBuf;

/// Why the scene cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The path is not one of the things that can be annotated.
    #[error(
        "{path}: {problem}; expected a scene file ({}), a dataset, a scene's folder in it, or a Hypersim mesh folder",
        Format::extensions()
    )]
    Path {
        /// The path given.
        path: String,
        /// The problem with it.
        problem: String,
    },
    /// A dataset has several scenes, or not the one that was named.
    #[error("{path}: {problem}; name one with --scene: {scenes}")]
    Scene {
        /// The dataset.
        path: String,
        /// The problem.
        problem: String,
        /// The scenes there are.
        scenes: String,
    },
    /// The labels in the folder of labels cannot be those of the scene.
    #[error(
        "{}: {problem}; copy annotation_log.jsonl with the tables, or name another folder with --labels: the first edit would overwrite these",
        folder.display()
    )]
    Labels {
        /// The folder.
        folder: PathBuf,
        /// The problem.
        problem: String,
    },
    /// The table of labels in the folder of labels cannot be read.
    #[error(transparent)]
    Table(#[from] enfilade_label::TableError),
    /// The scene file cannot be imported.
    #[error(transparent)]
    Import(#[from] enfilade_import::ImportError),
    /// The mesh folder cannot be read.
    #[error(transparent)]
    Dataset(#[from] enfilade_dataset::DatasetError),
}
