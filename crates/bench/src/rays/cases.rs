//! The rays of the measurement, made from camera views.

use enfilade_geometry::Bvh;
use enfilade_math::{DMat3, Distribution1, Onb, Ray, Rng, Vec3, offset_origin, warp};
use enfilade_scene::{Intrinsics, StartCamera};

type Triangle = [Vec3; 3];

const WIDTH: u32 = 1024;
const HEIGHT: u32 = 768;
const TILE: u32 = 16;

/// The question asked about a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// The first hit.
    Closest,
    /// Whether there is a hit.
    Any,
}

/// Rays of one kind.
pub struct Case {
    pub name: &'static str,
    pub question: Question,
    pub rays: Vec<Ray>,
}

/// A room, and the origins and directions of its rays.
pub struct Room {
    pub name: String,
    pub triangles: Vec<Triangle>,
    pub camera: StartCamera,
    /// Indices of triangles that emit light.
    pub lamps: Vec<u32>,
}

/// A point that a ray met, just above its surface, and the normal on the ray's side.
struct Seen {
    point: Vec3,
    normal: Vec3,
}

/// Camera rays in tiles of 16 × 16 pixels, cosine-distributed rays from the points they hit and again from where those end, and shadow
/// rays between visible points and toward lamps (the sky, where there are none).
pub fn cases(room: &Room, bvh: &Bvh) -> Vec<Case> {
    let primary = camera_rays(&room.camera);
    let seen = seen(room, bvh, &primary);
    let bounce_1 = diffuse(&seen, 1);
    let bounce_2 = diffuse(&self::seen(room, bvh, &bounce_1), 2);
    let (between, lamps) = (between(&seen), toward_lamps(room, &seen));
    let case = |name, question, rays| Case { name, question, rays };
    vec![
        case("primary", Question::Closest, primary),
        case("diffuse bounce", Question::Closest, bounce_1),
        case("second bounce", Question::Closest, bounce_2),
        case("shadow, between points", Question::Any, between),
        case("shadow, to lights", Question::Any, lamps),
    ]
}

/// A camera near a corner of a scene that has none.
pub fn corner_camera(bvh: &Bvh) -> StartCamera {
    let bounds = bvh.bounds();
    let position = bounds.min + bounds.extent() * Vec3::new(0.1, 0.2, 0.55);
    let back = (position - bounds.center()).normalize();
    let right = Vec3::Z.cross(back).normalize();
    let world_from_camera = DMat3::from_cols(right.as_dvec3(), back.cross(right).as_dvec3(), back.as_dvec3());
    StartCamera { name: "corner".into(), position: position.as_dvec3(), world_from_camera, fov_x_rad: 1.1, aspect: 4.0 / 3.0 }
}

fn camera_rays(camera: &StartCamera) -> Vec<Ray> {
    let intrinsics = Intrinsics::from_fov_x(WIDTH, HEIGHT, camera.fov_x_rad);
    let mut rays = Vec::with_capacity((WIDTH * HEIGHT) as usize);
    for tile in 0..(WIDTH / TILE) * (HEIGHT / TILE) {
        let (left, top) = (tile % (WIDTH / TILE) * TILE, tile / (WIDTH / TILE) * TILE);
        for pixel in 0..TILE * TILE {
            let (x, y) = (f64::from(left + pixel % TILE) + 0.5, f64::from(top + pixel / TILE) + 0.5);
            let direction = (camera.world_from_camera * intrinsics.ray(x, y)).normalize();
            rays.push(Ray::new(camera.position.as_vec3(), direction.as_vec3()));
        }
    }
    rays
}

fn seen(room: &Room, bvh: &Bvh, rays: &[Ray]) -> Vec<Seen> {
    let seen = |ray: &Ray| {
        let hit = bvh.closest(ray)?;
        let [a, b, c] = room.triangles[hit.triangle as usize];
        let n = (b - a).cross(c - a).normalize_or(Vec3::Z);
        let normal = if n.dot(ray.direction) > 0.0 { -n } else { n };
        Some(Seen { point: offset_origin(ray.at(hit.t), normal), normal })
    };
    rays.iter().filter_map(seen).collect()
}

fn diffuse(seen: &[Seen], seed: u64) -> Vec<Ray> {
    let mut rng = Rng::new(seed);
    let mut ray = |from: &Seen| {
        let local = warp::cosine_hemisphere([rng.next_f32(), rng.next_f32()]);
        Ray::new(from.point, Onb::from_z(from.normal).to_world(local))
    };
    seen.iter().map(&mut ray).collect()
}

/// Segments from the points of neighbouring pixels to those of random ones.
fn between(seen: &[Seen]) -> Vec<Ray> {
    let mut rng = Rng::new(3);
    seen.iter().map(|from| segment(from, seen[rng.below(seen.len())].point)).collect()
}

fn toward_lamps(room: &Room, seen: &[Seen]) -> Vec<Ray> {
    if room.lamps.is_empty() {
        return diffuse(seen, 4);
    }
    let mut rng = Rng::new(4);
    let corners = |i: usize| room.triangles[room.lamps[i] as usize];
    let areas: Vec<f32> = (0..room.lamps.len()).map(corners).map(|[a, b, c]| (b - a).cross(c - a).length()).collect();
    let choice = Distribution1::new(&areas).expect("lamps have an area");
    let mut ray = |from: &Seen| {
        let [a, b, c] = corners(choice.sample(rng.next_f32()).0);
        let w = warp::triangle([rng.next_f32(), rng.next_f32()]);
        segment(from, a + (b - a) * w.x + (c - a) * w.y)
    };
    seen.iter().map(&mut ray).collect()
}

fn segment(from: &Seen, to: Vec3) -> Ray {
    const BEFORE_THE_END: f32 = 0.9999;
    Ray { t_max: BEFORE_THE_END, ..Ray::new(from.point, to - from.point) }
}
