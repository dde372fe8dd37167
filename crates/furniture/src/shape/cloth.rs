//! Thin and soft shapes: hanging curtains, scatter cushions, and the leaves of plants.

use super::{Reshape, grid};
use enfilade_geometry::Mesh;
use enfilade_math::{Rng, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// A hanging curtain: a sheet from z = 0 down to −`drop`, `width` wide and centred on x, with `folds` waves of depth `fold_m` that
/// are even at the top and loosen towards the hem. It faces +y.
pub fn curtain(width: f32, drop: f32, folds: usize, fold_m: f32, rng: &mut Rng) -> Mesh {
    let (nu, nv) = (folds * 14, 28);
    let phases: Vec<[f32; 3]> = (0..=folds).map(|_| [rng.range(-1.0, 1.0), rng.range(0.7, 1.25), rng.range(-0.5, 0.5)]).collect();
    let point = |i: usize, j: usize| {
        let (s, t) = (i as f32 / nu as f32, j as f32 / nv as f32);
        let fold = s * folds as f32;
        let (k, f) = ((fold as usize).min(folds - 1), fold.fract());
        let blend = |c: usize| phases[k][c] + (phases[k + 1][c] - phases[k][c]) * f;
        let loose = t * t * (3.0 - 2.0 * t);
        let phase = TAU * fold + loose * blend(0) * 0.9;
        let amplitude = 0.5 * fold_m * (1.0 + loose * (blend(1) - 0.75));
        let wave = phase.sin() + 0.25 * loose * (2.0 * phase + blend(2)).sin();
        let x = (s - 0.5) * width * (1.0 - 0.06 * (PI * t).sin()) + 0.012 * loose * blend(2);
        Vec3::new(-x, amplitude * wave, -drop * t)
    };
    // Cloth is about one and a half times as wide as it hangs.
    let uv = |i: usize, j: usize| Vec2::new(1.5 * width * i as f32 / nu as f32, -drop * j as f32 / nv as f32);
    // u runs towards −x and v downward, so that u cross v is +y.
    grid(nu, nv, point, uv).smoothed(80.0)
}

/// A scatter cushion lying in the xy plane, centred on the origin: `size` on a side, `thickness` at the middle, drawn in at the
/// seams between its corners.
pub fn pillow(size: Vec2, thickness: f32, rng: &mut Rng) -> Mesh {
    const N: usize = 20;
    let dents: [f32; 4] = std::array::from_fn(|_| rng.range(-1.0, 1.0));
    let side = |sign: f32| {
        let point = move |i: usize, j: usize| {
            let q = Vec2::new(i as f32, j as f32) / N as f32 * 2.0 - 1.0;
            // Vertices gather towards the seam, where the curvature is.
            let q = Vec2::new((q.x * 0.5 * PI).sin(), (q.y * 0.5 * PI).sin());
            let fill = ((1.0 - q.x.powi(2)) * (1.0 - q.y.powi(2))).max(0.0);
            let draw = 1.0 - 0.07 * Vec2::new(1.0 - q.y * q.y, 1.0 - q.x * q.x);
            let dent = 1.0 + 0.06 * (dents[0] * q.x + dents[1] * q.y + dents[2] * (2.6 * q.x + dents[3]).sin() * (2.3 * q.y).cos());
            let height = sign * 0.5 * thickness * fill.powf(0.42) * dent;
            Vec3::new(0.5 * size.x * q.x * draw.x * sign, 0.5 * size.y * q.y * draw.y, height)
        };
        grid(N, N, point, |i, j| Vec2::new(i as f32 / N as f32 * size.x, j as f32 / N as f32 * size.y))
    };
    side(1.0).with(side(-1.0)).smoothed(75.0)
}

/// A leaf of `length` × `width` that starts at the origin along +x, its upper side up: folded along its midrib and drooping by
/// `droop` radians over its length.
pub fn leaf(length: f32, width: f32, droop: f32) -> Mesh {
    let (nu, nv) = (10, 6);
    let point = |i: usize, j: usize| {
        let (s, t) = (i as f32 / nu as f32, 2.0 * j as f32 / nv as f32 - 1.0);
        let outline = (PI * s.powf(0.8)).sin().max(0.0).powf(0.75) * (1.0 - 0.25 * s);
        let across = 0.5 * width * outline * t;
        let angle = droop * s;
        // The midrib is an arc whose slope turns by `droop` on its way.
        let (x, z) =
            if droop.abs() < 1e-3 { (length * s, 0.0) } else { (length * angle.sin() / droop, length * (angle.cos() - 1.0) / droop) };
        let fold = 0.22 * across.abs() + 0.006 * outline * (9.0 * s + 2.0 * t).sin();
        Vec3::new(x + fold * angle.sin(), across, z + fold * angle.cos())
    };
    grid(nu, nv, point, |i, j| Vec2::new(i as f32 / nu as f32, j as f32 / nv as f32)).smoothed(70.0)
}
