//! Small things of a bathroom: a holder with toilet paper (class paper), soap dispensers, mugs with toothbrushes, bottles and jars, toilet
//! brushes and pedal bins, all but the paper of class other prop. The origin of the paper holder is on the wall's face, the origin of the
//! others on what they stand on.

use super::tap::fittings;
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod, to_front, turned, vessel, wire};
use crate::pieces::soft::Wrinkles;
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, grid, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, TAU};

/// Toilet paper on its holder.
#[derive(Clone, Copy, Debug)]
pub struct PaperHolder {
    /// Radius of what is left of the roll.
    pub roll: f32,
    /// Finish of the holder.
    pub metal: Finish,
}

impl Furniture for PaperHolder {
    fn random(rng: &mut Rng) -> Self {
        Self { roll: rng.range(0.035, 0.056), metal: fittings(rng) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.182, 0.126, 0.28)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let holder = b.object("paper_holder", Class::OtherProp, pose);
        let (y, r) = (0.065, self.roll);
        let x = -0.066;
        let plate = to_front(cylinder(0.024, 0.008, 24)).moved(Vec3::new(x, -0.001, 0.0));
        let arm = wire(&[[x, 0.006, 0.0], [x, y - 0.01, 0.0], [x + 0.01, y, 0.0], [x + 0.06, y, 0.0], [-x - 0.002, y, 0.0]], 0.007, 14);
        b.part(&holder, "arm", plate.with(arm), self.metal);
        let paper = b.object("toilet_paper", Class::Paper, on(pose, Vec3::new(0.008, y, -0.012), 0.0));
        let section = [[0.02, -0.05], [r, -0.05], [r, 0.05], [0.02, 0.05], [0.0195, 0.05], [0.0195, -0.05], [0.02, -0.05]];
        b.part(&paper, "roll", turned(&section, 40).turned(Vec3::Y, FRAC_PI_2), Finish::Paper);
        let loose = rng.range(0.05, 0.1);
        let sway = Wrinkles::new(0.1, 0.004, rng);
        let hanging = |i: usize, j: usize| {
            let (s, t) = (i as f32 / 4.0 - 0.5, j as f32 / 8.0);
            Vec3::new(-0.1 * s, r + 0.0008 + t * sway.at(Vec2::new(s, t)), -loose * t)
        };
        // A sheet without thickness: it faces the room.
        let sheet = grid(4, 8, |i, j| hanging(4 - i, j), |i, j| Vec2::new(i as f32 * 0.025, -(j as f32) * 0.01));
        b.part(&paper, "sheet", sheet.smoothed(60.0), Finish::Paper);
    }
}

/// A dispenser of soap.
#[derive(Clone, Copy, Debug)]
pub struct SoapDispenser {
    /// Radius of the bottle.
    pub radius: f32,
    /// Height of its shoulder.
    pub height: f32,
}

impl Furniture for SoapDispenser {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.03, 0.037), height: rng.range(0.10, 0.14) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius, 0.12, self.height + 0.065)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let soap = b.object("soap_dispenser", Class::OtherProp, pose);
        let (r, h) = (self.radius, self.height);
        let body = [
            [0.0, 0.0],
            [r - 0.003, 0.0],
            [r, 0.003],
            [r, h - 0.02],
            [0.93 * r, h - 0.008],
            [0.6 * r, h],
            [0.011, h + 0.004],
            [0.011, h + 0.012],
            [0.0, h + 0.012],
        ];
        let finish = [Finish::Ceramic(0), Finish::BottleGlass(1), Finish::Porcelain, Finish::Stone][rng.below(4)];
        b.part(&soap, "bottle", turned(&body, 36).moved(Vec3::Z * CONTACT), finish);
        let pump = all([
            cylinder(0.014, 0.018, 22).moved(Vec3::Z * (h + 0.0115)),
            rod([0.0, 0.0, h + 0.028], [0.0, 0.0, h + 0.052], 0.0045, 12),
            wire(&[[0.0, -0.012, h + 0.056], [0.0, 0.01, h + 0.058], [0.0, 0.042, h + 0.055], [0.0, 0.05, h + 0.044]], 0.005, 12),
        ]);
        b.part(&soap, "pump", pump.moved(Vec3::Z * CONTACT), [Finish::Chrome, Finish::BlackPlastic][rng.below(2)]);
    }
}

/// A mug with toothbrushes.
#[derive(Clone, Copy, Debug)]
pub struct ToothbrushMug {
    /// Toothbrushes in it.
    pub brushes: usize,
    /// Glass instead of pottery.
    pub glass: bool,
}

impl Furniture for ToothbrushMug {
    fn random(rng: &mut Rng) -> Self {
        Self { brushes: 1 + rng.below(3), glass: rng.below(3) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.15, 0.15, 0.205)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let mug = b.object("toothbrush_mug", Class::OtherProp, pose);
        let finish = if self.glass { Finish::DrinkingGlass } else { Finish::Ceramic(rng.below(3) as u8) };
        b.part(
            &mug,
            "mug",
            vessel(&[[0.033, 0.0], [0.0345, 0.033], [0.036, 0.066], [0.037, 0.1]], 0.003, 40).moved(Vec3::Z * CONTACT),
            finish,
        );
        for k in 0..self.brushes {
            let brush = b.object("toothbrush", Class::OtherProp, pose);
            let out = Vec2::from_angle(TAU * k as f32 / 3.0 + rng.range(-0.3, 0.3));
            // A brush stands on the floor at one side and leans over the rim at the other; each passes the axis on its own side.
            let aside = 0.008 * out.perp();
            let foot = (aside - out * 0.008).extend(0.0082);
            let top = (aside + out * 0.0625).extend(0.188);
            let way = (top - foot).normalize();
            b.part(&brush, "handle", crate::shape::tube(&[foot, foot.lerp(top, 0.6), top], 0.0042, 10), Finish::Plastic(k as u8));
            let head = foot.lerp(top, 0.925) - out.extend(0.0) * 0.0085;
            let bristles = rounded_box(Vec3::new(0.011, 0.010, 0.024), 0.002, 1)
                .turned(Vec3::Y, way.x.atan2(way.z))
                .turned(Vec3::X, -way.y.atan2(way.z));
            b.part(&brush, "bristles", bristles.moved(head), Finish::WhitePlastic);
        }
    }
}

/// Bottles of shampoo, lotion and similar, side by side.
#[derive(Clone, Copy, Debug)]
pub struct Toiletries {
    /// Number of bottles.
    pub count: usize,
}

impl Furniture for Toiletries {
    fn random(rng: &mut Rng) -> Self {
        Self { count: 1 + rng.below(4) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.078 * self.count as f32 + 0.004, 0.09, 0.245)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        for k in 0..self.count {
            let x = 0.078 * (k as f32 - 0.5 * (self.count as f32 - 1.0));
            let at = on(pose, Vec3::new(x, rng.range(-0.008, 0.008), CONTACT), 0.0);
            let bottle = b.object("bottle", Class::OtherProp, at);
            let (r, h) = (rng.range(0.024, 0.034), rng.range(0.11, 0.19));
            let color = Finish::Plastic(rng.below(8) as u8);
            match rng.below(3) {
                0 => {
                    let body = [[0.0, 0.0], [r - 0.004, 0.0], [r, 0.005], [r, h - 0.02], [0.8 * r, h - 0.004], [0.012, h], [0.0, h]];
                    b.part(&bottle, "body", turned(&body, 32), color);
                    let (low, high, out) = (0.2 * h, 0.62 * h, r + 0.0004);
                    let label = [[r - 0.001, low], [out, low], [out, high], [r - 0.001, high], [r - 0.001, low]];
                    b.part(&bottle, "label", turned(&label, 32), Finish::Paper);
                    b.part(&bottle, "cap", cylinder(0.013, 0.026, 24).moved(Vec3::Z * (h - 0.0005)), Finish::WhitePlastic);
                }
                1 => {
                    // Flat and oval, standing on its cap.
                    let flat = |p: Vec3| Vec3::new(p.x, 0.62 * p.y, p.z);
                    let body = [
                        [0.0, 0.03],
                        [0.7 * r, 0.03],
                        [r, 0.05],
                        [1.05 * r, 0.6 * h],
                        [0.9 * r, h],
                        [0.3 * r, h + 0.008],
                        [0.0, h + 0.009],
                    ];
                    b.part(&bottle, "body", turned(&body, 36).deformed(flat).smoothed(50.0), color);
                    b.part(&bottle, "cap", cylinder(0.72 * r, 0.0302, 30).deformed(flat).smoothed(40.0), Finish::WhitePlastic);
                }
                _ => {
                    let body = [[0.0, 0.0], [r - 0.003, 0.0], [r, 0.004], [r, 0.42 * h], [r - 0.003, 0.43 * h], [0.0, 0.43 * h]];
                    b.part(&bottle, "jar", turned(&body, 36), [Finish::Ceramic(0), Finish::BottleGlass(1)][rng.below(2)]);
                    b.part(
                        &bottle,
                        "lid",
                        cylinder(r + 0.001, 0.02, 36).moved(Vec3::Z * (0.43 * h - 0.0005)),
                        [Finish::BlackPlastic, Finish::Brass][rng.below(2)],
                    );
                }
            }
        }
    }
}

/// A toilet brush in its pot.
#[derive(Clone, Copy, Debug)]
pub struct ToiletBrush {
    /// Finish of the pot.
    pub pot: Finish,
}

impl Furniture for ToiletBrush {
    fn random(rng: &mut Rng) -> Self {
        Self { pot: [Finish::WhitePlastic, Finish::Steel, Finish::Porcelain, Finish::BlackMetal][rng.below(4)] }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.11, 0.11, 0.41)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let brush = b.object("toilet_brush", Class::OtherProp, pose);
        b.part(
            &brush,
            "pot",
            vessel(&[[0.048, 0.0], [0.0485, 0.045], [0.048, 0.09], [0.047, 0.13]], 0.0025, 36).moved(Vec3::Z * CONTACT),
            self.pot,
        );
        let bristles = turned(&[[0.0, 0.012], [0.03, 0.014], [0.036, 0.04], [0.034, 0.09], [0.012, 0.1], [0.0, 0.1]], 24);
        b.part(&brush, "bristles", bristles, Finish::WhitePlastic);
        let lid = turned(&[[0.0, 0.131], [0.048, 0.131], [0.05, 0.134], [0.046, 0.139], [0.0, 0.142]], 32);
        let handle = turned(&[[0.0, 0.095], [0.006, 0.095], [0.0065, 0.38], [0.0115, 0.388], [0.0115, 0.4], [0.0, 0.404]], 16);
        b.part(&brush, "handle", lid.with(handle), Finish::Steel);
    }
}

/// A small bin with a pedal.
#[derive(Clone, Copy, Debug)]
pub struct PedalBin {
    /// Radius of the bin.
    pub radius: f32,
    /// Height of the bin.
    pub height: f32,
    /// Finish of body and lid.
    pub finish: Finish,
}

impl Furniture for PedalBin {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::Steel, Finish::WhiteEnamel, Finish::BlackMetal, Finish::ColoredMetal(0)][rng.below(4)];
        Self { radius: rng.range(0.08, 0.12), height: rng.range(0.24, 0.32), finish }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius + 0.012, 2.0 * self.radius + 0.1, self.height + 0.03)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let bin = b.object("bin", Class::OtherProp, pose);
        let (r, h) = (self.radius, self.height);
        let base = [[0.0, 0.0], [r, 0.0], [r + 0.004, 0.004], [r + 0.003, 0.018], [r, 0.02], [0.0, 0.02]];
        b.part(&bin, "base", turned(&base, 44).moved(Vec3::Z * CONTACT), Finish::BlackPlastic);
        b.part(&bin, "body", turned(&[[0.0, 0.0195], [r, 0.0195], [r, h], [0.0, h]], 48), self.finish);
        let lid = [[0.0, h + 0.001], [r, h + 0.001], [r + 0.002, h + 0.006], [0.94 * r, h + 0.017], [0.6 * r, h + 0.025], [0.0, h + 0.028]];
        b.part(&bin, "lid", turned(&lid, 48), self.finish);
        let pedal = rounded_box(Vec3::new(0.05, 0.05, 0.008), 0.003, 2).moved(Vec3::new(0.0, r + 0.02, 0.014));
        b.part(&bin, "pedal", pedal, Finish::BlackPlastic);
        b.part(
            &bin,
            "hinge",
            rounded_box(Vec3::new(0.05, 0.014, 0.02), 0.004, 2).moved(Vec3::new(0.0, -r - 0.003, h)),
            Finish::BlackPlastic,
        );
    }
}
