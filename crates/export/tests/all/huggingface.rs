//! Sides of the partition become splits of the Parquet files, and nothing is left out in silence.

use crate::common;
use enfilade_dataset::{Dataset, PartitionRow, Side};
use enfilade_export::{Existing, ExportConfig, ExportError, Exported, Format, export};
use enfilade_scene::Heard;
use std::path::Path;

fn written(dataset: &Dataset, out: &Path, heard: &Heard) -> Result<Exported, ExportError> {
    export(dataset, &ExportConfig::new(Format::Huggingface, dataset.scenes().unwrap()), out, Existing::Refuse, heard)
}

/// Puts every frame of the dataset on the side that `side` returns.
fn divide(dataset: &Dataset, side: impl Fn(&str) -> Option<Side>) {
    let mut rows = Vec::new();
    for scene in dataset.scenes().unwrap() {
        for camera in dataset.cameras(&scene).unwrap() {
            for frame in dataset.frame_numbers(&scene, &camera).unwrap() {
                let row = |partition| PartitionRow { scene: scene.clone(), camera: camera.clone(), frame, side: Ok(partition) };
                rows.extend(side(&scene).map(row));
            }
        }
    }
    dataset.write_partition(&rows).unwrap();
}

#[test]
fn sides_become_splits_and_what_is_on_none_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = common::write(&folder.path().join("dataset"), &common::pinhole());
    let out = folder.path().join("out");
    let has = |name: &str| out.join("data").join(name).is_file();
    let card = || std::fs::read_to_string(out.join("README.md")).unwrap();

    let heard = Heard::default();
    divide(&dataset, |scene| Some(if scene == "room" { Side::Val } else { Side::Test }));
    let whole = written(&dataset, &out, &heard).unwrap();
    assert!(has("validation-00000.parquet") && has("test-00000.parquet") && !has("train-00000.parquet"));
    assert!(card().starts_with("---\n") && card().contains("- split: validation\n    path: data/validation-*"), "{}", card());
    assert!(
        card().contains("load_dataset(\"this-folder\", split=\"validation\")"),
        "the example of a card loads what is there: {}",
        card()
    );
    assert_eq!(heard.lines(), Vec::<String>::new());

    divide(&dataset, |scene| (scene == "room").then_some(Side::Train));
    written(&dataset, &out, &heard).unwrap();
    assert!(has("train-00000.parquet") && !has("test-00000.parquet"));
    assert!(heard.lines()[0].contains("are on no side of the partition and left out"), "{:?}", heard.lines());

    divide(&dataset, |_| None);
    let error = written(&dataset, &out, &heard).unwrap_err();
    assert!(error.is_usage() && error.to_string().contains("divide again: enfilade partition"), "{error}");
    assert!(whole.frames > 1);
}
