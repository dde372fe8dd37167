//! Frames that lack a layer, or whose files were cut short by a download, are left out, and the others are exported.

use crate::common::{files, pinhole_of, write};
use enfilade_dataset::Dataset;
use enfilade_export::{CloudSource, Existing, ExportConfig, FORMATS, Format, export};
use enfilade_frame::{Layer, Values};
use enfilade_scene::{Heard, PartLabel, Quiet};
use std::path::Path;

/// The dataset as Hypersim's are: without records.
fn released(root: &Path, format: Format) -> Dataset {
    let dataset = write(root, &pinhole_of(format));
    for scene in dataset.scenes().unwrap() {
        for camera in dataset.cameras(&scene).unwrap() {
            std::fs::remove_dir_all(dataset.layout().records_dir(&scene, &camera)).unwrap();
        }
    }
    dataset
}

#[test]
fn a_frame_without_geometry_is_left_out_of_formats_that_need_it() {
    for spec in &FORMATS {
        let folder = tempfile::tempdir().unwrap();
        let dataset = released(&folder.path().join("dataset"), spec.format);
        for layer in
            [Layer::DepthMeters, Layer::DepthZMeters, Layer::SemanticInstance, Layer::Semantic, Layer::RenderEntityId, Layer::Position]
        {
            std::fs::remove_file(dataset.layout().layer("room", "cam_00", 1, layer)).unwrap();
        }
        let heard = Heard::default();
        let out = folder.path().join("out");
        // The few frames do not show a room to all its walls, which point clouds for layouts ask for.
        let config = ExportConfig { cloud: CloudSource::Mesh, ..ExportConfig::new(spec.format, dataset.scenes().unwrap()) };
        export(&dataset, &config, &out, Existing::Refuse, &heard).unwrap();
        let told = heard.lines().iter().any(|line| line.contains("room/cam_00 frame 1 is left out: no layer"));
        let needs_it = spec.needs.iter().any(|group| !group.contains(&Layer::Color));
        assert_eq!(told, needs_it, "{}: {:?}", spec.name, heard.lines());
        assert!(!files(&out).is_empty());
    }
}

#[test]
fn a_file_that_is_cut_short_takes_its_frame_with_it() {
    for format in [Format::Exr, Format::Webdataset, Format::Coco] {
        let folder = tempfile::tempdir().unwrap();
        let dataset = released(&folder.path().join("dataset"), format);
        for frame in [1, 3] {
            let path = dataset.layout().layer("room", "cam_00", frame, Layer::Color);
            let bytes = std::fs::read(&path).unwrap();
            std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
        }
        let heard = Heard::default();
        let config = ExportConfig::new(format, dataset.scenes().unwrap());
        export(&dataset, &config, &folder.path().join("out"), Existing::Refuse, &heard).unwrap();
        let messages = heard.lines();
        let told =
            messages.iter().filter(|message| message.contains("frame 1 and 1 more are left out") && message.contains("is cut short"));
        assert_eq!(told.count(), 1, "{messages:?}");
    }
}

#[test]
fn where_no_frame_has_what_is_needed_the_error_says_what() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = released(&folder.path().join("dataset"), Format::Coco);
    for scene in dataset.scenes().unwrap() {
        for camera in dataset.cameras(&scene).unwrap() {
            for frame in dataset.frame_numbers(&scene, &camera).unwrap() {
                std::fs::remove_file(dataset.layout().layer(&scene, &camera, frame, Layer::SemanticInstance)).unwrap();
            }
        }
    }
    let config = ExportConfig::new(Format::Coco, dataset.scenes().unwrap());
    let error = export(&dataset, &config, &folder.path().join("out"), Existing::Refuse, &Quiet).unwrap_err().to_string();
    assert!(error.contains("room/cam_00 frame 0") && error.contains("no layer semantic_instance; make it (label"), "{error}");
}

/// Takes the instances from tables and frames of the dataset, and the classes too where `classes` is false.
fn without_instances(dataset: &Dataset, classes: bool) {
    let taken = |label: &mut PartLabel| *label = PartLabel { semantic: if classes { label.semantic } else { -1 }, instance: -1 };
    for scene in dataset.scenes().unwrap() {
        let mut labels = dataset.read_label_tables(&scene).unwrap();
        labels.parts.iter_mut().for_each(taken);
        dataset.write_label_tables(&scene, &labels).unwrap();
        for camera in dataset.cameras(&scene).unwrap() {
            for frame in dataset.frame_numbers(&scene, &camera).unwrap() {
                let mut layers = dataset.read_frame(&scene, &camera, frame, &[Layer::Semantic, Layer::SemanticInstance]).unwrap();
                let none = Values::I16(vec![-1; layers.pixels()]);
                if !classes {
                    layers.insert(Layer::Semantic, none.clone());
                }
                layers.insert(Layer::SemanticInstance, none);
                dataset.write_label_layers(&scene, &camera, frame, &layers, "annotated").unwrap();
            }
        }
    }
}

#[test]
fn an_export_of_instances_that_finds_none_says_so_and_why() {
    for format in [Format::Coco, Format::Panoptic, Format::Scannet] {
        let folder = tempfile::tempdir().unwrap();
        let dataset = write(&folder.path().join("dataset"), &pinhole_of(format));
        let told = |out: &str| {
            let heard = Heard::default();
            let config = ExportConfig::new(format, dataset.scenes().unwrap());
            export(&dataset, &config, &folder.path().join(out), Existing::Refuse, &heard).unwrap();
            heard.lines().into_iter().filter(|line| line.contains("the export has no instance")).collect::<Vec<_>>()
        };
        assert!(told("labelled").is_empty(), "{format:?}");
        // Of both scenes four parts, a floor, a wall, a table and a chair.
        without_instances(&dataset, true);
        let classed = told("classed");
        assert!(classed.len() == 1 && classed[0].contains("8 parts have a class and none is an instance"), "{format:?}: {classed:?}");
        without_instances(&dataset, false);
        let bare = told("bare");
        assert!(bare.len() == 1 && bare[0].contains("no part has a label; name a label table"), "{format:?}: {bare:?}");
    }
}
