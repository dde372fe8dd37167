//! Every format is read back by its own library, or by its rules, in Python, and compared with the dataset as h5py reads it.

use enfilade_dataset::hdf5::{Storage, write_array};
use enfilade_dataset::{Array, Dataset};
use enfilade_export::{CloudSource, Existing, ExportConfig, FORMATS, FormatSpec, export};
use enfilade_math::DMat3;
use enfilade_scene::{Fisheye, Intrinsics, Projection, Quiet, RadialTangential, TiltedPinhole};
use std::path::Path;
use std::process::Command;

const READERS: &str = include_str!("readers.py");

/// Prints what the reader found; fails when it found something wrong.
fn read_back(spec: &FormatSpec, dataset: &Path, out: &Path) {
    let Some(python) = std::env::var_os("ENFILADE_PYTHON") else {
        return eprintln!("{} skipped: ENFILADE_PYTHON names no python", spec.name);
    };
    let output = Command::new(python).args(["-c", READERS, spec.name]).args([dataset, out]).output().unwrap();
    let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(matches!(output.status.code(), Some(0 | 77)), "{}:\n{said}\n{errors}", spec.name);
    eprintln!("{} {}", spec.name, said.trim());
}

fn export_all(dataset: &Dataset, folder: &Path, formats: impl Iterator<Item = &'static FormatSpec>) {
    for spec in formats {
        let out = folder.join(spec.name);
        let mut config = ExportConfig::new(spec.format, dataset.scenes().unwrap());
        config.shard_bytes = 150_000; // a few samples
        config.cloud = CloudSource::Mesh; // frames show one side of the room
        export(dataset, &config, &out, Existing::Refuse, &Quiet).unwrap_or_else(|error| panic!("{error}"));
        read_back(spec, dataset.root(), &out);
    }
}

#[test]
fn every_format_says_what_the_dataset_says() {
    let folder = tempfile::tempdir().unwrap();
    for spec in &FORMATS {
        let dataset = crate::common::write(&folder.path().join("dataset").join(spec.name), &crate::common::pinhole_of(spec.format));
        export_all(&dataset, folder.path(), std::iter::once(spec));
    }
}

#[test]
fn a_tilted_image_plane_becomes_a_turned_pinhole() {
    let k = Intrinsics { width: 40, height: 30, fx: 33.0, fy: 33.0, cx: 19.0, cy: 16.0, skew: 0.0 };
    let tilted = TiltedPinhole::new(40, 30, DMat3::from_rotation_x(0.15) * k.cam_from_uv()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let dataset = crate::common::write(&folder.path().join("dataset"), &Projection::TiltedPinhole(tilted).into());
    export_all(
        &dataset,
        folder.path(),
        FORMATS.iter().filter(|spec| ["depth-png", "scannet", "bop", "webdataset", "huggingface", "euroc"].contains(&spec.name)),
    );
}

#[test]
fn distorted_pixels_are_where_colmap_puts_them() {
    let k = Intrinsics { width: 40, height: 30, fx: 33.0, fy: 33.5, cx: 19.0, cy: 16.0, skew: 0.0 };
    let radial = |coefficients: &[f64]| Projection::RadialTangential(k, RadialTangential::new(coefficients).unwrap());
    let models = [
        ("opencv", radial(&[-0.2, 0.05, 0.002, -0.001])),
        ("full", radial(&[-0.2, 0.05, 0.002, -0.001, 0.01, 0.02, -0.01, 0.003])),
        ("fisheye", Projection::Fisheye(k, Fisheye::new([-0.01, 0.002, -0.0003, 0.0]).unwrap())),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (name, projection) in models {
        let dataset = crate::common::write(&folder.path().join(name).join("dataset"), &projection.into());
        export_all(&dataset, &folder.path().join(name), FORMATS.iter().filter(|spec| ["colmap", "colmap-text"].contains(&spec.name)));
    }
}

#[test]
fn box_files_turn_the_axes_of_objects() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = crate::common::write(&folder.path().join("dataset"), &crate::common::pinhole());
    let (sin, cos) = 0.4f64.sin_cos();
    let (none, turned) = ([f64::INFINITY; 9], [cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0]);
    let arrays = [
        ("positions", vec![3, 3], [&none[..3], &[-0.1, 0.75, 0.3], &none[..3]].concat()),
        ("orientations", vec![3, 3, 3], [&none[..], &turned, &none].concat()),
        ("extents", vec![3, 3], [&none[..3], &[1.0, 0.8, 0.6], &none[..3]].concat()),
    ];
    for (scene, (what, shape, values)) in ["room", "room-two"].iter().flat_map(|scene| arrays.iter().map(move |array| (scene, array))) {
        let name = format!("metadata_semantic_instance_bounding_box_object_aligned_2d_{what}.hdf5");
        let array = Array::f64(shape, values.clone());
        write_array(&dataset.layout().mesh_file(scene, &name), &array, Storage::Contiguous, &[]).unwrap();
    }
    export_all(&dataset, folder.path(), FORMATS.iter().filter(|spec| spec.name == "bop"));
    let text = std::fs::read_to_string(folder.path().join("bop/train_pbr/000000/scene_gt.json")).unwrap();
    assert!(text.contains("\"obj_id\": 1") && !text.contains("\"obj_id\": 2"), "only instance 1 has a box: {text}");
    // Beside the world's axes, the table's box is as wide as its diagonal's shadow: (0.8 cos + 0.5 sin) m.
    let sizes = std::fs::read_to_string(folder.path().join("bop/models/models_info.json")).unwrap();
    let wide = format!("\"size_x\": {:.2}", 1000.0 * (0.8 * cos + 0.5 * sin));
    assert!(sizes.contains(&wide[..wide.len() - 1]), "{wide} in {sizes}");
}

#[test]
fn hypersims_own_frame_is_exported() {
    let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
        return eprintln!("skipped: ENFILADE_SCENES is not set");
    };
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::open(Path::new(&scenes).join("hypersim-real")).unwrap();
    let formats = ["depth-png", "scannet", "exr", "webdataset", "croissant", "opencv"];
    export_all(&dataset, folder.path(), FORMATS.iter().filter(|spec| formats.contains(&spec.name)));
}
