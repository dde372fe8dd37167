//! What importing leaves: the scene package, its labels, and the dataset's files of the scene.

use super::Job;
use crate::error::Error;
use crate::workdir::Hash;
use enfilade_dataset::{FrameRecord, PlacedObjects, counted, mesh_names, remove_if_there, write_bytes, write_json};
use enfilade_math::Vec3;
use enfilade_scene::{Labels, Rooms, Scene, WorldMesh};
use enfilade_show::planview::rooms_svg;
use std::path::{Path, PathBuf};

/// Labels that came with the scene, in the work folder.
pub(super) const LABELS: &str = "labels.json";
/// Files of the mesh folder that importing makes. The tables of objects are there from then on too, of whole parts; the label stage makes
/// them, with the pieces of parts that people split.
const GEOMETRY: [&str; 10] = [
    mesh_names::VERTICES,
    mesh_names::NORMALS,
    mesh_names::TEXCOORDS,
    mesh_names::FACES_VERTICES,
    mesh_names::FACES_NORMALS,
    mesh_names::FACES_TEXCOORDS,
    mesh_names::FACES_GROUPS,
    mesh_names::FACES_MATERIALS,
    mesh_names::GROUPS,
    mesh_names::MATERIALS,
];

/// Writes the package, the labels and the dataset's files of a scene; returns them. `bytes` are those of the package.
pub(super) fn write(
    job: &Job,
    (scene, bytes): (&Scene, &[u8]),
    labels: Option<&Labels>,
    (rooms, placed): (Option<&Rooms>, Option<&PlacedObjects>),
    offset_m: Option<[f64; 3]>,
) -> Result<Vec<PathBuf>, Error> {
    let name = &job.scene.name;
    let package = job.package()?;
    remove_frames_of_other_scenes(job, &package, bytes)?;
    job.dataset.write_scene(name, scene).map_err(Error::stage)?;
    offset_m.map_or(Ok(()), |offset_m| job.dataset.write_offset(name, offset_m)).map_err(Error::stage)?;
    write_bytes(&package, bytes)?;
    let labels_file = job.work_file(LABELS)?;
    write_json(&labels_file, &labels)?;
    job.forget_scene();
    let layout = job.dataset.layout();
    let mut outputs = vec![package, labels_file, layout.metadata_scene(name), layout.metadata_nodes(name), layout.metadata_materials(name)];
    outputs.extend(GEOMETRY.iter().map(|file| layout.mesh_file(name, file)));
    let placed_file = layout.placed_objects(name);
    match placed {
        Some(placed) => {
            job.dataset.write_placed_objects(name, placed).map_err(Error::stage)?;
            outputs.push(placed_file);
        }
        None => remove_if_there(&placed_file)?,
    }
    let drawn = [layout.rooms(name), layout.rooms_drawing(name)];
    match rooms {
        Some(rooms) => {
            job.dataset.write_rooms(name, rooms).map_err(Error::stage)?;
            write_bytes(&drawn[1], rooms_svg(rooms))?;
            outputs.extend(drawn);
        }
        None => remove_built_rooms(job, &drawn)?,
    }
    Ok(outputs)
}

/// Removes the rooms of a home that the scene was before. Those that were fitted to its labels are a product of their own.
fn remove_built_rooms(job: &Job, files: &[PathBuf]) -> Result<(), Error> {
    let is_fitted = matches!(job.dataset.read_rooms(&job.scene.name), Ok(Some(rooms)) if rooms.fit.is_some());
    if is_fitted { Ok(()) } else { Ok(files.iter().try_for_each(|file| remove_if_there(file))?) }
}

/// Removes frames that show another scene: their part numbers may mean other parts of this one. `bytes` is the package that replaces the
/// one on disk.
fn remove_frames_of_other_scenes(job: &Job, package: &Path, bytes: &[u8]) -> Result<(), Error> {
    let name = &job.scene.name;
    if !job.dataset.layout().images_dir(name).is_dir() {
        return Ok(());
    }
    let hash = Hash::of_bytes(bytes);
    let is_replaced = package.is_file() && Hash::of_file(package)? != hash;
    let stays = |record: &FrameRecord| match &record.recipe {
        Some(recipe) if !recipe.scene_blake3.is_empty() => recipe.scene_blake3 == hash.0,
        // V-Ray's frames, and frames of earlier versions, do not name their scene: they show the one whose package is on disk.
        _ => !is_replaced,
    };
    job.there()?.iter().try_for_each(|camera| job.dataset.retain_frames(name, camera, stays)).map_err(Error::stage)
}

/// One line about a scene.
pub(crate) fn describe(scene: &Scene) -> String {
    let triangles: usize = scene.parts.iter().map(|p| scene.meshes[p.mesh as usize].triangles.len()).sum();
    let extent = WorldMesh::new(scene).bounds.extent().max(Vec3::ZERO);
    format!(
        "{}, {}, {}, {}; {} x {} x {} m",
        counted(scene.parts.len(), "part"),
        counted(triangles, "triangle"),
        counted(scene.materials.len(), "material"),
        counted(scene.images.len(), "image"),
        metres(extent.x),
        metres(extent.y),
        metres(extent.z)
    )
}

/// A length to a tenth, or, where it is below that, to two significant digits, so that a scene in a wrong unit shows its size.
fn metres(length: f32) -> String {
    let digits = if length > 0.0 && length < 0.1 { (1.0 - length.log10().floor()).min(12.0) as usize } else { 1 };
    format!("{length:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_lengths_keep_two_digits() {
        assert_eq!([0.0, 12.34, 0.94, 0.05, 0.00123, 1e-30].map(metres), ["0.0", "12.3", "0.9", "0.050", "0.0012", "0.000000000000"]);
    }
}
