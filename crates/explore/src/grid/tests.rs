//! The grid against plain versions of itself: occupied voxels, walks with and without leaps, random free points, and the octree made of it.

use super::*;
use enfilade_math::{Rng, Vec3, warp};

fn random_point(rng: &mut Rng, low: f64, high: f64) -> DVec3 {
    DVec3::from([0; 3].map(|_| low + (high - low) * rng.next_f64()))
}

fn plain_walk(grid: &VoxelGrid, origin: DVec3, direction: DVec3) -> WalkEnd {
    grid.walk(&Leaps::default(), grid.cells(origin), direction, 0.0, || f64::INFINITY)
}

/// A grid of about 30 voxels per edge, not aligned to bricks, with small triangles here and there.
fn cluttered(rng: &mut Rng) -> VoxelGrid {
    let grid = VoxelGrid::new(DVec3::splat(-1.33), DVec3::splat(1.57), 0.1).unwrap();
    let triangles: Vec<[Vec3; 3]> = (0..60)
        .map(|_| {
            let p = random_point(rng, -1.4, 1.6);
            [0; 3].map(|_| (p + random_point(rng, -0.1, 0.1)).as_vec3())
        })
        .collect();
    grid.occupy(&triangles);
    grid
}

#[test]
fn a_walk_frees_what_the_ray_passes_before_the_first_occupied_voxel() {
    let mut rng = Rng::new(8);
    let grid = cluttered(&mut rng);
    let mut ends = [0, 0];
    for _ in 0..200 {
        let (origin, direction) = (random_point(&mut rng, -1.0, 1.0), random_point(&mut rng, -1.0, 1.0).normalize());
        let end = plain_walk(&grid, origin, direction);
        ends[end as usize] += 1;
        for step in 0..200_000 {
            let p = origin + direction * (f64::from(step) * 2e-5);
            let Some(key) = VoxelKey::at(p, 0.1) else { break };
            let inside = (0..3).all(|a| (32768 - 14..32768 + 16).contains(&key.0[a]));
            match (inside, grid.state(p)) {
                (false, _) => {
                    assert_eq!(end, WalkEnd::Left);
                    break;
                }
                (true, Voxel::Occupied) => {
                    assert_eq!(end, WalkEnd::Blocked);
                    break;
                }
                (true, state) => assert_eq!(state, Voxel::Free, "{p} on the way from {origin} along {direction}"),
            }
        }
    }
    assert!(ends.iter().all(|n| *n > 20), "{ends:?}");
}

#[test]
fn the_octree_has_the_states_of_the_grid() {
    let mut rng = Rng::new(9);
    let grid = cluttered(&mut rng);
    for k in 0..3000 {
        plain_walk(&grid, DVec3::splat(0.05), warp::fibonacci_sphere(k, 3000));
    }
    let tree = grid.to_tree(0.1).unwrap();
    let (free, occupied) = grid.counts();
    assert_eq!((tree.count(Voxel::Free), tree.count(Voxel::Occupied)), (free, occupied));
    assert!(free > 1000 && occupied > 60, "{free} {occupied}");
    for _ in 0..20_000 {
        let p = random_point(&mut rng, -1.8, 2.0);
        assert_eq!(tree.state(p), grid.state(p), "{p}");
    }
}

#[test]
fn leaps_free_what_walks_step_by_step_free() {
    let mut rng = Rng::new(10);
    for _ in 0..6 {
        let seed = rng.next_u64();
        let [plain, leaping] = [0; 2].map(|_| cluttered(&mut Rng::new(seed)));
        let mut leaps = Leaps::default();
        let origin = random_point(&mut rng, -1.0, 1.0);
        for round in 0..6 {
            for _ in 0..1 << (2 * round) {
                // Directions along axes, along diagonals, nearly so, and others.
                let d = random_point(&mut rng, -1.0, 1.0);
                let d = match rng.below(4) {
                    0 => d,
                    1 => d.round() + DVec3::X,
                    2 => d.round() + DVec3::Y + 1e-12 * d,
                    _ => d.signum() + 1e-9 * d.round(),
                };
                let Some(d) = d.try_normalize() else { continue };
                let end_t = 40.0 * rng.next_f64();
                let ends = [
                    plain.walk(&Leaps::default(), plain.cells(origin), d, 0.0, || end_t),
                    leaping.walk(&leaps, leaping.cells(origin), d, 0.0, || end_t),
                ];
                assert_eq!(ends[0], ends[1], "{d}");
            }
            leaps.refresh(&leaping);
            assert_eq!(plain.to_tree(0.1).unwrap(), leaping.to_tree(0.1).unwrap());
        }
    }
}

#[test]
fn a_leap_is_as_long_as_everything_around_is_free() {
    let mut rng = Rng::new(12);
    let grid = cluttered(&mut rng);
    for k in 0..20_000 {
        plain_walk(&grid, DVec3::new(0.05, 0.1, 0.2), warp::fibonacci_sphere(k, 20_000));
    }
    let mut leaps = Leaps::default();
    leaps.refresh(&grid);
    let mut longest = 0;
    for_each_cell(grid.low, grid.high.map(|h| h - 1), |cell| {
        let is_free = |reach: i32| {
            let mut all = true;
            for_each_cell(cell.map(|c| c - reach), cell.map(|c| c + reach), |c| {
                all &= grid.inside(c) && grid.state_of(c) == Voxel::Free;
            });
            all
        };
        let (index, offset) = grid.address(cell);
        let code = leaps.block(index).map_or(0, |codes| codes[offset]);
        let expected = match grid.state_of(cell) {
            Voxel::Unknown => 0,
            Voxel::Occupied => 1,
            Voxel::Free => 2 + [1, 2, 4, 8, 16].into_iter().take_while(|reach| is_free(*reach)).count() as u8,
        };
        if leaps.block(index).is_some() {
            assert_eq!(code, expected, "{cell:?}");
        }
        longest = longest.max(expected);
    });
    assert!(longest >= 5, "{longest}");
}

#[test]
fn random_free_points_are_uniform_over_the_free_voxels() {
    let grid = VoxelGrid::new(DVec3::splat(-0.05), DVec3::splat(0.35), 0.1).unwrap();
    for k in 0..2000 {
        plain_walk(&grid, DVec3::splat(0.15), warp::fibonacci_sphere(k, 2000));
    }
    let (free, _) = grid.counts();
    assert_eq!(free, 125);
    let mut rng = Rng::new(2);
    let mut counts = std::collections::BTreeMap::new();
    let n = 100_000;
    for _ in 0..n {
        let p = grid.random_free(&mut rng).unwrap();
        assert_eq!(grid.state(p), Voxel::Free);
        *counts.entry(VoxelKey::at(p, 0.1).unwrap().0).or_insert(0u32) += 1;
    }
    let expected = f64::from(n) / 125.0;
    let chi_square: f64 = counts.values().map(|c| (f64::from(*c) - expected).powi(2) / expected).sum();
    // 124 degrees of freedom: beyond 198 once in 30,000 times.
    assert!(counts.len() == 125 && chi_square < 198.0, "{} voxels, chi-square {chi_square}", counts.len());
    assert!(VoxelGrid::new(DVec3::ZERO, DVec3::ONE, 0.1).unwrap().random_free(&mut rng).is_none());
}

#[test]
fn grids_too_large_or_too_far_are_refused() {
    let error = |min, max, voxel_m| VoxelGrid::new(min, max, voxel_m).err().unwrap();
    assert!(matches!(error(DVec3::ZERO, DVec3::splat(5e4), 0.1), ExploreError::OutOfKeySpace { .. }));
    assert!(matches!(error(DVec3::ZERO, DVec3::splat(3000.0), 0.1), ExploreError::TooManyVoxels { .. }));
}
