//! Claims about heights, limits of pitch, overlap, and views that are not worth taking.

use super::*;
use crate::testroom::cuboid;
use enfilade_math::Vec3;

/// The house of [`house_with_window`] is the box from here ...
const HOUSE_MIN: DVec3 = DVec3::new(0.0, 0.0, 0.0);
/// ... to here.
const HOUSE_MAX: DVec3 = DVec3::new(5.9, 4.9, 2.6);

/// A house in the open: walls without thickness that look inward, a window of 1.2 m without a pane in one of them, and a gap of
/// 3 cm in another. The ground continues outside.
fn house_with_window(ceiling: bool) -> Room {
    let quad = |a: DVec3, b: DVec3, c: DVec3, d: DVec3| [[a, b, c], [a, c, d]].map(|t| t.map(|p| p.as_vec3()));
    let (min, max) = (HOUSE_MIN, HOUSE_MAX);
    // A wall at x, seen from inside, from y0 to y1 and z0 to z1.
    let wall = |x: f64, y: [f64; 2], z: [f64; 2], to_min: bool| {
        let p = |y: f64, z: f64| DVec3::new(x, y, z);
        let [a, b, c, d] = [p(y[0], z[0]), p(y[1], z[0]), p(y[1], z[1]), p(y[0], z[1])];
        if to_min { quad(a, d, c, b) } else { quad(a, b, c, d) }
    };
    let ys = [min.y, max.y];
    let mut corners: Vec<[Vec3; 3]> = Vec::new();
    for (y, z) in [(ys, [0.0, 0.8]), (ys, [2.0, 2.6]), ([0.0, 1.8], [0.8, 2.0]), ([3.0, 4.9], [0.8, 2.0])] {
        corners.extend(wall(max.x, y, z, true));
    }
    for y in [[0.0, 2.4], [2.43, 4.9]] {
        corners.extend(wall(min.x, y, [0.0, 2.6], false));
    }
    let shell = cuboid(min, max, true);
    // The walls at y = 0 and y = 4.9, and the ceiling.
    let flat = |t: &[Vec3; 3], axis: usize, at: f64| t.iter().all(|p| (f64::from(p[axis]) - at).abs() < 1e-6);
    corners.extend(shell.iter().copied().filter(|t| flat(t, 1, min.y) || flat(t, 1, max.y) || (ceiling && flat(t, 2, max.z))));
    corners.extend(quad(
        DVec3::new(-6.0, -6.0, 0.0),
        DVec3::new(12.0, -6.0, 0.0),
        DVec3::new(12.0, 11.0, 0.0),
        DVec3::new(-6.0, 11.0, 0.0),
    ));
    corners.extend(cuboid(DVec3::new(1.0, 1.0, 0.0), DVec3::new(2.2, 1.6, 0.8), false));
    // Something to look at out there.
    corners.extend(cuboid(DVec3::new(8.0, 1.0, 0.0), DVec3::new(9.0, 3.0, 2.5), false));
    Room::from_corners(corners)
}

#[test]
fn no_trajectory_leaves_through_a_window_or_a_gap_thinner_than_a_voxel() {
    for ceiling in [true, false] {
        let room = house_with_window(ceiling);
        // What carving itself leaves out is kept, so that the views have to do it.
        let space = carved_with_outside(&room);
        let outside = DVec3::new(7.0, 2.4, 1.4);
        assert_eq!(space.tree.state(outside), enfilade_geometry::Voxel::Free, "free space must reach through the window");
        for (mode, seed) in modes().into_iter().flat_map(|mode| [1, 2].map(|seed| (mode.clone(), seed))) {
            let max_void_share = if ceiling { 0.2 } else { 0.8 };
            let config = PlanConfig { mode, seed, max_void_share, clearance_m: 0.1, ..quick() };
            for pose in trajectory(&room, &space, &start(), 0, &config, &Quiet).unwrap().poses {
                let p = pose.position;
                let inside = p.cmpge(HOUSE_MIN - 0.3).all() && p.cmple(HOUSE_MAX + 0.3).all();
                assert!(inside, "{} {seed} frame {}: {p}", config.mode.name(), pose.frame);
            }
        }
    }
}

#[test]
fn without_the_gates_some_views_would_be_from_outside() {
    let room = house_with_window(true);
    let stills = Mode::Stills(StillsConfig::default());
    let config =
        PlanConfig { mode: stills, clearance_m: 0.1, max_open_share: 1.0, max_back_face_share: 1.0, max_void_share: 1.0, ..quick() };
    let poses = trajectory(&room, &carved_with_outside(&room), &start(), 0, &config, &Quiet).unwrap().poses;
    assert!(poses.iter().any(|pose| pose.position.x > HOUSE_MAX.x + 0.5));
}

#[test]
fn a_gap_thinner_than_a_voxel_lets_nothing_through() {
    let room = house_with_window(true);
    let space = carved(&room);
    // Beyond the gap, seen from the start through it, were it open.
    let beyond = start().position + 1.5 * (DVec3::new(0.0, 2.415, 1.5) - start().position);
    assert_ne!(space.tree.state(beyond), enfilade_geometry::Voxel::Free);
}

#[test]
fn a_view_of_backs_is_a_fault_unless_the_part_was_modelled_inside_out() {
    let outside = Pose::look_at(0, DVec3::new(3.0, 9.0, 1.3), DVec3::new(3.0, 5.0, 1.3), DVec3::Z).unwrap();
    let fault = |inside_out: bool| {
        let shell = cuboid(DVec3::ZERO, DVec3::new(5.9, 4.9, 2.6), !inside_out);
        // Another building behind the camera, so that it is not in the open.
        let around = cuboid(DVec3::new(-9.0, -9.0, -1.0), DVec3::new(15.0, 15.0, 9.0), true);
        let room = Room::from_parts(vec![shell, around]);
        let space = carved(&room);
        with_planner(&room, &space, &quick(), |planner| {
            (planner.gates.fault(&outside, None), planner.gates.back_face_share(&planner.gates.glancer.look(&outside)))
        })
    };
    assert_eq!(fault(false).0, Some(Fault::BackFaces));
    assert!(fault(false).1 > 0.3);
    // Seen from inside, such a shell shows nothing but backs, so backs are no sign of a fault there.
    assert_eq!(fault(true), (None, 0.0));
}

#[test]
fn a_view_of_something_too_near_is_a_fault() {
    let room = furnished_room();
    let space = carved(&room);
    let near = Pose::look_at(0, DVec3::new(3.0, 0.2, 1.5), DVec3::new(3.0, -0.03, 1.5), DVec3::Z).unwrap();
    with_planner(&room, &space, &quick(), |planner| {
        assert_eq!(planner.gates.fault(&near, None), Some(Fault::Near));
        let glance = planner.gates.glancer.look(&near);
        assert!(glance.plane_share() == 1.0 && planner.gates.near_share(&glance) > 0.9);
        assert_eq!(planner.gates.fault(&start().pose(0), None), None);
    });
}

#[test]
fn cameras_stand_at_the_height_asked_for_and_look_level() {
    let room = furnished_room();
    let space = carved(&room);
    for (mode, range) in modes().into_iter().flat_map(|mode| [(mode.clone(), [1.3, 1.7]), (mode, [0.3, 0.6])]) {
        let config = PlanConfig { mode, camera_height_m: Some(range), level: true, frames: 12, ..quick() };
        let planned = plan(&room.world, &room.bvh, &space, &start(), 0, &config, &Quiet).unwrap();
        for pose in &planned.trajectory.poses {
            // The floor is at -0.03, and no place is above a table.
            let (h, name) = (pose.position.z + 0.03, config.mode.name());
            assert!(h > range[0] - 1e-6 && h < range[1] + 1e-6, "{name} frame {}: {h} m", pose.frame);
            assert!(pose.roll_rad().abs() < 1e-9 && pose.world_from_camera.z_axis.z.abs() < 1e-9, "{name} frame {}", pose.frame);
        }
        let measured = planned.report.statistics.height_m;
        assert!(measured.min > range[0] - 1e-4 && measured.max < range[1] + 1e-4, "{measured:?}");
    }
}

#[test]
fn a_band_of_heights_thinner_than_a_voxel_has_places() {
    // Between the centres of voxels 1.48 and 1.58 m above the floor.
    let band = [1.5, 1.54];
    let room = furnished_room();
    let space = carved(&room);
    for mode in modes() {
        let config = PlanConfig { mode, camera_height_m: Some(band), frames: 12, ..quick() };
        let planned = plan(&room.world, &room.bvh, &space, &start(), 0, &config, &Quiet).unwrap();
        let (height, name) = (planned.report.statistics.height_m, config.mode.name());
        assert!(height.min >= band[0] - 1e-6 && height.max <= band[1] + 1e-6, "{name}: {height:?}");
        assert!(planned.trajectory.poses.len() >= 10, "{name}: {} poses", planned.trajectory.poses.len());
    }
}

#[test]
fn a_start_camera_above_a_table_is_brought_down_beside_it() {
    let room = furnished_room();
    let space = carved(&room);
    let above = camera(DVec3::new(1.6, 1.3, 1.7), DVec3::new(3.0, 4.0, 1.2), DVec3::Z);
    let config = PlanConfig { camera_height_m: Some([0.3, 0.6]), frames: 1, ..quick() };
    let heard = Heard::default();
    let first = trajectory(&room, &space, &above, 0, &config, &heard).unwrap().poses[0];
    let height_m = first.position.z + 0.03;
    assert!((0.3 - 1e-6..=0.6 + 1e-6).contains(&height_m), "{height_m} m");
    assert!((first.position - above.position).truncate().length() <= 1.0, "{}", first.position);
    assert!(heard.lines().join("\n").contains("not at the height asked for"));
}

#[test]
fn targets_go_up_a_platform_with_the_camera() {
    // Most of the room is 0.9 m above the rest, more than `height_range_m`.
    let shell = cuboid(DVec3::new(2.03, -0.03, -0.03), DVec3::new(11.93, 4.93, 3.63), true);
    let platform = cuboid(DVec3::new(4.0, -0.5, -0.5), DVec3::new(12.5, 5.5, 0.87), false);
    let room = Room::from_corners([shell, platform].concat());
    let space = carved(&room);
    let band = [1.4, 1.7];
    let config = PlanConfig { camera_height_m: Some(band), step_m: [1.5, 1.5, 1.2], frames: 200, ..quick() };
    let poses = trajectory(&room, &space, &start(), 0, &config, &Quiet).unwrap().poses;
    let down_m = |pose: &Pose| pose.look_at.z - pose.position.z;
    let on_platform = |pose: &Pose| pose.position.z > 2.0;
    let pairs: Vec<&[Pose]> = poses.windows(2).filter(|pair| pair.iter().all(on_platform)).collect();
    assert!(pairs.len() > 5, "{} frames on the platform", pairs.len());
    for pair in pairs {
        let change_m = (down_m(&pair[1]) - down_m(&poses[0])).abs();
        assert!(change_m <= config.height_range_m + band[1] - band[0] + 1e-6, "frame {}: {change_m} m", pair[1].frame);
    }
}

#[test]
fn views_stay_within_the_limits_of_pitch() {
    let room = furnished_room();
    let space = carved(&room);
    for mode in modes() {
        let config = PlanConfig { mode, pitch_limits_deg: [-20.0, -5.0], frames: 12, ..quick() };
        let planned = plan(&room.world, &room.bvh, &space, &start(), 0, &config, &Quiet).unwrap();
        let pitch = planned.report.statistics.pitch_deg;
        assert!(pitch.min >= -20.0 - 1e-6 && pitch.max <= -5.0 + 1e-6, "{}: {pitch:?}", config.mode.name());
        assert!(planned.report.relaxed.is_empty());
    }
}

#[test]
fn neighbouring_views_share_as_much_as_asked_for() {
    let room = furnished_room();
    let space = carved(&room);
    let mean = |overlap: [f64; 2]| {
        let config = PlanConfig { overlap: Some(overlap), candidates: 60, frames: 100, ..quick() };
        let report = plan(&room.world, &room.bvh, &space, &start(), 0, &config, &Quiet).unwrap().report;
        let relaxed = report.relaxed.iter().filter(|r| r.fault == Fault::Overlap).count();
        let within = report.per_frame.overlap.iter().flatten().filter(|v| **v >= overlap[0] && **v <= overlap[1]).count();
        assert_eq!((within + relaxed, report.per_frame.overlap[0]), (99, None));
        assert!(relaxed <= 14 && report.rejected.overlap > 0, "{relaxed} of 99 relaxed");
        report.statistics.overlap.mean
    };
    let (little, much) = (mean([0.1, 0.4]), mean([0.6, 0.95]));
    assert!(little < 0.4 && much > 0.6, "{little} {much}");
}

#[test]
fn overlap_is_the_share_of_points_that_both_views_see() {
    let room = furnished_room();
    let space = carved(&room);
    with_planner(&room, &space, &quick(), |planner| {
        let glancer = planner.gates.glancer;
        let (here, back) = (start().pose(0), camera(start().position, start().position - DVec3::Y, DVec3::Z).pose(1));
        assert_eq!(glancer.overlap(&glancer.look(&here), &here), Some(1.0));
        assert_eq!(glancer.overlap(&glancer.look(&back), &here), Some(0.0));
        let aside = Pose::look_at(2, here.position + 0.5 * DVec3::X, here.look_at + 0.5 * DVec3::X, DVec3::Z).unwrap();
        let share = glancer.overlap(&glancer.look(&aside), &here).unwrap();
        assert!((0.5..0.95).contains(&share), "{share}");
    });
}

#[test]
fn an_open_start_is_taken_as_it_is_with_a_warning() {
    let mut room = furnished_room();
    // Only the floor and the furniture stay.
    let low = |t: &[Vec3; 3]| t.iter().all(|p| p.z < 2.0) && t.iter().any(|p| p.z > -0.02) || t.iter().all(|p| p.z < 0.0);
    room = Room::from_corners(room.world.corners.iter().copied().filter(low).collect());
    let (space, heard) = (carved(&room), Heard::default());
    let config = PlanConfig { frames: 2, max_void_share: 1.0, ..quick() };
    plan(&room.world, &room.bvh, &space, &start(), 0, &config, &heard).unwrap();
    assert!(heard.lines().join("\n").contains("is in the open"));
}

#[test]
fn settings_out_of_their_domain_are_refused() {
    let refused = |config: PlanConfig| config.validate().unwrap_err().to_string();
    assert!(refused(PlanConfig { overlap: Some([0.5, 0.2]), ..quick() }).starts_with("overlap = [0.5, 0.2]: expected two shares"));
    let video = Mode::Video(VideoConfig::default());
    assert!(refused(PlanConfig { overlap: Some([0.2, 0.5]), mode: video, ..quick() }).contains("expected mode walk"));
    assert!(refused(PlanConfig { camera_height_m: Some([1.5, 1.5]), ..quick() }).starts_with("camera_height_m = [1.5, 1.5]"));
    assert!(refused(PlanConfig { pitch_limits_deg: [10.0, -10.0], ..quick() }).starts_with("pitch_limits_deg"));
    assert!(refused(PlanConfig { max_open_share: 1.5, ..quick() }).starts_with("max_open_share = 1.5"));
    let mode = Mode::Video(VideoConfig { fps: 0.0, ..VideoConfig::default() });
    assert!(refused(PlanConfig { mode, ..quick() }).starts_with("fps = 0: expected"));
}
