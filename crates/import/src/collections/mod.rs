//! Scenes of published collections, in the layouts that they are published in, with their models, categories and instances.
//!
//! None of the collections was available: everything here was made from public descriptions and from the code that reads them, which the
//! module of each layout names, and tested with small files in the same layouts.
//!
//! | layout | what is given |
//! |---|---|
//! | Habitat (HSSD-200, ReplicaCAD), see `habitat/mod.rs` | `*.scene_instance.json` |
//! | 3D-FRONT with 3D-FUTURE, see `front3d/mod.rs` | the house's `.json` |
//! | ProcTHOR, see `procthor/mod.rs` | one house as `.json` |
//! | Replica, see `replica.rs` | `habitat/info_semantic.json`, or the scan's folder |
//! | Matterport3D, see `matterport.rs` | `*.house` |
//! | HM3D-Semantics, see `hm3d.rs` | `*.semantic.txt` |
//! | Structured3D, see `structured3d/mod.rs` | `annotation_3d.json`, or the scene's folder |
//!
//! # What all layouts have in common
//!
//! - The keys of its JSON decide which layout a file has. A folder means the one scene in it.
//! - A model's file is read once, by the importer of its format (glTF, OBJ, PLY, USD, FBX), and its meshes are shared by all places.
//! - Objects have names such as `chair_2 (ab12cd)`: their category, numbered, and what the collection calls their model. Where a model has
//!   several parts they are `chair_2 (ab12cd)/seat`, so that a label table can name the object.
//! - Categories become classes of NYU40 by `classes.csv`; other categories are reported and stay unlabelled. Each object is an instance;
//!   walls, floors and ceilings are none.
//! - Numbers may be text (`"1.0"`, as 3D-FRONT has some), and vectors of URDF have commas (as ReplicaCAD has them).
//! - Models that are missing or cannot be read are left out, with a warning for each and their number, and so are other entries of lists
//!   that are not what they should be. A picture that is missing is an
//!   error as everywhere, unless [`ImportOptions::allow_missing_textures`](crate::ImportOptions::allow_missing_textures) is set.
//! - Lights and cameras within models are left out, with a warning.

pub(crate) mod assets;
mod detect;
pub(crate) mod front3d;
mod habitat;
mod hm3d;
pub(crate) mod json;
mod lenient;
pub(crate) mod listed;
mod matterport;
mod objects;
pub(crate) mod procthor;
mod replica;
mod scan;
pub(crate) mod structured3d;

pub(crate) use detect::{no_scene_in_folder, scene_in_folder};

use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use detect::Layout;

/// Imports a scene of a collection.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let bytes = assembly.read_scene_file()?;
    match detect::layout(assembly.file(), &bytes)? {
        Layout::Habitat => habitat::load(&bytes, assembly),
        Layout::Front3d => front3d::load(&bytes, assembly),
        Layout::ProcThor => procthor::load(&bytes, assembly),
        Layout::Replica => replica::load(&bytes, assembly),
        Layout::Matterport => matterport::load(&bytes, assembly),
        Layout::Hm3d => hm3d::load(&bytes, assembly),
        Layout::Structured3d => structured3d::load(&bytes, assembly),
    }
}
