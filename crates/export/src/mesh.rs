//! The scene's triangles by instance, from the mesh folder.

use crate::ExportError;
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::mesh_names::{FACES_OBJECTS, FACES_VERTICES, OBJECTS_INSTANCE, OBJECTS_SEMANTIC, VERTICES};
use enfilade_dataset::{Dataset, DatasetError, Elements};
use enfilade_math::DVec3;
use std::collections::BTreeMap;
use std::path::Path;

/// The surface of one instance, world space, metres.
#[derive(Default)]
pub(crate) struct InstanceMesh {
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
pub(crate) fn instance_meshes(dataset: &Dataset, scene: &str) -> Result<BTreeMap<i16, InstanceMesh>, ExportError> {
    let file = |name: &str| dataset.layout().mesh_file(scene, name);
    if missing_mesh_file(dataset, scene).is_some() {
        return Ok(BTreeMap::new());
    }
    let metres = dataset.meters_per_asset_unit(scene)?;
    let vertices = read_f64(&file(VERTICES))?;
    let (corners, objects) = (read_i64(&file(FACES_VERTICES))?, read_i64(&file(FACES_OBJECTS))?);
    let labels = dataset.read_label_tables(scene)?;
    let wrong = |problem: String| DatasetError::Hdf5 { path: file(FACES_VERTICES), problem };
    if corners.len() != 3 * objects.len() {
        return Err(wrong(format!("{} corners for {} faces; import the scene again", corners.len(), objects.len())).into());
    }
    let mut meshes: BTreeMap<i16, (InstanceMesh, BTreeMap<i64, u32>)> = BTreeMap::new();
    for (face, &object) in corners.chunks_exact(3).zip(&objects) {
        let label = usize::try_from(object).ok().and_then(|object| labels.parts.get(object));
        let Some(label) = label.filter(|label| label.instance > 0) else { continue };
        let (mesh, known) = meshes.entry(label.instance).or_default();
        let mut own = [0; 3];
        for (own, &corner) in own.iter_mut().zip(face) {
            let place = usize::try_from(corner).ok().filter(|&i| 3 * i + 3 <= vertices.len());
            let place =
                place.ok_or_else(|| wrong(format!("it names vertex {corner} of {}; import the scene again", vertices.len() / 3)))?;
            *own = *known.entry(corner).or_insert_with(|| {
                mesh.vertices.push(DVec3::from_slice(&vertices[3 * place..]) * metres);
                mesh.vertices.len() as u32 - 1
            });
        }
        mesh.faces.push(own);
    }
    Ok(meshes.into_iter().map(|(number, (mesh, _))| (number, mesh)).collect())
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
