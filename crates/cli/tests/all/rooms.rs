//! Rooms of scenes from files, and the planes of their pixels, on the command line.

use crate::common::{Lamp, fail, folder, scene, succeed, write_config, write_room};
use std::fs;
use std::path::Path;

/// The test room, its shell taken apart: a box of 4 x 3 x 2.5 m.
fn write_shell(d: &Path) {
    write_room(d, "room", Lamp::On);
    let whole = fs::read_to_string(d.join("room.obj")).unwrap();
    let (head, things) = whole.split_once("o table").unwrap();
    // Faces of the shell, in the order of the file: y is up there.
    let (corners, faces): (Vec<&str>, Vec<&str>) = head.lines().partition(|line| !line.starts_with("f "));
    let named = |face: &&&str| {
        let heights: Vec<&str> = face[2..]
            .split(' ')
            .map(|i| {
                corners.iter().filter(|c| c.starts_with("v ")).nth(i.parse::<usize>().unwrap() - 1).unwrap().split(' ').nth(2).unwrap()
            })
            .collect();
        if heights.iter().all(|y| *y == "0") {
            "floor"
        } else if heights.iter().all(|y| *y == "2.5") {
            "ceiling"
        } else {
            "walls"
        }
    };
    let mut obj = corners.iter().filter(|line| !line.starts_with("o ")).copied().collect::<Vec<_>>().join("\n");
    for object in ["floor", "ceiling", "walls"] {
        obj += &format!("\no {object}\nusemtl wall\n");
        obj += &faces.iter().filter(|face| named(face) == object).copied().collect::<Vec<_>>().join("\n");
    }
    fs::write(d.join("room.obj"), format!("{obj}\no table{things}")).unwrap();
    fs::write(d.join("labels.csv"), "part,nyu40_id,instance\nfloor,2,\nceiling,22,\nwalls,1,\ntable,7,1\n").unwrap();
}

#[test]
fn rooms_are_fitted_where_a_scene_has_none_and_go_with_its_labels() {
    let dir = folder();
    let d = dir.path();
    write_shell(d);
    write_config(d, &[scene("room") + "labels = \"labels.csv\"\n"]);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let detail = d.join("out/scenes/room/_detail");
    assert!(!detail.join("layout.json").exists());
    let text = succeed(d, &["make", "out", "rooms"]);
    assert!(
        text.contains("room: 1 room, 4 wall faces, 0 doors and windows, fitted: 100 %") && text.contains("planes of 3 frames"),
        "{text}"
    );
    let json: serde_json::Value = serde_json::from_slice(&fs::read(detail.join("layout.json")).unwrap()).unwrap();
    assert_eq!((&json["rooms"][0]["kind"], &json["fit"]["near_share"]), (&"dining".into(), &1.0.into()));
    assert!(fs::read_to_string(detail.join("layout.svg")).unwrap().contains("<svg"));
    assert_eq!(fs::read_to_string(detail.join("metadata_planes.csv")).unwrap().lines().count(), 1 + 6);
    assert!(detail.join("cam_00/planes/frame.0002.plane_id.hdf5").is_file());
    let text = succeed(d, &["verify", "out"]);
    assert!(text.contains("laws hold over 3 frames") && text.contains("pixels with a plane of the rooms"), "{text}");

    // Files derived from labels are removed when the labels change.
    fs::write(d.join("labels.csv"), "part,nyu40_id,instance\ntable,7,1\n").unwrap();
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    assert!(!detail.join("layout.json").exists() && !detail.join("metadata_planes.csv").exists() && !detail.join("cam_00/planes").exists());
    fail(d, &["make", "out", "rooms"], 1, &["no scene of out that was chosen has rooms", "enfilade suggest"]);
}
