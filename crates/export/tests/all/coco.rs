//! COCO's categories: NYU40, or the list that scenes were annotated with.

use enfilade_dataset::{Dataset, LabelColors, write_bytes};
use enfilade_export::{Existing, ExportConfig, ExportError, Format, export};
use enfilade_frame::{Layer, Values};
use enfilade_scene::Quiet;
use serde_json::{Value, json};
use std::path::Path;

/// Class that chairs are changed to: beyond the numbers of NYU40.
const HARP: i16 = 77;

fn with_harp(class: i16) -> i16 {
    if class == 5 { HARP } else { class }
}

/// Annotates a scene with a list of its own: tables, list, and labels of the frames.
fn annotate(dataset: &Dataset, scene: &str, list: &str) {
    let mut labels = dataset.read_label_tables(scene).unwrap();
    labels.parts.iter_mut().for_each(|label| label.semantic = with_harp(label.semantic));
    let files = dataset.mesh_files(scene);
    let colors = LabelColors { semantic: vec![[9; 3]; HARP as usize + 1], instances: 2 };
    files.write_labels(&labels, &colors).unwrap();
    let header = "semantic_id,semantic_name,semantic_color_r,semantic_color_g,semantic_color_b";
    write_bytes(&files.file("semantic_label_descs.csv"), format!("{header}\n{list}")).unwrap();
    for camera in dataset.cameras(scene).unwrap() {
        for frame in dataset.frame_numbers(scene, &camera).unwrap() {
            let mut layers = dataset.read_frame(scene, &camera, frame, &[Layer::Semantic, Layer::SemanticInstance]).unwrap();
            let Some(Values::I16(classes)) = layers.get(Layer::Semantic) else { panic!("not int16") };
            let classes = classes.iter().map(|&class| with_harp(class)).collect();
            layers.insert(Layer::Semantic, Values::I16(classes));
            dataset.write_label_layers(scene, &camera, frame, &layers, "annotated").unwrap();
        }
    }
}

fn exported(dataset: &Dataset, out: &Path) -> Result<Value, ExportError> {
    export(dataset, &ExportConfig::new(Format::Coco, dataset.scenes()?), out, Existing::Refuse, &Quiet)?;
    Ok(serde_json::from_slice(&std::fs::read(out.join("annotations/instances.json")).unwrap()).unwrap())
}

/// Categories in use, ascending.
fn used(file: &Value) -> Vec<i64> {
    let mut used: Vec<i64> = file["annotations"].as_array().unwrap().iter().map(|a| a["category_id"].as_i64().unwrap()).collect();
    used.sort_unstable();
    used.dedup();
    used
}

#[test]
fn categories_are_those_of_the_list_that_scenes_were_annotated_with() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = crate::common::write(&folder.path().join("dataset"), &crate::common::pinhole());
    let before = exported(&dataset, &folder.path().join("before")).unwrap();
    assert_eq!((before["categories"].as_array().unwrap().len(), used(&before)), (40, vec![5, 7]));
    let list = "7,desk,1,2,3\n1,wall,1,2,3\n77,\"harp, gilded\",1,2,3\n";
    ["room", "room-two"].iter().for_each(|scene| annotate(&dataset, scene, list));
    let file = exported(&dataset, &folder.path().join("after")).unwrap();
    let expected = json!([
        { "id": 1, "name": "wall", "supercategory": "stuff" },
        { "id": 7, "name": "desk", "supercategory": "thing" },
        { "id": 77, "name": "harp, gilded", "supercategory": "thing" },
    ]);
    assert_eq!((&file["categories"], used(&file)), (&expected, vec![7, 77]));
}

#[test]
fn scenes_of_different_lists_do_not_share_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = crate::common::write(&folder.path().join("dataset"), &crate::common::pinhole());
    annotate(&dataset, "room-two", "7,desk,1,2,3\n77,harp,1,2,3\n");
    let message = exported(&dataset, &folder.path().join("out")).unwrap_err().to_string();
    assert!(message.contains("room-two") && message.contains("\"room\"") && message.contains("--scene"), "{message}");
}

#[test]
fn a_list_that_labels_were_not_made_from_is_left_over() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = crate::common::write(&folder.path().join("dataset"), &crate::common::pinhole());
    let path = dataset.mesh_files("room").file("semantic_label_descs.csv");
    let header = "semantic_id,semantic_name,semantic_color_r,semantic_color_g,semantic_color_b";
    write_bytes(&path, format!("{header}\n7,desk,1,2,3\n77,harp,1,2,3\n")).unwrap();
    assert_eq!(exported(&dataset, &folder.path().join("out")).unwrap()["categories"].as_array().unwrap().len(), 40);
    write_bytes(&path, "semantic_id,name\n7,desk\n").unwrap();
    let message = exported(&dataset, &folder.path().join("bad")).unwrap_err().to_string();
    assert!(message.contains("semantic_label_descs.csv") && message.contains("semantic_name"), "{message}");
}
