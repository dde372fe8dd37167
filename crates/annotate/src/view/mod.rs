//! Looking at a dataset: what it holds as JSON, its layers as raw arrays, its space as points and cubes.
//!
//! Everything is read at the moment of the request, so a dataset that is still being rendered can be watched. Nothing is ever
//! written. Layers go to the page as they are stored and are coloured there, on the graphics card; what a value is called and which
//! colour it has is therefore known in the browser alone, and changing an exposure asks the server for nothing.
//!
//! Names in addresses are checked before they become paths, and a path that a symbolic link leads out of the dataset's folder is
//! refused (`place`).

mod cache;
mod camera;
mod catalogue;
mod classes;
mod files;
mod frame;
mod layers;
mod mesh;
mod place;
mod points;
mod scene;
mod space;
mod summary;
#[cfg(test)]
mod tests;
mod thumbnail;

use crate::serve::{ApiProblem, beside};
use axum::Router;
use axum::routing::get;
use cache::Cache;
use enfilade_dataset::{Dataset, DatasetError};
use layers::DecodedLayer;
use place::FramePlace;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Memory that decoded layers may take: about a hundred layers of color at Hypersim's size.
const LAYER_CACHE_BYTES: usize = 512 << 20;
/// Memory that geometry and free space may take: those of a few scenes.
const SCENE_CACHE_BYTES: usize = 512 << 20;
/// Memory that small pictures may take: those of ten thousand frames.
const THUMBNAIL_CACHE_BYTES: usize = 64 << 20;

/// A dataset that is looked at.
pub struct Viewer {
    dataset: Dataset,
    /// The dataset's folder without symbolic links.
    root: PathBuf,
    layers: Cache<(FramePlace, enfilade_frame::Layer), DecodedLayer>,
    /// Geometry, free space and reports.
    buffers: Cache<(String, &'static str), Vec<u8>>,
    thumbnails: Cache<FramePlace, Vec<u8>>,
}

impl Viewer {
    /// Looks at the dataset in `folder`: ours, the Hypersim toolkit's, or one of unpacked Hypersim archives.
    ///
    /// # Errors
    /// When the folder cannot be read or is no dataset.
    pub fn open(folder: impl AsRef<Path>) -> Result<Self, DatasetError> {
        Ok(Self::of(Dataset::open(&folder)?))
    }

    /// Looks at a dataset that is open.
    pub fn of(dataset: Dataset) -> Self {
        let root = std::fs::canonicalize(dataset.root()).unwrap_or_else(|_| dataset.root().to_path_buf());
        let (layers, buffers) = (Cache::new(LAYER_CACHE_BYTES), Cache::new(SCENE_CACHE_BYTES));
        Self { dataset, root, layers, buffers, thumbnails: Cache::new(THUMBNAIL_CACHE_BYTES) }
    }
}

/// The routes of the page, all under `/api/view`.
pub fn router(viewer: Viewer) -> Router {
    Router::new()
        .route("/api/view/dataset", get(catalogue::dataset))
        .route("/api/view/scene/{scene}", get(scene::scene))
        .route("/api/view/scene/{scene}/geometry", get(mesh::geometry))
        .route("/api/view/scene/{scene}/space", get(space::space))
        .route("/api/view/camera/{scene}/{camera}", get(camera::camera))
        .route("/api/view/frame/{scene}/{camera}/{frame}", get(frame::frame))
        .route("/api/view/points/{scene}/{camera}/{frame}", get(points::points))
        .route("/api/view/thumbnail/{scene}/{camera}/{frame}", get(thumbnail::thumbnail))
        .route("/api/view/layer/{scene}/{camera}/{frame}/{layer}", get(layers::layer))
        .route("/api/view/file/{*path}", get(files::file))
        .with_state(Arc::new(viewer))
}

/// Does `job` on a thread for long work, and answers with what it makes.
async fn work<T: Send + 'static>(
    viewer: Arc<Viewer>,
    job: impl FnOnce(&Viewer) -> Result<T, ApiProblem> + Send + 'static,
) -> Result<T, ApiProblem> {
    beside(move || job(&viewer)).await
}
