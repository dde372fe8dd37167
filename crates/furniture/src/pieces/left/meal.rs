//! A plate after a meal, class other prop: 21 or 27 cm wide, with crumbs and a smear of sauce, and fork and knife across it, which are parts
//! of the same object.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, turned};
use crate::pieces::tableware::{Piece, plate};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, sphere};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// A plate after a meal.
#[derive(Clone, Copy, Debug)]
pub struct UsedPlate {
    /// Radius of the plate.
    pub radius: f32,
    /// Pieces of cutlery on it, at most two.
    pub cutlery: usize,
    /// Crumbs on it.
    pub crumbs: usize,
}

/// Height of the well of a plate, metres.
const WELL: f32 = 0.0085;
/// Height of its rim.
const RIM: f32 = 0.022;

impl UsedPlate {
    /// Fork or knife that lie with their middle in the well and their handle on the rim.
    fn cutlery(&self, rng: &mut Rng) -> Mesh {
        // The handle is heavier than the neck: a piece leans on the rim, its point in the well.
        let lean = (RIM - WELL).atan2(0.92 * self.radius) + 0.004;
        let turn = rng.range(0.0, TAU);
        all((0..self.cutlery.min(2)).map(|k| {
            let piece = if k == 0 { Piece::Fork } else { Piece::Knife };
            let aside = 0.017 * (2.0 * k as f32 - 1.0) * if self.cutlery > 1 { 1.0 } else { 0.0 };
            let out = 0.105 - 0.02;
            let lying = piece.mesh().moved(Vec3::new(aside, -out + 0.02, 0.0)).turned(Vec3::X, -lean);
            lying.turned(Vec3::Z, turn + 0.12 * k as f32).moved(Vec3::Z * (WELL + 0.002))
        }))
    }

    fn crumbs(&self, rng: &mut Rng) -> Mesh {
        all((0..self.crumbs).map(|_| {
            let size = rng.range(0.002, 0.0065);
            let at = Vec2::from_angle(rng.range(0.0, TAU)) * rng.range(0.1, 0.6) * self.radius;
            let seed = rng.range(0.0, 9.0);
            let lump = sphere(size, 8).deformed(|p| p * (0.8 + 0.3 * (700.0 * p.x + seed).sin() * (650.0 * p.y - seed).cos()));
            lump.smoothed(50.0).moved(at.extend(WELL + 0.5 * size))
        }))
    }

    /// A thin film of sauce in the well, its outline uneven.
    fn sauce(&self, rng: &mut Rng) -> Mesh {
        let (phase, radius) = (rng.range(0.0, TAU), rng.range(0.2, 0.45) * self.radius);
        let film = [[radius, 0.0], [radius - 0.002, 0.0006], [0.0, 0.0007]];
        let outline = |angle: f32| 1.0 + 0.22 * (2.0 * angle + phase).sin() + 0.13 * (5.0 * angle - phase).sin();
        let at = Vec2::from_angle(phase) * 0.12 * self.radius;
        turned(&film, 40).deformed(|p| (p.truncate() * outline(p.y.atan2(p.x))).extend(p.z)).smoothed(60.0).moved(at.extend(WELL - 0.0008))
    }
}

impl Furniture for UsedPlate {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: [0.135, 0.135, 0.105][rng.below(3)], cutlery: rng.below(3), crumbs: 3 + rng.below(14) }
    }

    fn size(&self) -> Vec3 {
        let wide = if self.cutlery > 0 { self.radius.max(0.19) } else { self.radius };
        Vec3::new(2.0 * wide, 2.0 * wide, 0.06)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("plate", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), rng.range(-PI, PI)));
        b.part(&object, "body", plate(self.radius), Finish::Ceramic(rng.below(3) as u8));
        b.part(&object, "sauce", self.sauce(rng), [Finish::Fruit(0), Finish::Bread, Finish::Soil][rng.below(3)]);
        b.part(&object, "crumbs", self.crumbs(rng), Finish::Bread);
        if self.cutlery > 0 {
            b.part(&object, "cutlery", self.cutlery(rng), Finish::Chrome);
        }
    }
}
