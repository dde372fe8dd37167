//! The dataset that is open: where it is, and what was read from it lately.

use super::cache::Cache;
use super::decoded_layer::DecodedLayer;
use super::pairs_of_scene::PairsOfScene;
use super::picture::FramePicture;
use super::place::FramePlace;
use super::report::ReportFile;
use super::shares::Shares;
use enfilade_dataset::{Dataset, DatasetError};
use enfilade_serve::{ApiProblem, beside};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Memory that decoded layers may take: about a hundred layers of color at Hypersim's size.
const LAYER_CACHE_BYTES: usize = 512 << 20;
/// Memory that geometry and free space may take: enough for a few scenes.
const SCENE_CACHE_BYTES: usize = 512 << 20;
/// Memory that small pictures may take: enough for ten thousand frames.
const THUMBNAIL_CACHE_BYTES: usize = 64 << 20;
/// Memory that shares of classes may take: enough for a hundred thousand frames.
const SHARE_CACHE_BYTES: usize = 32 << 20;

/// An open dataset, which is only read.
pub struct Viewer {
    pub(super) dataset: Dataset,
    /// The dataset's folder without symbolic links.
    pub(super) root: PathBuf,
    pub(super) layers: Cache<(FramePlace, FramePicture), DecodedLayer>,
    /// Geometry and free space, by scene and kind.
    pub(super) buffers: Cache<(String, &'static str), Vec<u8>>,
    pub(super) thumbnails: Cache<FramePlace, Vec<u8>>,
    pub(super) shares: Cache<FramePlace, Shares>,
    /// Pairs of frames, by scene.
    pub(super) pairs: Cache<String, PairsOfScene>,
    /// The report of the last verification.
    pub(super) reports: Cache<(), ReportFile>,
}

impl Viewer {
    /// Opens the dataset in `folder`: ours, the Hypersim toolkit's, or one of unpacked Hypersim archives.
    ///
    /// # Errors
    /// When the folder cannot be read or is no dataset.
    pub fn open(folder: impl AsRef<Path>) -> Result<Self, DatasetError> {
        Ok(Self::of(Dataset::open(&folder)?))
    }

    /// A viewer of a dataset that is open already.
    pub fn of(dataset: Dataset) -> Self {
        let root = std::fs::canonicalize(dataset.root()).unwrap_or_else(|_| dataset.root().to_path_buf());
        let (layers, buffers) = (Cache::new(LAYER_CACHE_BYTES), Cache::new(SCENE_CACHE_BYTES));
        let (thumbnails, reports) = (Cache::new(THUMBNAIL_CACHE_BYTES), Cache::new(SCENE_CACHE_BYTES));
        let (shares, pairs) = (Cache::new(SHARE_CACHE_BYTES), Cache::new(SCENE_CACHE_BYTES));
        Self { dataset, root, layers, buffers, thumbnails, shares, pairs, reports }
    }
}

/// Runs `job` on a thread for blocking work and returns its result.
pub(super) async fn work<T: Send + 'static>(
    viewer: Arc<Viewer>,
    job: impl FnOnce(&Viewer) -> Result<T, ApiProblem> + Send + 'static,
) -> Result<T, ApiProblem> {
    beside(move || job(&viewer)).await
}
