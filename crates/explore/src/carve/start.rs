//! Is a start camera in a place from which carving makes sense, and where exactly does carving begin?

use crate::ExploreError;
use crate::grid::VoxelGrid;
use enfilade_geometry::{Bvh, Voxel};
use enfilade_math::{DVec3, Ray, warp};
use enfilade_parallel::{map, map_up_to};
use enfilade_scene::WorldMesh;

/// Directions around a start position.
const RAYS: usize = 2048;

/// Distances are replaced by the smallest within this angle, so that a gap between two things does not look like a way out.
/// The original pools 50 of its 262,144 rays, a cone of 1.6 degrees; this one contains about eight of 2048.
const POOL_RAD: f64 = 0.09;

/// A start is in the open when this share of all directions meets no surface, ...
const OPEN_SHARE: f64 = 0.9;

/// ... or, for the question whether it is in a building, this share of the level ones: in front of a house it is at least half.
const OPEN_LEVEL_SHARE: f64 = 2.0 / 3.0;
const LEVEL: usize = 72;

/// A start is in a solid thing when half of all directions end within this many metres, ...
const TIGHT_M: f64 = 0.25;

/// ... or within this many, and nearly all of them on the back of a surface.
const TIGHT_BEHIND_M: f64 = 0.75;
const BEHIND_SHARE: f64 = 0.9;

/// Distances to the surfaces around a point.
struct Surroundings {
    directions: Vec<DVec3>,
    distances_m: Vec<f64>,
    behind_share: f64,
}

impl Surroundings {
    fn look(world: &WorldMesh, bvh: &Bvh, p: DVec3) -> Self {
        let directions: Vec<DVec3> = (0..RAYS).map(|k| warp::fibonacci_sphere(k, RAYS)).collect();
        let hits: Vec<(f64, bool)> = map(&directions, |d| match bvh.closest(&Ray::new(p.as_vec3(), d.as_vec3())) {
            Some(hit) => {
                let [a, b, c] = world.corners[hit.triangle as usize];
                (f64::from(hit.t), (b - a).cross(c - a).dot(d.as_vec3()) > 0.0)
            }
            None => (f64::INFINITY, false),
        });
        let share = |n: usize| n as f64 / RAYS as f64;
        Self {
            behind_share: share(hits.iter().filter(|(_, behind)| *behind).count()),
            distances_m: hits.into_iter().map(|(t, _)| t).collect(),
            directions,
        }
    }

    fn median_m(&self) -> f64 {
        let mut sorted = self.distances_m.clone();
        sorted.sort_by(f64::total_cmp);
        sorted[RAYS / 2]
    }

    /// Directions with their pooled distances, the farthest first.
    fn ways_out(&self) -> Vec<(DVec3, f64)> {
        let pooled = |d: &DVec3| {
            let near = self.directions.iter().zip(&self.distances_m).filter(|(other, _)| other.dot(*d) >= POOL_RAD.cos());
            near.map(|(_, t)| *t).fold(f64::INFINITY, f64::min)
        };
        let mut ways: Vec<(DVec3, f64)> = map(&self.directions, |d| (*d, pooled(d)));
        ways.sort_by(|a, b| b.1.total_cmp(&a.1));
        ways
    }
}

/// Whether nearly nothing is around a point.
pub(super) fn is_open(bvh: &Bvh, p: DVec3) -> bool {
    let misses = map_up_to(RAYS, |k| misses(bvh, p, warp::fibonacci_sphere(k, RAYS)));
    misses.into_iter().filter(|misses| *misses).count() as f64 >= OPEN_SHARE * RAYS as f64
}

/// Whether a point is in a building rather than in front of one or above it: few of the directions around it, and of the level ones,
/// meet no surface.
pub fn is_indoors(bvh: &Bvh, p: DVec3) -> bool {
    let level = |k: &usize| {
        let (sin, cos) = (std::f64::consts::TAU * (*k as f64 + 0.5) / LEVEL as f64).sin_cos();
        misses(bvh, p, DVec3::new(cos, sin, 0.0))
    };
    !is_open(bvh, p) && ((0..LEVEL).filter(level).count() as f64) < OPEN_LEVEL_SHARE * LEVEL as f64
}

fn misses(bvh: &Bvh, p: DVec3, direction: DVec3) -> bool {
    bvh.closest(&Ray::new(p.as_vec3(), direction.as_vec3())).is_none()
}

/// The position to carve from for start camera `index` at `start`: itself, or when its voxel is occupied the first voxel that is not,
/// along the direction with the widest open view.
///
/// # Errors
/// [`ExploreError::StartInWall`].
pub(super) fn verify(world: &WorldMesh, bvh: &Bvh, grid: &VoxelGrid, index: usize, start: DVec3) -> Result<DVec3, ExploreError> {
    let voxel_m = grid.voxel_m();
    let mut around = Surroundings::look(world, bvh, start);
    let in_wall =
        |around: &Surroundings| ExploreError::StartInWall { index, position: start, median_m: around.median_m(), clear_m: 2.0 * voxel_m };
    let mut position = start;
    if grid.state(start) == Voxel::Occupied {
        position = first_open(grid, start, &around.ways_out()).ok_or_else(|| in_wall(&around))?;
        around = Surroundings::look(world, bvh, position);
    }
    let median_m = around.median_m();
    if median_m < TIGHT_M || (median_m < TIGHT_BEHIND_M && around.behind_share > BEHIND_SHARE) {
        return Err(in_wall(&around));
    }
    Ok(position)
}

/// The first position along the ways out, in steps of a quarter voxel, whose voxel is not occupied.
fn first_open(grid: &VoxelGrid, start: DVec3, ways: &[(DVec3, f64)]) -> Option<DVec3> {
    let voxel_m = grid.voxel_m();
    let step = 0.25 * voxel_m;
    ways.iter().find_map(|(direction, distance)| {
        // A way out is short: a few voxels beyond the surface at hand.
        let steps = (distance.min(8.0 * voxel_m) / step) as usize;
        (1..=steps).map(|k| start + *direction * (k as f64 * step)).find(|p| grid.state(*p) != Voxel::Occupied)
    })
}
