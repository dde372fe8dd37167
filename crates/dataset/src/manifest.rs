//! `manifest.json`: what the dataset is, how to read it, and what has become of every frame.

use crate::{Dataset, DatasetError, FileRecord};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The manifest. The same dataset always gives the same bytes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// `enfilade dataset 1`.
    pub format: String,
    /// Version of the program that wrote it.
    pub enfilade_version: String,
    /// How to read the files.
    pub conventions: Conventions,
    /// The resolved configuration of the run.
    pub config: serde_json::Value,
    /// Seeds by what they are for.
    pub seeds: BTreeMap<String, u64>,
    /// By name.
    pub scenes: BTreeMap<String, SceneEntry>,
}

/// Units, axes and layers in words.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conventions {
    /// One sentence per subject.
    pub notes: BTreeMap<String, String>,
    /// The table of layers.
    pub layers: Vec<serde_json::Value>,
}

/// A scene of the manifest.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneEntry {
    /// Why the scene is not finished; absent when nothing went wrong.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
    /// By name.
    pub cameras: BTreeMap<String, CameraEntry>,
}

/// A camera of the manifest.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CameraEntry {
    /// Every frame of the trajectory, in order.
    pub frames: Vec<FrameEntry>,
}

/// What has become of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FrameStatus {
    /// In the trajectory, not rendered yet.
    Planned,
    /// Rendered; its files are listed.
    Complete,
    /// It could not be rendered; the reason is given.
    Failed,
}

/// A frame of the manifest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameEntry {
    /// Frame number.
    pub frame: u32,
    /// What has become of it.
    pub status: FrameStatus,
    /// Why it failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Seed of the random numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Hash of everything that the frame's values depend on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub config_hash: Option<String>,
    /// Layer files, labels included, by path relative to the scene's folder.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub files: BTreeMap<String, FileRecord>,
}

/// What the pipeline knows and the files do not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ManifestInfo {
    /// The resolved configuration of the run, without anything that differs between two runs.
    pub config: serde_json::Value,
    /// Seeds by what they are for.
    pub seeds: BTreeMap<String, u64>,
    /// Why a scene failed, by scene.
    pub failed_scenes: BTreeMap<String, String>,
    /// Why a frame failed, by scene, camera and frame number.
    pub failed_frames: BTreeMap<(String, String, u32), String>,
}

impl Dataset {
    /// Gathers the manifest from the trajectories and commit records on disk, and `info`. It reads no layer.
    ///
    /// # Errors
    /// When a trajectory or record cannot be read.
    pub fn collect_manifest(&self, info: &ManifestInfo) -> Result<Manifest, DatasetError> {
        todo!()
    }

    /// Writes `manifest.json`.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_manifest(&self, manifest: &Manifest) -> Result<(), DatasetError> {
        todo!()
    }

    /// The manifest; `None` where there is none (Hypersim's own data).
    ///
    /// # Errors
    /// When it cannot be read or understood.
    pub fn read_manifest(&self) -> Result<Option<Manifest>, DatasetError> {
        todo!()
    }

    /// Reads every file that the manifest lists and compares sizes and checksums: one sentence per file that is missing or not
    /// as it was written; none when all is well.
    ///
    /// # Errors
    /// When a file that is there cannot be read.
    pub fn verify_checksums(&self, manifest: &Manifest) -> Result<Vec<String>, DatasetError> {
        todo!()
    }
}
