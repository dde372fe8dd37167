//! EuRoC: pictures, inertial measurements and true motion agree in time and place.

use enfilade_dataset::{Dataset, StereoRecord, StereoSide};
use enfilade_export::{Existing, ExportConfig, Format, Selection, export};
use enfilade_math::{DQuat, DVec3};
use enfilade_scene::{Heard, Trajectory};
use std::path::{Path, PathBuf};

/// A video: the frames are a tenth of a second apart.
fn video(root: &Path) -> Dataset {
    let dataset = crate::common::write(root, &crate::common::pinhole());
    dataset.write_frame_time("room", "cam_00", 0.1).unwrap();
    dataset
}

/// Rows of a table without its head.
fn rows(path: &Path) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.starts_with('#'), "{text}");
    text.lines().skip(1).map(|line| line.split(',').map(ToString::to_string).collect()).collect()
}

/// The first camera of the room.
fn config() -> ExportConfig {
    let selection = Selection { scenes: vec!["room".into()], cameras: Some(vec!["cam_00".into()]), ..Selection::default() };
    ExportConfig { selection, ..ExportConfig::new(Format::Euroc, Vec::new()) }
}

fn exported(dataset: &Dataset, out: &Path) -> PathBuf {
    export(dataset, &config(), out, Existing::Refuse, &Heard::default()).unwrap();
    out.join("room_cam_00/mav0")
}

#[test]
fn pictures_measurements_and_motion_have_one_clock_and_one_body() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = video(&folder.path().join("dataset"));
    let mav = exported(&dataset, &folder.path().join("out"));
    let pictures = rows(&mav.join("cam0/data.csv"));
    assert_eq!(
        pictures.iter().map(|row| row[0].as_str()).collect::<Vec<_>>(),
        ["1400000000000000000", "1400000000100000000", "1400000000300000000"]
    );
    assert!(pictures.iter().all(|row| std::fs::read(mav.join("cam0/data").join(&row[1])).unwrap().starts_with(b"\x89PNG")));
    // Twenty samples from frame to frame, of which one is missing.
    let (measured, truth) = (rows(&mav.join("imu0/data.csv")), rows(&mav.join("state_groundtruth_estimate0/data.csv")));
    assert_eq!((measured.len(), truth.len(), measured[0].len(), truth[0].len()), (61, 61, 7, 17));
    let number = |row: &[String], at: usize| row[at].parse::<f64>().unwrap();
    let vector = |row: &[String], at: usize| DVec3::new(number(row, at), number(row, at + 1), number(row, at + 2));
    let rotation = |row: &[String]| DQuat::from_xyzw(number(row, 5), number(row, 6), number(row, 7), number(row, 4));
    let poses = dataset.read_trajectory("room", "cam_00").unwrap().poses;
    for pose in &poses {
        let row = &truth[20 * pose.frame as usize];
        assert!(vector(row, 1).distance(pose.position) < 1e-9);
        assert!((rotation(row) * DVec3::Z).abs_diff_eq(-pose.world_from_camera.z_axis, 1e-9));
    }
    // Force and velocity agree: the measured acceleration without gravity is the change of velocity.
    for (k, pair) in truth.windows(3).enumerate() {
        assert_eq!(measured[k][0], truth[k][0]);
        let acceleration = rotation(&pair[1]) * vector(&measured[k + 1], 4) - DVec3::Z * 9.80665;
        let change = (vector(&pair[2], 8) - vector(&pair[0], 8)) / 0.01;
        assert!(acceleration.distance(change) <= 0.05 + 0.03 * change.length(), "{k}: {acceleration} {change}");
    }
    let yaml = std::fs::read_to_string(mav.join("cam0/sensor.yaml")).unwrap();
    assert!(yaml.contains("rate_hz: 10\n") && yaml.contains("intrinsics: [33, 34.5, 18.75, 15.25]"), "{yaml}");
    assert!(std::fs::read_to_string(mav.join("imu0/sensor.yaml")).unwrap().contains("rate_hz: 200\n"));
}

/// EuRoC's own pictures are called `1403636579763555584.png`; DROID-SLAM and DPVO take `sorted(glob("*.png"))` for the order of time, and
/// Kalibr's `bagcreater` takes what is before the last nine digits for seconds.
#[test]
fn sorted_names_are_in_order_of_time_beyond_a_second_and_have_seconds() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = video(&folder.path().join("dataset"));
    dataset.write_frame_time("room", "cam_00", 0.4).unwrap();
    let mav = exported(&dataset, &folder.path().join("out"));
    let listed: Vec<String> = rows(&mav.join("cam0/data.csv")).into_iter().map(|row| row[1].clone()).collect();
    let mut sorted = listed.clone();
    sorted.sort();
    assert!(listed == sorted && listed.len() == 3 && listed[2] == "1400000001200000000.png", "{listed:?}");
    let kalibr = |name: &String| name.strip_suffix(".png").map(|time| (time[..time.len() - 9].parse::<u64>(), time.len()));
    assert!(listed.iter().all(|name| matches!(kalibr(name), Some((Ok(1_400_000_000 | 1_400_000_001), 19)))));
    for file in ["imu0/data.csv", "state_groundtruth_estimate0/data.csv"] {
        let times: Vec<String> = rows(&mav.join(file)).into_iter().map(|row| row[0].clone()).collect();
        assert_eq!((times[0].as_str(), times.last().unwrap().as_str()), ("1400000000000000000", "1400000001200000000"), "{file}");
    }
}

#[test]
fn the_right_camera_of_a_rig_is_cam1_of_the_left() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = video(&folder.path().join("dataset"));
    let camera = crate::common::pinhole();
    let left = dataset.read_trajectory("room", "cam_00").unwrap();
    for (name, side, partner) in [("cam_00", StereoSide::Left, "cam_01"), ("cam_01", StereoSide::Right, "cam_00")] {
        let trajectory = Trajectory { name: name.into(), poses: left.poses.clone() };
        dataset.write_trajectory("room", &trajectory, &camera, Some(&StereoRecord::new(side, partner.into(), 0.12))).unwrap();
        dataset.write_frame_time("room", name, 0.1).unwrap();
    }
    let out = folder.path().join("out");
    export(&dataset, &ExportConfig::new(Format::Euroc, vec!["room".into()]), &out, Existing::Refuse, &Heard::default()).unwrap();
    let mav = out.join("room_cam_00/mav0");
    let yaml = std::fs::read_to_string(mav.join("cam1/sensor.yaml")).unwrap();
    assert!(yaml.contains("data: [1, 0, 0, 0.12, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]"), "{yaml}");
    assert_eq!(rows(&mav.join("cam1/data.csv")).len(), 1);
    assert!(!out.join("room_cam_01").exists());
}

#[test]
fn without_the_motion_of_a_video_it_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = video(&folder.path().join("dataset"));
    dataset.write_frame_time("room", "cam_00", 1.0).unwrap();
    let error = export(&dataset, &config(), &folder.path().join("out"), Existing::Refuse, &Heard::default()).unwrap_err().to_string();
    assert!(error.contains("room/cam_00") && error.contains("kind = \"video\""), "{error}");
}
