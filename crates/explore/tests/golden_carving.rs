//! Preset `hypersim` against octrees that Hypersim's own program made. Reads `golden` beside the folder that `ENFILADE_SCENES` names;
//! skipped where that is unset or the rooms are missing.

use enfilade_explore::{CarveConfig, Preset, carve};
use enfilade_geometry::{Bvh, OccupancyTree, Voxel};
use enfilade_math::{Bounds3, DVec3, Vec3};
use enfilade_scene::{Quiet, TriangleSource, WorldMesh};
use enfilade_testkit::Npz;
use std::path::{Path, PathBuf};

/// The rooms whose walls do not lie on voxel borders; on others, rounding decides about a fifth of the occupied voxels.
const ROOMS: [&str; 2] = ["aws-house-offgrid", "staircase"];

/// Intersection over union of the voxels of a state, at least.
const SAME: f64 = 0.9999;

fn rooms() -> Vec<PathBuf> {
    let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
        println!("skipped: ENFILADE_SCENES is not set");
        return Vec::new();
    };
    let folders = ROOMS.map(|room| Path::new(&scenes).join("../golden").join(room));
    let (there, missing): (Vec<PathBuf>, Vec<PathBuf>) = folders.into_iter().partition(|folder| folder.is_dir());
    missing.iter().for_each(|folder| println!("skipped: no folder {}", folder.display()));
    there
}

fn read(path: PathBuf) -> Vec<u8> {
    std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn mesh(folder: &Path) -> WorldMesh {
    let mesh = Npz::new(&read(folder.join("mesh.npz")));
    let vertices: Vec<Vec3> = mesh.f32("vertices").chunks_exact(3).map(Vec3::from_slice).collect();
    let corners: Vec<[Vec3; 3]> = mesh.i32("faces").chunks_exact(3).map(|f| [0, 1, 2].map(|i| vertices[f[i] as usize])).collect();
    let sources = (0..corners.len() as u32).map(|triangle| TriangleSource { part: 0, triangle }).collect();
    let bounds = Bounds3::from_points(corners.iter().flatten().copied());
    WorldMesh { corners, sources, bounds }
}

fn points(value: &serde_json::Value) -> Vec<DVec3> {
    let point = |p: &serde_json::Value| DVec3::from([0, 1, 2].map(|a| p[a].as_f64().unwrap()));
    value.as_array().unwrap().iter().map(point).collect()
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

#[test]
fn the_original_program_finds_the_same_voxels_from_the_same_positions() {
    for folder in rooms() {
        let stats: serde_json::Value = serde_json::from_slice(&read(folder.join("stats.json"))).unwrap();
        let starts = points(&stats["start_positions"]);
        let world = mesh(&folder);
        let bvh = Bvh::new(&world.corners, &|_| false);
        let config = CarveConfig { preset: Preset::Hypersim, ..CarveConfig::default() };
        let space = carve(&world, &bvh, &starts, &config, &Quiet).unwrap();
        let golden = OccupancyTree::from_bt(&read(folder.join("octomap.bt"))).unwrap();
        for state in [Voxel::Free, Voxel::Occupied] {
            let (both, either) = shared(&space.tree, &golden, state);
            println!("{}: {state:?}: {both} of {either} voxels are the same", folder.display());
            assert!(both as f64 >= SAME * either as f64);
        }
        // The program rounds some of the bounds that it draws positions from to single precision.
        let positions = stats["carve_positions"].as_array().unwrap().iter().flat_map(|start| points(start).into_iter().take(5));
        for (ours, theirs) in space.report.positions.iter().zip(positions) {
            assert!(ours.distance(theirs) < 1e-6, "{ours} {theirs}");
        }
        let bounds = [&stats["free_space_min"], &stats["free_space_max"]].map(|b| DVec3::from([0, 1, 2].map(|a| b[a].as_f64().unwrap())));
        assert!(space.free_min.distance(bounds[0]) < 1e-6 && space.free_max.distance(bounds[1]) < 1e-6);
    }
}

#[test]
fn the_default_rules_free_nearly_the_same_in_closed_rooms() {
    for folder in rooms() {
        let stats: serde_json::Value = serde_json::from_slice(&read(folder.join("stats.json"))).unwrap();
        let world = mesh(&folder);
        let bvh = Bvh::new(&world.corners, &|_| false);
        let space = carve(&world, &bvh, &points(&stats["start_positions"]), &CarveConfig::default(), &Quiet).unwrap();
        let golden = OccupancyTree::from_bt(&read(folder.join("octomap.bt"))).unwrap();
        let (both, either) = shared(&space.tree, &golden, Voxel::Free);
        println!("{}: {both} of {either} free voxels are the same, {} outside", folder.display(), space.report.outside_voxels);
        assert!(both as f64 > 0.97 * either as f64);
    }
}
