//! Every format is read back by its own library, or by its rules, in Python, and compared with the dataset as h5py reads it.

mod common;

use enfilade_dataset::Dataset;
use enfilade_export::{Existing, ExportConfig, FORMATS, FormatSpec, export};
use enfilade_math::DMat3;
use enfilade_scene::{Intrinsics, Projection, Quiet, TiltedPinhole};
use std::path::Path;
use std::process::Command;

const READERS: &str = include_str!("readers.py");

/// Says what the reader found; fails when it found something wrong.
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
        export(dataset, &config, &out, Existing::Refuse, &Quiet).unwrap_or_else(|error| panic!("{error}"));
        read_back(spec, dataset.root(), &out);
    }
}

#[test]
fn every_format_says_what_the_dataset_says() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = common::write(&folder.path().join("dataset"), &common::pinhole());
    export_all(&dataset, folder.path(), FORMATS.iter());
}

#[test]
fn a_tilted_image_plane_becomes_a_turned_pinhole() {
    let k = Intrinsics { width: 40, height: 30, fx: 33.0, fy: 33.0, cx: 19.0, cy: 16.0, skew: 0.0 };
    let tilted = TiltedPinhole::new(40, 30, DMat3::from_rotation_x(0.15) * k.cam_from_uv()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let dataset = common::write(&folder.path().join("dataset"), &Projection::TiltedPinhole(tilted).into());
    export_all(&dataset, folder.path(), FORMATS.iter().filter(|spec| ["depth-png", "scannet", "bop"].contains(&spec.name)));
}

#[test]
fn hypersims_own_frame_is_exported() {
    let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
        return eprintln!("skipped: ENFILADE_SCENES is not set");
    };
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::open(Path::new(&scenes).join("hypersim-real")).unwrap();
    let formats = ["depth-png", "scannet", "exr", "webdataset", "croissant"];
    export_all(&dataset, folder.path(), FORMATS.iter().filter(|spec| formats.contains(&spec.name)));
}
