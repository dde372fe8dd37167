//! BOP's export of hidden and truncated parts of objects.

use enfilade_dataset::mesh_names::{OBJECTS_INSTANCE, VERTICES};
use enfilade_dataset::{AmodalMask, AmodalMasks, Dataset, InstanceView, PixelArea};
use enfilade_export::{Existing, ExportConfig, Format, export};
use enfilade_frame::Layer;
use enfilade_label::instances::visible_areas;
use enfilade_scene::{Labels, PartLabel, Quiet};
use serde_json::{Value, json};
use std::path::Path;

const SIZE: [u32; 2] = [40, 30];

/// Writes what `boxes` would have found if the table were seen in the first frame with `visible` pixels, filled the image up to column
/// `right`, and reached as far again beyond its left border.
fn write_whole(dataset: &Dataset, visible: PixelArea, right: u32) {
    let [width, height] = SIZE;
    let inside = right * height;
    let full = PixelArea { pixels: 2 * u64::from(inside), bounds: [-(right as i32), 0, right as i32, height as i32] };
    let view = InstanceView { frame: 0, instance: 1, semantic: 7, visible, full, inside_pixels: inside.into() };
    dataset.write_instance_views("room", "cam_00", &[view]).unwrap();
    let mask = AmodalMask { semantic_instance_id: 1, counts: vec![0, inside, width * height - inside] };
    dataset.write_amodal_masks("room", "cam_00", 0, &AmodalMasks { size: [height, width], instances: vec![mask] }).unwrap();
}

/// The exported entries of the instances in each image of the first camera.
fn exported(dataset: &Dataset, out: &Path) -> Value {
    export(dataset, &ExportConfig::new(Format::Bop, vec!["room".into()]), out, Existing::Refuse, &Quiet).unwrap();
    serde_json::from_slice(&std::fs::read(out.join("train_pbr/000000/scene_gt_info.json")).unwrap()).unwrap()
}

/// Whether a condition is true for every pixel of a grey picture, by column, row and value.
fn holds(out: &Path, name: &str, test: impl Fn(u32, u32, u16) -> bool) -> bool {
    let picture = image::open(out.join("train_pbr/000000").join(name)).unwrap().into_luma16();
    picture.dimensions() == (SIZE[0], SIZE[1]) && picture.enumerate_pixels().all(|(x, y, pixel)| test(x, y, pixel.0[0]))
}

#[test]
fn an_object_half_hidden_is_told_whole_where_the_dataset_knows_it() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = crate::common::write(&folder.path().join("dataset"), &crate::common::pinhole());
    let labels = crate::common::layer(&dataset, "room", "cam_00", 0, Layer::SemanticInstance);
    let visible = visible_areas(&labels, SIZE[0])[&1];
    let right = visible.bounds[2] as u32;
    write_whole(&dataset, visible, right);
    let out = folder.path().join("out");
    let infos = exported(&dataset, &out);
    let (table, chair) = (&infos["0"][0], &infos["0"][1]);
    assert_eq!(table["px_count_all"], json!(60 * right));
    assert_eq!(table["px_count_visib"], json!(visible.pixels));
    assert_eq!(table["visib_fract"], json!(visible.pixels as f64 / f64::from(60 * right)));
    assert_eq!(table["bbox_obj"], json!([-i64::from(right), 0, 2 * right - 1, 29]));
    let [left, upper, _, lower] = visible.bounds;
    assert_eq!(table["bbox_visib"], json!([left, upper, right as i32 - 1 - left, lower - 1 - upper]));
    let is_white = |inside: bool, value: u16| value == if inside { u16::MAX } else { 0 };
    assert!(holds(&out, "mask/000000_000000.png", |x, _, value| is_white(x < right, value)));
    assert!(holds(&out, "mask_visib/000000_000000.png", |x, y, value| is_white(labels.get((y * SIZE[0] + x) as usize) == 1.0, value)));
    let depth = image::open(out.join("train_pbr/000000/depth/000000.png")).unwrap().into_luma16();
    let valid = depth.enumerate_pixels().filter(|(x, _, depth)| *x < right && depth.0[0] > 0).count();
    assert_eq!(table["px_count_valid"], json!(valid));
    // Nothing is known of the chair, nor of other frames.
    for info in [chair, &infos["1"][0], &infos["3"][0]] {
        assert_eq!(
            (&info["visib_fract"], &info["px_count_all"], &info["bbox_obj"]),
            (&json!(1.0), &info["px_count_visib"], &info["bbox_visib"])
        );
    }
}

#[test]
fn what_was_found_of_other_labels_is_not_taken_for_these() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = crate::common::write(&folder.path().join("dataset"), &crate::common::pinhole());
    write_whole(&dataset, PixelArea::default().with(3, 4), 20);
    let infos = exported(&dataset, &folder.path().join("out"));
    assert_eq!((&infos["0"][0]["visib_fract"], &infos["0"][0]["bbox_obj"]), (&json!(1.0), &infos["0"][0]["bbox_visib"]));
}

#[test]
fn a_scene_without_labels_is_to_be_labelled() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |dataset: &Dataset| {
        let config = ExportConfig::new(Format::Bop, vec!["room".into()]);
        export(dataset, &config, &folder.path().join("out"), Existing::Refuse, &Quiet).unwrap_err().to_string()
    };
    let expected = "room cannot be exported as bop: no part of it is labelled as an instance, so poses of objects are not known; label it";
    let dataset = crate::common::write(&folder.path().join("never_labelled"), &crate::common::pinhole());
    std::fs::remove_file(dataset.layout().mesh_file("room", OBJECTS_INSTANCE)).unwrap();
    assert!(refused(&dataset).contains(expected), "{}", refused(&dataset));
    let dataset = crate::common::write(&folder.path().join("without_instances"), &crate::common::pinhole());
    let parts = dataset.read_label_tables("room").unwrap().parts.len();
    dataset.write_label_tables("room", &Labels { parts: vec![PartLabel::NONE; parts] }).unwrap();
    assert!(refused(&dataset).contains(expected), "{}", refused(&dataset));
    // Hypersim's public files have labels of pixels, but no mesh.
    let dataset = crate::common::write(&folder.path().join("without_mesh"), &crate::common::pinhole());
    std::fs::remove_file(dataset.layout().mesh_file("room", VERTICES)).unwrap();
    let expected =
        "it has neither box files nor a mesh (mesh_vertices.hdf5 is missing in _detail/mesh), so poses of objects are not known; add one";
    assert!(refused(&dataset).contains(expected), "{}", refused(&dataset));
}
