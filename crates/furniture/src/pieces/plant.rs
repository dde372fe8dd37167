//! Potted plants in ceramic pots, of class other prop: a rubber tree for corners with three stems, the tallest of 85 to 110 cm, and 13
//! leaves on each, and a small rosette of 16 leaves for shelves and sills.

use super::{CONTACT, Furniture};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::shape::{Reshape, disk, lathe, leaf, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// Depth of the soil below the pot's rim, metres.
const SOIL: f32 = 0.03;
/// Angle from one leaf to the next around a stem, radians: the golden angle, by which leaves shade each other least.
const GOLDEN_ANGLE: f32 = 2.4;
/// A potted plant: stems with large leaves, or a small rosette.
#[derive(Clone, Copy, Debug)]
pub struct Plant {
    /// Height of the pot.
    pub pot: f32,
    /// Radius of the pot's rim.
    pub radius: f32,
    /// Height of the stems above the soil; 0 for a rosette.
    pub stem: f32,
    /// Leaves on each stem.
    pub leaves: usize,
    /// Length of a leaf.
    pub leaf: f32,
}

impl Plant {
    /// A rubber tree for a corner.
    pub fn tall(rng: &mut Rng) -> Self {
        Self {
            pot: rng.range(0.28, 0.33),
            radius: rng.range(0.15, 0.175),
            stem: rng.range(0.85, 1.1),
            leaves: 13,
            leaf: rng.range(0.22, 0.26),
        }
    }

    /// A small plant for a shelf or sill.
    pub fn small(pot: f32, radius: f32) -> Self {
        Self { pot, radius, stem: 0.0, leaves: 16, leaf: 2.0 * radius }
    }

    fn reach(&self) -> f32 {
        if self.stem > 0.0 { 0.36 } else { self.leaf * 1.15 }
    }

    fn stems(&self, b: &mut Builder, plant: &crate::builder::Object, rng: &mut Rng) {
        let soil = self.pot - SOIL;
        for s in 0..3 {
            let out = Vec2::from_angle(s as f32 * TAU / 3.0 + rng.range(-0.4, 0.4));
            let height = self.stem * [1.0, 0.8, 0.6][s] * rng.range(0.95, 1.05);
            let spread = rng.range(0.05, 0.12);
            let sway = rng.range(-0.03, 0.03);
            let point = |t: f32| {
                (out * (0.3 * self.radius + spread * t * t) + out.perp() * sway * (4.0 * t).sin()).extend(soil - 0.01 + height * t)
            };
            let path: Vec<Vec3> = (0..=12).map(|i| point(i as f32 / 12.0)).collect();
            b.part(plant, &format!("stem_{}", s + 1), tube(&path, 0.0075 - 0.001 * s as f32, 10), Finish::Bark);
            let mut twigs: Option<enfilade_geometry::Mesh> = None;
            let mut blades: Option<enfilade_geometry::Mesh> = None;
            let mut turn = rng.range(0.0, TAU);
            for k in 0..self.leaves {
                let t = 0.22 + 0.78 * k as f32 / (self.leaves - 1) as f32;
                // Leaves are steeper towards the tip.
                turn += GOLDEN_ANGLE + rng.range(-0.25, 0.25);
                let rise = -0.25 + 1.25 * t + rng.range(-0.15, 0.15);
                let length = self.leaf * rng.range(0.8, 1.1) * (1.0 - 0.35 * t * t);
                let stalk = 0.05;
                let direction = Vec3::new(rise.cos() * turn.cos(), rise.cos() * turn.sin(), rise.sin());
                let foot = point(t);
                let twig = tube(&[foot, foot + direction * stalk], 0.0024, 5);
                let blade = leaf(length, 0.56 * length, rng.range(0.5, 1.1))
                    .turned(Vec3::X, rng.range(-0.25, 0.25))
                    .turned(Vec3::Y, -rise)
                    .turned(Vec3::Z, turn)
                    .moved(foot + direction * (stalk - 0.002));
                twigs = Some(twigs.map_or_else(|| twig.clone(), |all| all.with(twig.clone())));
                blades = Some(blades.map_or_else(|| blade.clone(), |all| all.with(blade.clone())));
            }
            if let (Some(twigs), Some(blades)) = (twigs, blades) {
                b.part(plant, &format!("stalks_{}", s + 1), twigs, Finish::Leaf);
                b.part(plant, &format!("leaves_{}", s + 1), blades, Finish::Leaf);
            }
        }
    }

    fn rosette(&self, b: &mut Builder, plant: &crate::builder::Object, rng: &mut Rng) {
        let soil = Vec3::new(0.0, 0.0, self.pot - SOIL);
        let mut all: Option<enfilade_geometry::Mesh> = None;
        for k in 0..self.leaves {
            let t = k as f32 / self.leaves as f32;
            let length = self.leaf * rng.range(0.75, 1.05) * (1.0 - 0.3 * t);
            let blade = leaf(length, 0.26 * length, 0.9 - 0.5 * t)
                .turned(Vec3::Y, -(0.55 + 0.8 * t))
                .turned(Vec3::Z, GOLDEN_ANGLE * k as f32 + rng.range(-0.2, 0.2))
                .moved(soil);
            all = Some(all.map_or_else(|| blade.clone(), |all| all.with(blade.clone())));
        }
        if let Some(leaves) = all {
            b.part(plant, "leaves", leaves, Finish::Leaf);
        }
    }
}

impl Furniture for Plant {
    fn random(rng: &mut Rng) -> Self {
        Self::tall(rng)
    }

    fn size(&self) -> Vec3 {
        let width = 2.0 * self.reach().max(self.radius);
        Vec3::new(width, width, self.pot + self.stem + self.leaf)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let plant = b.object("plant", Class::OtherProp, pose);
        let (h, r) = (self.pot, self.radius);
        let wall = 0.05 * r + 0.003;
        let profile = [
            [0.0, 0.0],
            [0.70 * r, 0.0],
            [0.74 * r, 0.01 * h],
            [0.98 * r, 0.9 * h],
            [r, h],
            [r - 0.4 * wall, h + 0.002],
            [r - wall, h - 0.002],
            [0.9 * r - wall, 0.6 * h],
            [0.0, 0.6 * h],
        ];
        b.part(
            &plant,
            "pot",
            lathe(&profile.map(Vec2::from_array), 48).moved(Vec3::new(0.0, 0.0, CONTACT)),
            Finish::Ceramic(rng.below(2) as u8),
        );
        let soil_radius = (r - wall) - 0.1 * r * (SOIL / (0.4 * h)).min(1.0);
        b.part(&plant, "soil", disk(soil_radius, 40).moved(Vec3::new(0.0, 0.0, h - SOIL)), Finish::Soil);
        if self.stem > 0.0 {
            self.stems(b, &plant, rng);
        } else {
            self.rosette(b, &plant, rng);
        }
    }
}
