//! Household things: a roll of kitchen paper on its stand (class paper), and waste bins, closed with a pedal or open with crumpled paper in
//! them (class other furniture).

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, turned, vessel};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, sphere};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A roll of kitchen paper on its stand.
#[derive(Clone, Copy, Debug)]
pub struct KitchenRoll;

impl Furniture for KitchenRoll {
    fn random(_rng: &mut Rng) -> Self {
        Self
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.15, 0.15, 0.32)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let stand = b.object("kitchen_roll", Class::Paper, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let metal = [Finish::Steel, Finish::BlackMetal, Finish::Wood][rng.below(3)];
        b.part(&stand, "base", cylinder(0.074, 0.012, 40), metal);
        b.part(&stand, "pin", cylinder(0.007, 0.29, 16).moved(Vec3::new(0.0, 0.0, 0.0118)), metal);
        b.part(&stand, "knob", sphere(0.012, 18).moved(Vec3::new(0.0, 0.0, 0.307)), metal);
        let r = rng.range(0.045, 0.062);
        let roll = [[0.02, 0.013], [r - 0.001, 0.013], [r, 0.014], [r, 0.242], [r - 0.001, 0.243], [0.02, 0.243], [0.02, 0.013]];
        b.part(&stand, "roll", turned(&roll, 48), Finish::Paper);
    }
}

/// A waste bin: a pedal bin for the kitchen, an open paper basket for a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum WasteBin {
    Pedal,
    Basket,
    Wire,
}

impl Furniture for WasteBin {
    fn random(rng: &mut Rng) -> Self {
        [Self::Pedal, Self::Basket, Self::Wire][rng.below(3)]
    }

    fn size(&self) -> Vec3 {
        match self {
            Self::Pedal => Vec3::new(0.27, 0.36, 0.46),
            _ => Vec3::new(0.28, 0.28, 0.31),
        }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let bin = b.object("waste_bin", Class::OtherFurniture, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        match self {
            Self::Pedal => {
                let finish = [Finish::Steel, Finish::CoatedWhite, Finish::BlackMetal][rng.below(3)];
                let foot = [[0.0, 0.0], [0.128, 0.0], [0.13, 0.004], [0.13, 0.03], [0.0, 0.03]];
                b.part(&bin, "foot", turned(&foot, 48), Finish::BlackPlastic);
                b.part(&bin, "can", cylinder(0.126, 0.37, 48).moved(Vec3::new(0.0, 0.0, 0.0298)), finish);
                let lid = [[0.0, 0.401], [0.129, 0.401], [0.131, 0.405], [0.126, 0.425], [0.08, 0.447], [0.0, 0.455]];
                b.part(&bin, "lid", turned(&lid, 48), finish);
                let pedal = crate::shape::rounded_box(Vec3::new(0.06, 0.06, 0.008), 0.003, 2).moved(Vec3::new(0.0, 0.145, 0.014));
                b.part(&bin, "pedal", pedal, Finish::Steel);
            }
            Self::Basket => {
                let body = vessel(&[[0.10, 0.0], [0.105, 0.004], [0.12, 0.15], [0.136, 0.30]], 0.004, 44);
                b.part(
                    &bin,
                    "body",
                    body,
                    [Finish::Wicker, Finish::BlackPlastic, Finish::WhitePlastic, Finish::ColoredMetal(1)][rng.below(4)],
                );
            }
            Self::Wire => {
                let ring = |r: f32, z: f32| turned(&[[r - 0.003, z], [r, z - 0.003], [r + 0.003, z], [r, z + 0.003], [r - 0.003, z]], 40);
                let rods = crate::pieces::form::around(36, 0.0)
                    .map(|d| crate::pieces::form::rod([d.x * 0.10, d.y * 0.10, 0.004], [d.x * 0.135, d.y * 0.135, 0.298], 0.0014, 5));
                b.part(&bin, "wires", all(rods), Finish::BlackMetal);
                let floor = cylinder(0.101, 0.003, 40);
                b.part(&bin, "rings", all([floor, ring(0.10, 0.004), ring(0.118, 0.15), ring(0.135, 0.298)]), Finish::BlackMetal);
            }
        }
        if *self != Self::Pedal && rng.below(3) > 0 {
            for k in 0..2 + rng.below(3) {
                let d = Vec2::from_angle(2.4 * k as f32) * 0.045;
                let object = b.object("crumpled_paper", Class::Paper, on(pose, Vec3::new(d.x, d.y, 0.05 + 0.03 * (k / 3) as f32), 0.0));
                let seed = rng.range(0.0, 9.0);
                let ball = sphere(0.038, 16)
                    .deformed(|p| p * (0.9 + 0.1 * ((60.0 * p.x + seed).sin() + (75.0 * p.y).sin() * (68.0 * p.z + seed).cos())))
                    .smoothed(20.0);
                b.part(&object, "ball", ball, Finish::Paper);
            }
        }
    }
}
