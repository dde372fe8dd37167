//! A second run does nothing, a killed one goes on where it was, and both end with the same bytes.

use crate::common::{Lamp, assert_same, contents, enfilade, fail, folder, scene, succeed, write_config, write_room};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, SystemTime};

fn modified(root: &Path) -> BTreeMap<PathBuf, SystemTime> {
    contents(root).into_keys().map(|path| (path.clone(), fs::metadata(root.join(path)).unwrap().modified().unwrap())).collect()
}

fn color_times(root: &Path) -> BTreeMap<PathBuf, SystemTime> {
    modified(root).into_iter().filter(|(path, _)| path.to_string_lossy().ends_with("color.hdf5")).collect()
}

#[test]
fn a_second_run_does_nothing_and_a_changed_label_table_renders_nothing() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room") + "labels = \"labels.csv\"\n"]);
    fs::write(d.join("labels.csv"), "material,nyu40_id\nwall,1\nwood,7\nlight,35\n").unwrap();
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let (before, times) = (contents(&d.join("out")), modified(&d.join("out")));
    let text = succeed(d, &["run", "dataset.toml", "-o", "out"]);
    assert!(text.contains("Nothing to do"), "{text}");
    assert_eq!(modified(&d.join("out")), times);

    fs::write(d.join("labels.csv"), "material,nyu40_id\nwall,1\nwood,14\nred,29\nlight,35\n").unwrap();
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let after = contents(&d.join("out"));
    let frames = |tree: &BTreeMap<PathBuf, Vec<u8>>| {
        tree.iter().filter(|(path, _)| path.to_string_lossy().ends_with(".semantic.hdf5")).map(|(_, b)| b.clone()).collect::<Vec<_>>()
    };
    assert_ne!(frames(&before), frames(&after));
    assert_eq!(
        color_times(&d.join("out")),
        times.iter().filter(|(p, _)| p.to_string_lossy().ends_with("color.hdf5")).map(|(p, t)| (p.clone(), *t)).collect()
    );

    // The verb with another table does the same, and keeps it.
    fs::write(d.join("other.csv"), "material,nyu40_id\nwall,1\nwood,7\nlight,35\n").unwrap();
    succeed(d, &["label", "out", "--table", "other.csv"]);
    assert_eq!(frames(&contents(&d.join("out"))), frames(&before));
    succeed(d, &["run", "out", "--only", "preview"]);
    succeed(d, &["verify", "out"]);
}

#[test]
fn a_label_table_that_cannot_be_read_changes_nothing() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["run", "dataset.toml", "-o", "out", "--frames", "1"]);
    let before = contents(&d.join("out"));
    fs::write(d.join("bad.csv"), "material,nyu40_id\nwall,many\n").unwrap();
    fail(d, &["label", "out", "--table", "nope.csv"], 1, &["nope.csv", "check the path for typing errors"]);
    fail(d, &["label", "out", "--table", "bad.csv"], 1, &["bad.csv"]);
    assert!(succeed(d, &["label", "out"]).contains("nothing to do"));
    assert_same(&contents(&d.join("out")), &before);
    succeed(d, &["verify", "out"]);
}

#[test]
fn scenes_of_the_folder_that_a_run_does_not_have_are_named() {
    let dir = folder();
    let d = dir.path();
    ["a", "b"].iter().for_each(|name| drop(write_room(d, name, Lamp::On)));
    let run = |scenes: &[String]| {
        write_config(d, scenes);
        succeed(d, &["run", "dataset.toml", "-o", "out", "--frames", "1"])
    };
    let text = run(&[scene("a")]);
    assert!(!text.contains("warning:"), "{text}");
    let frame = d.join("out/scenes/a/images/scene_cam_00_final_hdf5/frame.0000.color.hdf5");
    let before = fs::read(&frame).unwrap();
    let text = run(&[scene("b")]);
    assert!(text.contains("warning: out also holds scenes that this configuration does not have: a; they stay as they are"), "{text}");
    assert_eq!(fs::read(&frame).unwrap(), before);
    fail(d, &["run", "out", "--only", "render", "--scene", "a"], 2, &["no scene is named \"a\""]);
    run(&[scene("a"), scene("b")]);
    assert!(succeed(d, &["run", "out", "--only", "render", "--scene", "a"]).contains("nothing to do"));
}

#[test]
fn scenes_are_imported_again_when_a_file_comes_late_or_another_one_is_meant() {
    let dir = folder();
    let d = dir.path();
    for name in ["a", "b"] {
        let folder = d.join(name);
        fs::create_dir(&folder).unwrap();
        let obj = write_room(&folder, "room", Lamp::On);
        let text = fs::read_to_string(&obj).unwrap().replace("mtllib room.mtl\n", "mtllib room.mtl\nmtllib late.mtl\n");
        fs::write(&obj, text).unwrap();
        write_config(&folder, &[scene("room")]);
    }
    let late = |grey: f32| format!("newmtl wall\nKd {grey} {grey} {grey}\n");
    let package = || fs::read(d.join("out/.enfilade/room/scene.scene")).unwrap();
    let run = |name: &str| succeed(d, &["run", &format!("{name}/dataset.toml"), "--frames", "1", "-o", "out"]);
    run("a");
    assert!(run("a").contains("Nothing to do"));
    let without = package();
    fs::write(d.join("a/late.mtl"), late(0.5)).unwrap();
    run("a");
    let with = package();
    assert_ne!(without, with, "a library that was missing is there now");
    fs::write(d.join("b/late.mtl"), late(0.25)).unwrap();
    run("b");
    assert_ne!(with, package(), "the same words, another folder");
    assert!(run("b").contains("Nothing to do"));
}

/// Pictures were once named by their paths, so that a scene changed when its folder was renamed.
#[test]
fn sources_that_were_moved_make_the_same_bytes_and_cost_no_frame() {
    let dir = folder();
    let d = dir.path();
    fs::create_dir(d.join("here")).unwrap();
    write_room(&d.join("here"), "room", Lamp::On);
    let library = d.join("here/room.mtl");
    fs::write(&library, fs::read_to_string(&library).unwrap().replace("newmtl wall\n", "newmtl wall\nmap_Kd grey.pfm\n")).unwrap();
    fs::write(d.join("here/grey.pfm"), [b"PF\n1 1\n-1.0\n".as_slice(), [0.5f32; 3].map(f32::to_le_bytes).as_flattened()].concat()).unwrap();
    fs::write(d.join("here/labels.csv"), "material,nyu40_id\nwall,1\nwood,7\nlight,35\n").unwrap();
    write_config(&d.join("here"), &[scene("room") + "environment = { file = \"grey.pfm\" }\nlabels = \"labels.csv\"\n"]);
    succeed(d, &["run", "here/dataset.toml", "-o", "out"]);
    let (before, times) = (contents(&d.join("out")), color_times(&d.join("out")));
    fs::rename(d.join("here"), d.join("there")).unwrap();
    // The dataset knows only the old paths until it is run again.
    fail(d, &["label", "out"], 1, &["run again with the dataset.toml beside them"]);
    succeed(d, &["run", "there/dataset.toml", "-o", "out"]);
    assert_same(&before, &contents(&d.join("out")));
    assert_eq!(times, color_times(&d.join("out")));
}

#[test]
fn a_report_card_does_not_outlive_what_it_is_about() {
    let dir = folder();
    let d = dir.path();
    ["a", "b"].iter().for_each(|name| drop(write_room(d, name, Lamp::On)));
    write_config(d, &[scene("a"), scene("b")]);
    succeed(d, &["run", "dataset.toml", "-o", "out", "--frames", "1"]);
    let passed = || -> bool {
        let card: serde_json::Value = serde_json::from_slice(&fs::read(d.join("out/verify.json")).unwrap()).unwrap();
        card["passed"].as_bool().unwrap()
    };
    assert!(passed());
    succeed(d, &["run", "out", "--only", "render", "--scene", "b", "--samples", "2"]);
    assert!(!d.join("out/verify.json").exists());
    fs::remove_file(d.join("out/scenes/b/images/scene_cam_00_geometry_hdf5/frame.0000.semantic.hdf5")).unwrap();
    enfilade(d, &["run", "dataset.toml", "-o", "out", "--frames", "1", "--scenes", "a"]).output().unwrap();
    assert!(!passed(), "the other scene has changed since");
}

#[test]
fn a_run_does_not_pass_what_the_verb_verify_has_found_broken() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    let run = ["run", "dataset.toml", "-o", "out", "--frames", "1"];
    succeed(d, &run);
    let layer = d.join("out/scenes/room/images/scene_cam_00_geometry_hdf5/frame.0000.position.hdf5");
    let bytes = fs::read(&layer).unwrap();
    let mut damaged = bytes.clone();
    damaged[bytes.len() / 2] ^= 1;
    fs::write(&layer, damaged).unwrap();
    fail(d, &["verify", "out"], 1, &["FAIL"]);
    for _ in 0..2 {
        fail(d, &run, 1, &["room: `verify` failed:", "do not hold"]);
        let card: serde_json::Value = serde_json::from_slice(&fs::read(d.join("out/verify.json")).unwrap()).unwrap();
        assert_eq!(card["passed"], false);
    }
    fs::write(&layer, bytes).unwrap();
    assert!(succeed(d, &run).contains("laws hold"));
    assert!(succeed(d, &run).contains("Nothing to do"));
}

#[test]
fn killed_runs_end_with_the_same_bytes_without_rendering_finished_frames_again() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    let args = |out| ["run", "dataset.toml", "--frames", "5", "--size", "96x72", "--threads", "2", "-o", out];
    succeed(d, &args("whole"));
    let expected = contents(&d.join("whole"));

    // Moments from a fixed sequence, so that every run of the test kills at about the same places.
    let mut state = 7u64;
    let mut finished: BTreeMap<PathBuf, SystemTime> = BTreeMap::new();
    for _ in 0..12 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mut child = enfilade(d, &args("killed")).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(30 + (state >> 33) % 400));
        child.kill().unwrap(); // SIGKILL on Unix
        child.wait().unwrap();
        let records = complete_frames(&d.join("killed"));
        for (path, time) in &finished {
            assert_eq!(records.get(path), Some(time), "{} was rendered again", path.display());
        }
        finished = records;
    }
    succeed(d, &args("killed"));
    let records = complete_frames(&d.join("killed"));
    assert!(finished.iter().all(|(path, time)| records.get(path) == Some(time)));
    assert_same(&expected, &contents(&d.join("killed")));
}

/// The commit records of finished frames and when the frames were rendered: denoising writes records again, but no geometry.
fn complete_frames(out: &Path) -> BTreeMap<PathBuf, SystemTime> {
    let folder = out.join("scenes/room/_detail/cam_00/frames");
    let Ok(entries) = fs::read_dir(folder) else { return BTreeMap::new() };
    let paths = entries.map(|e| e.unwrap().path());
    let records = paths.filter(|p| p.extension().is_some_and(|e| e == "json") && !p.to_string_lossy().contains("labels"));
    let depth = |record: &Path| {
        let frame = record.file_stem().unwrap().to_string_lossy().into_owned();
        out.join(format!("scenes/room/images/scene_cam_00_geometry_hdf5/{frame}.depth_meters.hdf5"))
    };
    records.map(|p| (p.clone(), fs::metadata(depth(&p)).unwrap().modified().unwrap())).collect()
}

#[test]
fn thread_counts_change_no_byte() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    for (threads, out) in [("1", "one"), ("7", "seven")] {
        succeed(d, &["run", "dataset.toml", "--frames", "2", "--threads", threads, "-o", out]);
    }
    assert_same(&contents(&d.join("one")), &contents(&d.join("seven")));
}

#[test]
fn fewer_frames_leave_none_of_the_old_ones_behind() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    succeed(d, &["run", "dataset.toml", "--frames", "2", "-o", "fresh"]);
    succeed(d, &["run", "dataset.toml", "--frames", "3", "-o", "changed"]);
    // A shorter trajectory is another one, and the guide learns from all of it: its frames are rendered again.
    succeed(d, &["run", "dataset.toml", "--frames", "2", "-o", "changed"]);
    assert_same(&contents(&d.join("fresh")), &contents(&d.join("changed")));
}

#[test]
fn a_dataset_in_use_is_left_alone() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::On);
    write_config(d, &[scene("room")]);
    let mut child = enfilade(d, &["run", "dataset.toml", "--size", "640x480", "-o", "out"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !d.join("out/.enfilade/run.json").exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
    fail(d, &["run", "dataset.toml", "-o", "out"], 2, &["another process (process", "working on out"]);
    child.kill().unwrap();
    child.wait().unwrap();
    succeed(d, &["run", "out", "--only", "import"]);
}
