//! Reading Hypersim's release: the contents of the real files, and their peculiarities.

use enfilade_dataset::hdf5::{Storage, write_array};
use enfilade_dataset::{Array, Dataset, Elements, Window};
use enfilade_frame::{Layer, Values, f16};
use enfilade_math::DMat3;
use enfilade_scene::{Projection, Quiet};
use std::fs;
use std::path::Path;

const TABLE: &str = "metadata_camera_parameters.csv";

/// A scene of two poses in centimetres, the first of them stretched, with one image of a position; no tables.
fn release(scene: &Path) -> DMat3 {
    let rotation = DMat3::from_rotation_z(0.4) * DMat3::from_rotation_x(1.2);
    let stretched = rotation * DMat3::from_cols_array(&[1.1, 0.02, 0.0, 0.02, 0.9, 0.0, 0.0, 0.0, 1.0]);
    let camera = scene.join("_detail/cam_00");
    let images = scene.join("images/scene_cam_00_geometry_hdf5");
    fs::create_dir_all(&camera).unwrap();
    fs::create_dir_all(&images).unwrap();
    let rows = [stretched, rotation].map(|m| m.transpose().to_cols_array()).concat();
    let put = |path: &Path, array: &Array| write_array(path, array, Storage::Contiguous, &[]).unwrap();
    put(&camera.join("camera_keyframe_positions.hdf5"), &Array::f64(&[2, 3], vec![100.0, 0.0, 150.0, 200.0, 0.0, 150.0]));
    put(&camera.join("camera_keyframe_orientations.hdf5"), &Array::f64(&[2, 3, 3], rows));
    let image = |shape: &[usize], value: f32| {
        let values = Elements::F16(vec![f16::from_f32(value); shape.iter().product()]);
        Array { shape: shape.to_vec(), values }
    };
    put(&images.join("frame.0001.position.hdf5"), &image(&[2, 2, 3], 250.0));
    put(&images.join("frame.0001.depth_meters.hdf5"), &image(&[2, 2], 3.0));
    rotation
}

fn table(scene: &str) -> String {
    let matrix = "0.5,0,0.1,0,0.5,0,0,0.2,-1";
    let columns: Vec<String> = (0..9).map(|k| format!("M_cam_from_uv_{}{}", k / 3, k % 3)).collect();
    format!(
        "scene_name,settings_output_img_height,settings_output_img_width,settings_units_info_meters_scale,{}\n{scene},2.0,2.0,0.01,{matrix}\n",
        columns.join(",")
    )
}

#[test]
fn units_cameras_and_planar_depth_come_from_the_table_above_the_archives() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("downloads");
    let rotation = release(&root.join("ai_001_001"));
    fs::write(folder.path().join(TABLE), table("ai_001_001")).unwrap();
    let dataset = Dataset::open(&root).unwrap();
    assert!(dataset.is_released("ai_001_001"));
    assert_eq!(dataset.meters_per_asset_unit("ai_001_001").unwrap(), 0.01);
    let poses = dataset.read_trajectory("ai_001_001", "cam_00").unwrap().poses;
    assert!((poses[1].position.x - 2.0).abs() < 1e-12, "metres");
    let stored = dataset.read_stored_trajectory("ai_001_001", "cam_00").unwrap().poses;
    assert!(stored[0].orthonormality_error() > 0.1 && poses[0].orthonormality_error() < 1e-14, "the nearest rotation");
    assert!((poses[0].world_from_camera - rotation).to_cols_array().iter().all(|v| v.abs() < 1e-12));
    assert_eq!(stored[1], poses[1], "what is a rotation stays to the last bit");
    let gives = |layer| dataset.gives_layer("ai_001_001", "cam_00", 1, layer);
    assert!(gives(Layer::DepthZMeters) && !dataset.has_layer("ai_001_001", "cam_00", 1, Layer::DepthZMeters) && !gives(Layer::Color));
    let frame = dataset.read_frame("ai_001_001", "cam_00", 1, &[Layer::Position, Layer::DepthZMeters]).unwrap();
    assert_eq!(frame.get(Layer::Position), Some(&Values::F32(vec![2.5; 12])), "positions are in metres");
    let (Some(Values::F32(planar)), Projection::TiltedPinhole(camera)) =
        (frame.get(Layer::DepthZMeters), dataset.table_projection("ai_001_001").unwrap())
    else {
        panic!("a tilted pinhole and planar depth")
    };
    let axis = camera.straightened().1.transpose() * -enfilade_math::DVec3::Z;
    assert!((f64::from(planar[3]) - 3.0 * camera.ray(1.5, 1.5).normalize().dot(axis)).abs() < 1e-6);
}

#[test]
fn another_table_can_be_named_and_none_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("a/data");
    release(&root.join("ai_001_002"));
    let dataset = Dataset::open(&root).unwrap();
    let message = dataset.read_camera("ai_001_002", "cam_00").unwrap_err();
    assert!(message.is_not_found() && message.to_string().contains("contrib/mikeroberts3000"), "{message}");
    assert!(dataset.meters_per_asset_unit("ai_001_002").unwrap_err().is_not_found());
    assert!(dataset.read_trajectory("ai_001_002", "cam_00").unwrap_err().is_not_found(), "nothing says what a unit is");
    assert!(!dataset.gives_layer("ai_001_002", "cam_00", 1, Layer::DepthZMeters));
    let other = folder.path().join("other.csv");
    fs::write(&other, table("ai_001_002")).unwrap();
    let dataset = dataset.with_camera_table(&other);
    assert!(dataset.read_camera("ai_001_002", "cam_00").is_ok());
    fs::write(&other, table("ai_001_002").replace(",0.01,", ",-1,")).unwrap();
    let message = dataset.meters_per_asset_unit("ai_001_002").unwrap_err().to_string();
    assert!(message.contains("other.csv") && message.contains("-1 metres per asset unit"), "{message}");
    for silent in [table("ai_001_002").replace(",0.01,", ",,"), table("ai_001_002").replace("settings_units_info_meters_scale", "scale")] {
        fs::write(&other, silent).unwrap();
        let unit = dataset.meters_per_asset_unit("ai_001_002").unwrap_err();
        let trajectory = dataset.read_trajectory("ai_001_002", "cam_00").unwrap_err();
        for error in [unit, trajectory] {
            let message = error.to_string();
            assert!(!error.is_not_found() && message.contains("other.csv"), "{message}");
            assert!(message.contains("\"settings_units_info_meters_scale\""), "{message}");
        }
    }
    fs::write(&other, table("ai_001_009")).unwrap();
    assert!(dataset.meters_per_asset_unit("ai_001_002").unwrap_err().is_not_found(), "a table that lacks the scene is as good as none");
    fs::write(&other, table("ai_001_002").replace(",2.0,2.0,", ",2.0,1e9,")).unwrap();
    let message = dataset.read_camera("ai_001_002", "cam_00").unwrap_err().to_string();
    assert!(message.contains("the image's width is 1000000000; expected a whole number of pixels"), "{message}");
}

#[test]
fn planar_depth_of_images_of_another_size_than_the_camera_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    release(&folder.path().join("ai_001_006"));
    fs::write(folder.path().join(TABLE), table("ai_001_006")).unwrap();
    let dataset = Dataset::open(folder.path()).unwrap();
    let projection = || dataset.table_projection("ai_001_006");
    let corner = Window { top: 0, left: 0, height: 1, width: 1 };
    let planar = |window| dataset.read_specified("ai_001_006", "cam_00", 1, Layer::DepthZMeters, window, &projection);
    assert_eq!([planar(None), planar(Some(corner))].map(|read| read.unwrap().0), [[2, 2], [1, 1]]);
    for side in [1, 4] {
        let path = dataset.layout().layer("ai_001_006", "cam_00", 1, Layer::DepthMeters);
        let distances = Elements::F16(vec![f16::from_f32(3.0); side * side]);
        write_array(&path, &Array::new(&[side, side], distances), Storage::Contiguous, &[]).unwrap();
        for window in [None, Some(corner)] {
            let message = planar(window).unwrap_err().to_string();
            assert!(message.contains(&format!("have {side}x{side} pixels, but its camera 2x2")), "{message}");
        }
    }
}

#[test]
fn a_repacked_release_is_still_one_and_is_not_said_to_be_in_metres() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("downloads");
    release(&root.join("ai_001_007"));
    fs::write(folder.path().join(TABLE), table("ai_001_007")).unwrap();
    let dataset = Dataset::open(&root).unwrap();
    dataset.repack(&folder.path().join("copy"), None, &Quiet).unwrap();
    let copy = Dataset::open(folder.path().join("copy")).unwrap();
    assert!(copy.is_released("ai_001_007"));
    let position = |dataset: &Dataset| dataset.read_layer("ai_001_007", "cam_00", 1, Layer::Position).unwrap();
    assert_eq!(position(&copy), position(&dataset));
    let bytes = fs::read(copy.layout().layer("ai_001_007", "cam_00", 1, Layer::Position)).unwrap();
    assert!(!bytes.windows(4).any(|bytes| bytes == b"unit"));
}

#[test]
fn cameras_that_were_left_out_are_left_out() {
    let folder = tempfile::tempdir().unwrap();
    release(&folder.path().join("ai_001_003"));
    let detail = folder.path().join("ai_001_003/_detail");
    fs::write(detail.join("metadata_cameras.csv"), "camera_name\ncam_00\ncam_02\n").unwrap();
    let dataset = Dataset::open(folder.path()).unwrap();
    assert_eq!(dataset.cameras("ai_001_003").unwrap(), ["cam_00"]);
    let message = Dataset::open(detail.parent().unwrap()).unwrap_err().to_string();
    assert!(message.contains("it is one scene of a dataset"), "{message}");
}

#[test]
fn a_scene_without_detail_has_the_cameras_of_its_images() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("downloads");
    let scene = root.join("ai_001_004");
    release(&scene);
    fs::remove_dir_all(scene.join("_detail")).unwrap();
    for other in ["scene_cam_01_final_hdf5", "scene_cam_02_final_preview", "scene__final_hdf5", "notes"] {
        fs::create_dir_all(scene.join("images").join(other)).unwrap();
    }
    let dataset = Dataset::open(&root).unwrap();
    assert_eq!(dataset.scenes().unwrap(), ["ai_001_004"]);
    assert_eq!(dataset.cameras("ai_001_004").unwrap(), ["cam_00", "cam_01"]);
    assert_eq!(dataset.frame_numbers("ai_001_004", "cam_00").unwrap(), [1]);
    let frame = dataset.read_frame("ai_001_004", "cam_00", 1, &[Layer::DepthMeters]).unwrap();
    assert_eq!(frame.get(Layer::DepthMeters), Some(&Values::F32(vec![3.0; 4])));
    let message = dataset.read_trajectory("ai_001_004", "cam_00").unwrap_err();
    assert!(message.is_not_found() && message.to_string().contains("camera_keyframe_positions.hdf5"), "{message}");
    let message = dataset.read_frame("ai_001_004", "cam_00", 1, &[Layer::Position]).unwrap_err().to_string();
    assert!(message.contains("metadata_scene.csv"), "nothing says what a unit is: {message}");
    fs::write(folder.path().join(TABLE), table("ai_001_004")).unwrap();
    let dataset = Dataset::open(&root).unwrap();
    let frame = dataset.read_frame("ai_001_004", "cam_00", 1, &[Layer::Position, Layer::DepthZMeters]).unwrap();
    assert_eq!(frame.get(Layer::Position), Some(&Values::F32(vec![2.5; 12])));
    assert!(dataset.cameras("ai_001_005").unwrap_err().is_not_found(), "a scene that is not there");
}

#[test]
fn hypersims_own_distances_have_planar_depth() {
    let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
        return eprintln!("skipped: ENFILADE_SCENES is not set");
    };
    let dataset = Dataset::open(Path::new(&scenes).join("hypersim-real")).unwrap();
    assert!(dataset.is_released("ai_037_002"));
    // The archive's metadata_scene.csv is missing; the unit is in the table of cameras.
    let metres = dataset.meters_per_asset_unit("ai_037_002").unwrap();
    let steps = dataset.read_trajectory("ai_037_002", "cam_00").unwrap().poses;
    let mean = steps.windows(2).map(|pair| pair[0].position.distance(pair[1].position)).sum::<f64>() / 99.0;
    assert!((mean - 1.07).abs() < 0.01, "steps of {mean} m at {metres} m per unit");
    let frame = dataset.read_frame("ai_037_002", "cam_00", 0, &[Layer::DepthMeters, Layer::DepthZMeters]).unwrap();
    let [distance, planar] = [Layer::DepthMeters, Layer::DepthZMeters].map(|layer| frame.get(layer).unwrap());
    assert!((0..planar.len()).all(|i| planar.get(i) > 0.5 * distance.get(i) && planar.get(i) <= distance.get(i) * (1.0 + 1e-6)));
}
