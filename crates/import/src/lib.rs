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
mod imported;
mod load;
mod mesh;
pub mod mitsuba;
pub mod obj;
mod options;
pub mod package;
pub mod pbrt;
mod percent;
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
pub use imported::{Imported, ImportedLabel};
pub use load::load;
pub use options::{EnvironmentOverride, ImportOptions, UpAxis};
pub use report::{Counts, ImportReport};
