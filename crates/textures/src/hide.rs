//! Leather, cork, and plaited cane.

use super::noise::{Field, cells, fbm, lattice, noise, smoothstep};
use super::{Grain, Skin, skin};
use enfilade_math::{Rgb, Vec2};
use std::f32::consts::PI;

/// Full-grain leather as a factor, 512 pixels square over 0.2 m: pebbles between fine creases, some wrinkles. Tiles.
pub fn leather(name: &str, seed: u32) -> Skin {
    let bend = [0, 1].map(|key| Field::new(128, |uv| fbm(uv, [12, 12], 2, seed ^ key)));
    let wrinkles = Field::new(256, |uv| fbm(uv, [11, 6], 3, seed ^ 3));
    let clouds = Field::new(128, |uv| fbm(uv, [3, 3], 4, seed ^ 5));
    skin(name, [512, 512], |uv| {
        let bend = 0.5 * Vec2::new(bend[0].at(uv), bend[1].at(uv));
        let pebble = cells(uv * 90.0 + bend, [90, 90], seed ^ 2);
        let crease = smoothstep(0.22, 0.0, pebble.second - pebble.first);
        let wrinkle = 1.0 - (2.0 * wrinkles.at(uv).abs()).min(1.0);
        let cloud = clouds.at(uv);
        let tone = 0.90 + 0.10 * cloud - 0.16 * crease - 0.03 * wrinkle;
        Grain {
            color: Rgb::splat(tone),
            alpha: 0.30 + 0.12 * crease + 0.05 * cloud,
            height: 0.8 - 0.42 * crease - 0.12 * wrinkle + 0.1 * cloud,
        }
    })
}

/// Pressed cork, 512 pixels square over 0.4 m. Tiles.
pub fn cork(name: &str, seed: u32) -> Skin {
    skin(name, [512, 512], |uv| {
        let grain = cells(uv * 80.0, [80, 80], seed);
        let own = (grain.id & 0xff) as f32 / 256.0;
        let gap = smoothstep(0.12, 0.0, grain.second - grain.first);
        let dark = if own > 0.86 { 0.5 } else { 0.12 * own };
        let tone = Rgb::new(0.46, 0.29, 0.155).lerp(Rgb::new(0.13, 0.07, 0.035), (dark + 0.35 * gap).min(1.0));
        Grain { color: tone * (1.0 + 0.08 * noise(uv * 256.0, [256, 256], seed ^ 3)), alpha: 0.55, height: 0.8 - 0.5 * gap - 0.2 * dark }
    })
}

/// Baskets and rattan furniture: `strands` flat canes that go over and under as many stakes, as a factor, 512 pixels square. Tiles
/// for even numbers.
pub fn wicker(name: &str, strands: i32, seed: u32) -> Skin {
    let stakes = strands / 2;
    skin(name, [512, 512], |uv| {
        let p = Vec2::new(uv.x * stakes as f32, uv.y * strands as f32);
        let (i, j) = (p.x.floor() as i32, p.y.floor() as i32);
        let f = p - p.floor();
        let over = if (i + j) % 2 == 0 { 1.0 } else { -1.0 };
        // A cane bulges in front of one stake and hides behind the next.
        let bulge = 0.5 + 0.5 * over * (PI * (f.x - 0.5)).cos();
        let round = (1.0 - (2.0 * f.y - 1.0).powi(2) * 1.1).max(0.0).sqrt();
        let stake = (1.0 - ((f.x - 0.5) * 6.0).powi(2)).max(0.0).sqrt() * 0.55;
        let height = (round * (0.25 + 0.75 * bulge)).max(stake * (1.0 - round * bulge));
        let fibre = noise(Vec2::new(uv.x * 12.0, uv.y * 256.0), [12, 256], seed);
        let own = lattice(i.div_euclid(2), j, seed);
        let tone = (0.28 + 0.66 * height) * (0.88 + 0.20 * own + 0.08 * fibre);
        Grain { color: Rgb::splat(tone), alpha: 0.35, height: 0.9 * height + 0.03 * fibre }
    })
}
