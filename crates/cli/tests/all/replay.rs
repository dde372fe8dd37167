//! A frame is rendered again from its record to the same bytes, and when it cannot be, the message says why.

use crate::common::{Lamp, assert_same, contents, fail, folder, scene, succeed, write_config, write_room};
use std::fs;
use std::path::{Path, PathBuf};

const RECORD: &str = "out/scenes/room/_detail/cam_00/frames/frame.0001.json";

fn dataset(d: &Path, flags: &[&str]) {
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &[&["run", "dataset.toml", "-o", "out", "--color", "rendered"], flags].concat());
}

fn layers(root: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = root.join("scenes/room/images/scene_cam_00_final_hdf5");
    let names = ["color", "diffuse_illumination", "specular"].map(|name| folder.join(format!("frame.0001.{name}.hdf5")));
    names.into_iter().filter(|path| path.is_file()).map(|path| (path.file_name().unwrap().into(), fs::read(&path).unwrap())).collect()
}

#[test]
fn a_frame_comes_out_the_same() {
    let dir = folder();
    let d = dir.path();
    dataset(d, &[]);
    let text = succeed(d, &["replay", RECORD]);
    assert!(text.contains("same bytes  images/scene_cam_00_final_hdf5/frame.0001.color.hdf5") && !text.contains("DIFFERS"), "{text}");
    assert!(text.contains("room/cam_00/frame.0001: 18 of 18 files have the same bytes"), "{text}");
    succeed(d, &["replay", RECORD, "-o", "again", "--threads", "1"]);
    assert_eq!(layers(&d.join("again")), layers(&d.join("out")));
    // What was rendered is compared where color is denoised, too.
    succeed(d, &["run", "out", "--only", "denoise", "--color", "denoised"]);
    assert!(succeed(d, &["replay", RECORD]).contains("18 of 18 files have the same bytes"));
}

#[test]
fn a_frame_that_is_there_is_not_replaced() {
    let dir = folder();
    let d = dir.path();
    dataset(d, &[]);
    let (before, times) = (contents(&d.join("out")), fs::read(d.join("out/manifest_times.csv")).unwrap());
    for out in ["out", "./out/../out"] {
        fail(d, &["replay", RECORD, "-o", out], 2, &["room/cam_00/frame.0001 is in", "already", "name another folder with -o"]);
    }
    assert_same(&contents(&d.join("out")), &before);
    assert_eq!(fs::read(d.join("out/manifest_times.csv")).unwrap(), times);
}

#[test]
fn frames_of_a_noise_target_with_parts_of_light_and_further_layers_come_out_the_same() {
    let dir = folder();
    let d = dir.path();
    dataset(d, &["--noise", "30%", "--samples", "64", "--light-parts", "--extra", "--seed", "5"]);
    let text = succeed(d, &["replay", RECORD]);
    assert!(text.contains("specular") && text.contains("optical_flow") && !text.contains("DIFFERS"), "{text}");
}

#[test]
fn a_frame_that_a_time_limit_ended_is_given_as_many_samples() {
    let dir = folder();
    let d = dir.path();
    dataset(d, &["--time-limit", "0.000001", "--samples", "64"]);
    assert!(fs::read_to_string(d.join(RECORD)).unwrap().contains("\"time limit\""));
    succeed(d, &["replay", RECORD]);
}

#[test]
fn a_difference_is_told_and_so_is_what_is_missing() {
    let dir = folder();
    let d = dir.path();
    dataset(d, &[]);
    let path = d.join(RECORD);
    let record = fs::read_to_string(&path).unwrap();
    let changed = |from: &str, to: &str| fs::write(&path, record.replacen(from, to, 1)).unwrap();
    let parsed: serde_json::Value = serde_json::from_str(&record).unwrap();
    let text = |value: &serde_json::Value| value.as_str().unwrap().to_string();
    let color = text(&parsed["files"]["images/scene_cam_00_final_hdf5/frame.0001.color.hdf5"]["blake3"]);
    changed(&color, &"0".repeat(64));
    fail(d, &["replay", RECORD], 1, &["DIFFERS     images/scene_cam_00_final_hdf5/frame.0001.color.hdf5", "17 of 18 files"]);

    // Another release will do, another version of rendering and another program will not.
    let program = text(&parsed["recipe"]["program"]);
    changed(&program, "enfilade 0.0.1");
    succeed(d, &["replay", RECORD]);
    changed(&program, "V-Ray 5.0");
    fail(d, &["replay", RECORD], 1, &["was rendered by V-Ray 5.0 (rendering", "use the program that rendered it"]);
    changed(&format!("\"render_version\": {}", parsed["recipe"]["render_version"]), "\"render_version\": 0");
    fail(d, &["replay", RECORD], 1, &["(rendering 0), and this is enfilade", "use the program that rendered it"]);
    changed(&text(&parsed["recipe"]["scene_blake3"]), &"0".repeat(64));
    fail(d, &["replay", RECORD], 1, &["scene.scene has changed since", "render the frame again"]);
    changed(&text(&parsed["config_hash"]), &"0".repeat(64));
    fail(d, &["replay", RECORD], 1, &["the trajectory of cam_00 is not the one"]);
    // A record of an earlier version is read, but cannot be replayed.
    let mut old = parsed.clone();
    old.as_object_mut().unwrap().remove("recipe");
    fs::write(&path, old.to_string()).unwrap();
    fail(d, &["replay", RECORD], 1, &["its record is of an earlier version"]);
    succeed(d, &["inspect", "out", "--frame", "1", "--pixel", "3,4"]);

    fs::write(&path, &record).unwrap();
    fs::remove_file(d.join("out/.enfilade/room/scene.scene")).unwrap();
    fail(d, &["replay", RECORD], 1, &["scene.scene is not there"]);
    fail(d, &["replay", "out/manifest.json"], 2, &["is no commit record of a frame"]);
    fs::copy(&path, d.join("frame.json")).unwrap();
    fail(d, &["replay", "frame.json"], 2, &["is not where a dataset keeps the record"]);
}
