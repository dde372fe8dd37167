//! A panel radiator with pressed ribs, 60 to 160 cm wide and 35 to 60 cm high, with its grille, brackets, pipe and valve; all painted
//! white, class other structure. Its back, at negative y, is towards the wall.

use super::Furniture;
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::shape::{Reshape, grid, rounded_box, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// A ribbed panel radiator; its back is towards the wall.
#[derive(Clone, Copy, Debug)]
pub struct Radiator {
    /// Width.
    pub width: f32,
    /// Height of the panel.
    pub height: f32,
}

/// Height of the panel's lower edge above the floor, metres: air flows in from below.
const FOOT: f32 = 0.12;
/// y of the middle of panel, pipe and valve, metres: the brackets behind reach to the wall.
const MIDDLE: f32 = 0.01;

impl Furniture for Radiator {
    fn random(rng: &mut Rng) -> Self {
        Self { width: rng.range(0.6, 1.6), height: rng.range(0.35, 0.6) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width + 0.12, 0.10, FOOT + self.height + 0.012)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let radiator = b.object("radiator", Class::OtherStructure, pose);
        let (w, h, white) = (self.width, self.height, Finish::WhitePaint);
        let body = rounded_box(Vec3::new(w, 0.055, h), 0.008, 2).moved(Vec3::new(0.0, MIDDLE, FOOT + 0.5 * h));
        b.part(&radiator, "panel", body, white);
        // Pressed ribs protrude from the panel's front.
        let ribs = (w / 0.045) as usize;
        let (nu, half, low, high) = (ribs * 6, 0.5 * w - 0.02, FOOT + 0.035, FOOT + h - 0.035);
        let face = grid(
            nu,
            4,
            |i, j| {
                let t = j as f32 / 4.0;
                let swell = if j == 0 || j == 4 { 0.0 } else { 0.5 - 0.5 * (i as f32 / 6.0 * TAU).cos() };
                let z = if j == 1 {
                    low + 0.025
                } else if j == 3 {
                    high - 0.025
                } else {
                    low + (high - low) * t
                };
                Vec3::new(half - 2.0 * half * i as f32 / nu as f32, 0.0372 + 0.008 * swell, z)
            },
            |i, j| Vec2::new(i as f32 * 0.01, j as f32 * 0.1),
        );
        b.part(&radiator, "ribs", face.smoothed(60.0), white);
        let grille = rounded_box(Vec3::new(w - 0.004, 0.075, 0.012), 0.004, 2).moved(Vec3::new(0.0, 0.004, FOOT + h + 0.0055));
        b.part(&radiator, "grille", grille, white);
        let x = 0.5 * w;
        let pipe = [
            Vec3::new(x - 0.01, MIDDLE, FOOT + 0.06),
            Vec3::new(x + 0.03, MIDDLE, FOOT + 0.06),
            Vec3::new(x + 0.036, MIDDLE, FOOT + 0.054),
            Vec3::new(x + 0.036, MIDDLE, -0.001),
        ];
        b.part(&radiator, "pipe", tube(&pipe, 0.008, 12), white);
        let valve = tube(&[Vec3::new(x - 0.005, MIDDLE, FOOT + h - 0.06), Vec3::new(x + 0.06, MIDDLE, FOOT + h - 0.06)], 0.019, 18);
        b.part(&radiator, "valve", valve, Finish::WhitePlastic);
        for (name, s) in [("bracket_left", -1.0), ("bracket_right", 1.0)] {
            let arm = rounded_box(Vec3::new(0.03, 0.035, 0.05), 0.003, 1).moved(Vec3::new(s * 0.32 * w, -0.033, FOOT + 0.75 * h));
            b.part(&radiator, name, arm, white);
        }
    }
}
