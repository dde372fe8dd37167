//! Photos have the heights, pitches and compositions of photographs.

use super::*;
use crate::plan::composition::Composer;
use crate::testroom::cuboid;

/// A room 7 m by 6 m with furniture along its walls.
fn room() -> Room {
    let boxes = [([0.0, 0.0, 0.0], [2.2, 0.9, 0.9]), ([4.5, 0.0, 0.0], [7.0, 0.6, 0.75]), ([0.0, 4.0, 0.0], [0.6, 6.0, 1.9])];
    let mut parts = vec![cuboid(DVec3::splat(-0.03), DVec3::new(7.03, 6.03, 2.63), true)];
    parts.extend(boxes.map(|(min, max)| cuboid(DVec3::from(min) + 0.01, DVec3::from(max), false)));
    Room::from_parts(parts)
}

fn photographed(frames: u32, photos: PhotosConfig) -> Planned {
    let room = room();
    let config = PlanConfig { frames, mode: Mode::Photos(photos), ..quick() };
    plan(&room.world, &room.bvh, &carved(&room), &start(), 0, &config, &Quiet).unwrap()
}

#[test]
fn heights_and_pitches_are_those_of_photographs() {
    let planned = photographed(80, PhotosConfig { min_distance_m: 0.1, min_angle_deg: 10.0, ..PhotosConfig::default() });
    let of = |values: Vec<f64>| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        (mean, (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt())
    };
    let report = &planned.report.per_frame;
    assert_eq!(report.frame.len(), 80);
    // Views are chosen by what they show, too, so their pitch is not quite what is drawn.
    let (height, deviation) = of(report.height_m[1..].iter().map(|height| height.unwrap()).collect());
    assert!((height - 1.34).abs() < 0.05 && (deviation - 0.1).abs() < 0.03, "{height} ± {deviation} m");
    let (pitch, deviation) = of(report.pitch_deg[1..].to_vec());
    assert!((pitch + 13.3).abs() < 4.0 && (deviation - 6.9).abs() < 2.5, "{pitch} ± {deviation} degrees");
}

/// The mean logarithm of the likelihood of photos' compositions exceeds that of stills at the same heights.
#[test]
fn photos_are_composed_as_photographs_are() {
    let room = room();
    let space = carved(&room);
    let likelihood = |mode: Mode| {
        let config = PlanConfig { frames: 25, mode, camera_height_m: Some([1.1, 1.6]), ..quick() };
        let planned = plan(&room.world, &room.bvh, &space, &start(), 0, &config, &Quiet).unwrap();
        let composer = Composer::new(&room.world, &[]);
        with_planner(&room, &space, &config, |planner| {
            let glancer = planner.gates.glancer;
            let found = planned.trajectory.poses[1..].iter().map(|pose| composer.likelihood(glancer, pose, &glancer.look(pose)).ln());
            found.sum::<f64>() / (planned.trajectory.poses.len() - 1) as f64
        })
    };
    let stills = likelihood(Mode::Stills(StillsConfig { min_distance_m: 0.3, ..StillsConfig::default() }));
    let photos = likelihood(Mode::Photos(PhotosConfig::default()));
    assert!(photos > stills + 1.0, "photos {photos}, stills {stills}");
}

/// Known distances: a view along the axis of a box room with a cube before the camera.
#[test]
fn thirds_sides_and_things_are_measured() {
    let shell = cuboid(DVec3::new(-4.0, -3.0, 0.0), DVec3::new(4.0, 3.0, 3.0), true);
    let cube = cuboid(DVec3::new(-0.2, 1.3, 0.8), DVec3::new(0.2, 1.7, 1.2), false);
    let room = Room::from_parts(vec![shell, cube]);
    let config = PlanConfig { test_width: 256, test_height: 192, ..PlanConfig::default() };
    let pose = Pose::look_at(0, DVec3::new(0.0, -1.0, 1.0), DVec3::new(0.0, 3.0, 1.0), DVec3::Z).unwrap();
    let found = with_planner(&room, &carved(&room), &config, |planner| {
        let glancer = planner.gates.glancer;
        Composer::new(&room.world, &[]).composition(glancer, &pose, &glancer.look(&pose)).unwrap()
    });
    let [upper, middle, lower, sides, things] = found;
    // The far wall is 4 m away and fills the upper and the middle third but for the cube; the floor comes nearer below.
    assert!((upper - 4f64.ln()).abs() < 0.02 && middle < upper && lower < middle, "{found:?}");
    assert!(sides > 0.0, "the cube is in the middle: {found:?}");
    // The cube's front is 0.4 m wide and 2.3 m away, in a picture of 1.155 by 0.866 at unit distance.
    let share = (0.4f64 / 2.3).powi(2) / (1.1547 * 0.8660);
    assert!((things - share).abs() < 0.01, "{things} is not {share}");
}
