//! Claims about the random walk: rules, limits, start cameras in bad places, and repeatability.

use super::*;
use crate::Saliency;

#[test]
fn the_second_camera_of_a_rig_keeps_the_rules_too() {
    let room = furnished_room();
    let (space, config) = (carved(&room), PlanConfig { stereo_baseline_m: 0.6, ..quick() });
    let walk = trajectory(&room, &space, &start(), 0, &config, &Quiet).unwrap();
    for pose in &walk.beside("cam_01".into(), 0.6).poses {
        assert_eq!(space.tree.state(pose.position), enfilade_geometry::Voxel::Free, "frame {}", pose.frame);
        assert!(room.distance_m(pose.position) >= config.clearance_m, "frame {}", pose.frame);
    }
    // Without the rule some would not.
    let alone = trajectory(&room, &space, &start(), 0, &quick(), &Quiet).unwrap().beside("cam_01".into(), 0.6);
    assert!(alone.poses.iter().any(|pose| room.distance_m(pose.position) < config.clearance_m));
}

#[test]
fn every_pose_keeps_the_rules() {
    let room = furnished_room();
    let (space, config) = (carved(&room), quick());
    let walk = trajectory(&room, &space, &start(), 0, &config, &Quiet).unwrap();
    assert_eq!((walk.name.as_str(), walk.poses.len()), ("cam_00", 30));
    let first = walk.poses[0];
    assert_eq!(first.position, start().position);
    for (i, pose) in walk.poses.iter().enumerate() {
        assert_keeps_rules(&room, &space, &config, pose);
        assert_eq!(pose.frame, i as u32);
        if i == 0 {
            continue;
        }
        let last = walk.poses[i - 1];
        for (now, before, origin) in [(pose.position, last.position, first.position), (pose.look_at, last.look_at, first.look_at)] {
            assert!((now - before).abs().cmple(DVec3::from(config.step_m) + 1e-12).all(), "frame {i}: step {}", now - before);
            assert!((now.z - origin.z).abs() <= config.height_range_m + 1e-12, "frame {i}: height");
            assert!(seen(&room, before, now), "frame {i}: hidden from the last");
        }
    }
}

#[test]
fn views_of_many_triangles_are_preferred() {
    let room = furnished_room();
    let space = carved(&room);
    let mean = |saliency| {
        let config = PlanConfig { saliency, frames: 60, ..quick() };
        let walk = trajectory(&room, &space, &start(), 0, &config, &Quiet).unwrap();
        let intrinsics = Intrinsics::from_fov_x(config.test_width, config.test_height, config.fov_x_rad);
        let views = walk.poses.iter().map(|p| crate::view_stats(&room.world, &room.bvh, &intrinsics, p));
        views.map(|v| f64::from(v.triangles)).sum::<f64>() / 60.0
    };
    let (drawn, indifferent) = (mean(Saliency::default()), mean(Saliency::Triangles { alpha: 0.0, beta: 2.0 }));
    assert!(drawn > 1.3 * indifferent, "{drawn} triangles per view with saliency, {indifferent} without");
}

#[test]
fn trajectories_are_the_same_for_any_number_of_threads_and_differ_by_index_and_seed() {
    let room = furnished_room();
    let space = carved(&room);
    let config = PlanConfig { frames: 6, ..quick() };
    let plan_on = |threads, index, config: &PlanConfig| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| trajectory(&room, &space, &start(), index, config, &Quiet)).unwrap().poses
    };
    let one = plan_on(1, 0, &config);
    assert_eq!(one, plan_on(2, 0, &config));
    assert_eq!(one, plan_on(7, 0, &config));
    assert_ne!(one, plan_on(2, 1, &config));
    assert_ne!(one, plan_on(2, 0, &PlanConfig { seed: 1, ..config.clone() }));
}

#[test]
fn a_start_camera_in_free_space_is_frame_0_exactly() {
    let room = furnished_room();
    let space = carved(&room);
    for preset in [Preset::Default, Preset::Paper, Preset::Hypersim] {
        let config = PlanConfig { preset, frames: 3, ..quick() };
        let beside_a_wall = camera(DVec3::new(0.12, 2.5, 1.5), DVec3::new(3.0, 2.5, 1.5), DVec3::Z);
        let in_a_walls_voxel = camera(DVec3::new(0.05, 2.5, 1.5), DVec3::new(3.0, 2.5, 1.5), DVec3::Z);
        let rolled = camera(start().position, DVec3::new(3.0, 4.0, 1.2), DVec3::new(0.5, 0.0, 1.0));
        let down = camera(start().position, start().position - DVec3::Z, DVec3::Y);
        let at_a_wall = camera(DVec3::new(5.8, 1.0, 1.5), DVec3::new(5.9, 1.0, 1.5), DVec3::Z);
        for start in [start(), beside_a_wall, in_a_walls_voxel, rolled, down, at_a_wall] {
            let planned = plan(&room.world, &room.bvh, &space, &start, 0, &config, &Quiet).unwrap();
            let (pose, report) = (planned.trajectory.poses[0], planned.report.start.unwrap());
            assert_eq!((pose.position, pose.world_from_camera), (start.position, start.world_from_camera), "{preset:?}");
            assert!(
                report.is_kept && (preset == Preset::Hypersim || report.looks_along_axis == (start.position.x < 5.5)),
                "{preset:?} {report:?}"
            );
        }
    }
}

#[test]
fn a_start_camera_that_cannot_be_is_moved_or_turned_with_a_warning() {
    let room = furnished_room();
    let space = carved(&room);
    let first = |start: &StartCamera, config: &PlanConfig| {
        let heard = Heard::default();
        let planned = plan(&room.world, &room.bvh, &space, start, 0, config, &heard).unwrap();
        assert_eq!(planned.report.start.unwrap().is_kept, heard.lines().is_empty(), "{:?}", heard.lines());
        (planned.trajectory.poses[0], heard.lines().join("\n"))
    };
    let still = PlanConfig { frames: 1, ..quick() };
    assert_eq!(first(&start(), &still).1, "");
    // With the keys that ask for a height.
    let high = PlanConfig { camera_height_m: Some([1.6, 1.7]), ..still.clone() };
    let (pose, warnings) = first(&start(), &high);
    assert!(warnings.contains("height asked for") && (1.57..=1.67).contains(&pose.position.z), "{warnings}");
    let level = PlanConfig { level: true, ..still.clone() };
    let (pose, warnings) = first(&camera(start().position, DVec3::new(3.0, 4.0, 1.2), DVec3::new(0.5, 0.0, 1.0)), &level);
    assert!(warnings.contains("rolls by") && warnings.contains("looks ") && pose.roll_rad().abs() < 1e-9, "{warnings}");
}

#[test]
fn the_papers_walk_keeps_its_rules_and_no_others() {
    let room = furnished_room();
    let space = carved(&room);
    let config = PlanConfig { preset: Preset::Paper, clearance_m: 0.0, frames: 60, ..quick() };
    let walk = plan(&room.world, &room.bvh, &space, &start(), 0, &config, &Quiet).unwrap();
    assert_eq!((walk.report.preset, walk.report.rejected), (Preset::Paper, RejectedCounts::default()));
    let poses = walk.trajectory.poses;
    let is_free = |p: DVec3| space.tree.state(p) == enfilade_geometry::Voxel::Free;
    for pair in poses.windows(2) {
        let ([last, pose], first) = ([pair[0], pair[1]], poses[0]);
        assert!(is_free(pose.position) && is_free(pose.look_at) && pose.roll_rad().abs() <= 5f64.to_radians() + 1e-9);
        for (now, before, origin) in [(pose.position, last.position, first.position), (pose.look_at, last.look_at, first.look_at)] {
            assert!((now - before).abs().cmple(DVec3::from(config.step_m) + 1e-12).all() && (now.z - origin.z).abs() <= 0.25 + 1e-12);
            assert!(seen(&room, before, now));
        }
    }
    // Rolls are as different as poses are, over the whole range; some views would not pass ours.
    let rolls: Vec<f64> = poses[1..].iter().map(|pose| pose.roll_rad().to_degrees()).collect();
    assert!(rolls.iter().any(|roll| *roll > 3.5) && rolls.iter().any(|roll| *roll < -3.5), "{rolls:?}");
    assert!(poses.iter().any(|pose| room.distance_m(pose.position) < 0.2 || !seen(&room, pose.position, pose.look_at)));
    // Where nothing is free around the target, there is no last resort.
    let mut tree = enfilade_geometry::OccupancyTree::new(0.1);
    tree.set(tree.key(start().position).unwrap(), enfilade_geometry::Voxel::Free);
    let space = FreeSpace::new(tree, crate::CarveReport::default()).unwrap();
    let far = PlanConfig { step_m: [0.01, 0.01, 0.0], height_range_m: 0.0, ..config };
    assert!(plan(&room.world, &room.bvh, &space, &start(), 0, &far, &Quiet).is_err());
}

#[test]
fn impossible_starts_are_errors_that_say_where() {
    let room = furnished_room();
    let space = carved(&room);
    let run = |start: StartCamera, config: PlanConfig| trajectory(&room, &space, &start, 2, &config, &Quiet).unwrap_err();
    let outside = camera(DVec3::new(9.0, 9.0, 1.5), DVec3::new(3.0, 4.0, 1.2), DVec3::Z);
    assert!(matches!(run(outside, quick()), ExploreError::StartBlocked { .. }));
    assert!(matches!(run(start(), PlanConfig { clearance_m: 5.0, ..quick() }), ExploreError::Stuck { frame: 1, .. }));
    // A height that no room has is not blamed on the clearance alone.
    let high = run(start(), PlanConfig { camera_height_m: Some([5.0, 6.0]), ..quick() }).to_string();
    assert!(high.contains("is 5 to 6 m above the floor, as camera_height_m asks; move the camera, change camera_height_m"), "{high}");
    assert!(matches!(run(start(), PlanConfig { min_look_distance_m: 50.0, ..quick() }), ExploreError::Stuck { frame: 1, .. }));
    assert!(run(start(), PlanConfig { frames: 0, ..quick() }).to_string().starts_with("frames = 0: expected"));
}

#[test]
fn a_walk_that_cannot_go_on_says_where_it_is_stuck() {
    // Free are only the voxel of the camera and a few around its target; one sample per step does not find them again.
    let room = furnished_room();
    let camera = start();
    let mut tree = enfilade_geometry::OccupancyTree::new(0.1);
    let target = camera.position - camera.world_from_camera.z_axis;
    for p in [camera.position, target, target + DVec3::Y * 0.1, target + DVec3::Y * 0.2, target + DVec3::Y * 0.3] {
        tree.set(tree.key(p).unwrap(), enfilade_geometry::Voxel::Free);
    }
    let space = FreeSpace::new(tree, crate::CarveReport::default()).unwrap();
    let config = PlanConfig { queries: 1, step_m: [15.0, 15.0, 0.25], ..quick() };
    let error = trajectory(&room, &space, &camera, 2, &config, &Quiet).unwrap_err();
    assert!(error.to_string().starts_with("trajectory cam_02 is stuck at frame 1, position [3, 2.5, 1.5]: of 4 "), "{error}");
}

#[test]
fn warnings_name_a_trajectory_as_its_caller_does() {
    let mut room = furnished_room();
    room.remove_ceiling();
    let (space, heard) = (carved(&room), Heard::default());
    let config = PlanConfig { max_void_share: 0.0, frames: 3, fov_x_rad: 2.6, ..quick() };
    // The left camera of the second rig.
    let named = plan_accepted(&room.world, &room.bvh, &space, &start(), "cam_02", 1, &config, &|_| true, &heard).unwrap();
    assert_eq!((named.trajectory.name.as_str(), named.report.trajectory.as_str()), ("cam_02", "cam_02"));
    let warnings = heard.lines().join("\n");
    assert!(warnings.contains("cam_02") && !warnings.contains("cam_01"), "{warnings}");
    assert_eq!(named.trajectory.poses, trajectory(&room, &space, &start(), 1, &config, &Quiet).unwrap().poses);
}

#[test]
fn open_rooms_are_planned_with_a_warning_when_every_view_is_empty() {
    let mut room = furnished_room();
    room.remove_ceiling();
    let (space, heard) = (carved(&room), Heard::default());
    let config = PlanConfig { max_void_share: 0.0, frames: 3, fov_x_rad: 2.6, ..quick() };
    assert_eq!(trajectory(&room, &space, &start(), 0, &config, &heard).unwrap().poses.len(), 3);
    assert!(heard.lines().join("\n").contains("views"));
}
