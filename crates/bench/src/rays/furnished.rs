//! A furnished room of about 350 000 triangles, made by a formula, for machines without real rooms.

use enfilade_math::{Rng, Vec3, warp};
use std::f32::consts::TAU;

type Triangle = [Vec3; 3];

/// Walls of two triangles, round furniture of many, curtains in folds, leaves of plants, and many small boxes.
pub fn furnished_room() -> Vec<Triangle> {
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
