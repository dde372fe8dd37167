use super::*;
use crate::testroom::{Room, house_with_thin_wall};
use enfilade_geometry::Voxel;
use enfilade_scene::Quiet;

fn quick() -> CarveConfig {
    CarveConfig { rays: 40_000, ..CarveConfig::default() }
}

#[test]
fn free_volume_of_a_box_room_is_its_interior_less_a_shell() {
    // Walls 3 cm off the voxel borders: each occupies one layer of voxels, and the 39x29x24 within are free.
    let room = Room::new(DVec3::new(-0.03, -0.03, -0.03), DVec3::new(3.93, 2.93, 2.43));
    let space = carve(&room.world, &room.bvh, &[DVec3::new(1.0, 1.5, 1.4)], &quick(), &Quiet).unwrap();
    assert_eq!(space.report.free_voxels, 39 * 29 * 24);
    assert!((space.report.free_volume_m3 - 3.9 * 2.9 * 2.4).abs() < 1e-9);
    assert_eq!(space.report.occupied_voxels, 41 * 31 * 26 - 39 * 29 * 24);
    assert_eq!((space.free_min, space.free_max), (DVec3::ZERO, DVec3::new(39.0, 29.0, 24.0) * 0.1));
    assert_eq!(
        (space.tree.count(Voxel::Free), space.tree.count(Voxel::Occupied)),
        (space.report.free_voxels, space.report.occupied_voxels)
    );
    assert_eq!((space.report.escaped_share, space.report.positions.len()), (0.0, 5));
}

#[test]
fn walls_on_voxel_borders_are_two_voxels_thick_whatever_the_rounding() {
    for nudge in [-1e-6, 0.0, 1e-6] {
        let room = Room::new(DVec3::splat(nudge), DVec3::new(4.0, 3.0, 2.5) + DVec3::splat(nudge));
        let space = carve(&room.world, &room.bvh, &[DVec3::new(1.0, 1.5, 1.4)], &quick(), &Quiet).unwrap();
        assert_eq!(space.report.free_voxels, 38 * 28 * 23);
    }
}

#[test]
fn a_wall_thinner_than_a_voxel_does_not_leak() {
    // Two rooms share one plane that slants through the voxels; only one has a camera.
    let room = house_with_thin_wall();
    let space = carve(&room.world, &room.bvh, &[DVec3::new(1.0, 1.5, 1.4)], &quick(), &Quiet).unwrap();
    assert_eq!(space.report.escaped_share, 0.0);
    let beyond = |p: DVec3| room.beyond_wall(p);
    let leaked = space.tree.leaves().filter(|l| l.state == Voxel::Free && beyond(space.tree.center(l.key))).count();
    assert_eq!(leaked, 0);
    assert!(space.report.free_voxels > 8000);
}

#[test]
fn the_tree_is_the_same_for_any_number_of_threads() {
    let room = house_with_thin_wall();
    let starts = [DVec3::new(1.0, 1.5, 1.4), DVec3::new(3.6, 1.2, 1.0)];
    let carve_on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let space = pool.install(|| carve(&room.world, &room.bvh, &starts, &quick(), &Quiet)).unwrap();
        (space.tree.to_bt(), space.report)
    };
    let one = carve_on(1);
    assert_eq!(one, carve_on(2));
    assert_eq!(one, carve_on(7));
}

#[test]
fn an_open_side_is_reported_as_escaping_rays() {
    let mut room = Room::new(DVec3::splat(-0.03), DVec3::new(3.93, 2.93, 2.43));
    room.remove_ceiling();
    let space = carve(&room.world, &room.bvh, &[DVec3::new(1.0, 1.5, 1.4)], &quick(), &Quiet).unwrap();
    assert!(space.report.escaped_share > 0.05 && space.report.escaped_share < 0.4, "{}", space.report.escaped_share);
    assert!(space.free_max.z < 2.8, "space beyond the scene is never free: {}", space.free_max);
}

#[test]
fn a_camera_near_a_surface_is_moved_out_of_its_voxel() {
    let room = Room::new(DVec3::splat(-0.03), DVec3::new(3.93, 2.93, 2.43));
    let asked = DVec3::new(-0.01, 1.5, 1.4);
    let space = carve(&room.world, &room.bvh, &[asked], &quick(), &Quiet).unwrap();
    let used = space.report.starts[0].used.unwrap();
    assert!(used != asked && used.distance(asked) < 0.2 && used.x > 0.0, "{used}");
    assert_eq!(space.report.free_voxels, 39 * 29 * 24);
}

#[test]
fn bad_starts_are_named() {
    let walls = Room::with_walls(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), 0.4);
    let run = |starts: &[DVec3]| carve(&walls.world, &walls.bvh, starts, &quick(), &Quiet);
    let inside = DVec3::new(2.0, 1.5, 1.4);
    assert!(run(&[inside]).is_ok());
    assert_eq!(run(&[]).unwrap_err(), ExploreError::NoStarts);
    assert!(matches!(run(&[DVec3::new(-0.21, 1.5, 1.4)]).unwrap_err(), ExploreError::StartInWall { index: 0, .. }));
    assert!(matches!(run(&[DVec3::new(-0.35, 1.5, 1.4)]).unwrap_err(), ExploreError::StartInWall { index: 0, .. }));
    assert!(matches!(run(&[DVec3::new(20.0, 1.5, 1.4)]).unwrap_err(), ExploreError::StartOutside { index: 0, .. }));
    assert!(matches!(run(&[inside, DVec3::new(99.0, 1.5, 1.4)]).unwrap_err(), ExploreError::ExtentTooSmall { .. }));
    assert!(matches!(run(&[DVec3::NAN]).unwrap_err(), ExploreError::StartNotFinite { index: 0, .. }));
    let skipped = run(&[DVec3::new(-0.21, 1.5, 1.4), inside]).unwrap().report.starts;
    assert!(skipped[0].used.is_none() && skipped[0].problem.as_ref().unwrap().contains("inside a wall"));
    assert_eq!(skipped[1].used, Some(inside));
}

#[test]
fn bad_configurations_are_named() {
    let room = Room::new(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5));
    let run = |config| carve(&room.world, &room.bvh, &[DVec3::new(2.0, 1.5, 1.4)], &config, &Quiet).unwrap_err().to_string();
    assert!(run(CarveConfig { voxel_m: 0.0, ..quick() }).starts_with("voxel_m = 0: expected"));
    assert!(run(CarveConfig { iterations: 0, ..quick() }).starts_with("iterations = 0: expected"));
    assert!(run(CarveConfig { voxel_m: 1e-5, ..quick() }).contains("raise voxel_m"));
}
