//! Natural and cast stone: marble, granite, terrazzo, concrete, brick.

use super::noise::{Field, cells, fbm, lattice, noise, smoothstep};
use super::{Grain, Skin, skin};
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::Image;

/// A slab of natural stone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlabLook {
    /// Ground and veins: linear reflectances.
    pub colors: [Rgb; 2],
    /// How strong and how broad the veins are, 0 to 1.
    pub veins: f32,
    /// How strong the grains of granite are, 0 to 1.
    pub grains: f32,
}

impl SlabLook {
    /// White marble with grey clouds.
    pub const CARRARA: Self = Self { colors: [Rgb::new(0.72, 0.72, 0.71), Rgb::new(0.38, 0.39, 0.41)], veins: 0.45, grains: 0.0 };
    /// White marble with bold warm veins.
    pub const CALACATTA: Self = Self { colors: [Rgb::new(0.76, 0.75, 0.72), Rgb::new(0.36, 0.30, 0.23)], veins: 0.7, grains: 0.0 };
    /// Black marble with white veins.
    pub const MARQUINA: Self = Self { colors: [Rgb::new(0.022, 0.022, 0.024), Rgb::new(0.55, 0.54, 0.52)], veins: 0.4, grains: 0.0 };
    /// Green marble.
    pub const VERDE: Self = Self { colors: [Rgb::new(0.045, 0.085, 0.06), Rgb::new(0.30, 0.36, 0.30)], veins: 0.6, grains: 0.1 };
    /// Beige limestone.
    pub const LIMESTONE: Self = Self { colors: [Rgb::new(0.56, 0.49, 0.39), Rgb::new(0.43, 0.36, 0.27)], veins: 0.25, grains: 0.12 };
    /// Speckled grey granite.
    pub const GRANITE: Self = Self { colors: [Rgb::new(0.33, 0.32, 0.31), Rgb::new(0.05, 0.05, 0.055)], veins: 0.0, grains: 1.0 };
    /// Black granite.
    pub const ABSOLUTE_BLACK: Self = Self { colors: [Rgb::new(0.024, 0.024, 0.026), Rgb::new(0.08, 0.08, 0.085)], veins: 0.0, grains: 0.5 };
    /// White engineered quartz.
    pub const QUARTZ: Self = Self { colors: [Rgb::new(0.74, 0.73, 0.71), Rgb::new(0.52, 0.50, 0.47)], veins: 0.0, grains: 0.35 };
}

/// A polished slab, 1024 pixels square over 1.8 m: colour, and roughness as opacity. Tiles.
pub fn slab(name: &str, look: &SlabLook, seed: u32) -> Image {
    let [ground, veins] = look.colors;
    let bend = [0, 3].map(|key| Field::new(128, |uv| fbm(uv, [3, 3], 4, seed ^ key)));
    let cloud = Field::new(128, |uv| fbm(uv, [3, 3], 4, seed ^ 11));
    skin(name, [1024, 1024], |uv| {
        let cloud = cloud.at(uv);
        let mut dark = 0.16 * (0.5 + 0.5 * cloud) * look.veins;
        if look.veins > 0.0 {
            let bend = Vec2::new(bend[0].at(uv), bend[1].at(uv));
            let strength = smoothstep(-0.6, 0.6, cloud + 0.5 * bend.x);
            // Broad veins run one way through the slab, with a shadow beside them; thin ones make a net.
            let across = uv.x + 2.0 * uv.y + 0.34 * bend.x + 0.08 * fbm(uv, [9, 9], 3, seed ^ 5);
            let away = (across - across.round()).abs();
            let along = uv + 0.10 * bend;
            let net = fbm(along, [3, 4], 2, seed ^ 7).abs();
            let hair = fbm(along, [8, 7], 2, seed ^ 9).abs();
            dark += look.veins
                * (0.95 * smoothstep(0.012 + 0.05 * strength, 0.0, away) * strength
                    + 0.45 * smoothstep(0.26, 0.0, away) * strength
                    + 0.45 * smoothstep(0.05, 0.0, net) * strength
                    + 0.30 * smoothstep(0.035, 0.0, hair) * (1.0 - 0.6 * strength));
        }
        let mut color = ground.lerp(veins, dark.min(0.92)) * (1.0 + 0.05 * cloud);
        if look.grains > 0.0 {
            let grain = cells(uv * 300.0, [300, 300], seed ^ 21);
            let kind = (grain.id & 0xffff) as f32 / 65_536.0;
            let shade = if kind < 0.22 {
                0.8
            } else if kind > 0.85 {
                -0.35
            } else {
                0.1 * (kind - 0.5)
            };
            color = color.lerp(if shade > 0.0 { veins } else { Rgb::splat(0.6) }, look.grains * shade.abs());
        }
        Grain { color, alpha: 0.06 + 0.05 * dark, height: 0.5 }
    })
    .color
}

/// Terrazzo, ground and polished: chips of three stones in coloured cement, 768 pixels square over 1 m, with roughness as opacity.
/// Tiles.
pub fn terrazzo(name: &str, cement: Rgb, chips: [Rgb; 3], seed: u32) -> Image {
    skin(name, [768, 768], |uv| {
        let mut color = cement * (1.0 + 0.05 * fbm(uv, [5, 5], 3, seed) + 0.03 * noise(uv * 256.0, [256, 256], seed));
        for (count, keep, size) in [(130, 0.42, 0.16), (46, 0.45, 0.10), (22, 0.26, 0.07)] {
            let own = seed ^ count as u32;
            let bend = 0.16
                * Vec2::new(noise(uv * (4 * count) as f32, [4 * count; 2], own), noise(uv * (4 * count) as f32, [4 * count; 2], own ^ 1));
            let chip = cells(uv * count as f32 + bend, [count; 2], own);
            let random = |shift: u32| ((chip.id >> shift) & 0xff) as f32 / 256.0;
            if random(3) < keep {
                let tone = chips[(random(11) * 3.0) as usize % 3] * (0.82 + 0.36 * random(19));
                let rim = chip.second - chip.first;
                color = color.lerp(tone, smoothstep(size, size + 0.05, rim) * smoothstep(0.62, 0.56, chip.first));
            }
        }
        Grain { color, alpha: 0.10, height: 0.5 }
    })
    .color
}

/// Fair-faced concrete, or trowelled cement where `trowelled`, 1024 pixels square over 2.4 m. Tiles.
pub fn concrete(name: &str, tone: Rgb, trowelled: bool, seed: u32) -> Skin {
    let cloud = Field::new(256, |uv| fbm(uv, [4, 4], 4, seed));
    let bend = Field::new(64, |uv| fbm(uv, [3, 3], 2, seed ^ 2));
    let sweep = Field::new(256, |uv| fbm(uv, [5, 12], 3, seed ^ 4));
    skin(name, [1024, 1024], |uv| {
        let (cloud, sweep) = (cloud.at(uv) + 0.12 * fbm(uv, [90, 90], 2, seed ^ 9), sweep.at(uv + Vec2::splat(0.08 * bend.at(uv))));
        let sand = noise(uv * 512.0, [512, 512], seed ^ 6);
        let (mut pore, mut shade) = (0.0, 0.10 * cloud + 0.02 * sand);
        if trowelled {
            shade += 0.07 * sweep;
        } else {
            // Air bubbles at the formwork.
            let bubble = cells(uv * 70.0, [70, 70], seed ^ 8);
            let radius = 0.22 * ((bubble.id & 0xff) as f32 / 256.0 - 0.62).max(0.0);
            pore = smoothstep(radius + 0.015, radius - 0.015, bubble.first) * f32::from(radius > 0.0);
            shade -= 0.35 * pore;
        }
        Grain {
            color: tone * (1.0 + shade),
            alpha: (if trowelled { 0.28 } else { 0.5 }) + 0.08 * cloud,
            height: (0.6 + 0.12 * cloud + 0.10 * sweep + 0.05 * sand - 0.5 * pore).clamp(0.0, 1.0),
        }
    })
}

/// Bricks in running bond, 240 × 71 mm with joints of 10 mm (German normal format is 240 × 71), 1024 pixels square over 1 × 0.972 m.
pub fn brick(name: &str, tone: Rgb, mortar: Rgb, seed: u32) -> Skin {
    const ACROSS: i32 = 4;
    const COURSES: i32 = 12;
    let size = Vec2::new(0.25, 0.081);
    skin(name, [1024, 1024], |uv| {
        let row = (uv.y * COURSES as f32).floor().min(COURSES as f32 - 1.0);
        let x = uv.x * ACROSS as f32 + 0.5 * (row % 2.0);
        let key = [(x.floor() as i32).rem_euclid(ACROSS), row as i32];
        let f = Vec2::new(x - x.floor(), uv.y * COURSES as f32 - row);
        let random = |k: i32| lattice(key[0] * 8 + k, key[1], seed);
        let ragged = 0.0016 * fbm(uv, [40, 40], 3, seed ^ 1);
        let edge = (0.5 * size - ((f - 0.5) * size).abs()).min_element() - 0.005 + ragged;
        let fired = smoothstep(-0.0012, 0.0016, edge);
        let rough = fbm(uv, [60, 60], 3, seed ^ 5);
        let burnt = 0.55 * smoothstep(0.6, 1.0, random(2)) + 0.15 * fbm(uv, [9, 9], 2, seed ^ 7);
        let body = tone.lerp(tone * Rgb::new(0.42, 0.45, 0.55), burnt.clamp(0.0, 1.0)) * (0.85 + 0.3 * random(1) + 0.12 * rough);
        let joint = mortar * (0.95 + 0.12 * rough);
        Grain { color: joint.lerp(body, fired), alpha: 0.6, height: 0.22 + 0.10 * rough + fired * (0.5 + 0.16 * (random(4) - 0.5)) }
    })
}
