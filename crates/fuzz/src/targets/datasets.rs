//! Tables and records of datasets.

use crate::Run;
use crate::seeds::dataset;
use enfilade_dataset::Dataset;
use enfilade_math::DVec3;
use enfilade_post::label::LabelTable;
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

/// Reads a table as each of those that there are.
pub fn tables(folder: &Path) -> Run {
    let (dataset, input) = linked(folder, "csv");
    Box::new(move |bytes| {
        std::fs::write(&input, bytes).expect("a folder that can be written");
        drop((dataset.read_times(), dataset.read_split(), dataset.cameras(SCENE), dataset.read_nodes(SCENE)));
        drop((dataset.table_projection(SCENE), dataset.projection_matrix(SCENE), dataset.meters_per_asset_unit(SCENE)));
        drop((dataset.read_frame_time(SCENE, CAMERA), dataset.rejected_views(SCENE, CAMERA)));
        drop((dataset.read_tone_maps(SCENE, CAMERA), dataset.read_instance_views(SCENE, CAMERA)));
        drop(dataset.mesh_files(SCENE).read_splits());
        drop(LabelTable::parse(bytes, "labels.csv"));
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
        drop((dataset.denoise_record(SCENE, CAMERA, 0), dataset.read_amodal_masks(SCENE, CAMERA, 0), dataset.read_stereo(SCENE, CAMERA)));
        drop((dataset.frame_numbers(SCENE, CAMERA), dataset.frame_is_complete(SCENE, CAMERA, 0, "c0ffee")));
        if let Ok(camera) = dataset.read_camera(SCENE, CAMERA) {
            let [width, height] = camera.size().map(f64::from);
            let _ = (camera.projection.ray(0.5 * width, 0.5 * height), camera.projection.ray(0.0, height));
            let _ = camera.projection.project(DVec3::new(0.3, 0.2, -1.0));
        }
    })
}
