//! The entries of BOP's files.

use serde::Serialize;

#[derive(Serialize)]
pub(super) struct ImageCamera {
    #[serde(rename = "cam_K")]
    pub k: [f64; 9],
    pub depth_scale: f64,
    #[serde(rename = "cam_R_w2c")]
    pub rotation: [f64; 9],
    #[serde(rename = "cam_t_w2c")]
    pub translation_mm: [f64; 3],
}

/// The camera of the whole dataset, which bop_toolkit reads before any scene.
#[derive(Serialize)]
pub(super) struct DatasetCamera {
    pub cx: f64,
    pub cy: f64,
    pub depth_scale: f64,
    pub fx: f64,
    pub fy: f64,
    pub height: u32,
    pub width: u32,
}

#[derive(Serialize)]
pub(super) struct Truth {
    #[serde(rename = "cam_R_m2c")]
    pub rotation: [f64; 9],
    #[serde(rename = "cam_t_m2c")]
    pub translation_mm: [f64; 3],
    pub obj_id: u32,
}

#[derive(Serialize)]
pub(super) struct TruthInfo {
    pub bbox_obj: [i64; 4],
    pub bbox_visib: [i64; 4],
    pub px_count_all: u64,
    pub px_count_valid: usize,
    pub px_count_visib: u64,
    pub visib_fract: f64,
}

#[derive(Serialize)]
pub(super) struct ModelInfo {
    pub diameter: f64,
    pub min_x: f64,
    pub min_y: f64,
    pub min_z: f64,
    pub size_x: f64,
    pub size_y: f64,
    pub size_z: f64,
    /// Rows of 4 × 4 matrices, millimetres.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub symmetries_discrete: Vec<[f64; 16]>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub symmetries_continuous: Vec<ContinuousSymmetry>,
}

/// An axis about which every turn is a symmetry, through a point in millimetres.
#[derive(Serialize)]
pub(super) struct ContinuousSymmetry {
    pub axis: [f64; 3],
    pub offset: [f64; 3],
}

/// An instance that is an object of its own.
#[derive(Serialize)]
pub(super) struct OwnObject {
    pub scene: String,
    pub instance: i16,
    pub nyu40: i16,
}

/// A model in a size, of which scenes have copies.
#[derive(Serialize)]
pub(super) struct CopiedObject {
    pub model: String,
    pub scale: f64,
    pub nyu40: i16,
}

#[derive(Serialize)]
pub(super) struct SceneEntry {
    pub scene: String,
    pub camera: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub split: Option<&'static str>,
}

/// An object to be found in an image, and how many of it.
#[derive(Serialize)]
pub(super) struct EvaluationTarget {
    pub im_id: u32,
    pub inst_count: u32,
    pub obj_id: u32,
    pub scene_id: usize,
}
