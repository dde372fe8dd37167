//! Scene files to [`Scene`], with a report of what was dropped or guessed.
//!
//! ```no_run
//! use enfilade_import::{ImportOptions, load};
//! use enfilade_scene::Quiet;
//!
//! let imported = load("living-room/scene.gltf".as_ref(), &ImportOptions::default(), &Quiet)?;
//! println!("{}", imported.report);
//! # Ok::<(), enfilade_import::ImportError>(())
//! ```
//!
//! # What every importer does
//!
//! - The result is in metres with z up. Sources with y up are turned by (x, y, z) → (x, −z, y); [`ImportOptions::meters_per_unit`]
//!   scales positions, and with them point and spot lights (by its square) and absorption (by its inverse), so that the picture
//!   does not change. Radiance, irradiance of distant lights and environments do not depend on the unit.
//! - Every part keeps the name it has in the file; parts without one get a stable name, and names that occur twice get `_2`, `_3` …
//!   in the order of the file.
//! - Vertex normals that are zero or not finite are replaced by the mean of the adjoining faces; texture coordinates that are not
//!   finite by zero. A position that is not finite or an index out of range is an error.
//! - Mirroring placements get reversed triangles, so that the front stays the front. Placements that flatten a part drop it.
//! - A texture that is missing or broken is an error, unless [`ImportOptions::allow_missing_textures`] is set.
//! - Vertex colours, skins, morph targets and animations are dropped, and the report says so.
//!
//! # Formats
//!
//! The pages of [`gltf`], [`obj`], [`mitsuba`], [`pbrt`], [`ply`], [`usd`], [`fbx`], [`vray`], [`sweethome`] and [`package`] list what is
//! supported of each.

mod archive;
mod assembly;
mod blender;
mod error;
pub mod fbx;
mod format;
pub mod gltf;
mod ies;
mod images;
mod mesh;
pub mod mitsuba;
pub mod obj;
pub mod package;
pub mod pbrt;
pub mod ply;
mod polygon;
mod primitives;
mod report;
mod roughness;
mod spectrum;
pub mod sweethome;
pub mod usd;
pub mod vray;

pub use error::ImportError;
pub use format::Format;
pub use images::{check_exr_blocks, check_exr_table};
pub use report::{Counts, ImportReport};

use assembly::Assembly;
use enfilade_scene::{Cx, PartId, PartLabel, Scene};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The axis of the file that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum UpAxis {
    /// As in glTF.
    Y,
    /// As in this workspace.
    Z,
}

/// An environment picture to use instead of the file's own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnvironmentOverride {
    /// Equirectangular picture (HDR, EXR, PFM, or an eight-bit one); its upper edge is straight up, its middle −y.
    pub file: PathBuf,
    /// Multiplies the picture.
    #[serde(default = "one")]
    pub scale: f32,
    /// Turns it about the up axis, counter-clockwise seen from above, in degrees.
    #[serde(default)]
    pub rotation_deg: f32,
}

fn one() -> f32 {
    1.0
}

/// What the user knows about a scene file that the file does not say.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ImportOptions {
    /// Metres per unit of the file; 1 by default. Where the file states its own unit (USD, FBX, V-Ray scenes, Sweet Home 3D) this multiplies it.
    /// Scene packages are in metres, and anything but 1 is an error.
    pub meters_per_unit: f64,
    /// The axis that points up; by default the file's own (USD, FBX and V-Ray scenes state it), else the format's own. In scene
    /// packages z points up, and y is an error.
    pub up_axis: Option<UpAxis>,
    /// Replaces or sets the environment.
    pub environment: Option<EnvironmentOverride>,
    /// Goes on with plain grey where a texture is missing or broken, with a warning each; off by default.
    pub allow_missing_textures: bool,
}

impl Default for ImportOptions {
    fn default() -> Self {
        Self { meters_per_unit: 1.0, up_axis: None, environment: None, allow_missing_textures: false }
    }
}

/// A label that the scene file itself gives to a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ImportedLabel {
    /// The part.
    pub part: PartId,
    /// Its class and instance.
    pub label: PartLabel,
}

/// An imported scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The scene, which is valid.
    pub scene: Scene,
    /// Labels from the file, if it carries any, in the order of parts; see [`gltf`] for the convention.
    pub labels: Option<Vec<ImportedLabel>>,
    /// Every file that was read, in order of first use, for hashing.
    pub inputs: Vec<PathBuf>,
    /// Files that were looked for in vain, in that order: were they there, the scene would be another one.
    pub missing: Vec<PathBuf>,
    /// What the scene holds and what was dropped or guessed.
    pub report: ImportReport,
}

/// Imports a scene file by the importer that its extension calls for.
///
/// # Errors
/// When the file or one that it refers to cannot be read, is not what its format calls for, or leaves nothing visible; the
/// message names file and place and says what to do.
pub fn load(path: &Path, options: &ImportOptions, cx: &dyn Cx) -> Result<Imported, ImportError> {
    options.validate()?;
    let format = Format::of(path)?;
    let assembly = Assembly::new(format, path, UpAxis::Y, options, cx);
    match format {
        Format::Gltf => gltf::load(assembly),
        Format::Obj => obj::load(assembly),
        Format::Mitsuba => mitsuba::load(assembly),
        Format::Pbrt => pbrt::load(assembly),
        Format::Ply => ply::load(assembly),
        Format::VRay => vray::load(assembly),
        Format::Usd => usd::load(assembly),
        Format::Fbx => fbx::load(assembly),
        Format::SweetHome => sweethome::load(assembly),
        Format::Package => package::load(assembly, options),
    }
}

impl ImportOptions {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`ImportError::Option`] for the first one that is out of its range.
    pub fn validate(&self) -> Result<(), ImportError> {
        let metres = self.meters_per_unit;
        if !(metres.is_finite() && metres > 0.0) {
            let problem = format!("found {metres}; expected a number above zero, such as 1, 0.01 or 0.0254");
            return Err(ImportError::Option { option: "meters_per_unit", problem });
        }
        match &self.environment {
            Some(e) if !(e.scale.is_finite() && e.scale >= 0.0 && e.rotation_deg.is_finite()) => Err(ImportError::Option {
                option: "environment",
                problem: format!(
                    "found scale {} and rotation {}; expected finite numbers, the scale not below zero",
                    e.scale, e.rotation_deg
                ),
            }),
            _ => Ok(()),
        }
    }
}
