//! Scene files to [`Scene`](enfilade_scene::Scene), with a report of what was dropped or guessed.
//!
//! [`load`] recognises the format by the file's extension:
//!
//! ```
//! use enfilade_import::{ImportOptions, load};
//! use enfilade_scene::Quiet;
//!
//! # let folder = tempfile::tempdir()?;
//! let file = folder.path().join("floor.obj");
//! std::fs::write(&file, "g floor\nv 0 0 0\nv 4 0 0\nv 4 0 -3\nv 0 0 -3\nf 1 2 3 4\n")?;
//!
//! let imported = load(&file, &ImportOptions::default(), &Quiet)?;
//! let part = &imported.scene.parts[0];
//! assert_eq!((part.name.as_str(), imported.report.counts.triangles), ("floor", 2));
//! // y is up in OBJ files, z in scenes: the third corner is 3 m along y.
//! assert_eq!(imported.scene.world_corners(part, 0)[2].to_array(), [4.0, 3.0, 0.0]);
//! // What was dropped or guessed, here that there is no material.
//! println!("{}", imported.report);
//! # Ok::<(), Box<dyn std::error::Error>>(())
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
//! - Mirroring placements get reversed triangles, so that the front stays the front. Of a part that its placement flattens, the faces
//!   that still have an area are kept, with a warning; without any the part is left out.
//! - A texture that is not at the path in the file is sought by its name beside the scene file, in `textures/` and folders of such names,
//!   and in those beside the scene file's folder, in whatever case; the report says which was used.
//! - A texture that is missing or broken is an error, unless [`ImportOptions::allow_missing_textures`] is set.
//! - A scene farther than 8 km from the origin of its coordinates, such as map coordinates, is moved to the origin, and the report says by
//!   how much ([`ImportReport::offset_m`]). OBJ, PLY, USD, FBX, pbrt, Mitsuba and placements of all formats are read in double precision,
//!   so that nothing is lost on the way.
//! - A scene has no colours of vertices. If a file has them, their mean colours the part (glTF, OBJ, PLY, USD's display
//!   colour, `mesh_attribute` of Mitsuba) or they are dropped (FBX, pbrt); the report says so.
//! - Animations of nodes (glTF, FBX, USD, COLLADA) are rigid motion of bodies, those of skins, morph targets and scales shapes over time; the
//!   report says what else of an animation was left out.
//!
//! # Formats
//!
//! The pages of [`gltf`], [`obj`], [`mitsuba`], [`pbrt`], [`ply`], [`usd`], [`fbx`], [`collada`], [`stl`], [`robot`],
//! [`vray`], [`sweethome`] and [`package`] list what is
//! supported of each, and the page of [`collections`] lists the layouts of published collections that are read.

mod archive;
mod assembly;
mod blender;
mod classes;
pub mod collada;
pub mod collections;
mod disguise;
mod download;
mod environment;
mod error;
pub mod fbx;
mod format;
pub mod gltf;
mod ies;
mod images;
mod imported;
mod joints;
mod kinds;
mod load;
mod mesh;
pub mod mitsuba;
mod motion;
pub mod obj;
mod options;
mod others;
pub mod package;
pub mod pbrt;
mod percent;
pub mod plans;
pub mod ply;
mod polygon;
mod primitives;
mod report;
pub mod robot;
mod roughness;
mod spectrum;
pub mod stl;
pub mod sweethome;
pub mod usd;
mod vectors;
pub mod vray;
mod wildcards;
mod xml;

pub use environment::{EnvironmentOverride, EnvironmentSource};
pub use error::ImportError;
pub use format::{Format, scene_name};
pub use images::{check_exr_blocks, check_exr_table};
pub use imported::{Imported, ImportedLabel};
pub use load::{load, scene_in_folder};
pub use options::{ImportOptions, UpAxis, UpStated};
pub use plans::read_plan;
pub use report::{Counts, ImportReport};
pub use wildcards::{Match, matches};
