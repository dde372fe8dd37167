//! What carving costs: `cargo run --release --example carve_time -- FOLDER [default|hypersim]`.
//!
//! The folder holds a room as Hypersim's programs are given it: `mesh.npz` (`vertices`, `faces`) and `cameras.json` (a list of objects
//! with a `position`). Times are CPU seconds of one thread, the least of several runs.

use enfilade_explore::{CarveConfig, Preset, carve};
use enfilade_geometry::{Bvh, Voxel};
use enfilade_math::{Bounds3, DVec3, Vec3};
use enfilade_scene::{Quiet, TriangleSource, WorldMesh};
use enfilade_testkit::Npz;
use std::path::Path;

const RUNS: usize = 5;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().expect("expected the folder of a room");
    let preset = match arguments.next().as_deref() {
        Some("hypersim") => Preset::Hypersim,
        _ => Preset::Default,
    };
    let (world, starts) = room(Path::new(&folder));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    pool.install(|| {
        let (bvh, bvh_s) = best(|| Bvh::new(&world.corners, &|_| false));
        let config = CarveConfig { preset, ..CarveConfig::default() };
        let (space, carve_s) = best(|| carve(&world, &bvh, &starts, &config, &Quiet).expect("the room can be carved"));
        let [free, occupied] = [Voxel::Free, Voxel::Occupied].map(|state| space.tree.count(state));
        println!("{} triangles, {} starts, {preset:?}: {free} free and {occupied} occupied voxels", world.corners.len(), starts.len());
        println!("hierarchy {bvh_s:.3} s, carving {carve_s:.3} s");
    });
}

fn room(folder: &Path) -> (WorldMesh, Vec<DVec3>) {
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap_or_else(|e| panic!("{}: {e}", folder.join(name).display()));
    let mesh = Npz::new(&read("mesh.npz"));
    let vertices: Vec<Vec3> = mesh.f32("vertices").chunks_exact(3).map(Vec3::from_slice).collect();
    let corners: Vec<[Vec3; 3]> = mesh.i32("faces").chunks_exact(3).map(|f| [0, 1, 2].map(|i| vertices[f[i] as usize])).collect();
    let sources = (0..corners.len() as u32).map(|triangle| TriangleSource { part: 0, triangle }).collect();
    let bounds = Bounds3::from_points(corners.iter().flatten().copied());
    let cameras: serde_json::Value = serde_json::from_slice(&read("cameras.json")).expect("cameras.json is a list");
    let position = |camera: &serde_json::Value| DVec3::from([0, 1, 2].map(|a| camera["position"][a].as_f64().expect("a number")));
    let starts = cameras.as_array().expect("a list").iter().map(position).collect();
    (WorldMesh { corners, sources, bounds, contrasts: vec![0.0] }, starts)
}

/// The last result, and the least CPU seconds of this process for one.
fn best<T>(make: impl Fn() -> T) -> (T, f64) {
    let cpu_s = || {
        let t = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        t.tv_sec as f64 + t.tv_nsec as f64 * 1e-9
    };
    let mut least = f64::INFINITY;
    for _ in 1..RUNS {
        let start = cpu_s();
        drop(make());
        least = least.min(cpu_s() - start);
    }
    (make(), least)
}
