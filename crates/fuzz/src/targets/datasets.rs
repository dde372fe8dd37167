//! Arrays, tables and records of datasets: each input replaces every file of its kind in a small dataset.

use crate::Run;
use crate::seeds::dataset;
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::mesh_names::OBJECTS;
use enfilade_dataset::{BoxKind, Dataset, read_ray_grid};
use enfilade_frame::LAYERS;
use enfilade_math::DVec3;
use enfilade_suggest::{calibration, learn::read_names, lexicon::Lexicon, weights::Weights};
use std::path::{Path, PathBuf};

pub use dataset::{CAMERA, SCENE};

/// A small dataset in which every file with this extension is the one at the path that is returned.
pub fn linked(folder: &Path, extension: &str) -> (Dataset, PathBuf) {
    let input = folder.join("input");
    let dataset = dataset::write(&folder.join("dataset"));
    for file in dataset::files(dataset.root(), extension) {
        std::fs::remove_file(&file).expect("a folder that can be written");
        std::fs::hard_link(touched(&input), &file).expect("a folder that can be written");
    }
    (dataset, input)
}

/// The file, which is made where it is missing.
fn touched(file: &Path) -> &Path {
    std::fs::File::options().create(true).append(true).open(file).expect("a folder that can be written");
    file
}

/// Reads an array, and where it is one, as every array that a dataset has.
pub fn hdf5(folder: &Path) -> Run {
    let (dataset, input) = linked(folder, "hdf5");
    std::fs::write(dataset.mesh_files(SCENE).file(OBJECTS), "object_name\nfloor\n").expect("a folder that can be written");
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
        drop((dataset.read_surfaces(SCENE, CAMERA, 0), dataset.read_fixture_layers(SCENE, CAMERA, 0, 1)));
        let mesh = dataset.mesh_files(SCENE);
        drop((mesh.read(), mesh.read_labels(), mesh.read_last_class(), mesh.read_objects_of_faces()));
    })
}

/// Reads a table as each of those that there are.
pub fn tables(folder: &Path) -> Run {
    let (dataset, input) = linked(folder, "csv");
    Box::new(move |bytes| {
        std::fs::write(&input, bytes).expect("a folder that can be written");
        drop((dataset.read_times(), dataset.read_partition(), dataset.cameras(SCENE), dataset.read_nodes(SCENE)));
        drop((dataset.table_projection(SCENE), dataset.projection_matrix(SCENE), dataset.meters_per_asset_unit(SCENE)));
        drop((dataset.read_frame_time(SCENE, CAMERA), dataset.rejected_views(SCENE, CAMERA)));
        drop((dataset.read_tone_maps(SCENE, CAMERA), dataset.read_instance_views(SCENE, CAMERA), dataset.read_fixtures(SCENE)));
        drop((dataset.read_described_instances(SCENE), dataset.read_instance_relations(SCENE)));
        drop(dataset.mesh_files(SCENE).read_pieces());
        #[cfg(feature = "program")]
        drop(enfilade_label::LabelTable::parse(bytes, "labels.csv"));
        drop(read_names(bytes, "names.csv"));
        let text = String::from_utf8_lossy(bytes);
        drop((Lexicon::parse(&text, "words.csv"), Weights::parse(&text, "weights.csv")));
        drop((calibration::Calibration::parse(&text, "a.csv"), calibration::Thresholds::parse(&text, "b.csv")));
    })
}

/// Reads a record as each of those that there are, and looks through the camera that it may be.
pub fn records(folder: &Path) -> Run {
    let (dataset, input) = linked(folder, "json");
    Box::new(move |bytes| {
        std::fs::write(&input, bytes).expect("a folder that can be written");
        drop((dataset.read_manifest(), dataset.frame_record(SCENE, CAMERA, 0), dataset.label_record(SCENE, CAMERA, 0)));
        drop(dataset.rendered_record(SCENE, CAMERA, 0).map(|record| (dataset.color_is_whole(SCENE, &record), record.as_rendered())));
        drop((
            dataset.read_rendered([SCENE, CAMERA], 0, &[LAYERS[0].layer]),
            dataset.read_amodal_masks(SCENE, CAMERA, 0),
            dataset.read_stereo(SCENE, CAMERA),
        ));
        drop((dataset.frame_numbers(SCENE, CAMERA), dataset.frame_is_complete(SCENE, CAMERA, 0, "c0ffee")));
        if let Ok(camera) = dataset.read_camera(SCENE, CAMERA) {
            let [width, height] = camera.size().map(f64::from);
            let _ = (camera.projection.ray(0.5 * width, 0.5 * height), camera.projection.ray(0.0, height));
            let _ = camera.projection.project(DVec3::new(0.3, 0.2, -1.0));
        }
    })
}
