//! Claims about carving, on analytic rooms: volumes, leaks, starts in bad places, and the preset of Hypersim.

use super::*;
use crate::testroom::{Room, cuboid, house_with_thin_wall};
use enfilade_geometry::Voxel;
use enfilade_math::Vec3;
use enfilade_scene::{Heard, Quiet};

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
    let closed = house_with_thin_wall();
    let mut open = house_with_thin_wall();
    open.remove_ceiling();
    let starts = [DVec3::new(1.0, 1.5, 1.4), DVec3::new(3.6, 1.2, 1.0)];
    for (room, preset) in [(&closed, Preset::Default), (&open, Preset::Default), (&open, Preset::Hypersim)] {
        let carve_on = |threads| {
            let config = CarveConfig { preset, ..quick() };
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let space = pool.install(|| carve(&room.world, &room.bvh, &starts, &config, &Quiet)).unwrap();
            (space.tree.to_bt(), space.report)
        };
        let one = carve_on(1);
        assert_eq!(one, carve_on(2));
        assert_eq!(one, carve_on(7));
    }
}

/// A rectangle from `a` along `u` and `v`; it looks along u × v.
fn wall(a: [f64; 3], u: [f64; 3], v: [f64; 3]) -> Vec<[Vec3; 3]> {
    let [a, u, v] = [a, u, v].map(DVec3::from);
    let [a, b, c, d] = [a, a + u, a + u + v, a + v].map(|p| p.as_vec3());
    vec![[a, b, c], [a, c, d]]
}

/// A wall of the plane x = `x` from y = 0 to `width` and up to `height`, with a gap (y from, y to, z from, z to).
fn wall_with_gap(x: f64, width: f64, height: f64, [y0, y1, z0, z1]: [f64; 4]) -> Vec<[Vec3; 3]> {
    let piece = |y: f64, z: f64, dy: f64, dz: f64| wall([x, y, z], [0.0, dy, 0.0], [0.0, 0.0, dz]);
    [piece(0.0, 0.0, y0, height), piece(y1, 0.0, width - y1, height), piece(y0, 0.0, y1 - y0, z0), piece(y0, z1, y1 - y0, height - z1)]
        .concat()
}

/// A box from the origin without the side at its greatest x.
fn open_box(size: DVec3) -> Vec<[Vec3; 3]> {
    let on_side = |t: &[Vec3; 3]| t.iter().all(|p| p.x == size.x as f32);
    cuboid(DVec3::ZERO, size, true).into_iter().filter(|t| !on_side(t)).collect()
}

const GARDEN: ([f64; 3], [f64; 3], [f64; 3]) = ([-8.0, -8.0, -0.03], [24.0, 0.0, 0.0], [0.0, 20.0, 0.0]);

fn free_voxels(space: &FreeSpace, wanted: impl Fn(DVec3) -> bool) -> u64 {
    let leaves = space.tree.leaves().filter(|leaf| leaf.state == Voxel::Free);
    let center = |leaf: enfilade_geometry::Leaf, i: u64| {
        let edge = 1 << leaf.level;
        leaf.key.center(0.1) + DVec3::new((i % edge) as f64, (i / edge % edge) as f64, (i / edge / edge) as f64) * 0.1
    };
    leaves.flat_map(|leaf| (0..leaf.voxels()).map(move |i| center(leaf, i))).filter(|p| wanted(*p)).count() as u64
}

#[test]
fn free_space_ends_at_an_open_door() {
    let size = DVec3::new(4.05, 3.05, 2.55);
    let door = wall_with_gap(size.x, size.y, size.z, [1.05, 2.05, 0.0, 2.05]);
    let house = Room::from_corners([open_box(size), door, wall(GARDEN.0, GARDEN.1, GARDEN.2)].concat());
    let run = |keep_outside| {
        let config = CarveConfig { keep_outside, ..quick() };
        carve(&house.world, &house.bvh, &[DVec3::new(1.0, 1.5, 1.4)], &config, &Quiet).unwrap()
    };
    let (space, kept) = (run(false), run(true));
    let beyond = |p: DVec3| p.x > 4.15;
    assert_eq!(free_voxels(&space, beyond), 0);
    assert!(free_voxels(&kept, beyond) > 10_000);
    assert_eq!(kept.report.outside_voxels + space.report.free_voxels, kept.report.free_voxels);
    assert_eq!(kept.report.outside_voxels, space.report.outside_voxels);
    // All of the room but half a metre before the door.
    let before_door = |p: DVec3| p.distance(DVec3::new(4.05, 1.55, p.z)) < 0.8;
    let room = free_voxels(&kept, |p| p.x < 4.0 && !before_door(p));
    assert_eq!(free_voxels(&space, |p| !before_door(p)), room);
    let leak = &space.report.leaks[0];
    assert!(leak.position.distance(DVec3::new(4.0, 1.55, 1.0)) < 0.5, "{leak:?}");
    assert!((2.0..4.5).contains(&leak.area_m2), "{leak:?}");
    assert_eq!(kept.report.leaks, space.report.leaks);
}

#[test]
fn a_room_without_a_ceiling_is_free_up_to_its_walls() {
    let mut house = Room::new(DVec3::splat(-0.03), DVec3::new(3.93, 2.93, 2.43));
    house.remove_ceiling();
    let chimney = cuboid(DVec3::new(5.0, 0.0, 0.0), DVec3::new(6.0, 1.0, 9.0), false);
    let house = Room::from_corners([house.world.corners, chimney].concat());
    let space = carve(&house.world, &house.bvh, &[DVec3::new(1.0, 1.5, 1.4)], &quick(), &Quiet).unwrap();
    assert!(space.report.escaped_share > 0.05, "{}", space.report.escaped_share);
    assert_eq!(free_voxels(&space, |p| p.z < 2.4), 39 * 29 * 24);
    assert_eq!(space.report.free_voxels, 39 * 29 * 24, "nothing above the walls");
    assert!(space.report.outside_voxels > 10_000 && space.report.leaks[0].position.distance(DVec3::new(2.0, 1.5, 2.4)) < 0.5);
}

#[test]
fn walls_with_one_side_enclose_on_both_sides() {
    // Two rooms with one wall between them, which looks into the second, and a window without a pane in the second.
    let (size, part) = (DVec3::new(8.05, 3.05, 2.55), 4.05);
    let between = wall_with_gap(part, size.y, size.z, [1.05, 2.05, 0.0, 2.05]);
    let window = wall_with_gap(size.x, size.y, size.z, [1.05, 2.05, 1.05, 2.05]);
    let house = Room::from_corners([open_box(size), between, window].concat());
    for start in [DVec3::new(1.0, 1.5, 1.4), DVec3::new(7.0, 1.5, 1.4)] {
        let config = CarveConfig { iterations: 12, ..quick() };
        let space = carve(&house.world, &house.bvh, &[start], &config, &Quiet).unwrap();
        let kept = carve(&house.world, &house.bvh, &[start], &CarveConfig { keep_outside: true, ..config }, &Quiet).unwrap();
        let [all, room] = [kept, space.clone()].map(|space| free_voxels(&space, |p| p.x < size.x));
        assert!(all > 54_000 && room > all - 300, "{room} of {all}");
        assert!(free_voxels(&space, |p| p.x > size.x + 0.1) == 0 && space.report.outside_voxels > 0);
    }
}

#[test]
fn a_hole_of_one_voxel_leaks_only_by_the_original_rules() {
    // The voxel at y = 1.5, z = 1.4 is missing from a wall 5 cm behind a voxel border, in front of a garden.
    let size = DVec3::new(4.05, 3.05, 2.55);
    let hole = wall_with_gap(size.x, size.y, size.z, [1.5, 1.6, 1.4, 1.5]);
    let house = Room::from_corners([open_box(size), hole, wall(GARDEN.0, GARDEN.1, GARDEN.2)].concat());
    let run = |preset| {
        let config = CarveConfig { preset, ..quick() };
        carve(&house.world, &house.bvh, &[DVec3::new(1.0, 1.5, 1.4)], &config, &Quiet).unwrap()
    };
    let beyond = |space: &FreeSpace| free_voxels(space, |p| p.x > 4.1);
    let ours = run(Preset::Default);
    assert_eq!((beyond(&ours), ours.report.escaped_share), (0, 0.0));
    let original = run(Preset::Hypersim);
    assert!(beyond(&original) > 100 && original.report.escaped_share > 0.0, "{}", beyond(&original));
}

#[test]
fn a_sealed_room_next_to_another_stays_unknown() {
    let near = cuboid(DVec3::splat(-0.03), DVec3::new(3.93, 2.93, 2.43), true);
    let sealed = cuboid(DVec3::new(4.03, -0.03, -0.03), DVec3::new(7.93, 2.93, 2.43), true);
    let house = Room::from_corners([near, sealed].concat());
    for preset in [Preset::Default, Preset::Hypersim] {
        let config = CarveConfig { preset, ..quick() };
        let space = carve(&house.world, &house.bvh, &[DVec3::new(1.0, 1.5, 1.4)], &config, &Quiet).unwrap();
        assert_eq!(free_voxels(&space, |p| p.x > 4.0), 0, "{preset:?}");
        assert_eq!(space.report.free_voxels, 39 * 29 * 24, "{preset:?}");
        assert!(space.report.unknown_share > 0.3, "{}", space.report.unknown_share);
    }
}

#[test]
fn starts_at_one_position_are_carved_from_once_by_the_original_rules() {
    let room = house_with_thin_wall();
    let run = |starts: &[DVec3], preset| carve(&room.world, &room.bvh, starts, &CarveConfig { preset, ..quick() }, &Quiet).unwrap();
    let (p, q) = (DVec3::new(1.0, 1.5, 1.4), DVec3::new(3.6, 1.2, 1.0));
    let (twice, once) = (run(&[p, p, q], Preset::Hypersim), run(&[p, q], Preset::Hypersim));
    assert_eq!((twice.tree.to_bt(), &twice.report.positions), (once.tree.to_bt(), &once.report.positions));
    assert_eq!(twice.report.starts.iter().map(|start| start.used).collect::<Vec<_>>(), [Some(p), Some(p), Some(q)]);
    assert_eq!(run(&[p, p, q], Preset::Default).report.positions.len(), 15);
}

#[test]
fn an_open_stage_is_carved_whole_with_a_warning() {
    let stage = [wall(GARDEN.0, GARDEN.1, GARDEN.2), cuboid(DVec3::splat(1.0), DVec3::splat(2.0), false)].concat();
    let stage = Room::from_corners(stage);
    let heard = Heard::default();
    let space = carve(&stage.world, &stage.bvh, &[DVec3::new(0.0, 1.5, 1.4)], &quick(), &heard).unwrap();
    assert!(space.report.free_voxels > 100_000 && space.report.outside_voxels == 0);
    assert!(heard.lines().iter().any(|line| line.contains("no start camera stands inside")));
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

#[test]
fn an_open_place_is_carved_within_the_cube_with_a_warning() {
    // A block under a sky, and a camera four metres from it.
    let block = Room::from_corners(cuboid(DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0), false));
    let (start, heard) = (DVec3::new(1.0, -4.0, 1.2), Heard::default());
    let config = CarveConfig { extent_m: 12.0, ..quick() };
    let space = carve(&block.world, &block.bvh, &[start], &config, &heard).unwrap();
    assert!(space.report.starts[0].is_open && !space.report.sought_leaks && space.report.outside_voxels == 0);
    assert!((space.free_max - space.free_min).min_element() > 11.5, "{} {}", space.free_min, space.free_max);
    assert_eq!(space.tree.state(DVec3::new(1.0, 0.5, 0.5)), enfilade_geometry::Voxel::Unknown, "inside of the block");
    let warnings = heard.lines();
    assert!(warnings.len() == 1 && warnings[0].contains("is in the open"), "{warnings:?}");
    assert!(!crate::is_indoors(&block.bvh, start));
    // A room is none, and there it is known that nothing leaks.
    let room = Room::new(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5));
    let inside = DVec3::new(2.0, 1.5, 1.4);
    let space = carve(&room.world, &room.bvh, &[inside], &quick(), &Quiet).unwrap();
    assert!(!space.report.starts[0].is_open && space.report.sought_leaks && crate::is_indoors(&room.bvh, inside));
}

#[test]
fn the_papers_preset_keeps_what_it_sees_outside_and_frees_the_same_voxels_of_a_closed_room() {
    let closed = Room::new(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5));
    let run = |room: &Room, preset| {
        let config = CarveConfig { preset, ..quick() };
        carve(&room.world, &room.bvh, &[DVec3::new(2.0, 1.5, 1.4)], &config, &Quiet).unwrap()
    };
    assert!(run(&closed, Preset::Paper).tree == run(&closed, Preset::Default).tree);
    let mut open = crate::testroom::furnished_room();
    open.remove_ceiling();
    let (paper, default) = (run(&open, Preset::Paper).report, run(&open, Preset::Default).report);
    assert!(paper.outside_voxels == 0 && !paper.sought_leaks && default.sought_leaks, "{paper:?}");
}
