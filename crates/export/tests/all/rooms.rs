//! The rooms of buildings, exported and read back: Structured3D's files by our importer, which is made from its own description.

use crate::common::write;
use enfilade_dataset::{Dataset, PartitionRow, Side};
use enfilade_export::{CloudSource, Existing, ExportConfig, Format, export};
use enfilade_home::{FloorPlan, RoomKind};
use enfilade_import::{ImportOptions, load};
use enfilade_math::{Rng, Vec3};
use enfilade_scene::{Heard, Part, Quiet, Rooms, Scene, WallOpening};
use std::path::{Path, PathBuf};

fn home(seed: u64) -> Rooms {
    FloorPlan::new(&[RoomKind::Living, RoomKind::Kitchen, RoomKind::Hall, RoomKind::Bathroom], &Rng::new(seed)).to_rooms()
}

fn exported(folder: &Path, format: Format, rooms: Option<&Rooms>) -> Result<PathBuf, String> {
    let dataset: Dataset = write(&folder.join("dataset"), &crate::common::pinhole());
    let layout = dataset.layout();
    match rooms {
        Some(rooms) => dataset.write_rooms("room", rooms).unwrap(),
        None => std::fs::remove_file(layout.rooms("room")).unwrap(),
    }
    let out = folder.join("out");
    let config = ExportConfig::new(format, vec!["room".into()]);
    export(&dataset, &config, &out, Existing::Refuse, &Quiet).map(|_| out).map_err(|error| error.to_string())
}

/// Area of the floors, and of the walls without what opens in them.
fn areas(rooms: &Rooms) -> [f64; 2] {
    let holes: f64 = rooms.openings.iter().map(|o| o.walls.len() as f64 * o.size_m().iter().product::<f64>()).sum();
    let walls: f64 = rooms.walls.iter().map(|wall| wall.length_m() * (wall.ceiling_z_m - wall.floor_z_m)).sum();
    [rooms.outlines.iter().map(|room| room.area_m2()).sum(), walls - holes]
}

fn area(scene: &Scene, part: &Part) -> f64 {
    let corners: Vec<Vec3> = scene.world_positions(part).collect();
    let of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| corners[i as usize].as_dvec3());
        0.5 * (b - a).cross(c - a).length()
    };
    scene.meshes[part.mesh as usize].triangles.iter().map(of).sum()
}

#[test]
fn structured3ds_planes_have_the_areas_of_the_home_and_face_into_its_rooms() {
    for seed in [3, 4] {
        let rooms = home(seed);
        let folder = tempfile::tempdir().unwrap();
        let out = exported(folder.path(), Format::Structured3d, Some(&rooms)).unwrap();
        let imported = load(&out.join("scene_00000/annotation_3d.json"), &ImportOptions::default(), &Quiet).unwrap();
        let mut found = [0.0; 2];
        for label in imported.labels.iter().flatten() {
            let part = &imported.scene.parts[label.part as usize];
            if part.name.starts_with("outwall") {
                continue;
            }
            let place = match label.label.semantic {
                2 => 0,
                1 => 1,
                _ => continue, // reveals
            };
            found[place] += area(&imported.scene, part);
        }
        let expected = areas(&rooms);
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-3 * expected, "seed {seed}: {found} m2, expected {expected}");
        }
    }
}

#[test]
fn plans_read_from_exports_are_those_of_the_home() {
    for (format, file) in [(Format::Structured3d, "scene_00000/annotation_3d.json"), (Format::Spatiallm, "layout/room.txt")] {
        let rooms = home(3);
        let folder = tempfile::tempdir().unwrap();
        let dataset: Dataset = write(&folder.path().join("dataset"), &crate::common::pinhole());
        dataset.write_rooms("room", &rooms).unwrap();
        let config = ExportConfig { cloud: CloudSource::Mesh, ..ExportConfig::new(format, vec!["room".into()]) };
        let out = folder.path().join("out");
        export(&dataset, &config, &out, Existing::Refuse, &Quiet).unwrap();
        let bytes = std::fs::read(out.join(file)).unwrap();
        let drawn = enfilade_import::read_plan(&bytes, &out.join(file)).unwrap();
        let (plan, notes) = FloorPlan::drawn(&drawn, &Rng::new(1)).unwrap();
        let again = plan.to_rooms();
        for (a, b) in again.outlines.iter().zip(&rooms.outlines) {
            assert!((a.area_m2() - b.area_m2()).abs() < 1e-3, "{format:?}: {a:?}, expected {b:?}");
            assert!((a.ceiling_z_m - b.ceiling_z_m).abs() < 1e-3, "{format:?}");
        }
        assert_eq!((again.outlines.len(), again.openings.len()), (rooms.outlines.len(), rooms.openings.len()), "{format:?}: {notes:#?}");
        for opening in &rooms.openings {
            let same = |other: &&WallOpening| {
                let apart = other.center().distance(opening.center());
                apart < 0.4 && other.size_m().iter().zip(opening.size_m()).all(|(a, b)| (a - b).abs() < 0.02)
            };
            assert!(again.openings.iter().any(|other| same(&other)), "{format:?}: no {opening:?} in {:#?}\n{notes:#?}", again.openings);
        }
    }
}

#[test]
fn rooms_that_frames_do_not_show_are_left_out() {
    let folder = tempfile::tempdir().unwrap();
    // The frames look to one side of the room.
    let room = folder.path().join("room");
    let dataset = write(&room.join("dataset"), &crate::common::pinhole());
    let mut config = ExportConfig::new(Format::Spatiallm, vec!["room".into()]);
    let heard = Heard::default();
    let error = export(&dataset, &config, &room.join("out"), Existing::Refuse, &heard).unwrap_err();
    assert!(error.is_usage() && error.to_string().contains("--cloud mesh"), "{error}");
    assert!(heard.lines()[0].contains("1 of 1 rooms are left out, among them study_1"), "{:?}", heard.lines());

    config.cloud = CloudSource::Mesh;
    export(&dataset, &config, &room.join("out"), Existing::Refuse, &heard).unwrap();
    let layout = std::fs::read_to_string(room.join("out/layout/room.txt")).unwrap();
    assert_eq!(
        ["wall_", "door_", "window_", "bbox_"].map(|word| layout.lines().filter(|line| line.starts_with(word)).count()),
        [4, 1, 1, 2]
    );
    assert_eq!(std::fs::read_to_string(room.join("out/split.csv")).unwrap(), "id,split\nroom,train\n");
}

#[test]
fn numbers_of_structured3d_say_the_side_and_its_lists_know_every_word() {
    let folder = tempfile::tempdir().unwrap();
    let dataset: Dataset = write(&folder.path().join("dataset"), &crate::common::pinhole());
    let mut rooms = dataset.read_rooms("room").unwrap().unwrap();
    rooms.outlines[0].kind = "childrens".into();
    dataset.write_rooms("room", &rooms).unwrap();
    let row = |scene: &str, partition| PartitionRow { scene: scene.into(), camera: "cam_00".into(), frame: 0, side: Ok(partition) };
    dataset.write_partition(&[row("room", Side::Test), row("room-two", Side::Train)]).unwrap();
    let out = folder.path().join("out");
    export(&dataset, &ExportConfig::new(Format::Structured3d, dataset.scenes().unwrap()), &out, Existing::Refuse, &Quiet).unwrap();
    // RoomFormer: train below 3000, val below 3250, test from there on.
    assert_eq!(std::fs::read_to_string(out.join("scenes.csv")).unwrap(), "folder,scene\nscene_03250,room\nscene_00000,room-two\n");
    let text = std::fs::read_to_string(out.join("scene_03250/annotation_3d.json")).unwrap();
    let annotation: serde_json::Value = serde_json::from_str(&text).unwrap();
    let types: Vec<&str> = annotation["semantics"].as_array().unwrap().iter().map(|s| s["type"].as_str().unwrap()).collect();
    assert_eq!(types, ["bedroom", "door", "window", "outwall"]);
    // The room is 4 x 5 m with walls of 30 cm: its outer sides are 4.6 and 5.6 m long.
    let outer = annotation["semantics"][3]["planeID"].as_array().unwrap().len();
    assert_eq!(outer, 4);
    assert!(out.join("scene_03250/bbox_3d.json").is_file() && out.join("scene_03250/point_cloud.ply").is_file());
}

#[test]
fn a_scene_without_rooms_is_refused_by_name() {
    for format in [Format::Spatiallm, Format::Structured3d] {
        let folder = tempfile::tempdir().unwrap();
        let message = exported(folder.path(), format, None).unwrap_err();
        assert!(
            message.contains("room")
                && message.contains("_detail/layout.json")
                && message.contains("enfilade make ")
                && message.contains(" rooms`"),
            "{message}"
        );
    }
}
