//! The result of an import: the scene, its labels, the files it was made of, and the report.

use crate::{ImportReport, UpStated};
use enfilade_math::DMat3;
use enfilade_scene::{PartId, PartLabel, PictureFiles, Scene};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A label that the scene file itself gives to a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ImportedLabel {
    /// The part.
    pub part: PartId,
    /// Class and instance of the part.
    pub label: PartLabel,
}

/// An imported scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The scene, which is valid.
    pub scene: Scene,
    /// Labels from the file, if it carries any, in the order of parts; see [`gltf`] for the convention.
    pub labels: Option<Vec<ImportedLabel>>,
    /// The files of pictures of the scene that are still as they came.
    pub picture_files: PictureFiles,
    /// Every file that was read, in order of first use, for hashing.
    pub inputs: Vec<PathBuf>,
    /// Files that were looked for and not found, in that order: with them the scene would be a different one.
    pub missing: Vec<PathBuf>,
    /// The rotation, or reflection, from the file's axes to the world's; of no meaning for packages, which have the world's.
    pub axes: DMat3,
    /// Where it is stated which of them is up.
    pub up: UpStated,
    /// Counts of the scene's contents, and what was dropped or guessed.
    pub report: ImportReport,
}
