//! Datasets of every kind of camera: made, read back, and verified.

use crate::common::{LAMP, TABLE, WALL, assert_made, write_blocks};
use enfilade_dataset::Dataset;
use enfilade_dataset::hdf5::{Array, Storage, write_array};
use enfilade_frame::Layer;
use enfilade_math::DVec3;
use enfilade_pipeline::{Config, Overrides, Silent, Stage, run, run_stage};
use enfilade_scene::Intrinsics;
use std::path::Path;

/// A room of boxes, once per camera.
fn config(folder: &Path) -> Config {
    write_blocks(folder, &[WALL, TABLE, LAMP]);
    let k = Intrinsics::from_fov_x(64, 48, 1.2);
    let grid = (0..7 * 9).flat_map(|i| (k.ray(f64::from(i % 9) * 8.0, f64::from(i / 9) * 8.0) * DVec3::new(1.0, 1.1, 1.0)).to_array());
    let grid = Array::f64(&[7, 9, 3], grid.collect());
    write_array(&folder.join("grid.hdf5"), &grid, Storage::Contiguous, &[]).unwrap();
    let cameras = [
        ("lens", "lens = { f_number = 1.4, focal_length_mm = 50, focus_distance_m = 2.5, blades = 7 }"),
        ("rolling", "shutter = { exposure_s = 0.02, readout_s = 0.03, frame_time_s = 0.2 }"),
        ("stereo", "stereo = { baseline_m = 0.12 }"),
        ("tilted", "model = \"tilted_pinhole\"\ncam_from_uv = [[0.6, 0, 0.1], [0, 0.45, 0.05], [0.02, 0.1, -1]]"),
        (
            "distorted",
            "model = \"radial_tangential\"\nK = [[50, 0, 31], [0, 51, 23], [0, 0, 1]]\ndistortion = [-0.25, 0.06, 0.001, -0.002]",
        ),
        ("fisheye", "model = \"fisheye\"\ndistortion = [-0.02, 0.001, 0, 0]\nshutter = { exposure_s = 0.1, readout_s = 0.05 }"),
        ("panorama", "model = \"equirectangular\"\nstereo = { baseline_m = 0.065 }"),
        ("grid", "model = \"ray_grid\"\nray_grid = \"grid.hdf5\""),
    ];
    let mut text =
        "seed = 3\nframes = 2\n[render]\nsize = [64, 48]\nsamples = 1\nmax_bounces = 1\n[carve]\nrays = 8192\niterations = 2\n".to_string();
    for (name, keys) in cameras {
        text += &format!("[[scene]]\nname = \"{name}\"\nfile = \"room.obj\"\nup_axis = \"z\"\n[scene.camera]\n{keys}\n");
    }
    std::fs::write(folder.join("dataset.toml"), text).unwrap();
    Config::read(&folder.join("dataset.toml"), &Overrides::default()).unwrap()
}

#[test]
fn datasets_of_every_camera_verify_and_are_made_once() {
    let folder = tempfile::tempdir().unwrap();
    let config = config(folder.path());
    let out = folder.path().join("out");
    assert_made(&config, &out);
    assert!(run(&config, &out, None, &Silent).unwrap().nothing_done());

    let dataset = Dataset::open(&out).unwrap();
    let finished = |scene: &String| dataset.frame_numbers(scene, "cam_00").unwrap();
    let frames = || dataset.scenes().unwrap().iter().map(finished).collect::<Vec<_>>();
    let before = frames();
    assert!(run_stage(&out, Stage::Plan, None, true, &Silent).unwrap().ok());
    assert_eq!(frames(), before, "the same plan costs no frame");
    assert_eq!(dataset.cameras("stereo").unwrap(), ["cam_00", "cam_01"]);
    let eyes = ["cam_00", "cam_01"].map(|camera| dataset.read_trajectory("stereo", camera).unwrap().poses[1]);
    assert!((eyes[0].position.distance(eyes[1].position) - 0.12).abs() < 1e-12);

    // A user's calculation from the files alone: position = camera centre + distance × (world_from_camera × ray).
    for scene in ["distorted", "panorama", "grid"] {
        let pose = dataset.read_trajectory(scene, "cam_00").unwrap().poses[1];
        let rays = dataset.read_camera_rays(scene, "cam_00", [64, 48]).unwrap().unwrap();
        let [depth, position] = [Layer::DepthMeters, Layer::Position].map(|l| dataset.read_layer(scene, "cam_00", 1, l).unwrap());
        for (p, ray) in rays.iter().enumerate().filter(|(p, _)| depth.get(*p).is_finite()) {
            let found = pose.position + pose.world_from_camera * *ray * depth.get(p);
            let stored = DVec3::new(position.get(3 * p), position.get(3 * p + 1), position.get(3 * p + 2));
            assert!(found.distance(stored) < 1e-5, "{scene} pixel {p}: {found} not {stored}");
        }
    }
}
