//! Start cameras for scenes that come without any: places to stand, judged by floor, headroom and the surfaces around them.

use crate::CarveConfig;
use enfilade_geometry::Bvh;
use enfilade_math::{DMat3, DVec3, Ray, Vec3, warp};
use enfilade_parallel::flat_map_up_to;
use enfilade_scene::{Cx, StartCamera, Warning, WorldMesh};
use serde::{Deserialize, Serialize};

/// Columns of the search grid along the longer side of the scene, at most.
const MAX_COLUMNS: f64 = 40.0;
/// Surfaces looked through in one column.
const MAX_FLOORS: usize = 64;
/// Directions from which a place is judged.
const RAYS: usize = 256;
/// Surfaces beyond this count as not enclosing, metres.
const ENCLOSING_M: f32 = 12.0;
/// A place needs this share of directions that meet an enclosing surface. Leaves room for a missing wall or ceiling.
const MIN_ENCLOSED: f32 = 0.6;
/// Wider views than this are not better, metres.
const OPEN_M: f32 = 3.0;
/// Two places that see each other are only both taken when this far apart, metres.
const APART_M: f32 = 6.0;

/// Settings of the search for start cameras in a scene that has none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StartsConfig {
    /// Cameras wanted, at most.
    pub max_starts: u32,
    /// Height of the camera above the floor, metres.
    pub eye_height_m: f64,
    /// Free height that a floor needs above it, metres.
    pub headroom_m: f64,
    /// Distance to every surface around, metres.
    pub clearance_m: f64,
    /// The cameras are no further apart than this along any axis, metres: what is carved around them is no wider than
    /// [`CarveConfig::extent_m`].
    pub max_spread_m: f64,
    /// Horizontal field of view of the cameras made, radians.
    pub fov_x_rad: f64,
}

impl Default for StartsConfig {
    fn default() -> Self {
        Self {
            max_starts: 3,
            eye_height_m: 1.5,
            headroom_m: 2.0,
            clearance_m: 0.35,
            max_spread_m: CarveConfig::default().extent_m,
            fov_x_rad: std::f64::consts::FRAC_PI_3,
        }
    }
}

/// A place to stand.
#[derive(Clone, Copy)]
struct Standpoint {
    eye: Vec3,
    floor_z: f32,
    score: f32,
}

/// Finds places to stand inside a building, for scenes without cameras: at eye height above a floor, with headroom, enclosed by
/// surfaces in nearly all directions. The cameras look level along the longest view, and are named `start_00`, `start_01`, ….
///
/// Returns at most `max_starts`, the best first; none (with a warning) when nothing in the scene looks like an interior. A place too
/// far from better ones is left out with a warning.
pub fn find_starts(world: &WorldMesh, bvh: &Bvh, config: &StartsConfig, cx: &dyn Cx) -> Vec<StartCamera> {
    let mut places = places(world, bvh, config);
    prefer_common_floors(&mut places);
    places.sort_by(|a, b| b.score.total_cmp(&a.score));
    let chosen = choose(&places, bvh, config, cx);
    if chosen.is_empty() {
        let message = "no place was found that has a floor, headroom and surfaces all around; check units and up axis, or add a camera";
        cx.warn(Warning { place: "start cameras".into(), message: message.into() });
    }
    chosen.iter().enumerate().map(|(i, place)| camera(bvh, i, place.eye, config)).collect()
}

/// The first of `places` that do not see each other or are far apart, but no further than is allowed.
fn choose(places: &[Standpoint], bvh: &Bvh, config: &StartsConfig, cx: &dyn Cx) -> Vec<Standpoint> {
    let mut chosen: Vec<Standpoint> = Vec::new();
    let mut left_out = None;
    for place in places {
        if chosen.len() == config.max_starts as usize || place.score < 0.5 * places[0].score {
            break;
        }
        let apart = |other: &Standpoint| place.eye.distance(other.eye) > APART_M || is_blocked(bvh, place.eye, other.eye);
        if !chosen.iter().all(apart) {
            continue;
        }
        let spread_m = spread_m(chosen.iter().chain([place]));
        if spread_m <= config.max_spread_m {
            chosen.push(*place);
        } else {
            left_out.get_or_insert((place.eye, spread_m));
        }
    }
    if let Some((eye, spread_m)) = left_out {
        let message = format!(
            "a place to stand at {eye:.1} is left out: with it they would be {spread_m:.1} m apart along an axis, and only {} m are \
             carved; raise extent_m in [carve], or state cameras",
            config.max_spread_m
        );
        cx.warn(Warning { place: "start cameras".into(), message });
    }
    chosen
}

/// The longest side of the box around some places, metres.
fn spread_m<'a>(places: impl Iterator<Item = &'a Standpoint>) -> f64 {
    let eyes = places.map(|place| place.eye.as_dvec3());
    let (low, high) = eyes.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), eye| (low.min(eye), high.max(eye)));
    (high - low).max_element()
}

/// Every place on a grid over the scene where one can stand.
fn places(world: &WorldMesh, bvh: &Bvh, config: &StartsConfig) -> Vec<Standpoint> {
    let size = world.bounds.extent();
    if world.bounds.is_empty() {
        return Vec::new();
    }
    let spacing = f64::from(size.x.max(size.y)) / MAX_COLUMNS;
    let spacing = spacing.max(0.25) as f32;
    let (nx, ny) = ((size.x / spacing).ceil() as usize, (size.y / spacing).ceil() as usize);
    let directions: Vec<Vec3> = (0..RAYS).map(|k| warp::fibonacci_sphere(k, RAYS).as_vec3()).collect();
    flat_map_up_to(nx * ny, |column| {
        let (x, y) = ((column % nx) as f32 + 0.5, (column / nx) as f32 + 0.5);
        let (x, y) = (world.bounds.min.x + spacing * x, world.bounds.min.y + spacing * y);
        let floors = floors(world, bvh, x, y, config.headroom_m as f32);
        let eyes = floors.into_iter().map(move |z| (Vec3::new(x, y, z + config.eye_height_m as f32), z));
        eyes.filter_map(|(eye, floor_z)| {
            let score = judge(bvh, eye, config.clearance_m as f32, &directions)?;
            Some(Standpoint { eye, floor_z, score })
        })
        .collect::<Vec<_>>()
    })
}

/// Heights of the level surfaces of a column that have headroom above them.
fn floors(world: &WorldMesh, bvh: &Bvh, x: f32, y: f32, headroom: f32) -> Vec<f32> {
    let mut found = Vec::new();
    let (mut z, mut above) = (world.bounds.max.z + 1.0, f32::INFINITY);
    for _ in 0..MAX_FLOORS {
        let Some(hit) = bvh.closest(&Ray::new(Vec3::new(x, y, z), Vec3::NEG_Z)) else { break };
        let surface = z - hit.t;
        let [a, b, c] = world.corners[hit.triangle as usize];
        let normal = (b - a).cross(c - a).normalize_or_zero();
        if above - surface >= headroom && normal.z.abs() > 0.9 {
            found.push(surface);
        }
        above = surface;
        z = surface - 1e-3;
    }
    found
}

/// Score of a place; `None` when it is cramped or not enclosed.
fn judge(bvh: &Bvh, eye: Vec3, clearance: f32, directions: &[Vec3]) -> Option<f32> {
    let mut distances: Vec<f32> = directions.iter().map(|d| bvh.closest(&Ray::new(eye, *d)).map_or(f32::INFINITY, |hit| hit.t)).collect();
    distances.sort_by(f32::total_cmp);
    let enclosed = distances.partition_point(|t| *t <= ENCLOSING_M) as f32 / distances.len() as f32;
    if distances[0] < clearance || enclosed < MIN_ENCLOSED {
        return None;
    }
    let openness = distances[distances.len() / 2].min(OPEN_M) / OPEN_M;
    Some(enclosed.powi(4) * openness)
}

/// Most of a storey's places are on its floor, few on its tables: each score is weighted by the share of places whose floor is at the same
/// height.
fn prefer_common_floors(places: &mut [Standpoint]) {
    let mut heights: Vec<f32> = places.iter().map(|p| p.floor_z).collect();
    heights.sort_by(f32::total_cmp);
    let below = |z: f32| heights.partition_point(|h| *h < z);
    let popularity = |z: f32| (below(z + 0.1) - below(z - 0.1)) as f32;
    let max = heights.iter().map(|z| popularity(*z)).fold(1.0, f32::max);
    for place in places {
        place.score *= popularity(place.floor_z) / max;
    }
}

fn is_blocked(bvh: &Bvh, from: Vec3, to: Vec3) -> bool {
    let mut ray = Ray::new(from, to - from);
    ray.t_max = 1.0;
    bvh.occluded(&ray)
}

/// A level camera along the longest view. A view counts as long as the shortest within ten degrees of it, and a way out of the
/// scene as no view.
fn camera(bvh: &Bvh, index: usize, eye: Vec3, config: &StartsConfig) -> StartCamera {
    const DIRECTIONS: usize = 72;
    const POOL: usize = 2;
    let heading = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / DIRECTIONS as f64).sin_cos();
        DVec3::new(cos, sin, 0.0)
    };
    let lengths: Vec<f32> = (0..DIRECTIONS).map(|k| bvh.closest(&Ray::new(eye, heading(k).as_vec3())).map_or(0.0, |hit| hit.t)).collect();
    let pooled = |k: usize| {
        let near = (0..=2 * POOL).map(|i| lengths[(k + DIRECTIONS + i - POOL) % DIRECTIONS]);
        near.fold(f32::INFINITY, f32::min)
    };
    let longest = (1..DIRECTIONS).fold(0, |best, k| if pooled(k) > pooled(best) { k } else { best });
    let forward = heading(longest);
    StartCamera {
        name: format!("start_{index:02}"),
        position: eye.as_dvec3(),
        world_from_camera: DMat3::from_cols(forward.cross(DVec3::Z), DVec3::Z, -forward),
        fov_x_rad: config.fov_x_rad,
        aspect: 4.0 / 3.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::carve;
    use crate::testroom::{Room, cuboid, furnished_room};
    use enfilade_scene::{Heard, Quiet};

    /// Two closed rooms, the second from `x` on.
    fn two_rooms(x: f64) -> Room {
        let mut corners = cuboid(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), true);
        corners.extend(cuboid(DVec3::new(x, 0.0, 0.0), DVec3::new(x + 3.8, 3.0, 2.5), true));
        Room::from_corners(corners)
    }

    #[test]
    fn starts_stand_on_the_floor_inside() {
        let room = furnished_room();
        let starts = find_starts(&room.world, &room.bvh, &StartsConfig::default(), &Quiet);
        assert!((1..=3).contains(&starts.len()));
        let start = &starts[0];
        assert_eq!(start.name, "start_00");
        assert!((start.position.z - 1.47).abs() < 1e-5, "{}", start.position);
        assert!(room.distance_m(start.position) > 0.3);
        let forward = -start.world_from_camera.z_axis;
        assert!(forward.z == 0.0 && (start.world_from_camera.determinant() - 1.0).abs() < 1e-12);
        let view = room.bvh.closest(&Ray::new(start.position.as_vec3(), forward.as_vec3())).unwrap();
        assert!(view.t > 2.5, "looks {} m far", view.t);
        let config = CarveConfig { rays: 10_000, ..CarveConfig::default() };
        assert!(carve(&room.world, &room.bvh, &[start.position], &config, &Quiet).unwrap().report.free_volume_m3 > 50.0);
    }

    #[test]
    fn each_of_two_separate_rooms_gets_one() {
        let room = two_rooms(4.2);
        let starts = find_starts(&room.world, &room.bvh, &StartsConfig::default(), &Quiet);
        assert_eq!(starts.len(), 2);
        assert!((starts[0].position.x - 4.1) * (starts[1].position.x - 4.1) < 0.0);
    }

    #[test]
    fn rooms_further_apart_than_is_carved_get_one_with_a_warning() {
        let (room, heard) = (two_rooms(40.0), Heard::default());
        let starts = find_starts(&room.world, &room.bvh, &StartsConfig::default(), &heard);
        let warnings = heard.lines();
        assert_eq!((starts.len(), warnings.len()), (1, 1), "{warnings:?}");
        assert!(warnings[0].contains("only 30 m are carved"), "{warnings:?}");
        let config = CarveConfig { rays: 10_000, ..CarveConfig::default() };
        assert!(carve(&room.world, &room.bvh, &[starts[0].position], &config, &Quiet).unwrap().report.free_volume_m3 > 15.0);
        let wide = StartsConfig { max_spread_m: 50.0, ..StartsConfig::default() };
        assert_eq!(find_starts(&room.world, &room.bvh, &wide, &Quiet).len(), 2);
    }

    #[test]
    fn nothing_to_stand_in_gives_none() {
        let block = Room::from_corners(cuboid(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), false));
        let starts = find_starts(&block.world, &block.bvh, &StartsConfig { headroom_m: 3.0, ..StartsConfig::default() }, &Quiet);
        assert!(starts.is_empty());
    }
}
