//! Scans of Replica in their export for Habitat: `habitat/info_semantic.json` and `habitat/mesh_semantic.ply`.
//!
//! Made from the README of Replica-Dataset and habitat-sim's `ReplicaSemanticScene.cpp`. Metres, z up.
//!
//! | in the files | what becomes of it |
//! |---|---|
//! | `mesh_semantic.ply` | the faces of each `object_id` as one part, in the mean of its colours |
//! | `info_semantic.json` | `objects` (`id`, `class_id`, `class_name`) and `classes` (`id`, `name`) name them |
//! | `../mesh.ply` with `semantic.bin`, `textures/*.hdr`, `glass.sur` | not read: the parametric textures (PTex) and the binary segmentation are Replica's own forms. `mesh.ply` alone is a PLY without labels |

use super::json;
use super::listed::Listed;
use super::objects::Objects;
use super::scan;
use crate::assembly::Assembly;
use crate::{ImportError, Imported, UpAxis};
use serde::Deserialize;
use std::collections::HashMap;

/// The mesh beside the names.
pub(super) const MESH: &str = "mesh_semantic.ply";

#[derive(Deserialize)]
struct Info {
    #[serde(default)]
    classes: Listed<Class>,
    #[serde(default)]
    objects: Listed<Labelled>,
}

#[derive(Deserialize)]
struct Class {
    id: i64,
    name: String,
}

#[derive(Deserialize)]
struct Labelled {
    id: i64,
    #[serde(default = "none")]
    class_id: i64,
    class_name: Option<String>,
}

fn none() -> i64 {
    -1
}

/// Imports a scan by its names.
pub(super) fn load(bytes: &[u8], mut a: Assembly) -> Result<Imported, ImportError> {
    let file = a.file().to_path_buf();
    let info: Info = json::parse(bytes, &file, "the names of a scan of Replica")?;
    a.set_units(1.0, UpAxis::Z);
    info.classes.report("classes", &mut a);
    info.objects.report("objects", &mut a);
    let classes: HashMap<i64, &str> = info.classes.iter().map(|class| (class.id, class.name.as_str())).collect();
    let name = |object: &Labelled| object.class_name.clone().or_else(|| classes.get(&object.class_id).map(|name| (*name).to_string()));
    let names: HashMap<i64, Option<String>> = info.objects.iter().map(|object| (object.id, name(object))).collect();
    let mut objects = Objects::default();
    let category = |id: i64| (id, names.get(&id).cloned().flatten());
    scan::add(&file.with_file_name(MESH), &category, &mut objects, &mut a)?;
    objects.finish(&mut a);
    a.finish()
}
