//! Preset `hypersim` against octrees that Hypersim's own program made. Skipped where its results are not available.

#[allow(dead_code, reason = "each test uses a part of it")]
#[path = "../../bench/src/explore/room.rs"]
mod room;

use enfilade_explore::{CarveConfig, FreeSpace, Preset, carve};
use enfilade_geometry::{Bvh, OccupancyTree, Voxel};
use enfilade_scene::Quiet;
use room::{ROOMS, Room, folder};

/// Intersection over union of the voxels of a state, at least.
const SAME: f64 = 0.9999;

fn rooms() -> Vec<Room> {
    let Some(folder) = folder() else {
        println!("skipped: no results of Hypersim's programs; ENFILADE_GOLDEN or ENFILADE_SCENES says where they are");
        return Vec::new();
    };
    ROOMS.into_iter().map(|name| Room::read(&folder, name)).collect()
}

/// Voxels of a state in both trees, and in either.
fn shared(a: &OccupancyTree, b: &OccupancyTree, state: Voxel) -> (u64, u64) {
    let voxels = |tree: &OccupancyTree| {
        let mut keys = Vec::new();
        for leaf in tree.leaves().filter(|leaf| leaf.state == state) {
            let edge = 1u64 << leaf.level;
            let place = |i: u64| [i % edge, i / edge % edge, i / edge / edge];
            keys.extend((0..leaf.voxels()).map(|i| [0, 1, 2].map(|a| leaf.key.0[a] + place(i)[a] as u16)));
        }
        keys.sort_unstable();
        keys
    };
    let (a, b) = (voxels(a), voxels(b));
    let both = a.iter().filter(|key| b.binary_search(key).is_ok()).count() as u64;
    (both, a.len() as u64 + b.len() as u64 - both)
}

fn carved(room: &Room, preset: Preset) -> FreeSpace {
    let bvh = Bvh::new(&room.world.corners, &|_| false);
    let config = CarveConfig { preset, ..CarveConfig::default() };
    carve(&room.world, &bvh, &room.start_positions(), &config, &Quiet).unwrap()
}

#[test]
fn the_original_program_finds_the_same_voxels_from_the_same_positions() {
    for room in rooms() {
        let space = carved(&room, Preset::Hypersim);
        let golden = OccupancyTree::from_bt(&room.octomap).unwrap();
        for state in [Voxel::Free, Voxel::Occupied] {
            let (both, either) = shared(&space.tree, &golden, state);
            println!("{}: {both} of {either} {state:?} voxels are the same", room.name);
            assert!(both as f64 >= SAME * either as f64);
        }
        // The program rounds some of the bounds that it draws positions from to single precision.
        assert_eq!(space.report.positions.len(), room.carve_positions.len());
        for (ours, theirs) in space.report.positions.iter().zip(&room.carve_positions) {
            assert!(ours.distance(*theirs) < 1e-6, "{}: {ours} {theirs}", room.name);
        }
    }
}

#[test]
fn the_default_rules_free_nearly_the_same_in_closed_rooms() {
    for room in rooms() {
        let space = carved(&room, Preset::Default);
        let golden = OccupancyTree::from_bt(&room.octomap).unwrap();
        let (both, either) = shared(&space.tree, &golden, Voxel::Free);
        println!("{}: {both} of {either} free voxels are the same", room.name);
        assert!(both as f64 > 0.97 * either as f64);
        assert_eq!((space.report.escaped_share, space.report.outside_voxels), (0.0, 0));
    }
}
