//! Every verb that reads a dataset, over a miniature of Hypersim's release.

mod release;

use crate::common::{fail, folder, succeed};
use enfilade_dataset::Dataset;
use enfilade_frame::{Layer, Values};
use enfilade_math::{DMat3, DVec3};
use release::{FRAMES, SCENE, SIZE, Tree};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Names and contents of all files below a folder.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() { found.extend(contents(&entry)) } else { drop(found.insert(entry.clone(), fs::read(&entry).unwrap())) }
    }
    found
}

#[test]
fn verify_holds_the_release_to_what_float16_leaves_and_names_its_defects() {
    for tree in [Tree::Toolkit, Tree::Archives] {
        let dir = folder();
        let root = release::write(dir.path(), tree);
        let text = succeed(dir.path(), &["verify", "hypersim"]);
        for word in
            ["n/a", "known", "laws hold over 4 frames of 1 scene", "no rotation", "(#103)", "(#58)", "(#26)", "frames [2] are missing"]
        {
            assert!(text.contains(word), "{tree:?}: no {word:?} in\n{text}");
        }
        assert!(text.contains("position projects to the centre of its own pixel"), "{text}");
        let report: Value = serde_json::from_slice(&fs::read(root.join("verify.json")).unwrap()).unwrap();
        let laws: Vec<&str> = report["laws"].as_array().unwrap().iter().map(|law| law["law"].as_str().unwrap()).collect();
        for law in ["distance", "projection", "normal_camera", "box_contains", "two_view_distance", "two_view_ids", "calibration"] {
            assert!(laws.contains(&law), "{law} was not checked: {laws:?}");
        }
        assert!(fs::read_to_string(root.join("verify.html")).unwrap().contains("known defect"));
    }
}

#[test]
fn verify_finds_the_camera_without_its_shifts() {
    let dir = folder();
    release::write(dir.path(), Tree::Toolkit);
    let (k, _) = release::calibration();
    let naive = enfilade_scene::Intrinsics::from_fov_x(k.width, k.height, std::f64::consts::FRAC_PI_3);
    fs::write(dir.path().join("naive.csv"), release::camera_table(naive.cam_from_uv())).unwrap();
    fail(
        dir.path(),
        &["verify", "hypersim", "--cameras-csv", "naive.csv"],
        1,
        &["FAIL", "position projects to the centre of its own pixel"],
    );
}

#[test]
fn a_table_of_cameras_that_is_named_and_not_there_is_told() {
    let dir = folder();
    release::write(dir.path(), Tree::Toolkit);
    for args in [
        &["verify", "hypersim"][..],
        &["stats", "hypersim", "-o", "numbers"],
        &["run", "hypersim", "--only", "preview", "-o", "pictures"],
        &["animate", "hypersim", "-o", "films"],
        &["export", "hypersim", "--format", "coco", "-o", "coco"],
        &["inspect", "hypersim", "--pixel", "3,4"],
    ] {
        fail(dir.path(), &[args, &["--cameras-csv", "camera.csv"]].concat(), 2, &["no table of cameras at camera.csv"]);
    }
    assert!(["numbers", "pictures", "films", "coco"].iter().all(|name| !dir.path().join(name).exists()));
}

#[test]
fn a_release_without_the_table_of_cameras_says_where_to_get_it() {
    let dir = folder();
    let root = release::write(dir.path(), Tree::Toolkit);
    fs::remove_file(root.join("metadata_camera_parameters.csv")).unwrap();
    fail(dir.path(), &["export", "hypersim", "--format", "opencv", "-o", "out"], 2, &["contrib/mikeroberts3000", "--cameras-csv"]);
    fail(dir.path(), &["stats", "hypersim/scenes/ai_001_001"], 2, &["it is one scene of a dataset"]);
}

#[test]
fn opencv_cameras_and_planar_depth_give_the_stored_positions() {
    let dir = folder();
    let root = release::write(dir.path(), Tree::Archives);
    succeed(dir.path(), &["export", "hypersim", "--format", "opencv", "-o", "cameras"]);
    let json = fs::read(dir.path().join("cameras/ai_001_001/cam_00/cameras_opencv.json")).unwrap();
    let json: Value = serde_json::from_slice(&json).unwrap();
    let number = |v: &Value| v.as_f64().unwrap();
    let k: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| number(&json["K"][i][j])));
    let (expected, _) = release::calibration();
    assert!((k[0][0] - expected.fx).abs() < 1e-9 && (k[0][2] + 0.5 - expected.cx).abs() < 1e-9 && k[0][1] == 0.0, "{k:?}");
    let frames = json["frames"].as_array().unwrap();
    assert_eq!(frames.iter().map(|f| f["frame"].as_u64().unwrap() as u32).collect::<Vec<_>>(), FRAMES);
    let dataset = Dataset::open(&root).unwrap();
    for entry in frames {
        let m = |i: usize, j: usize| number(&entry["world_from_camera"][i][j]);
        let rotation = DMat3::from_cols(
            DVec3::new(m(0, 0), m(1, 0), m(2, 0)),
            DVec3::new(m(0, 1), m(1, 1), m(2, 1)),
            DVec3::new(m(0, 2), m(1, 2), m(2, 2)),
        );
        let identity = (rotation.transpose() * rotation - DMat3::IDENTITY).to_cols_array();
        assert!(identity.iter().all(|v| v.abs() < 1e-12), "frame 0 is a rotation too");
        let number = entry["frame"].as_u64().unwrap() as u32;
        let frame = dataset.read_frame(SCENE, "cam_00", number, &[Layer::Position, Layer::DepthZMeters]).unwrap();
        let (Some(Values::F32(p)), Some(Values::F32(z))) = (frame.get(Layer::Position), frame.get(Layer::DepthZMeters)) else { panic!() };
        let mut seen = 0;
        for (i, &z) in z.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            let (x, y) = ((i as u32 % SIZE[0]) as f64, (i as u32 / SIZE[0]) as f64);
            let ray = DVec3::new((x - k[0][2]) / k[0][0], (y - k[1][2]) / k[1][1], 1.0);
            let found = rotation * (ray * f64::from(z)) + DVec3::new(m(0, 3), m(1, 3), m(2, 3));
            let stored = DVec3::new(p[3 * i].into(), p[3 * i + 1].into(), p[3 * i + 2].into());
            // 120 inches are stored to 0.03 inches, 6 m to 2 mm.
            assert!(found.distance(stored) < 5e-3, "frame {number} pixel ({x}, {y}): {found} {stored}");
            seen += 1;
        }
        assert!(seen > 6000, "{seen}");
    }
    let csv = fs::read_to_string(dir.path().join("cameras/intrinsics.csv")).unwrap();
    assert!(csv.lines().nth(1).unwrap().starts_with("ai_001_001,cam_00,96,72,"), "{csv}");
    let listed = succeed(dir.path(), &["inspect", "metadata_camera_parameters.csv", "--cameras"]);
    assert!(listed.lines().count() == 2 && listed.contains("ai_001_001,,96,72,"), "{listed}");
}

#[test]
fn every_format_is_exported() {
    let dir = folder();
    release::write(dir.path(), Tree::Archives);
    for format in ["coco", "bop", "nerfstudio", "colmap", "colmap-text", "scannet", "exr", "depth-png", "webdataset", "croissant", "opencv"]
    {
        let text = succeed(dir.path(), &["export", "hypersim", "--format", format, "-o", format]);
        assert!(text.contains("4 frames"), "{format}: {text}");
    }
    let coco: Value = serde_json::from_slice(&fs::read(dir.path().join("coco/annotations/instances.json")).unwrap()).unwrap();
    assert_eq!(coco["images"].as_array().unwrap().len(), FRAMES.len());
    assert!(coco["annotations"].as_array().unwrap().iter().all(|a| a["category_id"] == 7));
    let card = fs::read_to_string(dir.path().join("croissant/croissant.json")).unwrap();
    assert!(card.contains("as Apple released them") && !card.contains("depth_z_meters-files"), "{card}");
    let depth = fs::read_to_string(dir.path().join("depth-png/ai_001_001/cam_00/cameras.json")).unwrap();
    assert!(depth.contains("\"planar\""), "{depth}");
}

#[test]
fn pictures_statistics_and_films_go_elsewhere_and_nothing_of_the_release_changes() {
    let dir = folder();
    let root = release::write(dir.path(), Tree::Toolkit);
    let before = contents(&root);
    fail(dir.path(), &["run", "hypersim", "--only", "preview"], 2, &["Hypersim's release", "name another folder with -o"]);
    let text = succeed(dir.path(), &["run", "hypersim", "--only", "preview", "-o", "pictures"]);
    assert!(text.contains("contact_sheet.jpg"), "{text}");
    let pictures = dir.path().join("pictures/scenes/ai_001_001/images");
    for name in [
        "final_preview/frame.0003.tonemap.jpg",
        "geometry_preview/frame.0000.depth_z_meters.png",
        "final_preview/frame.0001.bb_object_aligned_2d.jpg",
    ] {
        assert!(pictures.join(format!("scene_cam_00_{name}")).is_file(), "{name}");
    }
    succeed(dir.path(), &["stats", "hypersim", "-o", "numbers"]);
    let numbers: Value = serde_json::from_slice(&fs::read(dir.path().join("numbers/statistics.json")).unwrap()).unwrap();
    assert!(numbers.to_string().contains("ai_001_001"), "{numbers}");
    succeed(dir.path(), &["animate", "hypersim", "--layers", "tonemap", "--format", "gif", "-o", "films"]);
    assert_eq!(contents(&root), before);
    fail(dir.path(), &["label", "hypersim"], 2, &["semantic_instance already"]);
    fail(dir.path(), &["run", "hypersim", "--only", "boxes"], 2, &["_detail/mesh already"]);
    let pixel = succeed(dir.path(), &["inspect", "hypersim", "--frame", "1", "--pixel", "30,50"]);
    for word in ["depth_z_meters", "px from the pixel's centre", "@n"] {
        assert!(pixel.contains(word), "no {word:?} in\n{pixel}");
    }
}

#[test]
fn pictures_leave_out_what_cannot_be_made_of_a_part_of_the_archives() {
    let dir = folder();
    let root = release::write(dir.path(), Tree::Toolkit);
    let made = |folder: &str| {
        succeed(dir.path(), &["run", "hypersim", "--only", "preview", "-o", folder]);
        assert!(dir.path().join(folder).join("contact_sheet.jpg").is_file(), "{folder}");
        let images = dir.path().join(folder).join("scenes/ai_001_001/images/scene_cam_00_");
        let names = ["final_preview/frame.0001.bb_object_aligned_2d.jpg", "geometry_preview/frame.0001.position.png"];
        let there = |name: &str| PathBuf::from(format!("{}{name}", images.display())).is_file();
        assert!(there("geometry_preview/frame.0001.normal_world.png"), "{folder}");
        names.map(there)
    };
    assert_eq!(made("all"), [true, true]);
    fs::remove_file(root.join("metadata_camera_parameters.csv")).unwrap();
    assert_eq!(made("without-cameras"), [false, true]);
    fs::remove_dir_all(root.join("scenes/ai_001_001/_detail")).unwrap();
    assert_eq!(made("images-alone"), [false, false]);
    fail(dir.path(), &["animate", "hypersim", "--layers", "position", "-o", "films"], 1, &["metadata_scene.csv"]);
}

#[test]
fn statistics_of_some_scenes_do_not_take_the_place_of_those_of_all() {
    let dir = folder();
    let root = release::write(dir.path(), Tree::Toolkit);
    fs::create_dir_all(root.join("scenes/ai_001_002/images")).unwrap();
    succeed(dir.path(), &["stats", "hypersim"]);
    let of_all = contents(&root.join("statistics"));
    fail(dir.path(), &["stats", "hypersim", "--scene", "ai_001_001"], 2, &["1 of 2 were chosen", "with -o"]);
    assert!(contents(&root.join("statistics")) == of_all);
    succeed(dir.path(), &["stats", "hypersim", "--scene", "ai_001_001", "-o", "some"]);
    assert!(dir.path().join("some/statistics.json").is_file());
    succeed(dir.path(), &["stats", "hypersim", "--scene", "ai_001_*"]);
}

#[test]
fn a_camera_without_frames_does_not_stop_the_films_of_others() {
    let dir = folder();
    let root = release::write(dir.path(), Tree::Toolkit);
    fs::create_dir(root.join("scenes/ai_001_001/_detail/cam_01")).unwrap();
    let animate = ["animate", "hypersim", "--layers", "normal_world", "--format", "gif", "-o", "films"];
    let text = succeed(dir.path(), &animate);
    assert!(text.contains("films/ai_001_001_cam_00_normal_world.gif: 4 frames"), "{text}");
    assert!(text.contains("warning: ai_001_001/cam_01 has no frame with normal_world"), "{text}");
    assert!(dir.path().join("films/ai_001_001_cam_00_normal_world.gif").is_file());
    fail(dir.path(), &[&animate[..], &["--camera", "cam_01"]].concat(), 1, &["cam_01 has no frame with normal_world"]);
}

#[test]
fn exposures_are_the_toolkits() {
    let dir = folder();
    let root = release::write(dir.path(), Tree::Toolkit);
    succeed(dir.path(), &["run", "hypersim", "--only", "preview", "-o", "pictures"]);
    let dataset = Dataset::open(&root).unwrap();
    let table = fs::read_to_string(dir.path().join("pictures/scenes/ai_001_001/_detail/cam_00/metadata_tonemap.csv")).unwrap();
    for (line, frame) in table.lines().skip(1).zip(FRAMES) {
        let [color, ids] = [Layer::Color, Layer::RenderEntityId].map(|layer| dataset.read_layer(SCENE, "cam_00", frame, layer).unwrap());
        let seen = (0..ids.len()).filter(|&i| ids.get(i) != -1.0);
        let mut brightness: Vec<f64> =
            seen.map(|i| 0.3 * color.get(3 * i) + 0.59 * color.get(3 * i + 1) + 0.11 * color.get(3 * i + 2)).collect();
        brightness.sort_unstable_by(f64::total_cmp);
        // numpy.percentile's 90th: between the two values around 0.9 (n - 1).
        let at = 0.9 * (brightness.len() - 1) as f64;
        let (low, high) = (brightness[at.floor() as usize], brightness[at.ceil() as usize]);
        let scale = 0.8f64.powf(2.2) / (low + (high - low) * at.fract());
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!(cells[0] == f64::from(frame) && cells.iter().any(|cell| (cell / scale - 1.0).abs() < 1e-9), "{line}: {scale}");
    }
}
