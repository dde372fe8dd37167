//! All rays from one position.

use super::rays::{Rays, Tile};
use crate::grid::{Leaps, VoxelGrid, WalkEnd};
use enfilade_math::DVec3;
use rayon::prelude::*;

/// Casts all rays from `position`, frees what they pass, and returns how many left the domain.
///
/// `end_t` gives the parameter at which a ray ends, in voxels; see [`VoxelGrid::walk`]. What is freed is what walking along every ray
/// by itself would free, but little is walked twice: a few rays go ahead, and the others begin where the cone around their tile
/// first meets something that is not known to be free.
pub(super) fn cast(grid: &VoxelGrid, leaps: &mut Leaps, rays: &Rays, position: DVec3, end_t: impl Fn(DVec3) -> f64 + Sync) -> usize {
    let p = grid.cells(position);
    let walk = |leaps: &Leaps, ray: usize, from_t: f64| {
        let direction = rays.directions[ray];
        grid.walk(leaps, p, direction, from_t, || end_t(direction)) == WalkEnd::Left
    };
    // One ray of every fan, one of every tile.
    leaps.refresh(grid);
    rays.fans.par_iter().with_min_len(64).filter_map(|fan| fan.tiles.first()).for_each(|tile| {
        walk(leaps, tile.first, 0.0);
    });
    leaps.refresh(grid);
    rays.fans.par_iter().with_min_len(8).flat_map_iter(|fan| &fan.tiles).for_each(|tile| {
        walk(leaps, tile.first, 0.0);
    });
    leaps.refresh(grid);

    let leaps = &*leaps;
    let left_of_tile = |tile: &Tile, from_t: f64| {
        let from_t = leaps.clear_until(grid, p, tile.cone.axis, tile.cone.tan, from_t);
        (tile.first..tile.last).filter(|&ray| walk(leaps, ray, from_t)).count()
    };
    let fans = rays.fans.par_iter().with_min_len(4);
    fans.map(|fan| {
        let from_t = leaps.clear_until(grid, p, fan.cone.axis, fan.cone.tan, 0.0);
        fan.tiles.iter().map(|tile| left_of_tile(tile, from_t)).sum::<usize>()
    })
    .sum()
}
