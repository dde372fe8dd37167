//! Rules of a walk in the supplement of Hypersim's paper, with its own numbers: nothing here is read from the configuration under test.

use super::*;
use enfilade_geometry::{OccupancyTree, Voxel};
use enfilade_testkit::{chi_square_survival, write_evidence};

/// Tests of this file that draw a conclusion from a p-value, each with a few of them.
const P: f64 = 1e-5;

/// `preset = "paper"` with test images of a few pixels, where what they show does not matter.
fn paper() -> PlanConfig {
    PlanConfig { preset: Preset::Paper, clearance_m: 0.0, ..PlanConfig::default() }
}

fn blind() -> PlanConfig {
    PlanConfig { test_width: 4, test_height: 3, saliency: Saliency::Triangles { alpha: 0.0, beta: 0.0 }, ..paper() }
}

/// A hall too large for a walk to reach its walls, all of it free.
fn hall() -> (Room, FreeSpace) {
    let room = Room::new(DVec3::new(-60.0, -60.0, 0.0), DVec3::new(60.0, 60.0, 6.0));
    let mut tree = OccupancyTree::new(1.0);
    for i in 0..118 * 118 * 4 {
        let p = DVec3::new(f64::from(i % 118) - 58.5, f64::from(i / 118 % 118) - 58.5, f64::from(i / 118 / 118) + 1.5);
        tree.set(tree.key(p).unwrap(), Voxel::Free);
    }
    (room, FreeSpace::new(tree, crate::CarveReport::default()).unwrap())
}

/// Walks of 100 poses from the middle of the hall, 40 m before the target.
fn walks(count: u64) -> Vec<Vec<Pose>> {
    let (room, space) = hall();
    let first = Pose::look_at(0, DVec3::new(-20.0, 0.0, 3.0), DVec3::new(20.0, 0.0, 2.8), DVec3::Z).unwrap();
    with_planner(&room, &space, &blind(), |planner| {
        (0..count).map(|k| paper::walk(planner, first, &Rng::new(7).fork(k)).unwrap().poses).collect()
    })
}

/// Fails unless numbers fill the range from 0 to 1 uniformly.
fn assert_uniform(name: &str, values: &[f64]) {
    const CELLS: usize = 20;
    assert!(values.iter().all(|u| (-1e-9..=1.0 + 1e-9).contains(u)), "{name}: out of range");
    let mut counts = [0.0f64; CELLS];
    values.iter().for_each(|u| counts[((u * CELLS as f64) as usize).min(CELLS - 1)] += 1.0);
    assert_counts(name, &counts, &[1.0; CELLS]);
}

/// Fails unless counts are in proportion to weights.
fn assert_counts(name: &str, counts: &[f64], weights: &[f64]) {
    let (n, total) = (counts.iter().sum::<f64>(), weights.iter().sum::<f64>());
    let statistic: f64 = counts.iter().zip(weights).map(|(count, w)| (count - n * w / total).powi(2) / (n * w / total)).sum();
    let p = chi_square_survival(statistic, counts.len() - 1);
    if p < P {
        let place = write_evidence(&format!("supplement-{name}.txt"), format!("{counts:?}\n{weights:?}\n").as_bytes());
        panic!("{name}: chi-square {statistic:.1}, p = {p:.1e}; counts in {place}");
    }
}

#[test]
fn a_step_is_uniform_in_the_boxes_of_equations_2_and_3() {
    let (mut x, mut y, mut z) = (Vec::new(), Vec::new(), Vec::new());
    for walk in walks(40) {
        let of = |pose: &Pose| [pose.position, pose.look_at];
        for (last, now) in walk.iter().zip(&walk[1..]) {
            for ((first, last), now) in of(&walk[0]).into_iter().zip(of(last)).zip(of(now)) {
                // 1.5 m to each side of the last, and no limit from the first.
                x.push((now.x - last.x + 1.5) / 3.0);
                y.push((now.y - last.y + 1.5) / 3.0);
                // 0.25 m above and below the last, and 0.25 m above and below the first.
                let (low, high) = ((last.z - 0.25).max(first.z - 0.25), (last.z + 0.25).min(first.z + 0.25));
                z.push((now.z - low) / (high - low));
            }
        }
        let away = walk.iter().map(|pose| (pose.position - walk[0].position).truncate().length()).fold(0.0, f64::max);
        assert!(away > 3.0, "the box around the first has no sides: {away} m");
    }
    assert_eq!(x.len(), 40 * 99 * 2);
    for (name, values) in [("box-x", x), ("box-y", y), ("box-z", z)] {
        assert_uniform(name, &values);
    }
}

#[test]
fn the_box_around_the_first_pose_is_filled_to_a_quarter_of_a_metre() {
    // Heights of many steps: within 0.25 m of the first, and up to nearly that on both sides.
    for of in [|pose: &Pose| pose.position.z - 3.0, |pose: &Pose| pose.look_at.z - 2.8] {
        let heights: Vec<f64> = walks(3).iter().flatten().map(of).collect();
        let (low, high) = heights.iter().fold((0.0f64, 0.0f64), |(low, high), h| (low.min(*h), high.max(*h)));
        assert!((-0.25 - 1e-9..-0.24).contains(&low) && high > 0.24 && high < 0.25 + 1e-9, "{low} to {high} m");
    }
}

#[test]
fn roll_is_uniform_within_five_degrees() {
    let rolls: Vec<f64> = walks(40).iter().flat_map(|walk| &walk[1..]).map(|pose| (pose.roll_rad().to_degrees() + 5.0) / 10.0).collect();
    assert_uniform("roll", &rolls);
}

#[test]
fn the_first_target_is_found_by_casting_a_ray_along_the_view() {
    // Walls by hand: the ray meets x = 5.93, or y = 4.93, or z = -0.03 first. The target keeps 1.75 voxels from there, by up to a quarter.
    let room = Room::new(DVec3::splat(-0.03), DVec3::new(5.93, 4.93, 2.63));
    let space = carved(&room);
    let position = DVec3::new(3.0, 2.5, 1.5);
    for toward in [DVec3::X, DVec3::Y, DVec3::new(1.0, 0.5, 0.1), DVec3::new(0.3, 1.0, -0.2), DVec3::new(0.5, 0.2, -1.0)] {
        let ray = toward.normalize();
        let hit_m = [(5.93 - 3.0) / ray.x, (4.93 - 2.5) / ray.y, (-0.03 - 1.5) / ray.z, (2.63 - 1.5) / ray.z];
        let hit_m = hit_m.into_iter().filter(|t| *t > 0.0).fold(f64::INFINITY, f64::min);
        let start = camera(position, position + toward, DVec3::Z);
        let config = PlanConfig { frames: 1, ..blind() };
        let first = trajectory(&room, &space, &start, 0, &config, &Quiet).unwrap().poses[0];
        let along = (first.look_at - position).dot(ray);
        assert!((first.look_at - position - along * ray).length() < 1e-9, "{toward}: off the view");
        assert!(first.position == position && space.tree.state(first.look_at) == Voxel::Free, "{toward}");
        let short = hit_m - along;
        assert!((0.175 - 1e-6..0.175 + 0.15).contains(&short), "{toward}: {short} m before the surface at {hit_m} m");
    }
}

#[test]
fn the_next_pose_is_chosen_in_proportion_to_triangles_and_to_the_square_of_what_is_not_empty() {
    // A room under the sky, so that views are empty in part.
    let mut room = furnished_room();
    room.remove_ceiling();
    let space = carved(&room);
    let config = PlanConfig { test_width: 48, test_height: 36, ..paper() };
    with_planner(&room, &space, &config, |planner| {
        // Twenty views around the room, from well below the rim of the walls.
        let views: Vec<Pose> = (0..20)
            .map(|k| {
                let (sin, cos) = (f64::from(k) * 0.3).sin_cos();
                let position = DVec3::new(3.0, 2.5, 1.5);
                Pose::look_at(1, position, position + DVec3::new(cos, sin, 0.05 * f64::from(k % 7)), DVec3::Z).unwrap()
            })
            .collect();
        // Equation 1 with alpha 1 and beta 2: triangles, times the share with a surface, twice. Counted by single rays.
        let weights: Vec<f64> = views.iter().map(|pose| by_single_rays(&room, pose)).map(|(n, e)| n * (1.0 - e) * (1.0 - e)).collect();
        assert!(views.iter().any(|pose| by_single_rays(&room, pose).1 > 0.2), "no empty pixels to count");
        let mut counts = vec![0.0f64; views.len()];
        for k in 0..8000 {
            let (pose, _) = paper::choose(planner, &views, &mut Rng::new(11).fork(k)).unwrap();
            counts[views.iter().position(|view| *view == pose).unwrap()] += 1.0;
        }
        assert_counts("choice", &counts, &weights);
    });
}

/// The number of distinct triangles in an image of 48 × 36 pixels, 60 degrees wide, and its share of empty pixels.
fn by_single_rays(room: &Room, pose: &Pose) -> (f64, f64) {
    let focal = 24.0 / 30f64.to_radians().tan();
    let mut seen = std::collections::BTreeSet::new();
    let mut empty = 0.0;
    for i in 0..48 * 36 {
        let (x, y) = (f64::from(i % 48) + 0.5 - 24.0, 18.0 - f64::from(i / 48) - 0.5);
        let direction = (pose.world_from_camera * DVec3::new(x, y, -focal)).normalize();
        match room.bvh.closest(&enfilade_math::Ray::new(pose.position.as_vec3(), direction.as_vec3())) {
            Some(hit) => drop(seen.insert(hit.triangle)),
            None => empty += 1.0 / (48.0 * 36.0),
        }
    }
    (seen.len() as f64, empty)
}

#[test]
fn a_step_draws_a_thousand_points_and_twenty_pairs_and_looks_at_256_by_192_pixels() {
    let (room, space) = hall();
    let config = paper();
    with_planner(&room, &space, &config, |planner| {
        let first = Pose::look_at(0, DVec3::new(0.0, 0.0, 3.0), DVec3::new(9.0, 0.0, 3.0), DVec3::Z).unwrap();
        let (points, mut rng) = ([first.position], Rng::new(1));
        let pairs = paper::candidates(planner, &points, &[first.look_at], 1, &mut rng);
        assert_eq!((pairs.len(), planner.views(&pairs)[0].pixels), (20, 256 * 192));
        assert_eq!(crate::plan::walk::points(&config, first.position, first.position, 1.0, config.queries, &mut rng).len(), 1000);
        // The left and the right border of the test image are 60 degrees apart.
        let rays = planner.image.rays(&first);
        let [left, right] = [0.0, 256.0].map(|x| (rays.corner + (x - 0.5) * rays.right + 95.5 * rays.down).normalize());
        assert!((left.angle_between(right).to_degrees() - 60.0).abs() < 1e-3);
    });
    // And a walk has a hundred poses; free space is carved by 512 × 512 rays from each position.
    assert_eq!((config.frames, CarveConfig::default().rays), (100, 262_144));
}

#[test]
fn the_whole_range_of_exponents_finds_a_walk() {
    // Views of thousands of triangles, and views of next to nothing: their scores are far beyond single precision.
    let room = furnished_room();
    let space = carved(&room);
    for (alpha, beta) in [(0.0, 0.0), (11.0, 2.0), (16.0, 0.0), (0.0, 16.0), (16.0, 16.0)] {
        for preset in [Preset::Paper, Preset::Default] {
            let saliency = Saliency::Triangles { alpha, beta };
            let config = PlanConfig { preset, saliency, frames: 8, test_width: 64, test_height: 48, queries: 300, ..PlanConfig::default() };
            let planned = plan(&room.world, &room.bvh, &space, &start(), 0, &config, &Quiet);
            assert_eq!(planned.unwrap().trajectory.poses.len(), 8, "{preset:?} {alpha} {beta}");
        }
    }
    // In proportion, however small all of them are, and however large.
    for scale in [1e-200, 1e-40, 1.0, 1e40, 1e200] {
        let mut counts = [0.0; 3];
        let chance = planner::by_score(&[scale, 2.0 * scale, 5.0 * scale]).unwrap();
        let mut rng = Rng::new(3);
        (0..4000).for_each(|_| counts[chance.sample(rng.next_f32()).0] += 1.0);
        assert_counts("scores", &counts, &[1.0, 2.0, 5.0]);
    }
    assert!(planner::by_score(&[0.0, 0.0]).is_none() && planner::by_score(&[]).is_none());
}
