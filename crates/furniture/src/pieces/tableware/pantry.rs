//! Provisions, class other prop: bottles of wine, oil and water, 22 to 32 cm high, storage jars of glass or pottery, 10 to 22 cm high, and
//! a rack with twelve spice jars, each an object.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{cylinder, turned, vessel};
use crate::pieces::{CONTACT, Furniture, board, grained, on};
use crate::shape::Reshape;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A bottle with a label.
#[derive(Clone, Copy, Debug)]
pub struct Bottle {
    /// Height with the cap.
    pub height: f32,
    /// Radius of the belly.
    pub radius: f32,
    /// 0 wine, 1 oil, 2 water with a cap.
    pub kind: u8,
}

impl Furniture for Bottle {
    fn random(rng: &mut Rng) -> Self {
        match rng.below(3) {
            0 => Self { height: rng.range(0.29, 0.32), radius: rng.range(0.036, 0.039), kind: 0 },
            1 => Self { height: rng.range(0.22, 0.28), radius: rng.range(0.028, 0.034), kind: 1 },
            _ => Self { height: rng.range(0.24, 0.30), radius: rng.range(0.034, 0.04), kind: 2 },
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius + 0.002, 2.0 * self.radius + 0.002, self.height)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let bottle = b.object("bottle", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), rng.range(0.0, 6.0)));
        let (h, r) = (self.height, self.radius);
        let neck = 0.014;
        let shoulder = if self.kind == 1 { 0.68 } else { 0.58 } * h;
        let body = vessel(
            &[
                [0.92 * r, 0.0],
                [r, 0.006],
                [r, 0.3 * shoulder],
                [r, shoulder],
                [0.62 * r, shoulder + 0.10 * h],
                [neck, shoulder + 0.2 * h],
                [neck, h - 0.012],
            ],
            0.003,
            36,
        );
        // Wine in green or brown glass, oil in green or clear, water in clear or blue.
        let glass = [[0, 1], [0, 2], [2, 3]][usize::from(self.kind) % 3][rng.below(2)];
        b.part(&bottle, "body", body, Finish::BottleGlass(glass));
        let cap = cylinder(neck + 0.0012, 0.032, 24).moved(Vec3::new(0.0, 0.0, h - 0.032));
        b.part(
            &bottle,
            "cap",
            cap,
            [Finish::ColoredMetal(rng.below(4) as u8), Finish::Cork, Finish::Plastic(rng.below(4) as u8)][usize::from(self.kind) % 3],
        );
        let (low, high) = (0.22 * shoulder, 0.78 * shoulder);
        let band = |low: f32, high: f32, out: f32| {
            let r = r + out;
            turned(&[[r - 0.0003, low], [r, low + 0.0003], [r, high - 0.0003], [r - 0.0003, high], [r - 0.0003, low]], 36)
        };
        b.part(&bottle, "label", band(low, high, 0.0005), Finish::Paper);
        let stripe = low + (high - low) * rng.range(0.55, 0.75);
        b.part(&bottle, "stripe", band(stripe, stripe + 0.16 * (high - low), 0.0008), Finish::Accent(rng.below(3) as u8));
    }
}

/// A storage jar, of pottery or of glass that shows its contents.
#[derive(Clone, Copy, Debug)]
pub struct Jar {
    /// Height without the lid.
    pub height: f32,
    /// Outer radius.
    pub radius: f32,
    /// Glass instead of pottery.
    pub glass: bool,
}

impl Furniture for Jar {
    fn random(rng: &mut Rng) -> Self {
        Self { height: rng.range(0.1, 0.22), radius: rng.range(0.042, 0.06), glass: rng.below(3) > 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius, 2.0 * self.radius, self.height + 0.025)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let jar = b.object("jar", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let (h, r) = (self.height, self.radius);
        let body = vessel(&[[r - 0.004, 0.0], [r, 0.006], [r, 0.5 * h], [r, h - 0.012], [r - 0.004, h]], 0.0025, 36);
        b.part(&jar, "body", body, if self.glass { Finish::DrinkingGlass } else { Finish::Ceramic(rng.below(3) as u8) });
        if self.glass {
            let fill = rng.range(0.35, 0.8) * h;
            let inner = r - 0.0029;
            let heap = turned(&[[0.0, 0.003], [inner, 0.003], [inner, fill], [0.5 * inner, fill + 0.006], [0.0, fill + 0.004]], 32);
            b.part(&jar, "contents", heap, [Finish::Bread, Finish::Soil, Finish::Paper, Finish::Fruit(1), Finish::Cork][rng.below(5)]);
        }
        let lid = [[0.0, h + CONTACT], [r - 0.001, h + CONTACT], [r, h + 0.002], [r, h + 0.02], [r - 0.002, h + 0.022], [0.0, h + 0.022]];
        b.part(&jar, "lid", turned(&lid, 36), [Finish::Wood, Finish::Cork, Finish::Steel][rng.below(3)]);
    }
}

/// Small jars of spices in a rack of two boards.
#[derive(Clone, Copy, Debug)]
pub struct SpiceRack;

impl Furniture for SpiceRack {
    fn random(_rng: &mut Rng) -> Self {
        Self
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.32, 0.09, 0.27)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let rack = b.object("spice_rack", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let side = |x: f32| board([x, -0.045, 0.0], [x + 0.009, 0.045, 0.27], 0.001);
        let mut levels = side(-0.16).with(side(0.151));
        // Where boards end: a little inside the sides.
        let half = 0.1512;
        for z in [0.012, 0.145] {
            levels = levels.with(board([-half, -0.045, z], [half, 0.045, z + 0.008], 0.0008));
            levels = levels.with(board([-half, 0.037, z + 0.025], [half, 0.044, z + 0.04], 0.0008));
        }
        levels = levels.with(board([-half, -0.045, 0.0], [half, -0.041, 0.26], 0.0005));
        b.part(&rack, "frame", grained(levels, rng), Finish::Wood);
        for k in 0..12 {
            let at = Vec3::new(0.05 * ((k % 6) as f32 - 2.5), 0.004 + rng.range(-0.003, 0.003), if k < 6 { 0.0205 } else { 0.1535 });
            let jar = b.object("spice_jar", Class::OtherProp, on(pose, at + Vec3::new(0.0, 0.0, CONTACT), 0.0));
            let body = turned(&[[0.0, 0.0], [0.020, 0.0], [0.022, 0.003], [0.022, 0.07], [0.018, 0.078], [0.0, 0.078]], 20);
            b.part(&jar, "contents", body, [Finish::Soil, Finish::Bread, Finish::Fruit(k as u8), Finish::Leaf, Finish::Bark][rng.below(5)]);
            b.part(&jar, "lid", cylinder(0.0205, 0.016, 20).moved(Vec3::new(0.0, 0.0, 0.0782)), Finish::BlackMetal);
            let label = board([-0.013, 0.0216, 0.02], [0.013, 0.0226, 0.05], 0.0002).uv_moved(Vec2::splat(0.1));
            b.part(&jar, "label", label, Finish::Paper);
        }
    }
}
