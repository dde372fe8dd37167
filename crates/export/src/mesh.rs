//! The scene's triangles by instance or by object, from the mesh folder.

use crate::ExportError;
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::mesh_names::{FACES_OBJECTS, FACES_VERTICES, OBJECTS_INSTANCE, OBJECTS_SEMANTIC, VERTICES};
use enfilade_dataset::{Dataset, DatasetError, Elements};
use enfilade_math::DVec3;
use enfilade_scene::PartLabel;
use std::collections::BTreeMap;
use std::path::Path;

/// The surface of one instance or object, world space, metres.
#[derive(Default)]
pub(crate) struct SurfaceMesh {
    /// Each vertex once.
    pub vertices: Vec<DVec3>,
    pub faces: Vec<[u32; 3]>,
}

/// The first file that is missing of those that the surfaces of instances are made from.
pub(crate) fn missing_mesh_file(dataset: &Dataset, scene: &str) -> Option<&'static str> {
    let needed = [VERTICES, FACES_VERTICES, FACES_OBJECTS, OBJECTS_SEMANTIC, OBJECTS_INSTANCE];
    needed.into_iter().find(|name| !dataset.layout().mesh_file(scene, name).is_file())
}

/// The surfaces of the scene's instances by number; empty where the dataset has no mesh or no label tables (Hypersim's public files).
pub(crate) fn instance_meshes(dataset: &Dataset, scene: &str) -> Result<BTreeMap<i16, SurfaceMesh>, ExportError> {
    let labels = if missing_mesh_file(dataset, scene).is_some() { Vec::new() } else { dataset.read_label_tables(scene)?.parts };
    let number = |object: usize| labels.get(object).map(|label: &PartLabel| label.instance).filter(|&number| number > 0);
    meshes_by(dataset, scene, number)
}

/// The surfaces of the scene's objects by number; empty where the dataset has no mesh or no label tables.
pub(crate) fn object_meshes(dataset: &Dataset, scene: &str) -> Result<BTreeMap<usize, SurfaceMesh>, ExportError> {
    meshes_by(dataset, scene, Some)
}

/// The surfaces of the scene's objects by what `key` gives for each, those of which it gives none left out.
fn meshes_by<K: Ord>(dataset: &Dataset, scene: &str, key: impl Fn(usize) -> Option<K>) -> Result<BTreeMap<K, SurfaceMesh>, ExportError> {
    let file = |name: &str| dataset.layout().mesh_file(scene, name);
    if missing_mesh_file(dataset, scene).is_some() {
        return Ok(BTreeMap::new());
    }
    let metres = dataset.meters_per_asset_unit(scene)?;
    let vertices = read_f64(&file(VERTICES))?;
    let (corners, objects) = (read_i64(&file(FACES_VERTICES))?, read_i64(&file(FACES_OBJECTS))?);
    let wrong =
        |name: &str, problem: String| DatasetError::Hdf5 { path: file(name), problem: format!("{problem}; import the scene again") };
    if corners.len() != 3 * objects.len() {
        return Err(wrong(FACES_VERTICES, format!("{} corners for {} faces", corners.len(), objects.len())).into());
    }
    let mut meshes: BTreeMap<K, (SurfaceMesh, BTreeMap<i64, u32>)> = BTreeMap::new();
    for (face, &object) in corners.chunks_exact(3).zip(&objects) {
        let Some(key) = usize::try_from(object).ok().and_then(&key) else { continue };
        let (mesh, known) = meshes.entry(key).or_default();
        let mut own = [0; 3];
        for (own, &corner) in own.iter_mut().zip(face) {
            if let Some(&known) = known.get(&corner) {
                *own = known;
                continue;
            }
            let place = usize::try_from(corner).ok().and_then(|i| vertices.get(3 * i..3 * i + 3));
            let place = place.ok_or_else(|| wrong(FACES_VERTICES, format!("it names vertex {corner} of {}", vertices.len() / 3)))?;
            let position = DVec3::from_slice(place) * metres;
            if !position.as_vec3().is_finite() {
                return Err(wrong(VERTICES, format!("vertex {corner} is at {place:?}; expected finite numbers")).into());
            }
            *own = mesh.vertices.len() as u32;
            mesh.vertices.push(position);
            known.insert(corner, *own);
        }
        mesh.faces.push(own);
    }
    Ok(meshes.into_iter().map(|(key, (mesh, _))| (key, mesh)).collect())
}

/// Reads an array of doubles.
fn read_f64(path: &Path) -> Result<Vec<f64>, DatasetError> {
    match read_array(path)?.values {
        Elements::F64(values) => Ok(values),
        other => Err(unexpected(path, "float64", &other)),
    }
}

fn read_i64(path: &Path) -> Result<Vec<i64>, DatasetError> {
    match read_array(path)?.values {
        Elements::I64(values) => Ok(values),
        other => Err(unexpected(path, "int64", &other)),
    }
}

fn unexpected(path: &Path, expected: &str, found: &Elements) -> DatasetError {
    let problem = format!("expected {expected}, found {}; run the stage that makes this file again", found.element().name());
    DatasetError::Hdf5 { path: path.into(), problem }
}
