//! Datasets of every mode of trajectory: made, verified, and not made again.

use crate::common::{assert_made, write_home};
use enfilade_dataset::Dataset;
use enfilade_geometry::OccupancyTree;
use enfilade_math::DVec3;
use enfilade_pipeline::{Config, Overrides, Silent, run};
use enfilade_scene::Quiet;
use enfilade_verify::{Law, verify_scene};
use std::path::Path;

/// A home of one room, tiny, once per mode; the poses made by hand are of the demo's.
fn config(folder: &Path) -> Config {
    let table = "frame,position_x,position_y,position_z,look_at_x,look_at_y,look_at_z,roll_deg\n0,-1.1,4.2,1.4,-2.0,2.6,1.2,9\n3,-1.25,3.95,1.4,-2.0,2.6,1.2,9\n";
    std::fs::write(folder.join("path.csv"), table).unwrap();
    write_home(folder, 0);
    let modes = [
        ("walk", "overlap = [0.1, 0.95]\nroll_limit_deg = 20\nmode = { kind = \"walk\" }"),
        ("video", "camera_height_m = [1.2, 1.7]\nlevel = true\nmode = { kind = \"video\", fps = 10 }"),
        ("stills", "mode = { kind = \"stills\", min_distance_m = 0.5 }"),
        ("coverage", "mode = { kind = \"coverage\", views = 2, poses = 100, samples = 1000 }"),
        ("objects", "mode = { kind = \"objects\" }"),
        ("keyframes", "mode = { kind = \"keyframes\", files = [\"path.csv\"] }"),
    ];
    let mut text =
        "seed = 3\nframes = 4\n[render]\nsize = [64, 48]\nsamples = 1\nmax_bounces = 1\n[carve]\nrays = 8192\niterations = 2\n".to_string();
    for (name, keys) in modes {
        let source = if name == "keyframes" { "home = { seed = 0 }" } else { "file = \"home.scene\"" };
        text += &format!("[[scene]]\nname = \"{name}\"\n{source}\ncameras = [\"living_1\"]\n[scene.plan]\n{keys}\n");
        if name == "objects" {
            let mug = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/compose/models/mug.glb");
            text += &format!("[[scene.object]]\nfiles = {:?}\ncount = 2\non = \"table\"\nvisible_share = 0.5\n", mug.display().to_string());
        }
    }
    std::fs::write(folder.join("dataset.toml"), text).unwrap();
    Config::read(&folder.join("dataset.toml"), &Overrides::default()).unwrap()
}

#[test]
fn datasets_of_every_mode_verify_and_are_made_once() {
    let folder = tempfile::tempdir().unwrap();
    let config = config(folder.path());
    let out = folder.path().join("out");
    assert_made(&config, &out);
    assert!(run(&config, &out, None, &Silent).unwrap().nothing_done());

    let dataset = Dataset::open(&out).unwrap();
    for scene in ["walk", "video", "stills", "coverage", "objects", "keyframes"] {
        let text = std::fs::read_to_string(dataset.layout().plan_report(scene, "cam_00")).unwrap();
        let report: enfilade_explore::PlanReport = serde_json::from_str(&text).unwrap();
        assert_eq!((report.mode.as_str(), report.per_frame.frame.as_slice()), (scene, [0, 1, 2, 3].as_slice()));
        assert_eq!(report.coverage.is_some(), scene == "coverage");
        assert_eq!(report.objects.len(), if scene == "objects" { 2 } else { 0 });
        assert!(
            report.objects.iter().all(|one| one.name.starts_with("mug") && one.visible_share >= one.wanted_share),
            "{:?}",
            report.objects
        );
        // Beyond the usual limit, which only binds plans that have it.
        assert_eq!(report.per_frame.roll_deg.iter().any(|roll| roll.abs() > 5.0), ["walk", "keyframes"].contains(&scene), "{scene}");
    }
    let poses = dataset.read_trajectory("keyframes", "cam_00").unwrap().poses;
    assert_eq!((poses[0].position.x, poses[3].position.x), (-1.1, -1.25));
    let time = std::fs::read_to_string(dataset.layout().metadata_camera("video", "cam_00")).unwrap();
    assert!(time.contains("frame_time_seconds,0.1"), "{time}");

    // Where nothing is free, planned poses break a law. Poses made by hand are kept at any place.
    for (scene, broken) in [("walk", vec![Law::FreeTarget, Law::FreeCamera]), ("keyframes", vec![])] {
        dataset.write_free_space(scene, &OccupancyTree::new(0.1).to_bt(), DVec3::ZERO, DVec3::ZERO).unwrap();
        let report = verify_scene(&dataset, scene, &Quiet).unwrap();
        assert_eq!(report.failures().map(|law| law.law).collect::<Vec<_>>(), broken, "{scene}");
    }
}

#[test]
fn a_table_of_poses_that_cannot_be_read_says_where() {
    let folder = tempfile::tempdir().unwrap();
    let config = config(folder.path());
    std::fs::write(folder.path().join("path.csv"), "frame,position_x\n0,1\n").unwrap();
    let summary = run(&config, &folder.path().join("out"), Some("keyframes"), &Silent).unwrap();
    let failure = summary.scenes[0].failure.as_ref().unwrap();
    assert!(failure.message.contains("path.csv, pose 1: found"), "{}", failure.message);
    assert!(failure.hint.as_ref().unwrap().contains("docs/trajectories.md"));
}

#[test]
fn objects_to_look_at_that_the_scene_does_not_have_are_named() {
    let folder = tempfile::tempdir().unwrap();
    write_home(folder.path(), 0);
    let plan = "[plan]\nmode = { kind = \"objects\", look_at = [\"unicorn\"] }\n[carve]\nrays = 8192\niterations = 2\n";
    let text = format!("frames = 2\n{plan}[[scene]]\nname = \"room\"\nfile = \"home.scene\"\ncameras = [\"living_1\"]\n");
    std::fs::write(folder.path().join("dataset.toml"), text).unwrap();
    let config = Config::read(&folder.path().join("dataset.toml"), &Overrides::default()).unwrap();
    let summary = run(&config, &folder.path().join("out"), None, &Silent).unwrap();
    let failure = summary.scenes[0].failure.as_ref().unwrap();
    assert!(failure.message.contains("look at \"unicorn\""), "{}", failure.message);
    assert!(failure.hint.as_ref().unwrap().contains("armchair_1, "), "{:?}", failure.hint);
}
