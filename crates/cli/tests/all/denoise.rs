//! Denoising: not there until asked for, a clear word where the library is not installed, and what it makes where it is.

use crate::common::{Lamp, assert_same, contents, enfilade, folder, scene, succeed, write_config, write_room};
use std::path::Path;

/// A room of three frames, rendered without denoising.
fn rendered(dir: &Path) {
    write_room(dir, "room", Lamp::On);
    write_config(dir, &[scene("room")]);
    succeed(dir, &["run", "dataset.toml", "-o", "out"]);
}

/// Whether a dataset has any denoised file.
fn has_denoised(root: &Path) -> bool {
    contents(root).keys().any(|path| path.to_string_lossy().contains("denoised"))
}

#[test]
fn without_the_library_nothing_is_lost_and_the_way_out_is_told() {
    let dir = folder();
    let d = dir.path();
    rendered(d);
    let before = contents(&d.join("out"));
    assert!(!has_denoised(&d.join("out")));
    let output = enfilade(d, &["denoise", "out"]).env("ENFILADE_OIDN", "no/such/library.so").output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{text}");
    for words in ["Open Image Denoise was not found", "no/such/library.so", "pip install pyoidn", "ENFILADE_OIDN", "denoise_library"] {
        assert!(text.contains(words), "{words:?} is not in:\n{text}");
    }
    assert_same(&before, &contents(&d.join("out")));
    succeed(d, &["verify", "out"]);
    // A run that is to denoise says so before it does anything.
    let output =
        enfilade(d, &["run", "dataset.toml", "-o", "other", "--denoise"]).env("ENFILADE_OIDN", "no/such/library.so").output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && text.contains("Open Image Denoise was not found"), "{text}");
    assert!(!d.join("other/scenes/room").exists());
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    assert_same(&before, &contents(&d.join("out")));
}

#[test]
fn denoised_layers_come_by_every_way_with_the_same_bytes_and_go_again() {
    if std::env::var_os("ENFILADE_OIDN").is_none() {
        return eprintln!("skipped: ENFILADE_OIDN does not name Open Image Denoise");
    }
    let dir = folder();
    let d = dir.path();
    rendered(d);
    let raw = contents(&d.join("out"));
    let layer = d.join("out/scenes/room/images/scene_cam_00_final_hdf5/frame.0001.color_denoised.hdf5");
    let time = |path: &Path| path.metadata().unwrap().modified().unwrap();
    let color = d.join("out/scenes/room/images/scene_cam_00_final_hdf5/frame.0001.color.hdf5");
    let rendered_at = time(&color);

    succeed(d, &["render", "out", "--denoise"]);
    assert!(layer.is_file() && time(&color) == rendered_at, "nothing is rendered again");
    let text = succeed(d, &["verify", "out"]);
    assert!(text.contains("laws hold over 3 frames"), "{text}");
    let manifest = std::fs::read_to_string(d.join("out/manifest.json")).unwrap();
    assert!(manifest.contains("\"denoiser\": \"Open Image Denoise 2.") && manifest.contains("\"denoise\": true"));
    let text = succeed(d, &["run", "dataset.toml", "-o", "out", "--denoise"]);
    assert!(text.contains("laws hold") || text.contains("ok"), "{text}");
    assert!(succeed(d, &["denoise", "out"]).contains("nothing to do"));
    assert!(d.join("out/scenes/room/images/scene_cam_00_final_preview/frame.0001.color_denoised.jpg").is_file());

    succeed(d, &["run", "dataset.toml", "-o", "at-once", "--denoise", "--threads", "1"]);
    assert_same(&contents(&d.join("out")), &contents(&d.join("at-once")));
    std::fs::remove_file(&layer).unwrap();
    succeed(d, &["denoise", "out"]);
    assert!(!d.join("out/verify.json").exists(), "what was verified is no longer there");
    succeed(d, &["verify", "out"]);
    assert_same(&contents(&d.join("out")), &contents(&d.join("at-once")));

    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    assert_same(&contents(&d.join("out")), &raw);
}
