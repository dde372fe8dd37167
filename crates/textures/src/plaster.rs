//! Coverings of walls: paint on plaster, bare plaster, wallpaper.

use super::noise::{Field, fbm, lattice, noise, smoothstep};
use super::{Grain, Skin, skin};
use enfilade_math::{Rgb, Vec2};
use std::f32::consts::{PI, TAU};

/// Painted plaster as a factor, 512 pixels square over 1 m: the stipple of a roller. Tiles.
pub fn rolled(name: &str, seed: u32) -> Skin {
    skin(name, [512, 512], |uv| {
        let cloud = fbm(uv, [3, 3], 3, seed);
        let stipple = fbm(uv, [110, 110], 2, seed ^ 17);
        let tone = 0.985 + 0.010 * cloud + 0.004 * stipple;
        Grain { color: Rgb::splat(tone.min(1.0)), alpha: 1.0, height: 0.5 + 0.30 * stipple + 0.14 * cloud }
    })
}

/// Lime plaster, trowelled in arcs, as a factor, 1024 pixels square over 2.2 m. Tiles.
pub fn trowelled(name: &str, seed: u32) -> Skin {
    let bend = [0, 1].map(|key| Field::new(64, |uv| 0.06 * fbm(uv, [3, 3], 2, seed ^ key)));
    let strokes = [([5, 16], 2), ([15, 4], 3)].map(|(cells, key)| Field::new(512, |uv| fbm(uv, cells, 3, seed ^ key)));
    let blend = Field::new(64, |uv| smoothstep(-0.3, 0.3, fbm(uv, [4, 4], 2, seed ^ 4)));
    let cloud = Field::new(256, |uv| fbm(uv, [4, 4], 4, seed ^ 5));
    skin(name, [1024, 1024], |uv| {
        let bend = Vec2::new(bend[0].at(uv), bend[1].at(uv));
        let (a, b, blend) = (strokes[0].at(uv + bend), strokes[1].at(uv - bend), blend.at(uv));
        let stroke = a * blend + b * (1.0 - blend);
        let cloud = cloud.at(uv);
        let sand = noise(uv * 512.0, [512, 512], seed ^ 6);
        Grain {
            color: Rgb::splat(0.86 + 0.07 * stroke + 0.07 * cloud + 0.012 * sand),
            alpha: 0.45,
            height: 0.5 + 0.3 * stroke + 0.05 * sand,
        }
    })
}

/// Patterns of wallpaper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaperPattern {
    /// Woven grasscloth without figure.
    Grass,
    /// Upright stripes of two widths.
    Stripes,
    /// Rows of overlapping fans.
    Fans,
    /// Lozenges of fine lines.
    Lattice,
    /// Branches with leaves.
    Leaves,
    /// Terraced arches, one within another.
    Arches,
}

impl PaperPattern {
    /// All patterns.
    pub const ALL: [Self; 6] = [Self::Grass, Self::Stripes, Self::Fans, Self::Lattice, Self::Leaves, Self::Arches];
}

/// Wallpaper with a figure in `figure` and `accent` on `ground`, 1024 pixels square over 1.06 m: two lengths of 53 cm. Tiles.
pub fn wallpaper(name: &str, pattern: PaperPattern, [ground, figure, accent]: [Rgb; 3], seed: u32) -> Skin {
    skin(name, [1024, 1024], |uv| {
        let thread =
            noise(Vec2::new(uv.x * 300.0, uv.y * 40.0), [300, 40], seed) + noise(Vec2::new(uv.x * 24.0, uv.y * 400.0), [24, 400], seed ^ 2);
        let share = match pattern {
            PaperPattern::Grass => [0.16 + 0.22 * thread, 0.0],
            PaperPattern::Stripes => stripes(uv),
            PaperPattern::Fans => fans(uv),
            PaperPattern::Lattice => lozenges(uv),
            PaperPattern::Leaves => branches(uv, seed),
            PaperPattern::Arches => arches(uv),
        };
        let color = ground.lerp(figure, share[0].clamp(0.0, 1.0)).lerp(accent, share[1].clamp(0.0, 1.0));
        Grain { color: color * (0.985 + 0.012 * thread), alpha: 0.5, height: 0.5 + 0.12 * thread + 0.2 * share[0].max(share[1]) }
    })
}

fn line(distance: f32, half_width: f32) -> f32 {
    smoothstep(half_width + 0.004, half_width - 0.004, distance.abs())
}

fn stripes(uv: Vec2) -> [f32; 2] {
    let x = (uv.x * 10.0).fract() - 0.5;
    [line(x, 0.25), line(x.abs() - 0.32, 0.012)]
}

/// Scales in half-bond rows, each of rings around the middle of its lower edge.
fn fans(uv: Vec2) -> [f32; 2] {
    /// Scales across the picture.
    const ACROSS: f32 = 8.0;
    /// Rows of scales up the picture.
    const ROWS: f32 = 16.0;
    let p = Vec2::new(uv.x * ACROSS, uv.y * ROWS);
    // The lowest row whose scale covers the point is in front.
    let mut radius = 1.0f32;
    for back in [1.0, 0.0] {
        let row = p.y.floor() - back;
        let shift = 0.5 * row.rem_euclid(2.0);
        let x = (p.x + shift).fract() - 0.5;
        let r = x.hypot((p.y - row) * ACROSS / ROWS) / 0.5;
        if r < 1.0 {
            radius = r;
            break;
        }
    }
    let ring = [0.96, 0.72, 0.48, 0.24].iter().fold(0.0f32, |max, r| max.max(line(radius - r, 0.035)));
    [ring, f32::from(radius < 0.12)]
}

fn lozenges(uv: Vec2) -> [f32; 2] {
    let saw = |v: f32| 0.5 - (v - v.floor() - 0.5).abs();
    let (a, b) = (saw(uv.x * 8.0 + uv.y * 5.0), saw(uv.x * 8.0 - uv.y * 5.0));
    let near = a.min(b);
    [line(near, 0.022), line(near - 0.11, 0.008).max(f32::from(a + b > 0.93))]
}

/// Stems that wind upward, with leaves on both sides.
fn branches(uv: Vec2, seed: u32) -> [f32; 2] {
    let mut share = [0.0f32; 2];
    for stem in 0..4 {
        let phase = TAU * lattice(stem, 1, seed);
        let at = |y: f32| (stem as f32 + 0.5) / 4.0 + 0.035 * (TAU * y + phase).sin() + 0.012 * (3.0 * TAU * y + 2.0 * phase).sin();
        let wrapped = |x: f32| x - x.round();
        share[0] = share[0].max(line(wrapped(uv.x - at(uv.y)), 0.0022 + 0.0002));
        for k in 0..12 {
            let foot_y = (k as f32 + 0.5 * (stem % 2) as f32) / 12.0;
            let side = if k % 2 == 0 { 1.0 } else { -1.0 };
            let d = Vec2::new(wrapped(uv.x - at(foot_y)), wrapped(uv.y - foot_y));
            let q = Vec2::from_angle(-side * 0.9).rotate(d.perp() * -1.0) * Vec2::new(1.0, side);
            let (length, width) = (0.095 + 0.02 * lattice(stem, k, seed), 0.019);
            if q.x > 0.0 && q.x < length {
                let half = width * (PI * (q.x / length).powf(0.8)).sin();
                let leaf = smoothstep(half + 0.001, half - 0.001, q.y.abs());
                let rib = line(q.y, 0.0006);
                share[usize::from((stem + k) % 3 == 0)] = share[usize::from((stem + k) % 3 == 0)].max(leaf * (1.0 - 0.7 * rib));
            }
        }
    }
    share
}

fn arches(uv: Vec2) -> [f32; 2] {
    let p = Vec2::new(uv.x * 6.0, uv.y * 4.0);
    let row = p.y.floor();
    let x = (p.x + 0.5 * row.rem_euclid(2.0)).fract() - 0.5;
    let y = (p.y - row) * 1.5;
    let radius = if y < 0.95 { x.abs() } else { x.hypot(y - 0.95) };
    let band = [0.44, 0.34, 0.24].iter().fold(0.0f32, |max, r| max.max(line(radius - r, 0.022)));
    [band, smoothstep(0.16, 0.15, radius)]
}
