//! Shares that are known: two boards, a furnished room seen by cameras of every kind, and a reader that is not ours.

use crate::common::{along_y, board, cuboid, dataset, pinhole, scene};
use enfilade_dataset::{Covisibility, Dataset, HiddenBy};
use enfilade_math::{DMat3, DVec3, Vec3};
use enfilade_multiview::{CovisibilityConfig, Filmed, PairFilter, ScenePackage, choose_pairs, covisibility};
use enfilade_scene::{Camera, Fisheye, Heard, Pose, Projection, Quiet, Scene, Shutter, TiltedPinhole};
use std::process::Command;

const READER: &str = include_str!("covisibility.py");

/// Distance of the second camera to the right of the first, metres.
const BASELINE_M: f64 = 0.61;

fn measured(dataset: &Dataset, config: CovisibilityConfig) -> (Covisibility, Vec<String>) {
    let heard = Heard::default();
    let filmed = Filmed::read(dataset, "room", None, &heard).unwrap();
    let package = ScenePackage::read(&filmed, &heard).unwrap();
    (covisibility(&filmed, package.as_ref(), config, &heard).unwrap(), heard.lines())
}

/// A screen 1 m wide, 2 m before the cameras, and a wall 4 m before them.
fn boards() -> Scene {
    scene(&[board(4.0, -40.0, 40.0), board(2.0, -0.5, 0.5)])
}

/// Two frames of one camera that look at the boards.
fn before_boards(folder: &std::path::Path) -> Dataset {
    let poses = vec![along_y(0, DVec3::ZERO), along_y(1, DVec3::new(BASELINE_M, 0.0, 0.0))];
    dataset(folder, &boards(), &[("cam_00", pinhole().into(), poses)])
}

/// The share of a frame at x = `from` that one at x = `by` sees: column by column, since all rows are alike.
fn share_before_boards(from: f64, by: f64) -> f64 {
    let is_seen = |column: u32| {
        let slope = (f64::from(column) + 0.5 - 32.0) / 32.0;
        let on_screen = (from + 2.0 * slope).abs() < 0.5;
        let distance = if on_screen { 2.0 } else { 4.0 };
        let back = (from + distance * slope - by) / distance;
        back.abs() < 1.0 && (on_screen || (by + 2.0 * back).abs() > 0.5)
    };
    (0..64).filter(|&column| is_seen(column)).count() as f64 / 64.0
}

#[test]
fn shares_before_a_screen_are_those_of_the_closed_form() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = before_boards(folder.path());
    let (found, _) = measured(&dataset, CovisibilityConfig::default());
    assert_eq!((found.hidden_by, found.frames[1].surface_pixels), (HiddenBy::Scene, 3072));
    let expected = [1.0, share_before_boards(0.0, BASELINE_M), share_before_boards(BASELINE_M, 0.0), 1.0];
    assert_eq!(found.shares, expected.map(|share| share as f32));
    // Five columns of the wall leave the image on the left, and five are behind the screen.
    assert_eq!(expected[1], 1.0 - 10.0 / 64.0);
}

#[test]
fn without_the_scene_distances_tell_nearly_the_same_and_the_file_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = before_boards(folder.path());
    std::fs::remove_file(dataset.layout().scene_package("room")).unwrap();
    let (found, _) = measured(&dataset, CovisibilityConfig::default());
    assert_eq!(found.hidden_by, HiddenBy::Distances);
    for (share, expected) in
        [(found.share(0, 1), share_before_boards(0.0, BASELINE_M)), (found.share(1, 0), share_before_boards(BASELINE_M, 0.0))]
    {
        assert!((f64::from(share) - expected).abs() <= 1.0 / 64.0, "{share} {expected}");
    }
    dataset.write_covisibility("room", &found).unwrap();
    let list = std::fs::read_to_string(dataset.layout().covisibility_frames("room")).unwrap();
    assert!(list.ends_with(",distances\n"), "{list}");
}

#[test]
fn a_package_of_another_scene_is_not_asked() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = before_boards(folder.path());
    let mut record = dataset.frame_record("room", "cam_00", 0).unwrap().unwrap();
    let (program, settings) = ("test".into(), serde_json::Value::Null);
    let recipe = enfilade_dataset::Recipe { program, render_version: 1, scene_blake3: "0".repeat(64), settings, time_limit_s: None };
    record.recipe = Some(recipe);
    enfilade_dataset::write_json(&dataset.layout().frame_record("room", "cam_00", 0), &record).unwrap();
    let (found, warnings) = measured(&dataset, CovisibilityConfig::default());
    assert_eq!(found.hidden_by, HiddenBy::Distances);
    assert!(warnings[0].starts_with("room: cam_00/frame.0000 was rendered from another version"), "{warnings:?}");
}

/// A room of 6 by 6 by 3 metres with a cupboard, a table and a partition.
fn furnished() -> Scene {
    let boxes = [
        ([-3.0, -3.0, 0.0], [3.0, 3.0, 3.0]),
        ([1.2, -0.4, 0.0], [1.8, 0.9, 1.9]),
        ([-1.4, 0.3, 0.7], [-0.2, 1.4, 0.75]),
        ([-0.1, -2.9, 0.0], [0.05, -0.8, 2.4]),
    ];
    scene(&boxes.map(|(min, max)| cuboid(Vec3::from(min), Vec3::from(max))))
}

/// A pinhole, a fisheye, a panorama, a tilted pinhole and one whose shutter rolls, two frames each.
fn all_kinds() -> Vec<(&'static str, Camera, Vec<Pose>)> {
    let k = pinhole();
    let tilted = TiltedPinhole::new(64, 48, DMat3::from_rotation_x(0.2) * k.cam_from_uv()).unwrap();
    let mut fisheye_k = k;
    (fisheye_k.fx, fisheye_k.fy) = (18.0, 18.0);
    let rolling = Shutter { exposure_s: 0.01, readout_s: 0.4, frame_time_s: 0.5 };
    let kinds: [(&str, Camera); 5] = [
        ("cam_00", k.into()),
        ("cam_01", Projection::Fisheye(fisheye_k, Fisheye::new([-0.01, 0.002, -0.0003, 0.0]).unwrap()).into()),
        ("cam_02", Projection::Equirectangular { width: 96, height: 48 }.into()),
        ("cam_03", Projection::TiltedPinhole(tilted).into()),
        ("cam_04", Camera { shutter: Some(rolling), ..k.into() }),
    ];
    let pose = |camera: usize, frame: u32| {
        let angle = camera as f64 + 0.3 * f64::from(frame);
        let position = DVec3::new(2.2 * angle.sin(), 2.1 * angle.cos(), 1.5 + 0.1 * angle);
        Pose::look_at(frame, position, DVec3::new(0.3, 0.2 * f64::from(frame), 1.0), DVec3::new(0.05, 0.0, 1.0)).unwrap()
    };
    kinds.into_iter().enumerate().map(|(i, (name, camera))| (name, camera, vec![pose(i, 0), pose(i, 1)])).collect()
}

/// Whether a triangle crosses the segment from `a` to `b`, except for its last thousandth (Möller and Trumbore 1997).
fn crosses(triangle: [Vec3; 3], a: DVec3, b: DVec3) -> bool {
    let [p, q, r] = triangle.map(Vec3::as_dvec3);
    let (along, e1, e2) = (b - a, q - p, r - p);
    let across = along.cross(e2);
    let determinant = e1.dot(across);
    if determinant == 0.0 {
        return false;
    }
    let from = a - p;
    let u = from.dot(across) / determinant;
    let v = along.dot(from.cross(e1)) / determinant;
    let t = e2.dot(from.cross(e1)) / determinant;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < 0.999
}

#[test]
fn cameras_of_every_kind_see_of_each_other_what_brute_force_says() {
    let (folder, scene) = (tempfile::tempdir().unwrap(), furnished());
    let dataset = dataset(folder.path(), &scene, &all_kinds());
    let config = CovisibilityConfig { grid_pixels: 400 };
    let (found, _) = measured(&dataset, config);
    let triangles: Vec<[Vec3; 3]> =
        scene.meshes.iter().flat_map(|mesh| mesh.triangles.iter().map(|t| t.map(|i| mesh.positions[i as usize]))).collect();
    let filmed = Filmed::read(&dataset, "room", None, &Quiet).unwrap();
    let (mut partly, mut compared) = (0, 0);
    for of in 0..filmed.len() {
        let frame = &found.frames[of];
        let view = filmed.view(of);
        let depth = dataset.read_frame("room", &frame.camera, frame.frame, &[enfilade_frame::Layer::DepthMeters]).unwrap();
        let distance = depth.get(enfilade_frame::Layer::DepthMeters).unwrap();
        let grid = enfilade_dataset::CovisibleFrame::grid(view.camera().size(), frame.grid_step_px);
        let points: Vec<DVec3> = grid
            .filter_map(|[x, y]| {
                let ray = view.centre_ray(f64::from(x) + 0.5, f64::from(y) + 0.5)?;
                Some(ray.origin + ray.direction * distance.get((y * depth.width + x) as usize))
            })
            .collect();
        assert_eq!(points.len(), frame.surface_pixels as usize, "the room is closed");
        for by in (0..filmed.len()).filter(|&by| by != of) {
            let other = filmed.view(by);
            let [width, height] = other.camera().size().map(f64::from);
            let is_seen = |p: &DVec3| {
                let Some((x, y)) = other.project(*p) else { return false };
                let inside = (0.0..width).contains(&x) && (0.0..height).contains(&y);
                let Some(ray) = other.centre_ray(x, y).filter(|_| inside) else { return false };
                !triangles.iter().any(|&triangle| crosses(triangle, ray.origin, *p))
            };
            let expected = points.iter().filter(|p| is_seen(p)).count() as f64 / points.len() as f64;
            let share = f64::from(found.share(of, by));
            assert!((share - expected).abs() < 0.006, "{:?} by {:?}: {share}, brute force {expected}", filmed.name(of), filmed.name(by));
            partly += usize::from((0.1..0.9).contains(&expected));
            compared += 1;
        }
    }
    assert!(compared == 90 && partly > 50, "{partly} of {compared}");
    // The room has corners that a pinhole does not see and a panorama does.
    let seen = |by: usize| (0..filmed.len()).map(|of| found.share(of, by)).sum::<f32>();
    assert!(seen(4) > 1.3 * seen(0), "{} {}", seen(4), seen(0));
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = dataset(folder.path(), &furnished(), &all_kinds());
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (found, _) = pool.install(|| measured(&dataset, CovisibilityConfig::default()));
        dataset.write_covisibility("room", &found).unwrap();
        std::fs::read(dataset.layout().covisibility("room")).unwrap()
    };
    assert!(with(1) == with(7));
}

#[test]
fn pairs_have_baseline_and_angle_and_are_filtered() {
    let folder = tempfile::tempdir().unwrap();
    let poses: Vec<Pose> = (0..4).map(|i| along_y(i, DVec3::new(f64::from(i), 0.0, 0.0))).collect();
    let aside = Pose::look_at(0, DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0), DVec3::Z).unwrap();
    let cameras = [("cam_00", Camera::from(pinhole()), poses), ("cam_01", pinhole().into(), vec![aside])];
    let dataset = dataset(folder.path(), &boards(), &cameras);
    let filmed = Filmed::read(&dataset, "room", None, &Quiet).unwrap();
    let (found, _) = measured(&dataset, CovisibilityConfig::default());
    let all = choose_pairs(&filmed, &found, &PairFilter::default());
    assert_eq!(all.len(), 10, "every frame sees something of every other");
    assert!(all.windows(2).all(|pair| pair[0].pair < pair[1].pair));
    let turned = all.iter().find(|row| row.pair.first == ("cam_00".into(), 0) && row.pair.second.0 == "cam_01").unwrap();
    assert!(turned.baseline_m == 0.0 && (turned.angle_deg - 45.0).abs() < 1e-9);
    let filter = PairFilter { baseline_m: [1.5, 2.5], angle_deg: [0.0, 10.0], ..PairFilter::default() };
    let apart: Vec<(u32, u32)> = choose_pairs(&filmed, &found, &filter).iter().map(|row| (row.pair.first.1, row.pair.second.1)).collect();
    assert_eq!(apart, [(0, 2), (1, 3)]);
    let close = PairFilter { overlap: [0.7, 1.0], ..PairFilter::default() };
    assert!(choose_pairs(&filmed, &found, &close).iter().all(|row| row.first_seen_by_second >= 0.7 && row.second_seen_by_first >= 0.7));
}

#[test]
fn numpy_reads_the_same_shares() {
    let Some(python) = std::env::var_os("ENFILADE_PYTHON") else {
        return eprintln!("skipped: ENFILADE_PYTHON names no python");
    };
    let folder = tempfile::tempdir().unwrap();
    let dataset = before_boards(folder.path());
    let (found, _) = measured(&dataset, CovisibilityConfig::default());
    dataset.write_covisibility("room", &found).unwrap();
    let output = Command::new(python).args(["-c", READER]).arg(dataset.layout().scene_dir("room")).output().unwrap();
    assert!(output.status.success(), "{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
}
