//! Tracks whose answer is known: a camera that passes a screen, and a reader that is not ours.

use crate::common::{along_y, board, dataset, pinhole, scene};
use enfilade_dataset::{Dataset, Tracks};
use enfilade_math::DVec3;
use enfilade_multiview::{Filmed, ScenePackage, TracksConfig, tracks};
use enfilade_scene::{Pose, Quiet};
use std::process::Command;

const READER: &str = include_str!("tracks.py");

/// Nine frames 0.3 m apart that pass a screen 1 m wide, 2 m before them, and a wall 4 m before them.
fn passing(folder: &std::path::Path) -> Dataset {
    let poses: Vec<Pose> = (0..9).map(|i| along_y(2 * i, DVec3::new(0.3 * f64::from(i) - 1.2, 0.0, 0.1))).collect();
    dataset(folder, &scene(&[board(4.0, -40.0, 40.0), board(2.0, -0.5, 0.5)]), &[("cam_00", pinhole().into(), poses)])
}

fn followed(dataset: &Dataset, config: TracksConfig) -> Tracks {
    let filmed = Filmed::read(dataset, "room", None, &Quiet).unwrap();
    let package = ScenePackage::read(&filmed, &Quiet).unwrap().unwrap();
    let frames: Vec<usize> = (0..filmed.len()).collect();
    tracks(&filmed, &package, &frames, config, &Quiet).unwrap()
}

#[test]
fn points_are_where_the_closed_form_has_them_and_occluded_behind_the_screen() {
    let folder = tempfile::tempdir().unwrap();
    let found = followed(&passing(folder.path()), TracksConfig::default());
    assert_eq!((found.positions.len(), found.frames.as_slice()), (256, &[0, 2, 4, 6, 8, 10, 12, 14, 16][..]));
    let (mut hidden, mut outside, mut seen) = (0, 0, 0);
    for (point, p) in found.positions.iter().enumerate() {
        let on_screen = (p.y - 2.0).abs() < 1e-5;
        assert!(on_screen || (p.y - 4.0).abs() < 1e-5, "{p}");
        for t in 0..9 {
            let x = 0.3 * t as f64 - 1.2;
            let expected = [0.5 + 0.5 * (p.x - x) / p.y, 0.5 - 32.0 / 48.0 * (p.z - 0.1) / p.y];
            let at = found.points[9 * point + t].map(f64::from);
            assert!((at[0] - expected[0]).abs() < 1e-5 && (at[1] - expected[1]).abs() < 1e-5, "{at:?} {expected:?}");
            let inside = expected.iter().all(|share| (0.0..1.0).contains(share));
            let crossing = x + (p.x - x) * 2.0 / p.y;
            if !on_screen && (crossing.abs() - 0.5).abs() < 1e-4 {
                continue;
            }
            let behind = !on_screen && crossing.abs() < 0.5;
            assert_eq!(found.occluded[9 * point + t], !inside || behind, "point {point}, frame {t}");
            hidden += usize::from(inside && behind);
            outside += usize::from(!inside);
            seen += usize::from(inside && !behind);
        }
        let (own, [px, py]) = found.seeds[point];
        let at = found.points[9 * point + own as usize];
        assert!((at[0] * 64.0 - px).abs() < 1e-4 && (at[1] * 48.0 - py).abs() < 1e-4 && !found.occluded[9 * point + own as usize]);
    }
    assert!(hidden > 100 && outside > 200 && seen > 1000, "{hidden} hidden, {outside} outside, {seen} seen");
    let own: Vec<u32> = found.seeds.iter().map(|seed| seed.0).collect();
    assert!(own.is_sorted() && (0..9).all(|t| (28..=29).contains(&own.iter().filter(|&&own| own == t).count())));
}

#[test]
fn points_that_a_camera_has_no_image_of_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let back = Pose::look_at(1, DVec3::ZERO, DVec3::NEG_Y, DVec3::Z).unwrap();
    let cameras = [("cam_00", pinhole().into(), vec![along_y(0, DVec3::ZERO), back])];
    let dataset = dataset(folder.path(), &scene(&[board(4.0, -40.0, 40.0)]), &cameras);
    // The second frame shows nothing, so its half of the points is left out.
    let found = followed(&dataset, TracksConfig { points: 10, seed: 3 });
    assert_eq!(found.positions.len(), 5);
    assert!((0..5).all(|point| found.points[2 * point + 1] == [-1.0; 2] && found.occluded[2 * point + 1]));
}

#[test]
fn the_number_of_threads_changes_no_bit_and_the_seed_changes_the_points() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = passing(folder.path());
    let with = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| followed(&dataset, TracksConfig { points: 64, seed }))
    };
    assert_eq!(with(1, 0), with(7, 0));
    assert_ne!(with(1, 0), with(1, 1));
}

#[test]
fn numpy_reads_them_as_a_sample_of_tap_vid() {
    let Some(python) = std::env::var_os("ENFILADE_PYTHON") else {
        return eprintln!("skipped: ENFILADE_PYTHON names no python");
    };
    let folder = tempfile::tempdir().unwrap();
    let dataset = passing(folder.path());
    dataset.write_tracks("room", "cam_00", &followed(&dataset, TracksConfig::default())).unwrap();
    let output = Command::new(python).args(["-c", READER]).arg(dataset.layout().scene_dir("room")).output().unwrap();
    assert!(output.status.success(), "{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
}
