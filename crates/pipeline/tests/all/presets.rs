//! Results of a preset: its rules in the plan, its camera, and depth as Hypersim's loaders compute it.

use crate::common::{assert_made, write_home};
use enfilade_dataset::{Dataset, loader_depth};
use enfilade_explore::{PlanReport, Preset};
use enfilade_frame::Layer;
use enfilade_pipeline::{Config, Overrides, Silent, run};
use enfilade_scene::Quiet;
use enfilade_verify::{Law, verify_scene};
use std::path::Path;

/// A home of one room, walked through by every preset.
fn config(folder: &Path, size: &str, frames: u32) -> Config {
    write_home(folder, 0);
    let mut text = format!(
        "seed = 3\nframes = {frames}\n[render]\n{size}samples = 1\nmax_bounces = 1\ncolor = \"rendered\"\n[carve]\nrays = 8192\niterations = 2\n"
    );
    for preset in ["default", "paper", "hypersim"] {
        text += &format!("[[scene]]\nname = \"{preset}\"\npreset = \"{preset}\"\nfile = \"home.scene\"\ncameras = [\"living_1\"]\n");
    }
    std::fs::write(folder.join("dataset.toml"), text).unwrap();
    Config::read(&folder.join("dataset.toml"), &Overrides::default()).unwrap()
}

#[test]
fn every_presets_trajectories_keep_its_laws_and_begin_with_the_given_camera() {
    let folder = tempfile::tempdir().unwrap();
    let config = config(folder.path(), "size = [64, 48]\n", 12);
    let out = folder.path().join("out");
    assert_made(&config, &out);
    let dataset = Dataset::open(&out).unwrap();
    for preset in [Preset::Default, Preset::Paper, Preset::Hypersim] {
        let scene = preset.name();
        let text = std::fs::read_to_string(dataset.layout().plan_report(scene, "cam_00")).unwrap();
        let report: PlanReport = serde_json::from_str(&text).unwrap();
        let start = report.start.unwrap();
        assert_eq!((report.preset, start.name.as_str(), start.is_kept), (preset, "living_1", true), "{scene}");
        let first = dataset.read_trajectory(scene, "cam_00").unwrap().poses[0];
        assert_eq!((first.position, first.world_from_camera), (start.position, start.world_from_camera), "{scene}");
        let verified = verify_scene(&dataset, scene, &Quiet).unwrap();
        assert!(verified.passed, "{}", verified.to_text());
        let checked = |law| verified.laws.iter().find(|found| found.law == law).map_or(0, |found| found.checks);
        assert_eq!([Law::StartPose, Law::WalkBox, Law::WalkSight, Law::FreeTarget].map(checked), [1, 11, 11, 11], "{scene}");
        assert_eq!(checked(Law::Roll), if preset == Preset::Hypersim { 0 } else { 11 }, "{scene}");
        // Only the default rejects views.
        assert!(preset == Preset::Default || verified.frames == 12, "{scene}: {} frames", verified.frames);
    }
}

#[test]
fn hypersims_loaders_compute_planar_depth_right_from_its_preset_and_are_told_where_they_do_not() {
    let folder = tempfile::tempdir().unwrap();
    let config = config(folder.path(), "", 1);
    assert_eq!(config.scenes.iter().map(|scene| (scene.size, scene.fov_x_deg)).collect::<Vec<_>>()[1..], [([1024, 768], Some(60.0)); 2]);
    let out = folder.path().join("out");
    assert!(run(&config, &out, Some("hypersim"), &Silent).unwrap().ok());
    assert!(run(&config, &out, Some("default"), &Silent).unwrap().ok());
    let dataset = Dataset::open(&out).unwrap();
    for (scene, expected, noted) in [("hypersim", 0.0..1e-4, false), ("default", 0.04..0.2, true)] {
        // As Marigold's preprocessing does: planar depth from the distance, only by the pixel's position.
        let frame = dataset.read_frame(scene, "cam_00", 0, &[Layer::DepthMeters, Layer::DepthZMeters]).unwrap();
        let [distance, depth] = [Layer::DepthMeters, Layer::DepthZMeters].map(|layer| frame.get(layer).unwrap());
        let mut worst: f64 = 0.0;
        for i in (0..frame.pixels()).filter(|&i| depth.get(i).is_finite()) {
            let (x, y) = (i % frame.width as usize, i / frame.width as usize);
            let computed = loader_depth([x as f64 + 0.5, y as f64 + 0.5], distance.get(i));
            worst = worst.max((computed / depth.get(i) - 1.0).abs());
        }
        assert!(expected.contains(&worst), "{scene}: {worst}");
        let notes = verify_scene(&dataset, scene, &Quiet).unwrap().notes;
        assert_eq!(notes.iter().any(|note| note.contains("planar depth by loaders")), noted, "{scene}: {notes:?}");
    }
}
