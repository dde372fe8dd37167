//! Runs carving and walking on one room, by both presets, and compares times and results with those of Hypersim's programs.

use super::room::{Room, Walk};
use enfilade_explore::{CarveConfig, FreeSpace, PlanConfig, Preset, carve, plan};
use enfilade_geometry::{Bvh, OccupancyTree, Voxel};
use enfilade_scene::{Pose, Quiet};
use enfilade_testkit::{process_cpu_s, wall_s};
use std::collections::HashSet;

/// Runs of everything.
const RUNS: usize = 5;

/// The measurements of one room.
pub struct Measured {
    pub name: &'static str,
    pub triangles: usize,
    /// CPU seconds by preset, the programs' parameters first.
    pub carve_s: [f64; 2],
    pub hierarchy_s: f64,
    pub peer_carve_s: [f64; 2],
    /// CPU seconds of a walk by preset, and the programs', for each camera.
    pub walks_s: Vec<([f64; 2], f64)>,
    /// How many times faster all cores are than one, for carving and walking by the programs' rules.
    pub speedups: [f64; 2],
    pub agreement: Agreement,
}

/// How our results compare with the programs'.
pub struct Agreement {
    /// Intersection over union of the free voxels, and of the occupied.
    pub overlap: [f64; 2],
    /// Free voxels, ours and theirs.
    pub free: [u64; 2],
    /// The farthest that any position carved from is from theirs, metres.
    pub carve_positions_m: f64,
    /// Frames, and those at whose positions the programs' trajectories are.
    pub frames: [usize; 2],
}

pub fn room(room: &Room) -> Measured {
    let one = threads(1);
    let all = threads(0);
    let carve_with = |preset| CarveConfig { preset, ..CarveConfig::default() };
    let plan_with = |preset| PlanConfig { preset, ..PlanConfig::default() };
    let carved = |preset| {
        let bvh = Bvh::new(&room.world.corners, &|_| false);
        let space = carve(&room.world, &bvh, &room.start_positions(), &carve_with(preset), &Quiet).expect("the room can be carved");
        let bytes = space.tree.to_bt();
        (space, bytes)
    };
    let walked = |preset, camera: usize| {
        let bvh = Bvh::new(&room.world.corners, &|_| false);
        let space = room.free_space();
        plan(&room.world, &bvh, &space, &room.starts[camera], camera as u32, &plan_with(preset), &Quiet).expect("a trajectory begins here")
    };
    let presets = [Preset::Hypersim, Preset::Default];
    let carve_s = presets.map(|preset| one.install(|| median(process_cpu_s, || drop(carved(preset)))));
    let cameras = 0..room.starts.len();
    let walks_s = cameras.clone().map(|camera| {
        let ours = presets.map(|preset| one.install(|| median(process_cpu_s, || drop(walked(preset, camera)))));
        (ours, room.walks[camera].peer_s)
    });
    let walks_s = walks_s.collect();
    let hierarchy_s = one.install(|| median(process_cpu_s, || drop(Bvh::new(&room.world.corners, &|_| false))));
    let speedup = |work: &(dyn Fn() + Sync)| {
        let times = [&one, &all].map(|pool| median(wall_s, || pool.install(work)));
        times[0] / times[1]
    };
    let bvh = Bvh::new(&room.world.corners, &|_| false);
    let space = room.free_space();
    let only_carve = || drop(carve(&room.world, &bvh, &room.start_positions(), &carve_with(Preset::Hypersim), &Quiet));
    let only_walk = || drop(plan(&room.world, &bvh, &space, &room.starts[0], 0, &plan_with(Preset::Hypersim), &Quiet));
    let poses = cameras.map(|camera| walked(Preset::Hypersim, camera).trajectory.poses).collect::<Vec<_>>();
    Measured {
        name: room.name,
        triangles: room.world.corners.len(),
        carve_s,
        hierarchy_s,
        peer_carve_s: room.peer_carve_s,
        walks_s,
        speedups: [speedup(&only_carve), speedup(&only_walk)],
        agreement: Agreement::new(room, &carved(Preset::Hypersim).0, &poses),
    }
}

impl Agreement {
    fn new(room: &Room, space: &FreeSpace, poses: &[Vec<Pose>]) -> Self {
        let theirs = room.free_space().tree;
        let pairs = space.report.positions.iter().zip(&room.carve_positions);
        let same = |(walk, poses): (&Walk, &Vec<Pose>)| {
            walk.positions.iter().zip(poses).filter(|(p, pose)| p.distance(pose.position) < 1e-6).count()
        };
        Self {
            overlap: [Voxel::Free, Voxel::Occupied].map(|state| overlap(&space.tree, &theirs, state)),
            free: [&space.tree, &theirs].map(|tree| tree.count(Voxel::Free)),
            carve_positions_m: pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max),
            frames: [poses.iter().map(Vec::len).sum(), room.walks.iter().zip(poses).map(same).sum()],
        }
    }
}

/// Intersection over union of the voxels of one state.
pub fn overlap(a: &OccupancyTree, b: &OccupancyTree, state: Voxel) -> f64 {
    let keys = |tree: &OccupancyTree| -> HashSet<[u16; 3]> {
        let leaves = tree.leaves().filter(|leaf| leaf.state == state);
        let voxels = leaves.flat_map(|leaf| {
            let edge = 1u32 << leaf.level;
            (0..edge.pow(3))
                .map(move |i| [i % edge, i / edge % edge, i / edge / edge].map(|k| k as u16))
                .map(move |k| [0, 1, 2].map(|a| leaf.key.0[a] + k[a]))
        });
        voxels.collect()
    };
    let (a, b) = (keys(a), keys(b));
    let both = a.intersection(&b).count();
    both as f64 / (a.len() + b.len() - both) as f64
}

/// A pool of `n` threads; 0 for one per processor.
fn threads(n: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads")
}

fn median(clock_s: fn() -> f64, work: impl Fn()) -> f64 {
    let mut times: Vec<f64> = (0..RUNS)
        .map(|_| {
            let start = clock_s();
            work();
            clock_s() - start
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[RUNS / 2]
}
