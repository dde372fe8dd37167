//! Pictures that hang on walls: hills, cut-paper shapes or bands, in five colours of the palette.

use super::noise::{fbm, lattice, smoothstep};
use super::paint;
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::Image;

/// Subject of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaintingStyle {
    /// Hills behind hills under a pale sky.
    Hills,
    /// Overlapping cut-paper shapes.
    Shapes,
    /// A few brushed bands of colour.
    Bands,
}

/// A picture of 384 pixels a side in the given colours; it is stretched to its frame.
pub fn painting(name: &str, style: PaintingStyle, colors: &[Rgb; 5], seed: u32) -> Image {
    paint(name, 384, 384, |uv| {
        let canvas = 1.0 + 0.05 * (lattice((uv.x * 384.0) as i32, (uv.y * 384.0) as i32, seed) - 0.5) + 0.05 * fbm(uv, [40, 40], 2, seed);
        let color = match style {
            PaintingStyle::Hills => hills(uv, colors, seed),
            PaintingStyle::Shapes => shapes(uv, colors, seed),
            PaintingStyle::Bands => bands(uv, colors, seed),
        };
        color * canvas
    })
}

fn hills(uv: Vec2, colors: &[Rgb; 5], seed: u32) -> Rgb {
    let mist = colors[0];
    let mut color = mist.lerp(colors[1], 0.5 * smoothstep(0.5, 1.0, uv.y));
    let sun = Vec2::new(0.3 + 0.4 * lattice(1, 1, seed), 0.72);
    color = color.lerp(colors[2], 1.0 - smoothstep(0.075, 0.085, uv.distance(sun)));
    for ridge in 0..5 {
        let depth = ridge as f32 / 4.0;
        let height =
            0.62 - 0.11 * ridge as f32 + (0.10 + 0.03 * depth) * fbm(Vec2::new(uv.x, 0.5), [2 + ridge, 2], 4, seed ^ (ridge as u32 + 40));
        let tone = colors[3].lerp(colors[4], depth).lerp(mist, 0.5 * (1.0 - depth));
        // Mist lies in the valleys: every ridge fades towards its foot.
        let haze = tone.lerp(mist, 0.55 * (1.0 - 0.8 * depth) * smoothstep(0.0, 0.2, height - uv.y));
        color = color.lerp(haze, smoothstep(0.0, 0.006, height - uv.y));
    }
    color
}

fn shapes(uv: Vec2, colors: &[Rgb; 5], seed: u32) -> Rgb {
    let mut color = colors[0];
    let wobble = 0.012 * fbm(uv, [5, 5], 2, seed);
    for k in 0..6 {
        let random = |j: i32| lattice(k, j, seed ^ 91);
        let center = Vec2::new(0.22 + 0.56 * random(0), 0.22 + 0.56 * random(1));
        let p = Vec2::from_angle(3.1 * random(2)).rotate(uv - center);
        let (a, b) = (0.10 + 0.16 * random(3), 0.10 + 0.12 * random(4));
        let distance = match k % 3 {
            0 => p.length() - a,
            1 => (p.x.abs() - a).max(p.y.abs() - 0.6 * b),
            _ => (p.length() - b).max(-p.y),
        };
        let tone = colors[1 + (k as usize) % 4] * (0.95 + 0.1 * fbm(uv, [30, 30], 2, seed ^ k as u32));
        color = color.lerp(tone, 0.93 * (1.0 - smoothstep(0.0, 0.006, distance + wobble)));
    }
    color
}

fn bands(uv: Vec2, colors: &[Rgb; 5], seed: u32) -> Rgb {
    let edge = 0.03 * fbm(uv, [3, 9], 4, seed) + 0.012 * fbm(uv, [6, 80], 3, seed ^ 5);
    let margin = uv.x.min(1.0 - uv.x).min(uv.y).min(1.0 - uv.y);
    let y = uv.y + edge;
    let cuts = [0.30 + 0.08 * lattice(0, 0, seed), 0.52, 0.66 + 0.08 * lattice(1, 0, seed)];
    let layer = cuts.iter().filter(|&&c| y > c).count();
    let brushed = colors[1 + layer] * (0.9 + 0.18 * fbm(uv, [3, 90], 3, seed ^ 21));
    colors[0].lerp(brushed, smoothstep(0.05, 0.058, margin + 0.3 * edge))
}
