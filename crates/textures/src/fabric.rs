//! Cloth, as a factor of a colour: woven, knitted, looped.

use super::noise::{Field, cells, fbm, lattice, noise, smoothstep};
use super::{Grain, Skin, skin};
use enfilade_math::{Rgb, Vec2};
use std::f32::consts::{PI, TAU};

/// How warp and weft cross.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weave {
    /// Over one, under one: linen, cotton, canvas.
    Plain,
    /// Over two, under two, shifted: denim, chinos.
    Twill,
    /// Twill that turns round: woollen upholstery and coats.
    Herringbone,
}

impl Weave {
    /// True if the warp (along v) is on top at the crossing of warp `i` and weft `j`.
    fn warp_on_top(self, i: i32, j: i32) -> bool {
        match self {
            Self::Plain => (i + j).rem_euclid(2) == 0,
            Self::Twill => (i + j).rem_euclid(4) < 2,
            Self::Herringbone => (if i.rem_euclid(32) < 16 { i + j } else { j - i - 1 }).rem_euclid(4) < 2,
        }
    }
}

/// A woven cloth of `threads` × `threads`, 512 pixels square: yarns of uneven tone and thickness, dark gaps. Tiles where `threads`
/// divides by 32.
pub fn weave(name: &str, weave: Weave, threads: i32, unevenness: f32, seed: u32) -> Skin {
    let clouds = Field::new(64, |uv| fbm(uv, [5, 5], 2, seed ^ 31));
    skin(name, [512, 512], |uv| {
        // Yarns do not run quite straight.
        let wander = 0.35 * unevenness * Vec2::new(noise(uv * 16.0, [16, 16], seed ^ 51), noise(uv * 16.0, [16, 16], seed ^ 52));
        let p = uv * threads as f32 + wander;
        let (i, j) = ((p.x.floor() as i32).rem_euclid(threads), (p.y.floor() as i32).rem_euclid(threads));
        let f = p - p.floor();
        let warp = weave.warp_on_top(i, j);
        let (across, along, yarn, slub) = if warp {
            (f.x, f.y, lattice(i, 1, seed), noise(Vec2::new(i as f32, uv.y * 24.0), [threads, 24], seed ^ 41))
        } else {
            (f.y, f.x, lattice(0, j, seed), noise(Vec2::new(uv.x * 24.0, j as f32), [24, threads], seed ^ 43))
        };
        let round = (across * PI).sin().max(0.0).sqrt();
        let rise = if weave == Weave::Plain { 0.7 + 0.3 * (along * PI).sin() } else { 0.85 };
        let fleck = lattice(i, j, seed ^ 77);
        let heather = 1.0 + unevenness * (0.26 * (yarn - 0.5) + 0.12 * (fleck - 0.5) + 0.14 * slub + 0.05 * clouds.at(uv));
        let side = if weave == Weave::Plain || warp { 1.0 } else { 0.86 };
        let height = round * rise;
        Grain {
            color: Rgb::splat((0.60 + 0.34 * height) * heather * side),
            alpha: 1.0,
            height: 0.15 + 0.7 * height + 0.12 * unevenness * slub,
        }
    })
}

/// Printed or yarn-dyed patterns of household linen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// None.
    Plain,
    /// Fine lengthwise stripes.
    PinStripes,
    /// Even stripes of 4 cm.
    Stripes,
    /// Gingham checks of 2 cm.
    Gingham,
    /// A large check with fine lines, as on blankets and shirts.
    Tartan,
    /// Small dots.
    Dots,
    /// Sprigs of leaves.
    Sprigs,
}

/// Washed cotton with soft creases and a pattern in `second` on a ground of `first`, 1024 pixels square over 0.48 m. Tiles.
pub fn cotton(name: &str, pattern: Pattern, [first, second]: [Rgb; 2], seed: u32) -> Skin {
    let creases = Field::new(256, |uv| fbm(uv, [7, 9], 3, seed ^ 3));
    let folds = Field::new(256, |uv| fbm(uv, [5, 6], 3, seed ^ 5));
    skin(name, [1024, 1024], |uv| {
        let crease = creases.at(uv);
        let fold = 1.0 - folds.at(uv).abs();
        let thread = (uv.x * 340.0 * TAU).sin() * (uv.y * 340.0 * TAU).sin();
        let share = printed(pattern, uv, seed);
        let color = first.lerp(second, share) * (0.97 + 0.02 * thread + 0.015 * crease);
        Grain { color, alpha: 1.0, height: 0.35 + 0.2 * crease + 0.25 * fold + 0.02 * thread }
    })
}

/// How much of the second colour is seen, on [0,1].
fn printed(pattern: Pattern, uv: Vec2, seed: u32) -> f32 {
    let wave = |v: f32, n: f32| (v * n).fract();
    let bar = |v: f32, from: f32, to: f32| f32::from((from..to).contains(&v));
    match pattern {
        Pattern::Plain => 0.0,
        Pattern::PinStripes => bar(wave(uv.x, 32.0), 0.42, 0.58),
        Pattern::Stripes => bar(wave(uv.x, 6.0), 0.25, 0.75),
        Pattern::Gingham => 0.5 * (bar(wave(uv.x, 12.0), 0.0, 0.5) + bar(wave(uv.y, 12.0), 0.0, 0.5)),
        Pattern::Tartan => {
            let band =
                |v: f32| 0.45 * bar(wave(v, 4.0), 0.0, 0.42) + 0.5 * bar(wave(v, 4.0), 0.68, 0.72) + 0.3 * bar(wave(v, 4.0), 0.18, 0.21);
            (band(uv.x) + band(uv.y)).min(1.0)
        }
        Pattern::Dots => {
            let p = uv * 14.0;
            let q = Vec2::new(p.x + 0.5 * (p.y.floor() % 2.0), p.y);
            smoothstep(0.17, 0.14, (q - q.floor() - 0.5).length())
        }
        Pattern::Sprigs => {
            let p = uv * 6.0;
            let cell = p.floor();
            let turn = Vec2::from_angle(TAU * lattice(cell.x as i32, cell.y as i32, seed));
            let q = turn.rotate(p - cell - 0.5);
            let stem = q.x.abs() < 0.011 && q.y.abs() < 0.3;
            let leaf = [(-0.16, 1.0), (0.0, -1.0), (0.16, 1.0)].iter().any(|&(y, side): &(f32, f32)| {
                let d = Vec2::from_angle(-0.7 * side).rotate(q - Vec2::new(0.0, y)) * side;
                d.x > 0.0 && d.x < 0.2 && d.y.abs() < 0.045 * (PI * d.x / 0.2).sin()
            });
            f32::from(stem || leaf)
        }
    }
}

/// A chunky knit of `ribs` columns of stitches, 512 pixels square. Tiles.
pub fn knit(name: &str, ribs: i32, seed: u32) -> Skin {
    let rows = (ribs as f32 * 1.2).round();
    skin(name, [512, 512], |uv| {
        let p = Vec2::new(uv.x * ribs as f32, uv.y * rows);
        let side = (p.x.fract() - 0.5).abs() * 2.0;
        let stitch = (p.y + 0.55 * side).fract();
        let round = (stitch * PI).sin().max(0.0).powf(0.6) * (1.0 - side.powi(4)).max(0.0).sqrt().mul_add(0.6, 0.4);
        let fuzz = noise(uv * 256.0, [256, 256], seed);
        let heather = 1.0 + 0.07 * fbm(uv, [6, 6], 2, seed ^ 5);
        Grain { color: Rgb::splat((0.46 + 0.46 * round + 0.07 * fuzz) * heather), alpha: 1.0, height: 0.1 + 0.8 * round + 0.05 * fuzz }
    })
}

/// Loops: bouclé where `curl` is large, terry and carpet where it is small, `loops` of them across 512 pixels. Tiles.
pub fn loops(name: &str, loops: i32, curl: f32, seed: u32) -> Skin {
    skin(name, [512, 512], |uv| {
        let bend = curl
            * Vec2::new(noise(uv * loops as f32 * 0.5, [loops / 2; 2], seed), noise(uv * loops as f32 * 0.5, [loops / 2; 2], seed ^ 1));
        let near = cells(uv * loops as f32 + bend, [loops; 2], seed ^ 2);
        let dome = (1.0 - near.first * near.first * 1.3).max(0.0).sqrt();
        let gap = smoothstep(0.0, 0.35, near.second - near.first);
        let own = (near.id & 0xff) as f32 / 256.0;
        let fibre = noise(uv * 256.0, [256, 256], seed ^ 4);
        let height = dome * (0.55 + 0.45 * gap) * (0.8 + 0.2 * own);
        let tone = (0.52 + 0.42 * height) * (1.0 + 0.16 * (own - 0.5) + 0.08 * fibre + 0.06 * fbm(uv, [4, 4], 3, seed ^ 9));
        Grain { color: Rgb::splat(tone), alpha: 1.0, height: 0.1 + 0.8 * height + 0.06 * fibre }
    })
}

/// Pile of velvet: nearly even, brushed in patches, 512 pixels square. Tiles.
pub fn pile(name: &str, seed: u32) -> Skin {
    skin(name, [512, 512], |uv| {
        let brushed = fbm(uv, [4, 3], 4, seed);
        let fibre = noise(uv * 256.0, [256, 256], seed ^ 4);
        Grain { color: Rgb::splat(0.88 + 0.10 * brushed + 0.03 * fibre), alpha: 1.0, height: 0.5 + 0.25 * brushed + 0.08 * fibre }
    })
}

/// Felt and coir: fibres in all directions, 512 pixels square. Tiles.
pub fn felt(name: &str, coarse: i32, seed: u32) -> Skin {
    skin(name, [512, 512], |uv| {
        let along = |n: i32, key: u32| noise(Vec2::new(uv.x * (6 * n) as f32, uv.y * n as f32), [6 * n, n], seed ^ key);
        let across = |n: i32, key: u32| noise(Vec2::new(uv.x * n as f32, uv.y * (6 * n) as f32), [n, 6 * n], seed ^ key);
        let fibres = along(coarse, 1).max(across(coarse, 2)) + 0.5 * along(coarse / 2, 3).max(across(coarse / 2, 4));
        Grain { color: Rgb::splat(0.78 + 0.12 * fibres + 0.05 * fbm(uv, [4, 4], 2, seed ^ 7)), alpha: 1.0, height: 0.5 + 0.3 * fibres }
    })
}
