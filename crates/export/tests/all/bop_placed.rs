//! BOP's export of objects that `[[object]]` placed.

use enfilade_dataset::mesh_names::VERTICES;
use enfilade_dataset::{Dataset, PartitionRow, PlacedObject, PlacedObjects, Side};
use enfilade_export::{Existing, ExportConfig, Format, SymmetryRule, export};
use enfilade_scene::{Heard, Quiet};
use serde_json::{Value, json};
use std::path::Path;
use std::process::Command;

const EVALUATION: &str = include_str!("bop_evaluation.py");

/// The room's table is 0.8 × 0.5 × 0.6 m about this point of the floor, its chair a cube of 0.4 m about this middle.
const TABLE: [f64; 3] = [-0.1, 0.75, 0.0];
const CHAIR: [f64; 3] = [0.8, 1.0, 0.2];

/// A pose turned by `quarters` of a full turn about z.
fn placed(name: &str, instance: i16, model: &str, [x, y, z]: [f64; 3], quarters: usize, is_distractor: bool) -> PlacedObject {
    let (cos, sin) = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][quarters];
    PlacedObject {
        name: name.into(),
        instance,
        semantic: 7,
        model: model.into(),
        scale: 2.5,
        world_from_model: [[cos, -sin, 0.0, x], [sin, cos, 0.0, y], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]],
        rests_on: "floor".into(),
        is_distractor,
        visible_share: 0.0,
    }
}

/// Two scenes: in the first the cube distracts, in the second it is a target, and the table is turned by half.
fn dataset(root: &Path) -> Dataset {
    let dataset = crate::common::write(root, &crate::common::pinhole());
    write_objects(&dataset, "room", vec![placed("table", 1, "block.glb", TABLE, 0, false), placed("chair", 2, "cube.glb", CHAIR, 0, true)]);
    write_objects(
        &dataset,
        "room-two",
        vec![placed("chair", 2, "cube.glb", CHAIR, 1, false), placed("table", 1, "block.glb", TABLE, 2, false)],
    );
    dataset
}

fn write_objects(dataset: &Dataset, scene: &str, objects: Vec<PlacedObject>) {
    dataset.write_placed_objects(scene, &PlacedObjects { solver: "test".into(), objects, missing: Vec::new() }).unwrap();
}

fn config(scenes: &[&str]) -> ExportConfig {
    ExportConfig::new(Format::Bop, scenes.iter().map(|scene| scene.to_string()).collect())
}

fn read(out: &Path, name: &str) -> Value {
    serde_json::from_slice(&std::fs::read(out.join(name)).unwrap()).unwrap()
}

/// Numbers of the objects in every image.
fn ids(out: &Path, folder: &str) -> Vec<Vec<u64>> {
    let truths = read(out, &format!("{folder}/scene_gt.json"));
    let of_image = |image: &Value| image.as_array().unwrap().iter().map(|one| one["obj_id"].as_u64().unwrap()).collect();
    truths.as_object().unwrap().values().map(of_image).collect()
}

/// Checks an export with Python; prints what it says.
fn judge(out: &Path) {
    let Some(python) = std::env::var_os("ENFILADE_PYTHON") else {
        return eprintln!("skipped: ENFILADE_PYTHON names no python");
    };
    let output = Command::new(python).args(["-c", EVALUATION]).arg(out).output().unwrap();
    let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(matches!(output.status.code(), Some(0 | 77)), "{said}\n{errors}");
    eprintln!("{}", said.trim());
}

#[test]
fn copies_of_a_model_are_one_object_and_distractors_none() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(&folder.path().join("dataset"));
    let row = |scene: &str, side| PartitionRow { scene: scene.into(), camera: "cam_00".into(), frame: 0, side: Ok(side) };
    dataset.write_partition(&[row("room", Side::Train), row("room-two", Side::Test)]).unwrap();
    let out = folder.path().join("out");
    export(&dataset, &config(&["room", "room-two"]), &out, Existing::Refuse, &Quiet).unwrap();
    let names = read(&out, "objects.json");
    assert_eq!(names, json!({"1": {"model": "block.glb", "scale": 2.5, "nyu40": 7}, "2": {"model": "cube.glb", "scale": 2.5, "nyu40": 7}}));
    // The cube of the first scene hides things, but has no entry.
    assert!(ids(&out, "train_pbr/000000").iter().all(|image| image == &[1]), "{:?}", ids(&out, "train_pbr/000000"));
    assert!(ids(&out, "test/000002").iter().any(|image| image == &[1, 2]));
    assert_eq!(read(&out, "scenes.json")["2"], json!({"scene": "room-two", "camera": "cam_00", "split": "test"}));
    let infos = read(&out, "models/models_info.json");
    let count = |id: &str| infos[id]["symmetries_discrete"].as_array().unwrap().len();
    assert_eq!((count("1"), count("2")), (3, 23), "a block has three half turns, a cube 23 rotations");
    assert_eq!((&infos["1"]["min_z"], &infos["1"]["symmetries_continuous"]), (&json!(0.0), &Value::Null));
    assert!((infos["2"]["min_x"].as_f64().unwrap() + 200.0).abs() < 1e-3, "{}", infos["2"]);
    assert!(std::fs::read_to_string(out.join("README.md")).unwrap().contains("models_eval"));
    judge(&out);
}

#[test]
fn poses_are_the_recorded_ones() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(&folder.path().join("dataset"));
    let out = folder.path().join("out");
    export(&dataset, &config(&["room-two"]), &out, Existing::Refuse, &Quiet).unwrap();
    let (camera, truths) = (read(&out, "train_pbr/000000/scene_camera.json"), read(&out, "train_pbr/000000/scene_gt.json"));
    let numbers = |value: &Value| value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect::<Vec<f64>>();
    for (frame, camera) in camera.as_object().unwrap() {
        let (r, t) = (numbers(&camera["cam_R_w2c"]), numbers(&camera["cam_t_w2c"]));
        // Half a turn about z changes the signs of the first two columns.
        let (found, moved) = (numbers(&truths[frame][0]["cam_R_m2c"]), numbers(&truths[frame][0]["cam_t_m2c"]));
        for row in 0..3 {
            for (column, sign) in [-1.0, -1.0, 1.0].into_iter().enumerate() {
                assert!((found[3 * row + column] - sign * r[3 * row + column]).abs() < 1e-12);
            }
            let expected = t[row] + (0..3).map(|k| r[3 * row + k] * 1000.0 * TABLE[k]).sum::<f64>();
            assert!((moved[row] - expected).abs() < 1e-9, "{moved:?}");
        }
    }
}

#[test]
fn numbers_are_the_same_when_scenes_are_exported_apart() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(&folder.path().join("dataset"));
    let (one, all) = (folder.path().join("one"), folder.path().join("all"));
    export(&dataset, &config(&["room"]), &one, Existing::Refuse, &Quiet).unwrap();
    export(&dataset, &config(&["room", "room-two"]), &all, Existing::Refuse, &Quiet).unwrap();
    for name in ["objects.json", "models/models_info.json", "models/obj_000002.ply", "models_eval/obj_000001.ply"] {
        assert_eq!(std::fs::read(one.join(name)).unwrap(), std::fs::read(all.join(name)).unwrap(), "{name}");
    }
    judge(&one);
    // A scene that is not finished has numbers, but no models.
    std::fs::remove_file(dataset.layout().mesh_file("room-two", VERTICES)).unwrap();
    export(&dataset, &config(&["room"]), &folder.path().join("early"), Existing::Refuse, &Quiet).unwrap();
    assert_eq!(read(&folder.path().join("early"), "objects.json"), json!({"1": read(&one, "objects.json")["1"]}));
}

#[test]
fn a_scene_without_placed_objects_has_images_and_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(&folder.path().join("dataset"));
    std::fs::remove_file(dataset.layout().placed_objects("room-two")).unwrap();
    let (out, heard) = (folder.path().join("out"), Heard::default());
    let without = ExportConfig { symmetries: SymmetryRule::None, ..config(&["room", "room-two"]) };
    export(&dataset, &without, &out, Existing::Refuse, &heard).unwrap();
    assert!(heard.lines().iter().any(|line| line.contains("room-two") && line.contains("without poses")));
    assert!(ids(&out, "train_pbr/000002").iter().all(Vec::is_empty));
    assert_eq!(read(&out, "models/models_info.json")["1"]["symmetries_discrete"], Value::Null);
}

#[test]
fn poses_and_labels_that_do_not_belong_together_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(&folder.path().join("dataset"));
    let refused = |object: PlacedObject| {
        write_objects(&dataset, "room-two", vec![object]);
        export(&dataset, &config(&["room", "room-two"]), &folder.path().join("out"), Existing::Refuse, &Quiet).unwrap_err().to_string()
    };
    let moved = [TABLE[0], TABLE[1] + 0.1, TABLE[2]];
    let error = refused(placed("table", 1, "block.glb", moved, 0, false));
    assert!(error.contains("room-two: object \"table\"") && error.contains("bounds 100.0 mm off"), "{error}");
    let error = refused(placed("table", 7, "block.glb", TABLE, 0, false));
    assert!(error.contains("no triangles of the scene have its instance number, 7"), "{error}");
    let mut scaled = placed("table", 1, "block.glb", TABLE, 0, false);
    scaled.world_from_model[0][0] = 2.0;
    assert!(refused(scaled).contains("no rotation with a shift"));
}
