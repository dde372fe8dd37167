//! Trees of OctoMap, and arrays of HDF5.

use super::datasets::{CAMERA, SCENE, linked};
use crate::Run;
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::{BoxKind, read_ray_grid};
use enfilade_frame::LAYERS;
use enfilade_geometry::OccupancyTree;
use std::path::Path;

/// Reads trees of both kinds. What was read is written and read again.
pub fn octree(_: &Path) -> Run {
    Box::new(|bytes| {
        if let Ok(tree) = OccupancyTree::from_bt(bytes) {
            assert!(OccupancyTree::from_bt(&tree.to_bt()).is_ok(), "a tree that was written can be read");
        }
        if let Ok(tree) = OccupancyTree::from_ot(bytes) {
            assert!(OccupancyTree::from_ot(&tree.to_ot()).is_ok(), "a tree that was written can be read");
        }
    })
}

/// Reads an array, and where it is one, as every array that a dataset has.
pub fn hdf5(folder: &Path) -> Run {
    let (dataset, input) = linked(folder, "hdf5");
    std::fs::write(dataset.mesh_files(SCENE).file("metadata_objects.csv"), "object_name\nfloor\n").expect("a folder that can be written");
    Box::new(move |bytes| {
        std::fs::write(&input, bytes).expect("a folder that can be written");
        if read_array(&input).is_err() {
            return;
        }
        drop(dataset.read_trajectory(SCENE, CAMERA));
        drop(dataset.read_camera_rays(SCENE, CAMERA, [8, 6]));
        drop(read_ray_grid(&input, [8, 6]));
        drop(dataset.read_free_space(SCENE));
        BoxKind::ALL.iter().for_each(|&kind| drop(dataset.read_boxes(SCENE, kind)));
        LAYERS.iter().for_each(|spec| drop(dataset.read_frame(SCENE, CAMERA, 0, &[spec.layer])));
        let mesh = dataset.mesh_files(SCENE);
        drop((mesh.read(), mesh.read_labels(), mesh.read_last_class(), mesh.read_objects_of_faces()));
    })
}
