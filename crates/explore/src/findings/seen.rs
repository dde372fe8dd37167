//! Faults that people in the rooms of a scene would see: backs of shells, and missing ceilings.

use crate::Ceiling;
use crate::surroundings::meet;
use enfilade_geometry::Bvh;
use enfilade_math::{Ray, Vec3, warp};
use enfilade_parallel::{flat_map, map_up_to};
use enfilade_scene::{PartId, WorldMesh};
use std::f32::consts::TAU;

/// Places in all rooms together, about, and directions around each.
const PLACES: usize = 64;
const DIRECTIONS: usize = 256;
/// Share of what is seen of a part that is its back, where the part is named.
const MOSTLY_BACK: f64 = 0.9;

/// Plumb lines along the longer side of the scene, at most, and the least distance between them, metres.
const MAX_LINES: f32 = 96.0;
const MIN_SPACING_M: f32 = 0.2;
/// Height above a floor at which walls are looked for, and how far away they are at most, metres.
const WALLS_AT_M: f32 = 1.2;
const WALLS_WITHIN_M: f32 = 12.0;
/// Level directions, and how many of them meet a wall between walls.
const LEVEL: usize = 16;
const WALLED: usize = 12;

/// Parts seen from behind in the rooms of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Backs {
    /// Share of what is seen that is the back of a face, by counter-clockwise corners.
    pub share: f64,
    /// The parts of which nothing else is seen, those that are seen most first.
    pub parts: Vec<PartId>,
}

/// Looks around in every room; `None` without any.
pub(super) fn backs(world: &WorldMesh, bvh: &Bvh, ceilings: &[Ceiling]) -> Option<Backs> {
    let places: Vec<Vec3> = ceilings.iter().flat_map(|ceiling| ceiling.midpoints(PLACES.div_ceil(ceilings.len()))).collect();
    let look = |p: &Vec3| {
        let p = p.as_dvec3();
        let met = (0..DIRECTIONS).filter_map(move |k| meet(world, bvh, p, warp::fibonacci_sphere(k, DIRECTIONS)));
        met.map(|point| (point.part, point.behind))
    };
    let met: Vec<(PartId, bool)> = flat_map(&places, look);
    if met.is_empty() {
        return None;
    }
    let parts = world.sources.last().map_or(0, |source| source.part as usize + 1);
    let mut counts = vec![[0usize; 2]; parts];
    met.iter().for_each(|(part, behind)| counts[*part as usize][usize::from(*behind)] += 1);
    let is_back = |[front, back]: [usize; 2]| back > 0 && back as f64 >= MOSTLY_BACK * (front + back) as f64;
    let mut from_behind: Vec<PartId> = (0..parts).filter(|part| is_back(counts[*part])).map(|part| part as PartId).collect();
    from_behind.sort_by_key(|part| std::cmp::Reverse(counts[*part as usize][1]));
    let share = met.iter().filter(|(_, behind)| *behind).count() as f64 / met.len() as f64;
    Some(Backs { share, parts: from_behind })
}

/// Area of the surfaces that have walls around them and nothing above, square metres.
pub(super) fn open_floor_m2(world: &WorldMesh, bvh: &Bvh) -> f64 {
    if world.bounds.is_empty() {
        return 0.0;
    }
    let (low, size) = (world.bounds.min, world.bounds.extent());
    let spacing_m = (size.x.max(size.y) / MAX_LINES).max(MIN_SPACING_M);
    let [nx, ny] = [size.x, size.y].map(|length| (length / spacing_m).ceil() as usize);
    let is_open = |i: usize| {
        let (x, y) = ((i / ny) as f32 + 0.5, (i % ny) as f32 + 0.5);
        let from = Vec3::new(low.x + spacing_m * x, low.y + spacing_m * y, low.z + size.z + 1.0);
        bvh.closest(&Ray::new(from, Vec3::NEG_Z)).is_some_and(|hit| is_walled(bvh, from - Vec3::Z * (hit.t - WALLS_AT_M)))
    };
    let open = map_up_to(nx * ny, is_open).into_iter().filter(|open| *open).count();
    open as f64 * f64::from(spacing_m).powi(2)
}

fn is_walled(bvh: &Bvh, p: Vec3) -> bool {
    let meets = |k: &usize| {
        let (sin, cos) = (TAU * (*k as f32 + 0.5) / LEVEL as f32).sin_cos();
        bvh.occluded(&Ray { t_max: WALLS_WITHIN_M, ..Ray::new(p, Vec3::new(cos, sin, 0.0)) })
    };
    (0..LEVEL).filter(meets).count() >= WALLED
}
