//! A dataset in the layouts that other programs load: COCO (instances and panoptic), BOP, nerfstudio, COLMAP, ScanNet, OpenEXR, depth PNG,
//! WebDataset, Croissant, OpenCV's cameras, Pix3D, Hugging Face's Parquet files, SpatialLM, Structured3D, TUM RGB-D, Replica, MapAnything's WAI, and
//! labelled points (PLY).
//!
//! Every export is a pure function of the dataset folder and an [`ExportConfig`]: nothing is rendered, the same input gives the
//! same bytes, and no file carries a clock, a host or a path. [`Format`] has the table of formats, `formats/` one file for each,
//! whose first lines state what it writes and in which units, axes and pixel coordinates, `readmes/` the page that goes with its files.
//! `docs/export.md` has all of them in one table.
//!
//! An export is complete or absent: it grows under another name beside its place and is renamed when all is written.
//!
//! Three things change between formats, and each changes in one out: camera axes and K in `calibration.rs`, depth in `depth.rs`,
//! and pixels of colour in `picture.rs`.

mod boxes;
mod calibration;
mod depth;
mod error;
mod export_folder;
mod format;
mod formats;
mod instances;
mod intrinsics;
mod mesh;
mod model_meshes;
mod numpy;
mod options;
mod picture;
mod points;
mod scene_file;
mod scene_gltf;
mod selected_frames;
mod symmetries;

pub use error::ExportError;
pub use export_folder::{Existing, Exported};
pub use format::{FORMATS, Format, FormatSpec};
pub use intrinsics::intrinsics_csv;
pub use options::{CloudSource, ExportOptions, SymmetryRule};
pub use scene_file::{SceneEncoder, scene_encoder};
pub use scene_gltf::{SceneGltf, scene_gltf};
pub use selected_frames::Selection;

use enfilade_dataset::Dataset;
use enfilade_scene::Cx;
use export_folder::ExportFolder;
use selected_frames::SelectedFrames;
use std::path::Path;

/// The settings of an export.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportConfig {
    /// The layout.
    pub format: Format,
    /// The scenes, cameras, frames and layers to export.
    pub selection: Selection,
    /// Largest size of a WebDataset shard, or of a Parquet file, bytes; a sample that is larger has one of its own. One gigabyte by
    /// default.
    pub shard_bytes: u64,
    /// Source of SpatialLM's point clouds.
    pub cloud: CloudSource,
    /// The rule by which BOP's models have symmetries.
    pub symmetries: SymmetryRule,
}

impl ExportConfig {
    /// Everything that the format can store of all scenes named.
    pub fn new(format: Format, scenes: Vec<String>) -> Self {
        let usual = ExportOptions::default();
        let selection = Selection { scenes, ..Selection::default() };
        Self { format, selection, shard_bytes: usual.shard_bytes(), cloud: usual.cloud, symmetries: usual.symmetries }
    }
}

/// Writes `dataset` to the folder `out` with the settings `config`. `existing` decides what happens to an existing folder that is no
/// export.
///
/// # Errors
/// When nothing is selected, a layer or camera is not what the format needs, or a file cannot be read or written. Then `out` is as
/// it was.
pub fn export(dataset: &Dataset, config: &ExportConfig, out: &Path, existing: Existing, cx: &dyn Cx) -> Result<Exported, ExportError> {
    let selected = SelectedFrames::open(dataset, config.format.spec(), &config.selection, cx)?;
    let out = ExportFolder::prepare(out, dataset.root(), existing)?;
    match config.format {
        Format::Coco => formats::coco::write(&selected, &out),
        Format::Bop => formats::bop::write(&selected, &out, config.symmetries),
        Format::Nerfstudio => formats::nerfstudio::write(&selected, &out),
        Format::Colmap => formats::colmap::write(&selected, &out, formats::colmap::binary),
        Format::ColmapText => formats::colmap::write(&selected, &out, formats::colmap_text::text),
        Format::Scannet => formats::scannet::write(&selected, &out),
        Format::Exr => formats::openexr::write(&selected, &out),
        Format::DepthPng => formats::depth_png::write(&selected, &out),
        Format::Webdataset => formats::webdataset::write(&selected, &out, config.shard_bytes),
        Format::Croissant => formats::croissant::write(&selected, &out),
        Format::Opencv => formats::opencv::write(&selected, &out),
        Format::Pix3d => formats::pix3d::write(&selected, &out),
        Format::Euroc => formats::euroc::write(&selected, &out),
        Format::Tum => formats::tum::write(&selected, &out),
        Format::Replica => formats::replica::write(&selected, &out),
        Format::Panoptic => formats::panoptic::write(&selected, &out),
        Format::Wai => formats::wai::write(&selected, &out),
        Format::Dust3r => formats::dust3r::write(&selected, &out),
        Format::Marigold => formats::marigold::write(&selected, &out),
        Format::Moge => formats::moge::write(&selected, &out),
        Format::Points => formats::points::write(&selected, &out),
        Format::Huggingface => formats::huggingface::write(&selected, &out, config.shard_bytes),
        Format::Spatiallm => formats::spatiallm::write(&selected, &out, config.cloud),
        Format::Structured3d => formats::structured3d::write(&selected, &out),
    }?;
    out.finish(config.format, &selected)
}
