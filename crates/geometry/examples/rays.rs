//! How many rays a second does the hierarchy trace? `cargo run --release -p enfilade-geometry --example rays`
//!
//! Builds a furnished room of about 350 000 triangles, or reads one from a file named on the command line (nine little-endian `f32`
//! per triangle), and prints millions of rays per second of CPU time on one thread: rays of a camera, cosine-distributed rays after the
//! first and second hit (incoherent), and shadow rays between random visible points. CPU time is used because wall time on a shared
//! machine says nothing; where it cannot be read (not Linux) it is wall time.

use enfilade_geometry::{Bvh, Hit};
use enfilade_math::{Onb, Ray, Rng, Vec3, offset_origin, warp};
use std::f32::consts::TAU;

type Triangle = [Vec3; 3];

const WIDTH: usize = 1024;
const HEIGHT: usize = 768;
const TILE: usize = 16;

fn main() {
    let triangles = match std::env::args().nth(1) {
        Some(file) => read_triangles(&file),
        None => furnished_room(),
    };
    let start = cpu_seconds();
    let bvh = Bvh::new(&triangles, &|_| false);
    let build = cpu_seconds() - start;
    println!("{} triangles, built in {build:.2} s, {:.1} MB", triangles.len(), bvh.memory_bytes() as f64 / 1e6);

    let primary = camera_rays(&bvh);
    let hits = measure("camera", &primary, |ray| bvh.closest(ray));
    let bounce_1 = bounce(&triangles, &primary, &hits, 1);
    let hits_1 = measure("bounce 1", &bounce_1, |ray| bvh.closest(ray));
    let bounce_2 = bounce(&triangles, &bounce_1, &hits_1, 2);
    measure("bounce 2", &bounce_2, |ray| bvh.closest(ray));
    measure("bounce 2, filtered", &bounce_2, |ray| bvh.closest_filtered(ray, |hit| hit.u > 0.5));
    let shadow = shadow_rays(&primary, &hits);
    measure("shadow", &shadow, |ray| bvh.occluded(ray));
}

/// Seconds of CPU time of this thread.
fn cpu_seconds() -> f64 {
    thread_local!(static START: std::time::Instant = std::time::Instant::now());
    let on_cpu = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = on_cpu.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| START.with(|start| start.elapsed().as_secs_f64()), |ns| ns * 1e-9)
}

/// Traces `rays` until half a second is over, and returns the answers.
fn measure<T>(name: &str, rays: &[Ray], trace: impl Fn(&Ray) -> T) -> Vec<T> {
    let start = cpu_seconds();
    let mut passes = 0;
    loop {
        let answers: Vec<T> = rays.iter().map(&trace).collect();
        passes += 1;
        let seconds = cpu_seconds() - start;
        if seconds > 0.5 {
            println!("{name:>20}  {:6.2} Mrays/s  ({} rays)", (passes * rays.len()) as f64 / seconds / 1e6, rays.len());
            return answers;
        }
    }
}

/// A camera in the middle of one side of the scene, looking at its centre, tile by tile.
fn camera_rays(bvh: &Bvh) -> Vec<Ray> {
    let bounds = bvh.bounds();
    let from = bounds.min + bounds.extent() * Vec3::new(0.1, 0.2, 0.55);
    let forward = (bounds.center() - from).normalize();
    let right = forward.cross(Vec3::Z).normalize();
    let up = right.cross(forward);
    let mut rays = Vec::with_capacity(WIDTH * HEIGHT);
    for tile in 0..(WIDTH / TILE) * (HEIGHT / TILE) {
        let (left, top) = (tile % (WIDTH / TILE) * TILE, tile / (WIDTH / TILE) * TILE);
        for pixel in 0..TILE * TILE {
            let x = (left + pixel % TILE) as f32 + 0.5 - WIDTH as f32 / 2.0;
            let y = HEIGHT as f32 / 2.0 - (top + pixel / TILE) as f32 - 0.5;
            rays.push(Ray::new(from, (forward + (right * x + up * y) * (1.2 / WIDTH as f32)).normalize()));
        }
    }
    rays
}

/// One cosine-distributed ray from every hit, on the side that the ray came from.
fn bounce(triangles: &[Triangle], rays: &[Ray], hits: &[Option<Hit>], seed: u64) -> Vec<Ray> {
    let mut rng = Rng::new(seed);
    std::iter::zip(rays, hits)
        .filter_map(|(ray, hit)| {
            let hit = hit.as_ref()?;
            let [a, b, c] = triangles[hit.triangle as usize];
            let n = (b - a).cross(c - a).normalize_or(Vec3::Z);
            let n = if n.dot(ray.direction) > 0.0 { -n } else { n };
            let local = warp::cosine_hemisphere([rng.next_f32(), rng.next_f32()]);
            Some(Ray::new(offset_origin(ray.at(hit.t), n), Onb::from_z(n).to_world(local)))
        })
        .collect()
}

/// Segments between points seen by neighbouring pixels and points seen by random ones.
fn shadow_rays(rays: &[Ray], hits: &[Option<Hit>]) -> Vec<Ray> {
    let points: Vec<Vec3> = std::iter::zip(rays, hits).filter_map(|(r, h)| Some(r.at(h.as_ref()?.t))).collect();
    let mut rng = Rng::new(3);
    let other = |rng: &mut Rng| points[rng.below(points.len())];
    points.iter().map(|&p| Ray { t_min: 1e-4, t_max: 0.9999, ..Ray::new(p, other(&mut rng) - p) }).collect()
}

fn read_triangles(file: &str) -> Vec<Triangle> {
    let bytes = std::fs::read(file).unwrap_or_else(|e| panic!("{file}: {e}"));
    let floats: Vec<f32> = bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    floats.chunks_exact(9).map(|t| [0, 3, 6].map(|i| Vec3::new(t[i], t[i + 1], t[i + 2]))).collect()
}

/// Walls of two triangles, round furniture of many, curtains in folds, leaves of plants, and many small boxes.
fn furnished_room() -> Vec<Triangle> {
    let mut rng = Rng::new(0);
    let size = Vec3::new(7.0, 5.0, 2.8);
    let mut triangles = Vec::new();
    push_box(&mut triangles, Vec3::ZERO, size);
    for _ in 0..14 {
        let center = Vec3::new(rng.range(1.0, 6.0), rng.range(1.0, 4.0), rng.range(0.2, 1.0));
        let radii = Vec3::new(rng.range(0.1, 0.6), rng.range(0.1, 0.6), rng.range(0.05, 0.4));
        push_surface(&mut triangles, 100, |s, t| center + radii * ball(s, t) * (1.0 + 0.02 * (40.0 * s).sin() * (31.0 * t).cos()));
    }
    for wall in [0.05, size.y - 0.05] {
        push_surface(&mut triangles, 120, |s, t| {
            Vec3::new(1.0 + 5.0 * s, wall + 0.03 * (150.0 * s).sin() * (1.0 - 0.5 * t), 0.1 + 2.5 * t)
        });
    }
    for _ in 0..400 {
        let p = Vec3::new(rng.range(0.2, 6.5), rng.range(0.2, 4.5), rng.range(0.0, 1.2));
        push_box(&mut triangles, p, p + Vec3::new(rng.range(0.01, 0.2), rng.range(0.01, 0.2), rng.range(0.01, 0.3)));
    }
    for _ in 0..8000 {
        let p = Vec3::new(6.0, 4.0, 0.9) + 0.5 * warp::sphere([rng.next_f32(), rng.next_f32()]);
        let [u, v] = [0.04, 0.02].map(|size| size * warp::sphere([rng.next_f32(), rng.next_f32()]));
        triangles.extend([[p, p + u, p + v], [p + u, p + u + v, p + v]]);
    }
    triangles
}

fn ball(s: f32, t: f32) -> Vec3 {
    let (theta, phi) = (t * TAU / 2.0, s * TAU);
    Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

/// A grid of n × n squares of two triangles over the unit square, mapped by `surface`.
fn push_surface(triangles: &mut Vec<Triangle>, n: usize, surface: impl Fn(f32, f32) -> Vec3) {
    let p = |i: usize, j: usize| surface(i as f32 / n as f32, j as f32 / n as f32);
    for i in 0..n {
        for j in 0..n {
            let (a, b, c, d) = (p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j + 1));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
}

fn push_box(triangles: &mut Vec<Triangle>, min: Vec3, max: Vec3) {
    let corner = |i: usize| Vec3::new([min, max][i & 1].x, [min, max][i >> 1 & 1].y, [min, max][i >> 2].z);
    for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        triangles.extend([[a, b, c], [a, c, d]].map(|t| t.map(corner)));
    }
}
