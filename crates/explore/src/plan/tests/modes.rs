//! Claims about each mode.

use super::coverage::{Tally, seen_by_each};
use super::patches::patches;
use super::rules::turned_rad;
use super::*;
use enfilade_testkit::chi_square_survival;

#[test]
fn every_mode_keeps_the_rules_and_numbers_its_frames() {
    let room = furnished_room();
    let space = carved(&room);
    for mode in modes() {
        let config = PlanConfig { mode, roll_limit_deg: 3.0, ..quick() };
        let planned = plan(&room.world, &room.bvh, &space, &start(), 0, &config, &Quiet).unwrap();
        assert!(planned.trajectory.poses.len() >= 10, "{}: {} poses", config.mode.name(), planned.trajectory.poses.len());
        for (i, pose) in planned.trajectory.poses.iter().enumerate() {
            assert_keeps_rules(&room, &space, &config, pose);
            assert_eq!(pose.frame, i as u32);
        }
        assert_eq!(planned.report.mode, config.mode.name());
        assert_eq!(planned.report.per_frame.score.len(), planned.trajectory.poses.len());
        assert!(planned.report.relaxed.is_empty(), "{}: {:?}", config.mode.name(), planned.report.relaxed);
    }
}

#[test]
fn every_mode_plans_the_same_on_any_number_of_threads() {
    let room = furnished_room();
    let space = carved(&room);
    for mode in modes() {
        let config = PlanConfig { mode, frames: 8, ..quick() };
        let plan_on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| plan(&room.world, &room.bvh, &space, &start(), 0, &config, &Quiet)).unwrap()
        };
        let one = plan_on(1);
        assert_eq!(one, plan_on(2), "{}", config.mode.name());
        assert_eq!(one, plan_on(7), "{}", config.mode.name());
    }
}

#[test]
fn every_mode_leaves_room_for_the_second_camera() {
    let room = furnished_room();
    let space = carved(&room);
    for mode in modes() {
        let config = PlanConfig { mode, frames: 12, stereo_baseline_m: 0.4, ..quick() };
        for pose in &trajectory(&room, &space, &start(), 0, &config, &Quiet).unwrap().beside("cam_01".into(), 0.4).poses {
            let clearance = room.distance_m(pose.position);
            assert!(clearance >= config.clearance_m, "{} frame {}: {clearance} m to a surface", config.mode.name(), pose.frame);
        }
    }
}

#[test]
fn candidates_are_chosen_in_proportion_to_their_score() {
    let room = furnished_room();
    let space = carved(&room);
    let config = PlanConfig { max_near_share: 1.0, ..quick() };
    with_planner(&room, &space, &config, |planner| {
        let candidates = stills::candidates(planner, 0, start().position, &mut Rng::new(5));
        let views = planner.views(&candidates);
        let mut counts = vec![0.0f64; candidates.len()];
        let draws = 8000;
        for k in 0..draws {
            let mut rng = Rng::new(9).fork(k);
            counts[planner.choose(&candidates, &views, None, &mut RejectedCounts::default(), &mut rng).unwrap()] += 1.0;
        }
        let scores: Vec<f64> = views.iter().map(|view| planner.score(view)).collect();
        let total: f64 = scores.iter().sum();
        let statistic: f64 =
            counts.iter().zip(&scores).map(|(n, score)| (n - draws as f64 * score / total).powi(2) / (draws as f64 * score / total)).sum();
        let p = chi_square_survival(statistic, counts.len() - 1);
        assert!(counts.len() == 20 && p > 1e-3, "p = {p}: {counts:?} for {scores:?}");
    });
}

#[test]
fn a_video_keeps_its_bounds_from_frame_to_frame() {
    let room = furnished_room();
    let space = carved(&room);
    let video = VideoConfig { fps: 30.0, max_speed_m_s: 1.0, max_turn_deg_s: 45.0, max_acceleration_m_s2: 1.5, waypoint_distance_m: 1.5 };
    let config = PlanConfig { mode: Mode::Video(video.clone()), frames: 400, ..quick() };
    let poses = trajectory(&room, &space, &start(), 3, &config, &Quiet).unwrap().poses;
    let (mut moved, mut turned) = (0.0, 0.0);
    for pair in poses.windows(2) {
        let (step, turn) = (pair[0].position.distance(pair[1].position), turned_rad(&pair[0], &pair[1]).to_degrees());
        assert!(step * video.fps <= video.max_speed_m_s, "frame {}: {} m/s", pair[1].frame, step * video.fps);
        assert!(turn * video.fps <= video.max_turn_deg_s, "frame {}: {} degrees/s", pair[1].frame, turn * video.fps);
        for t in [0.25, 0.5, 0.75] {
            let clearance = room.distance_m(pair[0].position.lerp(pair[1].position, t));
            assert!(clearance >= config.clearance_m, "before frame {}: {clearance} m to a surface", pair[1].frame);
        }
        (moved, turned) = (moved + step, turned + turn);
    }
    for three in poses.windows(3) {
        let change = (three[2].position - 2.0 * three[1].position + three[0].position).length() * video.fps * video.fps;
        // Along the path and sideways together.
        assert!(change <= 1.1 * 2f64.sqrt() * video.max_acceleration_m_s2, "frame {}: {change} m/s²", three[1].frame);
    }
    assert!(moved > 4.0 && turned > 90.0, "{moved} m, {turned} degrees");
    assert!(poses[0].position.distance(start().position) < 0.2);
}

#[test]
fn a_video_of_a_small_room_goes_to_and_fro_at_one_height_and_rests_at_the_ends() {
    // No two places are as far apart as waypoints.
    let room = Room::with_walls(DVec3::new(2.0, 1.5, 0.0), DVec3::new(4.0, 3.5, 2.5), 0.1);
    let space = carved(&room);
    let video = VideoConfig { max_acceleration_m_s2: 5.0, max_turn_deg_s: 360.0, ..VideoConfig::default() };
    let config = PlanConfig { mode: Mode::Video(video.clone()), frames: 300, height_range_m: 0.0, min_look_distance_m: 0.3, ..quick() };
    let poses = trajectory(&room, &space, &start(), 0, &config, &Quiet).unwrap().poses;
    let speeds: Vec<f64> = poses.windows(2).map(|pair| pair[0].position.distance(pair[1].position) * video.fps).collect();
    let moved = speeds.iter().sum::<f64>() / video.fps;
    assert!(moved > 2.0, "{moved} m, so further than from one end to the other");
    assert!(poses.iter().all(|pose| (pose.position.z - poses[0].position.z).abs() < 1e-9));
    let braking = speeds.windows(2).map(|pair| (pair[1] - pair[0]).abs() * video.fps).fold(0.0, f64::max);
    assert!(braking <= 1.1 * 2f64.sqrt() * video.max_acceleration_m_s2, "{braking} m/s²");
}

#[test]
fn exponents_that_leave_no_choice_are_refused_and_great_scores_are_compared() {
    let room = furnished_room();
    let space = carved(&room);
    let with = |alpha| PlanConfig { saliency: Saliency::Triangles { alpha, beta: 2.0 }, ..quick() };
    for alpha in [17.0, -1.0, f64::NAN] {
        let error = trajectory(&room, &space, &start(), 0, &with(alpha), &Quiet).unwrap_err().to_string();
        assert!(error.contains("saliency") && error.contains("exponents from 0 to 16"), "{error}");
    }
    // Hundreds of triangles to the power of 16 are beyond the range of single precision.
    let config = PlanConfig { max_near_share: 1.0, ..with(16.0) };
    with_planner(&room, &space, &config, |planner| {
        let candidates = stills::candidates(planner, 0, start().position, &mut Rng::new(5));
        let mut views = planner.views(&candidates);
        views.iter_mut().for_each(|view| view.triangles += 300);
        assert!(views.iter().any(|view| planner.score(view) > f64::from(f32::MAX)));
        assert!(planner.choose(&candidates, &views, None, &mut RejectedCounts::default(), &mut Rng::new(1)).is_some());
    });
}

#[test]
fn a_slower_video_takes_the_same_path() {
    let room = furnished_room();
    let space = carved(&room);
    let at = |fps| {
        let video = VideoConfig { fps, ..VideoConfig::default() };
        let config = PlanConfig { mode: Mode::Video(video), frames: if fps == 10.0 { 31 } else { 61 }, ..quick() };
        trajectory(&room, &space, &start(), 0, &config, &Quiet).unwrap().poses
    };
    let (few, many) = (at(10.0), at(20.0));
    for (i, pose) in few.iter().enumerate() {
        assert!(pose.position.distance(many[2 * i].position) < 1e-9, "frame {i}");
    }
}

#[test]
fn stills_keep_their_distance_and_fill_the_room() {
    let room = furnished_room();
    let space = carved(&room);
    let stills = StillsConfig { min_distance_m: 0.8, ..StillsConfig::default() };
    let config = PlanConfig { mode: Mode::Stills(stills), frames: 10_000, candidates: 6, ..quick() };
    let heard = Heard::default();
    let poses = trajectory(&room, &space, &start(), 0, &config, &heard).unwrap().poses;
    assert!(heard.lines().join("\n").contains("of 10000 stills were found"));
    for (i, a) in poses.iter().enumerate() {
        for b in &poses[..i] {
            assert!(a.position.distance(b.position) >= 0.8);
        }
    }
    // Blue noise: as dense as the distance allows, so (nearly) no place is farther than that from all stills.
    let places = places::Places::around(&Rules::new(&room.bvh, &space, &config), start().position, |_, _| true).points;
    let lonely = places.iter().filter(|p| poses.iter().all(|pose| pose.position.distance(**p) > 0.8 + 0.1)).count();
    assert!(poses.len() > 40 && lonely * 50 < places.len(), "{} stills, {lonely} of {} places without one near", poses.len(), places.len());
}

#[test]
fn stills_nearer_than_their_distance_look_another_way() {
    let room = furnished_room();
    let space = carved(&room);
    let stills = StillsConfig { min_distance_m: 1.5, min_angle_deg: 60.0 };
    let config = PlanConfig { mode: Mode::Stills(stills), frames: 60, ..quick() };
    let poses = trajectory(&room, &space, &start(), 0, &config, &Quiet).unwrap().poses;
    let mut near = 0;
    for (i, a) in poses.iter().enumerate() {
        for b in poses[..i].iter().filter(|b| a.position.distance(b.position) < 1.5) {
            near += 1;
            assert!(a.world_from_camera.z_axis.angle_between(b.world_from_camera.z_axis).to_degrees() >= 60.0 - 1e-6);
        }
    }
    assert!(poses.len() == 60 && near > 10, "{} stills, {near} pairs near each other", poses.len());
}

#[test]
fn the_lazy_choice_is_the_greedy_one_and_the_report_counts_what_the_poses_see() {
    // Nothing in the room hides anything, so what is in the picture is seen.
    let room = Room::new(DVec3::splat(-0.03), DVec3::new(5.93, 4.93, 2.63));
    let space = carved(&room);
    let coverage = CoverageConfig { views: 2, poses: 80, samples: 600, max_distance_m: 4.0, ..CoverageConfig::default() };
    let config = PlanConfig { mode: Mode::Coverage(coverage.clone()), frames: 25, ..quick() };
    let planned = plan(&room.world, &room.bvh, &space, &start(), 0, &config, &Quiet).unwrap();
    let (poses, report) = (&planned.trajectory.poses, planned.report.coverage.unwrap());
    with_planner(&room, &space, &config, |planner| {
        let patches = patches(&room.world, 600);
        let by_rays = seen_by_each(planner, &patches, poses, &coverage);
        let by_hand: Vec<Vec<u32>> = poses.iter().map(|pose| seen_by_hand(&patches, pose, &coverage, &config)).collect();
        assert_eq!(by_rays, by_hand);
        let mut tally = Tally::new(&patches, &coverage);
        let mut gains = Vec::new();
        for (pose, seen) in poses.iter().zip(&by_hand) {
            // Of the poses that were chosen, each one added most of those left.
            let left = poses.iter().zip(&by_hand).skip(gains.len()).skip(1).map(|(pose, seen)| tally.gain(pose, seen));
            let gain = tally.gain(pose, seen);
            assert!(gains.is_empty() || left.fold(0.0, f64::max) <= gain + 1e-9);
            gains.push(gain);
            tally.add(pose, seen);
        }
        assert!(gains.iter().all(|gain| *gain > 0.0));
        let area: f64 = patches.iter().map(|p| p.area_m2).sum();
        let share = |k: usize| patches.iter().zip(tally.times()).filter(|(_, n)| *n == k).map(|(p, _)| p.area_m2).sum::<f64>() / area;
        for k in 0..=2 {
            assert!((report.seen_share[k] - share(k)).abs() < 1e-9, "{k} times: {} {}", report.seen_share[k], share(k));
        }
        assert!((report.area_m2 - area).abs() < 1e-9 && (report.seen_share.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    });
    assert!(report.seen_share[2] > 0.5, "{:?}", report.seen_share);
}

/// The patches in a picture, near enough and not too grazing, from the definitions.
fn seen_by_hand(patches: &[super::patches::Patch], pose: &Pose, coverage: &CoverageConfig, config: &PlanConfig) -> Vec<u32> {
    let (tan_x, tan_y) = ((0.5 * config.fov_x_rad).tan(), (0.5 * config.fov_x_rad).tan() * 36.0 / 48.0);
    let is_seen = |i: &u32| {
        let patch = &patches[*i as usize];
        let way = patch.p_world - pose.position;
        let p = pose.world_from_camera.transpose() * way;
        let incidence = way.normalize().dot(patch.normal).abs().acos().to_degrees();
        let inside = p.z < 0.0 && p.x.abs() < -p.z * tan_x && p.y.abs() < -p.z * tan_y;
        inside && way.length() <= coverage.max_distance_m && incidence <= coverage.max_incidence_deg
    };
    (0..patches.len() as u32).filter(is_seen).collect()
}

#[test]
fn what_no_camera_can_see_is_reported() {
    // Part 1 is a box in a sealed box (part 2).
    let room_part = crate::testroom::cuboid(DVec3::splat(-0.03), DVec3::new(5.93, 4.93, 2.63), true);
    let inner = crate::testroom::cuboid(DVec3::new(1.4, 1.4, 0.3), DVec3::new(1.7, 1.7, 0.6), false);
    let outer = crate::testroom::cuboid(DVec3::new(1.0, 1.0, 0.02), DVec3::new(2.2, 2.0, 0.9), false);
    let room = Room::from_parts(vec![room_part, inner, outer]);
    let space = carved(&room);
    let coverage = CoverageConfig { views: 1, poses: 200, samples: 1000, ..CoverageConfig::default() };
    let config = PlanConfig { mode: Mode::Coverage(coverage), frames: 60, ..quick() };
    let report = plan(&room.world, &room.bvh, &space, &start(), 0, &config, &Quiet).unwrap().report;
    let coverage = report.coverage.unwrap();
    assert_eq!(coverage.never_seen, [1]);
    assert_eq!(coverage.parts.iter().map(|part| part.part).collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!(coverage.parts[1].seen_share, [1.0, 0.0]);
    assert!((report.seen_part_share - 2.0 / 3.0).abs() < 1e-9);
    // All that was reachable was covered before the frames ran out.
    assert!(report.per_frame.frame.len() < 60 && (coverage.reachable_share - coverage.seen_share[1]).abs() < 1e-9);
}
