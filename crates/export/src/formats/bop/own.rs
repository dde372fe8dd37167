//! Every instance as an object of its own: scenes whose objects were not placed by `[[object]]`.

use super::model::{bounds, model_info, ply};
use super::records::{ModelInfo, OwnObject};
use super::targets::{Pose, Targets};
use crate::ExportError;
use crate::boxes::instance_boxes;
use crate::export_folder::ExportFolder;
use crate::mesh::{SurfaceMesh, instance_meshes, missing_mesh_file};
use crate::selected_frames::SelectedFrames;
use enfilade_math::{DVec3, OrientedBox};
use std::collections::BTreeMap;

/// A BOP object.
struct Object {
    id: u32,
    shape: OrientedBox,
    mesh: Option<SurfaceMesh>,
}

/// Writes the models of all instances; returns the objects of each scene.
pub(super) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<BTreeMap<String, Targets>, ExportError> {
    let (mut models, mut entries) = (BTreeMap::new(), BTreeMap::new());
    let mut all = BTreeMap::new();
    let mut first_id = 1;
    for tracks in selected.scenes() {
        let scene = &tracks[0].scene;
        let objects = objects_of(selected, scene, first_id)?;
        first_id += objects.len() as u32;
        let labels = selected.labels(scene)?.parts;
        let mut targets = Targets::new();
        for (instance, object) in objects {
            models.insert(object.id, write_model(out, &object)?);
            let nyu40 = labels.iter().find(|label| label.instance == instance).map_or(-1, |label| label.semantic);
            entries.insert(object.id, OwnObject { scene: scene.clone(), instance, nyu40 });
            let pose = Pose { rotation: object.shape.world_from_box, translation: object.shape.center };
            targets.insert(instance, (object.id, pose));
        }
        all.insert(scene.clone(), targets);
    }
    out.write_json("models/models_info.json", &models)?;
    out.write_json("objects.json", &entries)?;
    Ok(all)
}

/// The objects of a scene by instance number, numbered from `first_id`.
fn objects_of(selected: &SelectedFrames<'_>, scene: &str, first_id: u32) -> Result<BTreeMap<i16, Object>, ExportError> {
    let mut meshes = instance_meshes(selected.dataset, scene)?;
    let boxes = instance_boxes(selected.dataset, scene, &meshes)?;
    if boxes.is_empty() {
        return Err(selected.unsuitable(scene, without_objects(selected, scene)));
    }
    let object = |(id, (number, shape))| (number, Object { id, shape, mesh: meshes.remove(&number) });
    Ok((first_id..).zip(boxes).map(object).collect())
}

/// Why a scene has no objects, and what to do.
fn without_objects(selected: &SelectedFrames<'_>, scene: &str) -> String {
    let (problem, remedy) = match missing_mesh_file(selected.dataset, scene) {
        Some(file) if !file.contains("_objects_") => {
            (format!("it has neither box files nor a mesh ({file} is missing in _detail/mesh)"), "add one of them")
        }
        _ => ("no part of it is labelled as an instance".to_string(), "label it"),
    };
    format!("{problem}, so poses of objects are not known; {remedy}, or leave it out")
}

/// Writes the object's mesh, if it is known, and returns its size.
fn write_model(out: &ExportFolder, object: &Object) -> Result<ModelInfo, ExportError> {
    let half = 0.5 * object.shape.extents;
    let Some(mesh) = &object.mesh else { return Ok(model_info(vec![-half, half], [-half, half])) };
    let vertices: Vec<DVec3> = mesh.vertices.iter().map(|&v| object.shape.local(v)).collect();
    out.write(&format!("models/obj_{:06}.ply", object.id), &ply(&vertices, None, &mesh.faces))?;
    let bounds = bounds(&vertices);
    Ok(model_info(vertices, bounds))
}
