//! A city seen from high up: rings of towers, the farther the hazier, with lit windows at night.

use super::{LIT_WINDOW, Surroundings, View, hazed};
use enfilade_math::{Rgb, Vec2};
use enfilade_textures::noise::{fbm, lattice, smoothstep};
use std::f32::consts::TAU;

/// A ring of towers: its radius, how many there are, their minimum and maximum height, and how hazy they are.
struct Ring {
    distance: f32,
    count: i32,
    height: [f32; 2],
    depth: f32,
}

/// Height of an eye on the twelfth floor above the ground, metres.
const EYE: f32 = 38.0;
/// Towers from the horizon to the near blocks.
const RINGS: [Ring; 5] = [
    Ring { distance: 1500.0, count: 130, height: [25.0, 230.0], depth: 0.62 },
    Ring { distance: 900.0, count: 90, height: [20.0, 150.0], depth: 0.42 },
    Ring { distance: 480.0, count: 60, height: [15.0, 95.0], depth: 0.24 },
    Ring { distance: 240.0, count: 38, height: [12.0, 48.0], depth: 0.10 },
    Ring { distance: 110.0, count: 22, height: [9.0, 26.0], depth: 0.03 },
];
/// Walls: concrete, grey panels, sandstone, brick, blue-grey panels.
const WALLS: [Rgb; 5] = [
    Rgb::new(0.42, 0.40, 0.37),
    Rgb::new(0.30, 0.31, 0.33),
    Rgb::new(0.50, 0.45, 0.37),
    Rgb::new(0.33, 0.22, 0.16),
    Rgb::new(0.16, 0.20, 0.24),
];

impl Surroundings {
    pub(super) fn skyline(&self, view: &View, sky: Rgb) -> Rgb {
        let mut color = sky;
        if view.rise < 0.0 {
            let ground = view.to_ground(EYE);
            let block = |across: f32, deep: f32, key: u32| lattice((view.turn * across) as i32, (ground / deep) as i32, self.seed ^ key);
            let roof = 0.10 + 0.16 * block(300.0, 18.0, 0);
            let lamps = if block(700.0, 6.0, 8) < 0.03 { 0.6 * self.dark() } else { 0.0 };
            let far = smoothstep(60.0, 1500.0, ground);
            color = hazed(self.level(Rgb::new(1.0, 0.96, 0.9) * roof) + LIT_WINDOW * lamps, view.haze, 0.7 * far);
        }
        for (k, ring) in RINGS.iter().enumerate() {
            color = self.towers(view, color, ring, self.seed ^ (k as u32 * 131 + 7));
        }
        color
    }

    fn towers(&self, view: &View, behind: Rgb, ring: &Ring, seed: u32) -> Rgb {
        let p = view.on_ring(ring.distance, EYE);
        let width = TAU * ring.distance / ring.count as f32;
        let tower = ((p.x / width).floor() as i32).rem_euclid(ring.count);
        let random = |k: i32| lattice(tower, k, seed);
        let x = (p.x / width).fract() * width;
        let [low, high] = ring.height;
        let margin = width * (0.03 + 0.25 * random(1));
        let height = low + (high - low) * random(2).powi(3);
        // Some have a set-back top floor or a lift house.
        let top = height + if (x - 0.5 * width).abs() < 0.18 * width { 3.5 * random(5) } else { 0.0 };
        if x < margin || x > width - margin || p.y > top || p.y < -2.0 {
            return behind;
        }
        let wall = WALLS[(random(3) * 5.0) as usize % 5];
        let glassy = random(4) < 0.3;
        let q = Vec2::new(x / 3.2, p.y / 3.3);
        let f = q - q.floor();
        let pane = p.y < height - 1.0 && if glassy { f.y > 0.16 } else { (f.x - 0.5).abs() < 0.3 && (f.y - 0.5).abs() < 0.27 };
        // From far away windows melt into a grey.
        let melted = smoothstep(600.0, 1600.0, ring.distance);
        let wall_color = self.upright(view, wall * (1.0 + 0.1 * fbm(Vec2::new(view.turn, p.y / 200.0), [40, 4], 2, seed)));
        let glass = self.upright(view, Rgb::splat(0.05)) + view.haze * 0.14;
        let day = wall_color.lerp(glass, if pane { 1.0 - 0.6 * melted } else { 0.3 * melted });
        let cell = |k: u32| lattice(q.x as i32 + tower * 64, q.y as i32, seed ^ k);
        let lit = if pane && cell(21) < 0.2 { self.dark() * (0.25 + cell(22)) } else { 0.0 };
        let tint = Rgb::WHITE.lerp(Rgb::new(0.7, 1.05, 1.9), cell(23) * f32::from(glassy));
        hazed(day, view.haze, ring.depth) + LIT_WINDOW * tint * (lit * (1.0 - 0.6 * ring.depth))
    }
}
