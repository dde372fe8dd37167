//! The contents of `color`: denoised from the first run, rendered on request, and one after the other without rendering.

use crate::common::{Lamp, assert_same, contents, enfilade, fail, folder, scene, succeed, write_config, write_room};
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, SystemTime};

/// The configuration of a room of three frames.
fn room(dir: &Path) {
    write_room(dir, "room", Lamp::On);
    write_config(dir, &[scene("room")]);
}

fn layer(out: &Path, name: &str) -> PathBuf {
    out.join(format!("scenes/room/images/scene_cam_00_final_hdf5/frame.0001.{name}.hdf5"))
}

fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// When the depth of a frame was written: nothing but rendering writes it.
fn rendered_at(out: &Path) -> SystemTime {
    let depth = out.join("scenes/room/images/scene_cam_00_geometry_hdf5/frame.0001.depth_meters.hdf5");
    depth.metadata().unwrap().modified().unwrap()
}

#[test]
fn color_is_denoised_from_the_first_run_and_changes_without_rendering() {
    let dir = folder();
    let d = dir.path();
    room(d);
    let [out, raw, bare] = ["out", "raw", "bare"].map(|name| d.join(name));
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    succeed(d, &["run", "dataset.toml", "-o", "raw", "--color", "rendered", "--threads", "1"]);
    assert_eq!(bytes(&layer(&out, "color_rendered")), bytes(&layer(&raw, "color")));
    assert_ne!(bytes(&layer(&out, "color")), bytes(&layer(&raw, "color")));
    assert_eq!(bytes(&layer(&raw, "color_rendered")), bytes(&layer(&raw, "color")), "by another name");
    let names = |out: &Path| std::fs::read_to_string(out.join("manifest.json")).unwrap().matches("color_rendered.hdf5").count();
    assert_eq!([names(&out), names(&raw)], [3, 0], "no content is listed twice");
    for (out, color) in [(&out, "denoised"), (&raw, "rendered")] {
        let manifest = std::fs::read_to_string(out.join("manifest.json")).unwrap();
        let record = std::fs::read_to_string(out.join("scenes/room/_detail/cam_00/frames/frame.0001.json")).unwrap_or_default();
        let says = format!("\"color\": \"{color}\"");
        assert!(manifest.contains(&says) && (record.is_empty() || record.contains(&says)), "{color}:\n{manifest}\n{record}");
        assert!(std::fs::read_to_string(out.join("verify.html")).unwrap().contains(color));
        assert!(succeed(d, &["verify", &out.to_string_lossy()]).contains("laws hold over 3 frames"));
    }
    assert!(succeed(d, &["run", "dataset.toml", "-o", "out"]).contains("nothing to do"));

    // One way and the other, each as if it had been so from the beginning.
    let [first, clean] = [rendered_at(&out), rendered_at(&raw)];
    let denoised = contents(&out);
    let rendered = contents(&raw);
    succeed(d, &["run", "dataset.toml", "-o", "out", "--color", "rendered"]);
    succeed(d, &["run", "dataset.toml", "-o", "raw"]);
    assert_same(&contents(&out), &rendered);
    assert_same(&contents(&raw), &denoised);
    assert_eq!([rendered_at(&out), rendered_at(&raw)], [first, clean], "nothing is rendered again");
    succeed(d, &["run", "out", "--color", "denoised"]);
    assert_eq!(bytes(&layer(&out, "color")), bytes(&layer(&raw, "color")));
    succeed(d, &["run", "out", "--color", "rendered"]);
    assert_eq!(bytes(&layer(&out, "color")), rendered[&layer(Path::new(""), "color")]);
    assert_eq!(rendered_at(&out), first);

    // Rendered colour that was not kept is rendered again, and a message reports that.
    let text = std::fs::read_to_string(d.join("dataset.toml")).unwrap();
    std::fs::write(d.join("bare.toml"), text.replace("[render]\n", "[render]\nkeep_rendered = false\n")).unwrap();
    succeed(d, &["run", "bare.toml", "-o", "bare"]);
    assert_eq!(bytes(&layer(&bare, "color")), bytes(&layer(&raw, "color")));
    assert!(!layer(&bare, "color_rendered").exists());
    assert!(succeed(d, &["verify", "bare"]).contains("laws hold over 3 frames"));
    let told = "3 frames denoised, and what was rendered was not kept";
    fail(d, &["run", "bare.toml", "-o", "bare", "--color", "rendered"], 0, &[told]);
    assert_eq!(bytes(&layer(&bare, "color")), bytes(&layer(&out, "color")));
}

#[test]
fn changes_of_color_that_are_killed_end_with_the_same_bytes_and_render_nothing() {
    let dir = folder();
    let d = dir.path();
    room(d);
    let run = |out: &str, color: &str| enfilade(d, &["run", "dataset.toml", "--size", "96x72", "-o", out, "--color", color]);
    for color in ["denoised", "rendered"] {
        assert!(run(color, color).output().unwrap().status.success());
    }
    let expected = ["denoised", "rendered"].map(|color| (color, contents(&d.join(color))));
    assert!(run("killed", "denoised").output().unwrap().status.success());
    let rendered = rendered_at(&d.join("killed"));
    // Moments from a fixed sequence, so that every run of the test kills at about the same places.
    let mut state = 7u64;
    for color in ["rendered", "denoised"].into_iter().cycle().take(10) {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mut child = run("killed", color).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(10 + (state >> 33) % 250));
        child.kill().unwrap(); // SIGKILL on Unix
        child.wait().unwrap();
    }
    for (color, expected) in expected {
        assert!(run("killed", color).output().unwrap().status.success());
        assert_same(&contents(&d.join("killed")), &expected);
    }
    assert_eq!(rendered_at(&d.join("killed")), rendered);
}

#[test]
fn frames_that_an_installed_library_denoised_count_as_denoised() {
    let dir = folder();
    let d = dir.path();
    room(d);
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    // As an earlier version has left them: by a library that the settings named.
    for entry in std::fs::read_dir(d.join("out/scenes/room/_detail/cam_00/frames")).unwrap() {
        let path = entry.unwrap().path();
        let Ok(mut record) = serde_json::from_slice::<serde_json::Value>(&bytes(&path)) else { continue };
        if let Some(denoised) = record.get_mut("denoised") {
            *denoised = serde_json::json!({ "denoiser": "Open Image Denoise 2.5.1", "denoise_hash": "of a path" });
            std::fs::write(&path, serde_json::to_vec_pretty(&record).unwrap()).unwrap();
        }
    }
    std::fs::remove_file(d.join("out/.enfilade/room/denoise.json")).unwrap();
    let color = bytes(&layer(&d.join("out"), "color"));
    succeed(d, &["run", "dataset.toml", "-o", "out"]);
    let stage = std::fs::read_to_string(d.join("out/.enfilade/room/denoise.json")).unwrap();
    assert!(stage.contains("3 frames denoised before"), "{stage}");
    assert_eq!(bytes(&layer(&d.join("out"), "color")), color);
    let manifest = std::fs::read_to_string(d.join("out/manifest.json")).unwrap();
    assert!(manifest.contains("\"denoiser\": \"Open Image Denoise 2.5.1\""), "{manifest}");
    assert!(succeed(d, &["run", "dataset.toml", "-o", "out"]).contains("nothing to do"));
}
