//! Cloth.

use super::noise::{fbm, lattice, noise};
use super::paint;
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::Image;
use std::f32::consts::PI;

/// A plain weave of `threads` × `threads` as a factor of mean near 0.85: yarns of uneven tone, dark gaps. Tiles.
pub fn weave(name: &str, threads: i32, unevenness: f32, seed: u32) -> Image {
    paint(name, 512, 512, |uv| {
        let p = uv * threads as f32;
        let (i, j) = (p.x.floor() as i32, p.y.floor() as i32);
        let f = p - p.floor();
        let over = (i + j).rem_euclid(2) == 0;
        let (across, along, yarn) = if over { (f.y, f.x, lattice(0, j, seed)) } else { (f.x, f.y, lattice(i, 1, seed)) };
        let round = (across * PI).sin().powf(0.5) * (0.75 + 0.25 * (along * PI).sin());
        let fleck = lattice(i, j, seed ^ 77);
        let heather = 1.0 + unevenness * (0.9 * (yarn - 0.5) + 0.8 * (fleck - 0.5) + 0.2 * fbm(uv, [9, 9], 2, seed ^ 31));
        Rgb::splat((0.62 + 0.33 * round) * heather)
    })
}

/// A chunky knit of `ribs` columns of stitches as a factor. Tiles.
pub fn knit(name: &str, ribs: i32, seed: u32) -> Image {
    paint(name, 512, 512, |uv| {
        let p = Vec2::new(uv.x * ribs as f32, uv.y * ribs as f32 * 1.2);
        let side = (p.x.fract() - 0.5).abs() * 2.0;
        let stitch = (p.y + 0.55 * side).fract();
        let round = (stitch * PI).sin().powf(0.6) * (1.0 - side.powi(4)).max(0.0).sqrt().mul_add(0.6, 0.4);
        let fuzz = 0.08 * noise(uv * 256.0, [256, 256], seed);
        Rgb::splat(0.42 + 0.52 * round + fuzz)
    })
}
