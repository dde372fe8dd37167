//! Houses: a row across the street, seen from the first floor, and detached ones among trees.

use super::garden::Trees;
use super::{LIT_WINDOW, Surroundings, View, hazed};
use enfilade_math::{Rgb, Vec2};
use enfilade_textures::noise::{fbm, lattice, smoothstep};
use std::f32::consts::TAU;

/// A ring of houses.
struct Row {
    /// Radius, metres.
    distance: f32,
    /// Houses on the ring.
    count: i32,
    /// Gap between neighbours, as a share of their width.
    gap: f32,
    /// Minimum and maximum number of storeys.
    floors: [f32; 2],
    depth: f32,
    seed: u32,
}

/// Height of a storey, metres.
const FLOOR_HEIGHT: f32 = 3.0;
/// Walls: rendered in pale and earthen tones, and of brick.
const RENDERS: [Rgb; 7] = [
    Rgb::new(0.62, 0.58, 0.49),
    Rgb::new(0.55, 0.46, 0.32),
    Rgb::new(0.68, 0.66, 0.62),
    Rgb::new(0.46, 0.30, 0.22),
    Rgb::new(0.42, 0.45, 0.44),
    Rgb::new(0.58, 0.50, 0.40),
    Rgb::new(0.30, 0.16, 0.11),
];
/// Roofs: red tiles, slate, brown tiles.
const ROOFS: [Rgb; 3] = [Rgb::new(0.24, 0.10, 0.06), Rgb::new(0.10, 0.10, 0.105), Rgb::new(0.16, 0.11, 0.08)];

impl Surroundings {
    pub(super) fn street(&self, view: &View, sky: Rgb) -> Rgb {
        /// Height of an eye on the first floor above the street, metres.
        const EYE: f32 = 5.0;
        let row = Row { distance: 17.0, count: 11, gap: 0.0, floors: [3.0, 5.0], depth: 0.0, seed: self.seed ^ 0x51 };
        let mut color = self.houses(view, sky, EYE, &row);
        let ground = view.to_ground(EYE);
        if ground < row.distance {
            let paved = 1.0 + 0.15 * fbm(Vec2::new(view.turn, ground / 20.0), [90, 20], 3, self.seed);
            let albedo = if (5.0..13.5).contains(&ground) { Rgb::splat(0.09) } else { Rgb::new(0.27, 0.26, 0.24) };
            color = self.level(albedo * paved);
        }
        // Street trees.
        let p = view.on_ring(12.0, EYE);
        let spacing = TAU * 12.0 / 9.0;
        let k = (p.x / spacing).floor();
        let q = Vec2::new(p.x - (k + 0.35 + 0.3 * lattice(k as i32, 1, self.seed)) * spacing, p.y - 5.2);
        let ragged = 0.5 * fbm(Vec2::new(view.turn, p.y / 24.0), [60, 20], 4, self.seed ^ 31);
        let crown = smoothstep(-0.15, 0.15, 1.0 + ragged - (q / Vec2::new(1.5, 2.0)).length());
        let shade = 0.75 + 0.35 * (q.y / 2.0) + 0.5 * ragged;
        if lattice(k as i32, 3, self.seed) < 0.6 {
            color = color.lerp(self.leaves(Rgb::new(0.065, 0.095, 0.03) * shade.max(0.1)), crown);
            let trunk = q.x.abs() < 0.11 && q.y < -0.8 && p.y > 0.0;
            color = if trunk && crown < 0.5 { self.upright(view, Rgb::new(0.10, 0.08, 0.06)) } else { color };
        }
        color
    }

    pub(super) fn suburb(&self, view: &View, sky: Rgb) -> Rgb {
        let far = Trees { height_deg: 7.0, depth: 0.3, crowns: 11, seed: self.seed ^ 5 };
        let row = Row { distance: 34.0, count: 13, gap: 0.45, floors: [1.0, 2.0], depth: 0.05, seed: self.seed ^ 0x52 };
        let color = self.houses(view, self.trees(view, sky, &far), 1.6, &row);
        let hedge = Trees { height_deg: 2.2, depth: 0.0, crowns: 30, seed: self.seed ^ 19 };
        self.lawn(view, self.trees(view, color, &hedge))
    }

    fn houses(&self, view: &View, behind: Rgb, eye: f32, row: &Row) -> Rgb {
        let p = view.on_ring(row.distance, eye);
        let width = TAU * row.distance / row.count as f32;
        let house = ((p.x / width).floor() as i32).rem_euclid(row.count);
        let random = |k: i32| lattice(house, k, row.seed);
        let inner = width * (1.0 - row.gap);
        let q = Vec2::new((p.x / width).fract() * width - 0.5 * row.gap * width, p.y);
        let [low, high] = row.floors;
        let eaves = FLOOR_HEIGHT * (low + (random(1) * (high - low + 1.0)).floor().min(high - low)) + 0.6;
        if q.x < 0.0 || q.x > inner || q.y < 0.0 {
            return behind;
        }
        let render = RENDERS[(random(2) * 7.0) as usize % 7];
        if q.y > eaves {
            return self.roof(view, behind, q - Vec2::new(0.0, eaves), inner, row, random(3));
        }
        let weathered = 1.0 + 0.08 * fbm(Vec2::new(view.turn, q.y / 20.0), [120, 10], 3, row.seed);
        let mut color = self.upright(view, render * weathered);
        if eaves - q.y < 0.25 || (q.y % FLOOR_HEIGHT < 0.12 && random(4) < 0.4) {
            color = self.upright(view, Rgb::splat(0.62));
        }
        if let Some(window) = self.window(view, q, inner, house, row) {
            color = window;
        }
        hazed(color, view.haze, row.depth)
    }

    fn roof(&self, view: &View, behind: Rgb, q: Vec2, width: f32, row: &Row, random: f32) -> Rgb {
        let gabled = row.gap > 0.0 && random < 0.5;
        let height = if gabled { 0.8 * (0.5 * width - (q.x - 0.5 * width).abs()) } else { 2.6 };
        let chimney = (q.x - 0.7 * width).abs() < 0.35 && q.y < 3.6;
        if q.y > height && !chimney {
            return behind;
        }
        let tiles = 0.88 + 0.12 * ((q.y * 5.0).fract() - 0.3);
        let albedo = if q.y > height {
            RENDERS[3]
        } else if gabled {
            RENDERS[2]
        } else {
            ROOFS[(random * 3.0) as usize % 3] * tiles
        };
        hazed(self.upright(view, albedo) * 1.1, view.haze, row.depth)
    }

    /// A window pane, its frame, or nothing at `q` of a façade.
    fn window(&self, view: &View, q: Vec2, width: f32, house: i32, row: &Row) -> Option<Rgb> {
        let bays = (width / 2.6).round().max(1.0);
        let (bay, floor) = ((q.x / width * bays).floor(), (q.y / FLOOR_HEIGHT).floor());
        let f = Vec2::new((q.x / width * bays - bay - 0.5) * width / bays, q.y - floor * FLOOR_HEIGHT - 1.65);
        let (half, key) = (Vec2::new(0.55, 0.8), house * 64 + bay as i32 * 8 + floor as i32);
        if f.x.abs() > half.x + 0.09 || f.y.abs() > half.y + 0.09 {
            return None;
        }
        let bar = f.x.abs() < 0.04 || (f.y - 0.3).abs() < 0.035;
        if f.x.abs() > half.x || f.y.abs() > half.y || bar {
            return Some(self.upright(view, Rgb::splat(0.68)));
        }
        let random = |k: i32| lattice(key, k, row.seed);
        // Glass mirrors some sky; behind it is a dark room, at times a curtain.
        let curtain = f.x.abs() > half.x * (0.4 + 0.6 * random(11));
        let inside = self.upright(view, Rgb::splat(if curtain { 0.35 } else { 0.035 })) * 0.8;
        let mirrored = view.haze * (0.07 + 0.05 * random(12));
        let lit = if random(13) < 0.45 { self.dark() * (0.4 + 0.9 * random(14)) * (0.75 + 0.25 * f.y / half.y) } else { 0.0 };
        let tint = Rgb::WHITE.lerp(Rgb::new(0.75, 1.0, 1.5), random(15).powi(3));
        Some(inside + mirrored + LIT_WINDOW * tint * (lit * if curtain { 0.6 } else { 1.0 }))
    }
}
