//! The flags of rendering: parts of light, limits, and a frame that goes on where a killed run has left it.

use crate::common::{Lamp, assert_same, contents, enfilade, fail, folder, scene, succeed, write_config, write_room};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Duration;

fn room(dir: &Path) {
    write_room(dir, "room", Lamp::On);
    write_config(dir, &[scene("room")]);
}

fn record(out: &Path, frame: u32) -> serde_json::Value {
    let path = out.join(format!("scenes/room/_detail/cam_00/frames/frame.{frame:04}.json"));
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn color_layers(tree: &BTreeMap<PathBuf, Vec<u8>>) -> Vec<&Vec<u8>> {
    tree.iter().filter(|(path, _)| path.to_string_lossy().ends_with(".color.hdf5")).map(|(_, bytes)| bytes).collect()
}

#[test]
fn extra_layers_come_when_asked_for_and_change_nothing_else() {
    let dir = folder();
    let d = dir.path();
    room(d);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let raw = contents(&d.join("out"));
    succeed(d, &["run", "dataset.toml", "-o", "more", "--extra"]);
    let more = contents(&d.join("more"));
    assert_eq!(color_layers(&raw), color_layers(&more));
    for name in ["optical_flow", "base_color", "depth_behind_meters", "occlusion_boundary"] {
        assert!(d.join(format!("more/scenes/room/images/scene_cam_00_geometry_hdf5/frame.0001.{name}.hdf5")).is_file(), "{name}");
        assert!(d.join(format!("more/scenes/room/images/scene_cam_00_geometry_preview/frame.0001.{name}.png")).is_file(), "{name}");
    }
    let text = succeed(d, &["verify", "more"]);
    assert!(text.contains("extra layers are within their ranges"), "{text}");
    assert!(succeed(d, &["inspect", "more", "--pixel", "3,4"]).contains("optical_flow"));
    // Asked for no longer, they go.
    succeed(d, &["run", "dataset.toml", "-o", "more"]);
    assert_same(&contents(&d.join("more")), &raw);
}

#[test]
fn parts_of_light_come_when_asked_for_change_nothing_else_and_go_again() {
    let dir = folder();
    let d = dir.path();
    room(d);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let raw = contents(&d.join("out"));
    assert!(!raw.keys().any(|path| path.to_string_lossy().contains("diffuse_direct")));
    assert_eq!(record(&d.join("out"), 0)["stopped_by"], "samples");
    assert_eq!(record(&d.join("out"), 0)["samples_taken"], 4.0);

    // Of an existing dataset they are asked for from now on.
    succeed(d, &["run", "out", "--only", "render", "--light-parts"]);
    succeed(d, &["run", "dataset.toml", "-o", "at-once", "--light-parts"]);
    let split = contents(&d.join("at-once"));
    assert_eq!(color_layers(&raw), color_layers(&split));
    let images = d.join("at-once/scenes/room/images");
    for name in ["diffuse_direct", "transmission", "light_surfaces", "light_points"] {
        assert!(images.join(format!("scene_cam_00_final_hdf5/frame.0002.{name}.hdf5")).is_file(), "{name}");
        assert!(images.join(format!("scene_cam_00_final_preview/frame.0002.{name}.jpg")).is_file(), "{name}");
    }
    let text = succeed(d, &["verify", "at-once"]);
    assert!(text.contains("light by path and light by source each sum to color"), "{text}");
    assert!(succeed(d, &["inspect", "at-once", "--pixel", "3,4"]).contains("light_environment"));
    assert!(fs::read_to_string(d.join("out/manifest.json")).unwrap().contains("\"splits\": true"));
    succeed(d, &["run", "out", "--only", "label,preview"]);
    succeed(d, &["verify", "out"]);
    // What the verb `verify` found is not kept for the next run, so the frames are compared.
    assert_eq!(color_layers(&contents(&d.join("out"))), color_layers(&split));
    assert!(succeed(d, &["run", "out", "--only", "render"]).contains("nothing to do"));

    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    assert_same(&contents(&d.join("out")), &raw);
}

#[test]
fn a_killed_run_goes_on_within_the_frame_and_ends_with_the_same_bytes() {
    let dir = folder();
    let d = dir.path();
    room(d);
    let toml = fs::read_to_string(d.join("dataset.toml")).unwrap().replace("samples = 4\n", "samples = 4\nsave_every_s = 0\n");
    fs::write(d.join("dataset.toml"), toml).unwrap();
    let args = |out| ["run", "dataset.toml", "--frames", "2", "--samples", "400", "--light-parts", "-o", out];
    succeed(d, &args("whole"));
    let partial = |frame: u32| d.join(format!("killed/.enfilade/room/partial/cam_00.{frame:04}.partial"));
    let mut kept = 0;
    for _ in 0..3 {
        let mut child = enfilade(d, &args("killed")).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let before = fs::read(partial(0)).ok();
        // Killed once it has come further within the first frame, or has ended.
        while child.try_wait().unwrap().is_none() && (!partial(0).is_file() || fs::read(partial(0)).ok() == before) {
            std::thread::sleep(Duration::from_millis(1));
        }
        child.kill().unwrap(); // SIGKILL on Unix
        child.wait().unwrap();
        kept += usize::from(partial(0).is_file());
    }
    assert!(kept > 0, "no run was killed within its first frame");
    succeed(d, &args("killed"));
    assert_same(&contents(&d.join("whole")), &contents(&d.join("killed")));
    assert!(!partial(0).exists() && !partial(1).exists());
}

#[test]
fn a_damaged_partial_frame_is_told_and_begun_anew() {
    let dir = folder();
    let d = dir.path();
    room(d);
    succeed(d, &["run", "dataset.toml", "--frames", "1", "-o", "whole"]);
    let partial = d.join("out/.enfilade/room/partial");
    fs::create_dir_all(&partial).unwrap();
    fs::write(partial.join("cam_00.0000.partial"), "enfilpar and no more").unwrap();
    fs::write(partial.join("cam_07.0003.partial"), "of another trajectory").unwrap();
    let output = enfilade(d, &["run", "dataset.toml", "--frames", "1", "-o", "out"]).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && text.contains("cam_00.0000.partial") && text.contains("started again"), "{text}");
    assert_same(&contents(&d.join("whole")), &contents(&d.join("out")));
    assert_eq!(fs::read_dir(&partial).unwrap().count(), 0);
}

#[test]
fn a_time_limit_ends_a_frame_whole_and_is_recorded() {
    let dir = folder();
    let d = dir.path();
    room(d);
    let text = succeed(d, &["run", "dataset.toml", "-o", "out", "--samples", "640", "--time-limit", "0.000001s"]);
    assert!(text.contains("ok"), "{text}");
    let found = record(&d.join("out"), 1);
    assert_eq!(found["stopped_by"], "time limit");
    // No frame has less than one sample of every pixel, and this one has no more.
    assert!(found["samples_taken"] == 1.0 && found["noise"].is_null() && found["samples"] == 640, "{found}");
    assert!(succeed(d, &["run", "dataset.toml", "-o", "out", "--samples", "640", "--time-limit", "0.000001"]).contains("Nothing to do"));
    succeed(d, &["verify", "out"]);
    let manifest: serde_json::Value = serde_json::from_slice(&fs::read(d.join("out/manifest.json")).unwrap()).unwrap();
    let scene = &manifest["config"]["scenes"][0];
    assert!(scene["time_limit_s"] == 0.000001 && scene["render"]["samples"] == 640, "{scene}");
    // Without the limit the frames are another configuration's.
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    assert_eq!(record(&d.join("out"), 1)["stopped_by"], "samples");
}

#[test]
fn rendering_goes_on_with_the_numbers_it_was_given() {
    let dir = folder();
    let d = dir.path();
    room(d);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    succeed(d, &["run", "out", "--only", "render", "--samples", "96", "--noise", "50%", "--max-bounces", "2", "--clamp", "10"]);
    let manifest = fs::read_to_string(d.join("out/manifest.json")).unwrap();
    for words in ["\"samples\": 96", "\"noise\": 0.5", "\"max_bounces\": 2", "\"clamp\": 10.0"] {
        assert!(manifest.contains(words), "{words} is not in the manifest");
    }
    assert_eq!(record(&d.join("out"), 0)["stopped_by"], "noise");
    assert!(succeed(d, &["run", "out", "--only", "render"]).contains("nothing to do"));
    // Too few samples for the requested noise violate no law, but the frames are useless.
    succeed(d, &["run", "out", "--only", "render", "--samples", "2", "--noise", "1%"]);
    succeed(d, &["label", "out"]);
    assert!(succeed(d, &["verify", "out"]).contains("of target: noise; rejects 3 of 3"));
    fail(d, &["verify", "out", "--strict"], 1, &["laws hold", "of target: noise; rejects 3 of 3"]);
    for (args, words) in [
        (&["--samples", "0"][..], "samples must be at least 1"),
        (&["--noise", "200%"], "noise must lie between 0 and 1"),
        (&["--noise", "little"], "0.02 or 2%"),
        (&["--clamp=-1"], "clamp must be above 0"),
        (&["--time-limit", "0s"], "time_limit_s must be above 0"),
        (&["--time-limit", "soon"], "90s, 5m or 1h"),
    ] {
        fail(d, &[&["run", "out", "--only", "render"], args].concat(), 2, &[words]);
        fail(d, &[&["run", "--demo", "other"], args].concat(), 2, &[words]);
    }
    fail(d, &["run", "--demo", "other", "--samples", "3", "--quality", "high"], 2, &["--quality"]);
    assert!(!d.join("other").exists());
}

#[test]
fn a_dataset_of_black_pictures_is_not_ok_and_the_last_line_says_why() {
    let dir = folder();
    let d = dir.path();
    write_room(d, "room", Lamp::Off);
    write_config(d, &[format!("{}environment = \"sky\"\n", scene("room"))]);
    for _ in 0..2 {
        let (code, out, err) = crate::common::run(d, &["run", "dataset.toml", "-o", "out"]);
        assert_eq!(code, 1, "{out}\n{err}");
        let last = out.lines().last().unwrap_or_default();
        assert!(
            last.starts_with("NOT OK: room: verify: ") && last.contains("are black") && last.contains("all light comes from outside"),
            "{out}"
        );
        assert!(err.contains("hang lamps by lamps = \"ceiling\""), "{err}");
    }
    fail(d, &["verify", "out"], 1, &["at most half of a scene's frames are black"]);
    write_config(d, &[format!("{}lamps = \"ceiling\"\n", scene("room"))]);
    let text = succeed(d, &["run", "dataset.toml", "-o", "out"]);
    assert!(!text.contains("NOT OK"), "{text}");
}
