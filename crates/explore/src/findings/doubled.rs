//! Faces with the same corners as another.

use enfilade_parallel::flat_map_up_to;
use enfilade_scene::WorldMesh;
use rayon::slice::ParallelSliceMut;

/// Corners that are nearer to each other than this, along each axis, are mostly taken for the same, metres.
const SAME_M: f64 = 1e-5;

/// Triangles (of the world) with the corners of an earlier one, in whatever order, as `[earlier, later]`, in the order of the later ones.
/// Those without area are left out.
pub fn doubled_faces(world: &WorldMesh) -> Vec<[u32; 2]> {
    let mut keys: Vec<([[i64; 3]; 3], u32)> = flat_map_up_to(world.corners.len(), |i| {
        let cell = |axis: f32| (f64::from(axis) / SAME_M).round() as i64;
        let mut key = world.corners[i].map(|corner| corner.to_array().map(cell));
        key.sort_unstable();
        (key[0] != key[1] && key[1] != key[2]).then_some((key, i as u32))
    });
    keys.par_sort_unstable();
    let groups = keys.chunk_by(|a, b| a.0 == b.0);
    let mut doubled: Vec<[u32; 2]> = groups.flat_map(|group| group[1..].iter().map(|later| [group[0].1, later.1])).collect();
    doubled.sort_unstable_by_key(|[_, later]| *later);
    doubled
}
