//! Folders of exports, what they may replace, and the messages when they cannot be made.

use enfilade_dataset::Dataset;
use enfilade_export::{Existing, ExportConfig, Exported, Format, Selection, export};
use enfilade_frame::Layer;
use enfilade_scene::{Fisheye, Heard, Intrinsics, Projection, Quiet};
use std::fs;
use std::path::Path;

fn dataset(folder: &Path) -> Dataset {
    crate::common::write(&folder.join("dataset"), &crate::common::pinhole())
}

fn run(dataset: &Dataset, format: Format, out: &Path, existing: Existing) -> Result<Exported, String> {
    let config = ExportConfig::new(format, dataset.scenes().unwrap());
    export(dataset, &config, out, existing, &Quiet).map_err(|error| error.to_string())
}

fn select(dataset: &Dataset, selection: Selection, out: &Path) -> Result<Exported, String> {
    let config = ExportConfig { selection, ..ExportConfig::new(Format::Exr, Vec::new()) };
    export(dataset, &config, out, Existing::Refuse, &Quiet).map_err(|error| error.to_string())
}

#[test]
fn an_export_replaces_an_export_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let (dataset, out) = (dataset(folder.path()), folder.path().join("out"));
    run(&dataset, Format::Exr, &out, Existing::Refuse).unwrap();
    run(&dataset, Format::DepthPng, &out, Existing::Refuse).unwrap();
    assert!(out.join("room/cam_00/cameras.json").is_file() && !out.join("room/cam_00/frame.0000.exr").exists());
    let foreign = folder.path().join("foreign");
    fs::create_dir(&foreign).unwrap();
    run(&dataset, Format::DepthPng, &foreign, Existing::Refuse).unwrap();
    fs::remove_file(foreign.join("enfilade_export.json")).unwrap();
    let message = run(&dataset, Format::DepthPng, &foreign, Existing::Refuse).unwrap_err();
    assert!(message.contains("is no export") && message.contains("--force"), "{message}");
    fs::write(foreign.join("diary.txt"), "dear diary").unwrap();
    run(&dataset, Format::DepthPng, &foreign, Existing::SetAside).unwrap();
    assert_eq!(fs::read_to_string(folder.path().join("foreign.old/diary.txt")).unwrap(), "dear diary");
    assert!(!foreign.join("diary.txt").exists());
}

#[test]
fn what_holds_the_dataset_is_no_place_for_its_export() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    for out in [dataset.root().to_path_buf(), folder.path().to_path_buf(), dataset.layout().scene_dir("room")] {
        let message = run(&dataset, Format::DepthPng, &out, Existing::SetAside).unwrap_err();
        assert!(message.contains("choose another folder"), "{message}");
    }
    assert_eq!(dataset.frame_numbers("room", "cam_00").unwrap(), [0, 1, 3]);
}

#[test]
fn an_export_that_fails_leaves_the_one_before_it_and_no_trace() {
    let folder = tempfile::tempdir().unwrap();
    let (dataset, out) = (dataset(folder.path()), folder.path().join("out"));
    run(&dataset, Format::Scannet, &out, Existing::Refuse).unwrap();
    let before = crate::common::files(&out);
    let color = dataset.layout().layer("room", "cam_00", 3, Layer::Color);
    let length = fs::metadata(&color).unwrap().len() as usize;
    fs::write(&color, vec![0; length]).unwrap();
    let message = run(&dataset, Format::Scannet, &out, Existing::Refuse).unwrap_err();
    assert!(message.contains("frame.0003.color.hdf5"), "{message}");
    assert_eq!(crate::common::files(&out), before);
    let names: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names.len(), 2, "{names:?}");
    // What a killed program leaves is swept away by the next one.
    fs::create_dir_all(folder.path().join(".out.partial/rubbish")).unwrap();
    run(&dataset, Format::DepthPng, &out, Existing::Refuse).unwrap();
    assert!(!out.join("rubbish").exists() && !folder.path().join(".out.partial").exists());
}

#[test]
fn scenes_cameras_frames_and_layers_are_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let (dataset, out) = (dataset(folder.path()), folder.path().join("out"));
    let room = Selection { scenes: vec!["room".into()], ..Selection::default() };
    let one = Selection { cameras: Some(vec!["cam_00".into()]), frames: Some(1..3), layers: Some(vec![Layer::Semantic]), ..room.clone() };
    assert_eq!(select(&dataset, one, &out).unwrap().frames, 1);
    let names: Vec<_> = crate::common::files(&out).into_keys().filter(|name| name.extension().is_some_and(|e| e == "exr")).collect();
    assert_eq!(names, [Path::new("room/cam_00/frame.0001.exr")]);
    let message = select(&dataset, Selection { frames: Some(50..60), ..room.clone() }, &out).unwrap_err();
    assert!(message.contains("no finished frame") && message.contains("cam_00, cam_01"), "{message}");
    let config =
        ExportConfig { selection: Selection { layers: Some(vec![Layer::Color]), ..room }, ..ExportConfig::new(Format::Coco, Vec::new()) };
    let message = export(&dataset, &config, &out, Existing::Refuse, &Quiet).unwrap_err().to_string();
    assert_eq!(message, "coco needs the layer semantic_instance; add it to --layers");
}

#[test]
fn a_chosen_frame_that_lacks_a_file_is_left_out_with_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    for (camera, frame) in [("cam_00", 0), ("cam_00", 3), ("cam_01", 0)] {
        fs::remove_file(dataset.layout().layer("room", camera, frame, Layer::Position)).unwrap();
    }
    let said = |name: &str, frames: Option<std::ops::Range<u32>>| {
        let selection = Selection { scenes: vec!["room".into()], cameras: Some(vec!["cam_00".into()]), frames, layers: None };
        let config = ExportConfig { selection, ..ExportConfig::new(Format::Coco, Vec::new()) };
        let heard = Heard::default();
        assert_eq!(export(&dataset, &config, &folder.path().join(name), Existing::Refuse, &heard).unwrap().frames, 1);
        heard.lines()
    };
    let warnings = said("all", None);
    assert!(warnings.len() == 1 && warnings[0].starts_with("room/cam_00: frame 0 and 1 more are left out: "), "{warnings:?}");
    assert!(warnings[0].contains("frame.0000.position.hdf5: it is missing"), "{warnings:?}");
    assert!(said("some", Some(1..3)).is_empty());
}

#[test]
fn layers_that_are_not_of_the_cameras_size_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path());
    dataset.write_camera_parameters("room", &Intrinsics::from_fov_x(80, 60, 1.0).into()).unwrap();
    let message = run(&dataset, Format::DepthPng, &folder.path().join("out"), Existing::Refuse).unwrap_err();
    assert!(message.contains("its layers have 40x30 pixels, its camera 80x60"), "{message}");
}

#[test]
fn cameras_that_a_format_cannot_say_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let k = Intrinsics { width: 40, height: 30, fx: 20.0, fy: 20.0, cx: 20.0, cy: 15.0, skew: 0.0 };
    let fisheye = Projection::Fisheye(k, Fisheye::new([0.01, 0.0, 0.0, 0.0]).unwrap());
    let panorama = Projection::Equirectangular { width: 40, height: 20 };
    for (name, projection) in [("fisheye", fisheye), ("panorama", panorama)] {
        let dataset = crate::common::write(&folder.path().join(name), &projection.into());
        let out = |format: Format| folder.path().join(format!("{name}-{}", format.spec().name));
        for format in [Format::Coco, Format::Exr, Format::DepthPng, Format::Webdataset, Format::Croissant] {
            run(&dataset, format, &out(format), Existing::Refuse).unwrap();
        }
        let mut refused = vec![Format::Bop, Format::Scannet];
        match name {
            "fisheye" => [Format::Colmap, Format::ColmapText, Format::Nerfstudio].into_iter().for_each(|format| {
                run(&dataset, format, &out(format), Existing::Refuse).unwrap();
            }),
            _ => refused.extend([Format::Colmap, Format::Nerfstudio]),
        }
        for format in refused {
            let message = run(&dataset, format, &out(format), Existing::Refuse).unwrap_err();
            assert!(message.starts_with("room/cam_00 cannot be exported as") && message.contains("leave"), "{message}");
        }
    }
}
