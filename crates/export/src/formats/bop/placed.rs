//! Objects that `[[object]]` placed: copies of a model in one size are one BOP object, and what is no target is left out.

use super::model::{bounds, model_info, ply};
use super::records::{CopiedObject, ModelInfo};
use super::targets::{Pose, Targets};
use crate::ExportError;
use crate::export_folder::ExportFolder;
use crate::mesh::{SurfaceMesh, instance_meshes};
use crate::model_meshes::{clustered, vertex_normals, with_short_sides};
use crate::options::SymmetryRule;
use crate::selected_frames::SelectedFrames;
use crate::symmetries::symmetries;
use enfilade_dataset::{PlacedObject, PlacedObjects};
use enfilade_math::{DMat3, DVec3};
use enfilade_scene::Warning;
use std::collections::BTreeMap;

/// Models for evaluation have no sides longer than this share of the diameter.
const EVAL_SIDE: f64 = 0.05;

/// Models for evaluation of more triangles are simplified on a grid of so many cells to the diameter.
const EVAL_TRIANGLES: usize = 20_000;
const EVAL_CELLS: f64 = 100.0;

/// Copies of a model differ by no more than this and this share of the diameter, metres: rounding of stored vertices.
const COPY_M: f64 = 5e-4;
const COPY_SHARE: f64 = 2e-3;

/// A matrix is a rotation if what it is with its transpose differs from 1 by no more.
const RIGID: f64 = 1e-6;

/// A model in a size; sizes are ordered as numbers.
type Key = (String, u64);

/// The objects that were placed in the scenes of the dataset.
pub(super) struct Placed {
    /// Scenes in the order of their names, those without placed objects left out.
    scenes: BTreeMap<String, PlacedObjects>,
    ids: BTreeMap<Key, u32>,
}

/// A BOP object with its model.
struct Object {
    vertices: Vec<DVec3>,
    bounds: [DVec3; 2],
    diameter_m: f64,
    info: ModelInfo,
}

/// The objects placed in any scene of the dataset, so that numbers are the same whichever scenes are exported; `None` if the exported ones
/// have none.
pub(super) fn placed(selected: &SelectedFrames<'_>) -> Result<Option<Placed>, ExportError> {
    let mut scenes = BTreeMap::new();
    for scene in selected.dataset.scenes()? {
        if let Some(found) = selected.dataset.read_placed_objects(&scene)? {
            scenes.insert(scene, found);
        }
    }
    let exported = || selected.scenes().map(|tracks| &tracks[0].scene);
    if !exported().any(|scene| scenes.contains_key(scene)) {
        return Ok(None);
    }
    for scene in exported().filter(|scene| !scenes.contains_key(*scene)) {
        let message = "[[object]] placed nothing in it: its images are exported without poses".to_string();
        selected.warn(Warning { place: scene.clone(), message });
    }
    let keys: BTreeMap<Key, ()> = scenes.values().flat_map(targets).map(|object| (key(object), ())).collect();
    Ok(Some(Placed { scenes, ids: keys.into_keys().zip(1..).collect() }))
}

fn targets(found: &PlacedObjects) -> impl Iterator<Item = &PlacedObject> {
    found.objects.iter().filter(|object| !object.is_distractor)
}

/// Bits of positive numbers are in the order of the numbers.
fn key(object: &PlacedObject) -> Key {
    (object.model.clone(), object.scale.to_bits())
}

impl Placed {
    /// Numbers of all objects.
    pub fn ids(&self) -> impl Iterator<Item = u32> {
        self.ids.values().copied()
    }

    /// Writes the models, each from its first copy; returns the objects of each exported scene.
    pub fn write(
        &self,
        selected: &SelectedFrames<'_>,
        out: &ExportFolder,
        rule: SymmetryRule,
    ) -> Result<BTreeMap<String, Targets>, ExportError> {
        let (mut objects, mut entries) = (BTreeMap::new(), BTreeMap::new());
        let mut all: BTreeMap<String, Targets> = BTreeMap::new();
        for (scene, found) in &self.scenes {
            let is_exported = selected.scenes().any(|tracks| tracks[0].scene == *scene);
            let is_new = |object: &PlacedObject| !objects.contains_key(&self.ids[&key(object)]);
            if !is_exported && !targets(found).any(is_new) {
                continue;
            }
            let meshes = instance_meshes(selected.dataset, scene)?;
            let mut here = Targets::new();
            for object in targets(found) {
                let id = self.ids[&key(object)];
                let problem = |problem: String| selected.unsuitable(format!("{scene}: object {:?}", object.name), problem);
                let mesh = match meshes.get(&object.instance) {
                    Some(mesh) => mesh,
                    None if is_exported => return Err(problem(without_mesh(object.instance))),
                    // Scenes that are not finished yet do not hinder the others.
                    None => continue,
                };
                let pose = rigid(object).ok_or_else(|| problem(NOT_RIGID.into()))?;
                let vertices: Vec<DVec3> = mesh.vertices.iter().map(|v| pose.rotation.transpose() * (*v - pose.translation)).collect();
                match objects.get(&id) {
                    Some(first) => check_copy(first, &vertices).map_err(problem)?,
                    None => {
                        let mesh = SurfaceMesh { vertices, faces: mesh.faces.clone() };
                        objects.insert(id, write_model(out, id, &mesh, rule)?);
                        entries.insert(id, CopiedObject { model: object.model.clone(), scale: object.scale, nyu40: object.semantic });
                    }
                }
                here.insert(object.instance, (id, pose));
            }
            all.insert(scene.clone(), here);
        }
        let infos: BTreeMap<u32, &ModelInfo> = objects.iter().map(|(id, object)| (*id, &object.info)).collect();
        out.write_json("models/models_info.json", &infos)?;
        out.write_json("models_eval/models_info.json", &infos)?;
        out.write_json("objects.json", &entries)?;
        Ok(all)
    }
}

const NOT_RIGID: &str = "its pose in placed_objects.json is no rotation with a shift; import the scene again, which rewrites it";

fn without_mesh(instance: i16) -> String {
    format!(
        "no triangles of the scene have its instance number, {instance}: the mesh is missing in _detail/mesh, or the labels have changed since it \
         was placed; run the import and the label stage again"
    )
}

/// The pose of an object; `None` where it is not rigid.
fn rigid(object: &PlacedObject) -> Option<Pose> {
    let row = |i: usize| DVec3::new(object.world_from_model[i][0], object.world_from_model[i][1], object.world_from_model[i][2]);
    let rotation = DMat3::from_cols(row(0), row(1), row(2)).transpose();
    let translation = DVec3::from_array(std::array::from_fn(|i| object.world_from_model[i][3]));
    let off = (rotation * rotation.transpose() - DMat3::IDENTITY).to_cols_array();
    let is_rigid = off.iter().all(|v| v.abs() < RIGID) && rotation.determinant() > 0.0 && translation.is_finite();
    (is_rigid && object.world_from_model[3] == [0.0, 0.0, 0.0, 1.0]).then_some(Pose { rotation, translation })
}

/// Whether another copy of a model, put back by its own pose, is where the first is.
fn check_copy(first: &Object, vertices: &[DVec3]) -> Result<(), String> {
    let off = bounds(vertices).into_iter().zip(first.bounds).map(|(a, b)| (a - b).abs().max_element()).fold(0.0, f64::max);
    if vertices.len() == first.vertices.len() && off <= COPY_M + COPY_SHARE * first.diameter_m {
        return Ok(());
    }
    Err(format!(
        "put back by its pose it is not the model that other copies are: {} vertices instead of {}, bounds {:.1} mm off; the labels have changed \
         since it was placed, or placed_objects.json is of another import: run the import and the label stage again",
        vertices.len(),
        first.vertices.len(),
        1000.0 * off
    ))
}

/// Writes a model's two meshes.
fn write_model(out: &ExportFolder, id: u32, mesh: &SurfaceMesh, rule: SymmetryRule) -> Result<Object, ExportError> {
    let bounds = bounds(&mesh.vertices);
    let info = model_info(mesh.vertices.clone(), bounds);
    let diameter_m = info.diameter / 1000.0;
    let found = symmetries(mesh, diameter_m, rule);
    let coarse = (mesh.faces.len() > EVAL_TRIANGLES).then(|| clustered(mesh, diameter_m / EVAL_CELLS));
    let eval = with_short_sides(coarse.as_ref().unwrap_or(mesh), EVAL_SIDE * diameter_m);
    for (folder, mesh) in [("models", mesh), ("models_eval", &eval)] {
        let normals = vertex_normals(mesh);
        out.write(&format!("{folder}/obj_{id:06}.ply"), &ply(&mesh.vertices, Some(&normals), &mesh.faces))?;
    }
    Ok(Object { vertices: mesh.vertices.clone(), bounds, diameter_m, info: info.with_symmetries(&found) })
}
