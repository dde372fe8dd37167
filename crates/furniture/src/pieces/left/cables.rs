//! Cables that run over floors and desks in bends, with a charger at one end, and power strips with their cable; class other prop.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, wire};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec3};

/// Ends of bends of a cable that never crosses itself: it runs along y and swings aside, each time less than halfway to the next bend.
fn bends(length: f32, wide: f32, radius: f32, rng: &mut Rng) -> Vec<[f32; 3]> {
    let count = (length / 0.09).ceil().max(3.0) as usize;
    let mut side = if rng.below(2) == 0 { 1.0 } else { -1.0 };
    (0..=count)
        .map(|k| {
            side *= if rng.below(3) == 0 { 1.0 } else { -1.0 };
            let x = if k == 0 || k == count { 0.0 } else { side * rng.range(0.2, 0.42) * wide };
            [x, length * (k as f32 / count as f32 - 0.5), radius]
        })
        .collect()
}

/// A charging cable that lies in bends, a charger at one end.
#[derive(Clone, Copy, Debug)]
pub struct LooseCable {
    /// Length from end to end as it lies.
    pub length: f32,
    /// Width of its bends.
    pub wide: f32,
    /// White instead of black.
    pub white: bool,
    /// It ends in a charger.
    pub charger: bool,
}

impl Furniture for LooseCable {
    fn random(rng: &mut Rng) -> Self {
        Self { length: rng.range(0.24, 0.55), wide: rng.range(0.08, 0.2), white: rng.below(3) > 0, charger: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.wide.max(0.06), self.length + 0.16, if self.charger { 0.032 } else { 0.01 })
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let finish = if self.white { Finish::WhitePlastic } else { Finish::BlackPlastic };
        let cable = b.object("cable", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let r = 0.0019;
        b.part(&cable, "cord", wire(&bends(self.length, self.wide, r, rng), r, 8), finish);
        let end = 0.5 * self.length;
        let plug = rounded_box(Vec3::new(0.010, 0.026, 0.006), 0.002, 2).moved(Vec3::new(0.0, end + 0.011, 0.003));
        let tip = rounded_box(Vec3::new(0.0082, 0.01, 0.0024), 0.0008, 2).moved(Vec3::new(0.0, end + 0.027, 0.003));
        b.part(&cable, "plug", plug, finish);
        b.part(&cable, "tip", tip, Finish::Chrome);
        if self.charger {
            let cube = rounded_box(Vec3::new(0.042, 0.052, 0.028), 0.006, 3).moved(Vec3::new(0.0, -end - 0.024, 0.014));
            let pins = [-0.0095f32, 0.0095]
                .map(|x| cylinder(0.002, 0.019, 10).turned(Vec3::X, std::f32::consts::FRAC_PI_2).moved(Vec3::new(x, -end - 0.049, 0.014)));
            b.part(&cable, "charger", cube, finish);
            b.part(&cable, "pins", all(pins), Finish::Chrome);
        }
    }
}

/// A strip of sockets with its cable.
#[derive(Clone, Copy, Debug)]
pub struct PowerStrip {
    /// Number of sockets.
    pub sockets: usize,
    /// Black instead of white.
    pub black: bool,
    /// Sockets that are in use, from the far end.
    pub used: usize,
}

/// Distance between sockets, metres.
const SOCKET: f32 = 0.055;

impl Furniture for PowerStrip {
    fn random(rng: &mut Rng) -> Self {
        let sockets = 3 + rng.below(4);
        Self { sockets, black: rng.below(3) == 0, used: rng.below(sockets) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.2, SOCKET * self.sockets as f32 + 0.38, 0.11)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let finish = if self.black { Finish::BlackPlastic } else { Finish::WhitePlastic };
        let other = if self.black { Finish::WhitePlastic } else { Finish::BlackPlastic };
        let strip = b.object("power_strip", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let long = SOCKET * self.sockets as f32 + 0.05;
        let (middle, r) = (0.5 * self.size().y - 0.5 * long, 0.0034);
        let body = rounded_box(Vec3::new(0.054, long, 0.04), 0.008, 3).moved(Vec3::new(0.0, middle, 0.02));
        b.part(&strip, "body", body, finish);
        let place = |k: usize| middle + SOCKET * (k as f32 - 0.5 * (self.sockets as f32 - 1.0));
        let wells = (self.used..self.sockets).map(|k| cylinder(0.0195, 0.0012, 28).moved(Vec3::new(0.0, place(k), 0.0396)));
        b.part(&strip, "sockets", all(wells), other);
        let plug = |k: usize| {
            let head = cylinder(0.0185, 0.03, 24).moved(Vec3::new(0.0, place(k), 0.0402));
            let cord =
                wire(&[[0.0, place(k), 0.06], [0.0, place(k), 0.085], [0.03, place(k) + 0.008, 0.06], [0.075, place(k) + 0.004, r]], r, 8);
            head.with(cord)
        };
        if self.used > 0 {
            b.part(&strip, "plugs", all((0..self.used).map(plug)), if rng.below(2) == 0 { finish } else { other });
        }
        let from = middle - 0.5 * long + 0.01;
        let length = from + 0.5 * self.size().y - 0.004;
        let cord = wire(&bends(length, 0.16, r, rng), r, 8).moved(Vec3::new(0.0, from - 0.5 * length, 0.0));
        b.part(&strip, "cord", cord.deformed(|p| Vec3::new(p.x, p.y, p.z.max(0.0))).smoothed(50.0), finish);
    }
}
