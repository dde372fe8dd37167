//! Rugs as seen from above: a pattern in one colour on a ground of another, stretched to the size of the rug.

use super::noise::{fbm, lattice, smoothstep};
use super::paint;
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::Image;

/// How a rug is patterned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RugStyle {
    /// Thin crossing lines on a pale ground, as in Berber rugs.
    Lattice,
    /// Broad soft stripes.
    Stripes,
    /// A border around a plain field.
    Bordered,
}

/// A rug of 768 × 512 pixels: `ground` with a pattern in `figure`, tufts of uneven tone.
pub fn rug(name: &str, style: RugStyle, ground: Rgb, figure: Rgb, seed: u32) -> Image {
    paint(name, 768, 512, |uv| {
        let wobble = Vec2::new(fbm(uv, [12, 8], 3, seed), fbm(uv, [12, 8], 3, seed ^ 3));
        let amount = match style {
            RugStyle::Lattice => lattice_lines(uv + 0.006 * wobble),
            RugStyle::Stripes => stripes(uv + 0.005 * wobble, seed),
            RugStyle::Bordered => border(uv + 0.003 * wobble),
        };
        let tuft = lattice((uv.x * 384.0) as i32, (uv.y * 256.0) as i32, seed ^ 13) - 0.5;
        let worn = 1.0 + 0.10 * fbm(uv, [5, 4], 4, seed ^ 29) + 0.16 * tuft;
        ground.lerp(figure, amount * (0.86 + 0.2 * tuft)) * worn
    })
}

fn line(distance: f32, half_width: f32) -> f32 {
    1.0 - smoothstep(0.6 * half_width, 1.4 * half_width, distance.abs())
}

/// Diamonds of two line families, every other one with a small lozenge in it.
fn lattice_lines(uv: Vec2) -> f32 {
    let p = Vec2::new(uv.x * 6.0, uv.y * 3.0);
    let saw = |v: f32| (v - v.floor() - 0.5).abs();
    let (a, b) = (p.x + p.y, p.x - p.y);
    let cross = line(0.5 - saw(a), 0.035).max(line(0.5 - saw(b), 0.035));
    let inside = saw(a).max(saw(b));
    let lozenge = line(inside - 0.16, 0.022);
    let edge = uv.x.min(1.0 - uv.x) * 1.5;
    cross.max(lozenge * f32::from((a.floor() as i32 + b.floor() as i32).rem_euclid(2) == 0)) * smoothstep(0.02, 0.03, edge)
}

fn stripes(uv: Vec2, seed: u32) -> f32 {
    let p = uv.x * 13.0;
    let (k, f) = (p.floor() as i32, p.fract());
    let half = 0.12 + 0.3 * lattice(k, 2, seed);
    line(f - 0.5, half) * (0.3 + 0.7 * lattice(k, 5, seed))
}

fn border(uv: Vec2) -> f32 {
    let p = Vec2::new(uv.x * 1.5, uv.y);
    let edge = p.x.min(1.5 - p.x).min(p.y).min(1.0 - p.y);
    line(edge - 0.07, 0.022).max(line(edge - 0.105, 0.006))
}
