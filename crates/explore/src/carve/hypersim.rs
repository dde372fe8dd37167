//! The differences of [`Preset::Hypersim`](crate::Preset): the decisions of the toolkit's `generate_octomap`.

use super::CarveConfig;
use crate::ExploreError;
use crate::armadillo::Armadillo;
use crate::grid::VoxelGrid;
use enfilade_geometry::{Bvh, Voxel};
use enfilade_math::{DVec3, Ray};
use enfilade_parallel::map;
use enfilade_scene::WorldMesh;
use std::collections::BTreeMap;

/// Rays whose distances are pooled, the ray itself among them.
const NEIGHBOURS: usize = 50;

/// Random points tried before giving up; one free voxel in a cube of 300³ is missed by all of them once in 10¹⁷ times.
const MAX_TRIES: u64 = 1 << 30;

/// The cube with the voxels of its surface samples occupied. OctoMap is given the voxel's edge in single precision.
pub(super) fn grid(world: &WorldMesh, min: DVec3, max: DVec3, config: &CarveConfig) -> Result<VoxelGrid, ExploreError> {
    let grid = VoxelGrid::new(min, max, f64::from(config.voxel_m as f32))?;
    grid.occupy_samples(&world.corners, min, max);
    Ok(grid)
}

/// Distance at which a ray meets the mesh, in voxels; infinite when it does not.
pub(super) fn hit(bvh: &Bvh, grid: &VoxelGrid, position: DVec3, direction: DVec3) -> f64 {
    let hit = bvh.closest(&Ray::new(position.as_vec3(), direction.as_vec3()));
    hit.map_or(f64::INFINITY, |hit| f64::from(hit.t) / grid.voxel_m())
}

/// The box around the centres of all free voxels, metres.
pub(super) fn free_box(grid: &VoxelGrid) -> Option<(DVec3, DVec3)> {
    let (first, last) = grid.free_bounds()?;
    Some((first.center(grid.voxel_m()), last.center(grid.voxel_m())))
}

/// A point in a free voxel, by rejection from [`free_box`].
pub(super) fn random_free(grid: &VoxelGrid, rng: &mut Armadillo) -> Option<DVec3> {
    let (min, max) = free_box(grid)?;
    let mut draw = || min + DVec3::new(rng.uniform(), rng.uniform(), rng.uniform()) * (max - min);
    (0..MAX_TRIES).map(|_| draw()).find(|p| grid.state(*p) == Voxel::Free)
}

/// The position to carve from: the first one, in steps of a quarter voxel, whose voxel is not occupied, along the direction with the
/// farthest pooled hit, then the next farthest, and so on. Usually that is the start itself.
pub(super) fn verify(bvh: &Bvh, grid: &VoxelGrid, directions: &[DVec3], index: usize, start: DVec3) -> Result<DVec3, ExploreError> {
    if grid.state(start) != Voxel::Occupied {
        return Ok(start);
    }
    let distances = map(directions, |d| hit(bvh, grid, start, *d));
    let mut ways = pool(directions, &distances);
    ways.sort_by(|a, b| b.1.total_cmp(&a.1));
    let step = 0.25 * grid.voxel_m();
    let open = |(direction, distance): (DVec3, f64)| {
        let path = (0u32..).map(|k| f64::from(k) * step).take_while(|t| *t <= distance * grid.voxel_m()).map(|t| start + direction * t);
        path.take_while(|p| grid.contains(*p)).find(|p| grid.state(*p) != Voxel::Occupied)
    };
    let median_m = ways[ways.len() / 2].1 * grid.voxel_m();
    let in_wall = || ExploreError::StartInWall { index, position: start, median_m, clear_m: 2.0 * grid.voxel_m() };
    ways.into_iter().find_map(open).ok_or_else(in_wall)
}

/// Every direction with the smallest distance among its nearest neighbours.
fn pool(directions: &[DVec3], distances: &[f64]) -> Vec<(DVec3, f64)> {
    // A cell is as wide as the cap with twice the neighbours needed, so that they are in the 27 cells around.
    let wide = (8.0 * NEIGHBOURS as f64 / directions.len() as f64).sqrt();
    let cell = |d: DVec3| (d / wide).floor().as_i64vec3().to_array();
    let mut cells: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    directions.iter().enumerate().for_each(|(i, d)| cells.entry(cell(*d)).or_default().push(i));
    let pooled = |d: &DVec3| {
        let [x, y, z] = cell(*d);
        let around = (0..27).filter_map(|i| cells.get(&[x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1])).flatten();
        let mut near: Vec<(f64, f64)> = around.map(|&i| (-directions[i].dot(*d), distances[i])).collect();
        let count = NEIGHBOURS.min(near.len());
        near.select_nth_unstable_by(count - 1, |a, b| a.0.total_cmp(&b.0));
        (*d, near[..count].iter().map(|(_, distance)| *distance).fold(f64::INFINITY, f64::min))
    };
    map(directions, pooled)
}
