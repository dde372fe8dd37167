//! Casts all rays from one position and frees what they pass, with as little walked twice as can be.

use super::rays::{Fan, Rays, Tile};
use crate::grid::{Leaps, VoxelGrid, WalkEnd};
use enfilade_geometry::Voxel;
use enfilade_math::DVec3;
use enfilade_parallel::{each, map};

/// Casts all rays from `position`, frees what they pass, and returns how many left the domain.
///
/// `end_t` gives the parameter at which a ray ends, in voxels; see [`VoxelGrid::walk`]. The result is the same as if every ray were
/// walked by itself from its origin, but little is walked twice: a few rays go ahead, and the others begin where the cone around their
/// tile first meets something that is not known to be free.
pub(super) fn cast(grid: &VoxelGrid, leaps: &mut Leaps, rays: &Rays, position: DVec3, end_t: impl Fn(DVec3) -> f64 + Sync) -> usize {
    let p = grid.cells(position);
    let walk = |leaps: &Leaps, ray: usize, from_t: f64| {
        let direction = rays.directions[ray];
        grid.walk(leaps, p, direction, from_t, || end_t(direction)) == WalkEnd::Left
    };
    let clear_in_fan = |leaps: &Leaps, fan: &Fan| leaps.clear_until(grid, p, fan.cone.axis, fan.cone.tan, 0.0);

    // Where nothing is known yet, one ray of every fan goes ahead.
    leaps.refresh(grid);
    if grid.state(position) != Voxel::Free {
        each(&rays.fans, |fan| {
            if let Some(tile) = fan.tiles.first() {
                walk(leaps, tile.first, 0.0);
            }
        });
        leaps.refresh(grid);
    }

    // One ray of every tile, from where the cone around its fan first meets something not known to be free.
    each(&rays.fans, |fan| {
        let from_t = clear_in_fan(leaps, fan);
        for tile in &fan.tiles {
            walk(leaps, tile.first, from_t);
        }
    });
    leaps.refresh(grid);

    // All rays, from where the cone around their tile does.
    let leaps = &*leaps;
    let left_of_tile = |tile: &Tile, from_t: f64| {
        let from_t = leaps.clear_until(grid, p, tile.cone.axis, tile.cone.tan, from_t);
        (tile.first..tile.last).filter(|&ray| walk(leaps, ray, from_t)).count()
    };
    let left_of_fan = |fan: &Fan| {
        let from_t = clear_in_fan(leaps, fan);
        fan.tiles.iter().map(|tile| left_of_tile(tile, from_t)).sum::<usize>()
    };
    map(&rays.fans, left_of_fan).into_iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testroom::furnished_room;
    use enfilade_math::Rng;

    #[test]
    fn casting_frees_what_walking_along_every_ray_frees() {
        let room = furnished_room();
        let rays = Rays::new(20_000);
        for open in [false, true] {
            // With a side open, and with rays that end by themselves.
            let walls = if open { &room.world.corners[2..] } else { &room.world.corners };
            let [fast, plain] = [0; 2].map(|_| {
                let grid = VoxelGrid::new(DVec3::splat(-2.0), DVec3::new(8.0, 7.0, 4.0), 0.1).unwrap();
                grid.occupy(walls);
                grid
            });
            let end_t = |d: DVec3| if open && d.z > 0.1 { 17.3 + 9.0 * d.y } else { f64::INFINITY };
            let mut leaps = Leaps::default();
            let mut rng = Rng::new(1);
            let mut position = DVec3::new(3.0, 2.5, 1.4);
            for round in 0..6 {
                let left = cast(&fast, &mut leaps, &rays, position, end_t);
                let walk = |d: &&DVec3| plain.walk(&Leaps::default(), plain.cells(position), **d, 0.0, || end_t(**d)) == WalkEnd::Left;
                let expected = rays.directions.iter().filter(walk).count();
                assert!(left == expected && open == (left > 0), "round {round}: {left} {expected}");
                assert!(fast.to_tree(0.1).unwrap() == plain.to_tree(0.1).unwrap(), "round {round}");
                position = fast.random_free(&mut rng).unwrap();
            }
        }
    }
}
