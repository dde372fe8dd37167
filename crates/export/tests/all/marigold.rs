//! Marigold: normals, the lists by side of the partition, and what has none of them. MoGe's lists are divided in the same way.

use enfilade_dataset::{Dataset, FrameInfo, FrameTime, PartitionRow, Side};
use enfilade_export::{Existing, ExportConfig, Format, export};
use enfilade_frame::{Frame, Layer, Values, f16};
use enfilade_math::DVec3;
use enfilade_scene::{Camera, Heard, Intrinsics, Pose, Trajectory};
use std::path::Path;

/// Two scenes of a camera with frames 0 and 7 before a wall 2 m away. Of frame 7 of the first, a pixel has no normal; normals of the second look
/// away and are twice as long as they should.
fn dataset(root: &Path) -> Dataset {
    let dataset = Dataset::create(root).unwrap();
    let camera: Camera = Intrinsics { width: 4, height: 3, fx: 3.0, fy: 3.0, cx: 2.0, cy: 1.5, skew: 0.0 }.into();
    let pose = |frame| Pose::look_at(frame, DVec3::ZERO, DVec3::Y, DVec3::Z).unwrap();
    for scene in ["a", "b"] {
        dataset.write_camera_parameters(scene, &camera).unwrap();
        let trajectory = Trajectory { name: "cam_00".into(), poses: vec![pose(0), pose(7)] };
        dataset.write_trajectory(scene, &trajectory, &camera, None).unwrap();
        for number in [0, 7] {
            let mut frame = Frame::new(4, 3);
            let normal = if scene == "a" { [0.0, 0.0, 1.0] } else { [0.0, 0.0, -2.0] };
            let mut normals: Vec<f16> = (0..12).flat_map(|_| normal).map(f16::from_f64).collect();
            if (scene, number) == ("a", 7) {
                normals[5] = f16::NAN;
            }
            frame.insert(Layer::NormalCam, Values::F16(normals));
            frame.insert(Layer::Color, Values::F16(vec![f16::from_f64(0.5); 36]));
            frame.insert(Layer::RenderEntityId, Values::I16(vec![1; 12]));
            frame.insert(Layer::DepthZMeters, Values::F32(vec![2.0; 12]));
            let (config_hash, camera) = ("test".into(), camera.clone());
            let info = FrameInfo { seed: 1, samples: 1, config_hash, pose: pose(number), camera, sampling: None, recipe: None };
            dataset.write_frame(scene, "cam_00", &frame, &info, FrameTime::default()).unwrap();
        }
    }
    dataset
}

fn exported(dataset: &Dataset, format: Format, out: &Path) -> String {
    let heard = Heard::default();
    export(dataset, &ExportConfig::new(format, vec!["a".into(), "b".into()]), out, Existing::Refuse, &heard).unwrap();
    heard.lines().join("\n")
}

#[test]
fn sides_have_lists_and_normals_face_the_camera() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(&folder.path().join("dataset"));
    let out = folder.path().join("without");
    let heard = exported(&dataset, Format::Marigold, &out);
    assert!(heard.contains("a/cam_00 frame 7 and 0 of 4 frames have pixels without a normal"), "{heard}");
    let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    assert_eq!(read("train/filename_list_train.txt").lines().count(), 4);
    assert_eq!(
        read("train/hypersim_filtered_train.txt"),
        "a/rgb_cam_00_fr0000.png a/normal_cam_cam_00_fr0000.npy\nb/rgb_cam_00_fr0000.png b/normal_cam_cam_00_fr0000.npy\n\
         b/rgb_cam_00_fr0007.png b/normal_cam_cam_00_fr0007.npy\n"
    );
    assert!(!out.join("train/a/normal_cam_cam_00_fr0007.npy").exists() && out.join("train/a/depth_plane_cam_00_fr0007.png").exists());
    for scene in ["a", "b"] {
        let bytes = std::fs::read(out.join(format!("train/{scene}/normal_cam_cam_00_fr0000.npy"))).unwrap();
        let head = String::from_utf8_lossy(&bytes[..128]).into_owned();
        assert!(head.contains("'<f4'") && head.contains("(3, 4, 3)"), "{head}");
        let values: Vec<f32> = bytes[128..].as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
        assert_eq!(values, [0.0, 0.0, 1.0].repeat(12), "{scene}");
    }

    // The table by which E2E-FT finds its files: 12 pixels of one colour 2 m away.
    let table = read("train/filename_meta_train.csv");
    let row = "2,b,cam_00,0,True,,train,b/rgb_cam_00_fr0000.png,204,0,204,204,b/depth_plane_cam_00_fr0000.png,2,0,2,2,0";
    assert_eq!(table.lines().nth(3), Some(row), "{table}");
    let seen = "normals/b/images/scene_cam_00_geometry_preview/frame.0007.normal_cam.png";
    let picture = image::open(out.join(seen)).unwrap().into_rgb8();
    assert!(picture.pixels().all(|pixel| pixel.0 == [128, 128, 255]));

    // By the dataset's partition.
    let row = |scene: &str, frame, side| PartitionRow { scene: scene.into(), camera: "cam_00".into(), frame, side: Ok(side) };
    let rows = [0, 7].into_iter().flat_map(|frame| [row("a", frame, Side::Train), row("b", frame, Side::Val)]);
    dataset.write_partition(&rows.collect::<Vec<_>>()).unwrap();
    let out = folder.path().join("with");
    exported(&dataset, Format::Marigold, &out);
    let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    assert!(read("val/filename_list_val.txt").starts_with("b/rgb_cam_00_fr0000.png b/depth_plane_cam_00_fr0000.png\n"));
    assert!(out.join("train/a/rgb_cam_00_fr0000.png").exists() && !out.join("train/b").exists() && !out.join("test").exists());
    let out = folder.path().join("moge");
    exported(&dataset, Format::Moge, &out);
    let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    assert_eq!(read(".index.txt").lines().collect::<Vec<_>>(), ["a/cam_00_0000", "a/cam_00_0007", "b/cam_00_0000", "b/cam_00_0007"]);
    assert_eq!(read(".val.txt"), "b/cam_00_0000\nb/cam_00_0007\n");
}
