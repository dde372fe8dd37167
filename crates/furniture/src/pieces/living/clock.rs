//! A round clock on the wall, 28 to 48 cm across, of class other prop, at a random time: with a face, or a ring without one. The origin is
//! the middle of its back, and it faces +y.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::Furniture;
use crate::pieces::form::{all, around, cylinder, rod, to_front, turned};
use crate::shape::{Reshape, bevelled_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// A round clock on the wall; its origin is the middle of its back.
#[derive(Clone, Copy, Debug)]
pub struct WallClock {
    /// Radius over the rim.
    pub radius: f32,
    /// Minutes after noon.
    pub minutes: f32,
    /// A ring with spokes instead of a face.
    pub skeleton: bool,
    /// Finish of rim, spokes and works.
    pub rim: Finish,
}

impl Furniture for WallClock {
    fn random(rng: &mut Rng) -> Self {
        Self {
            radius: rng.range(0.14, 0.24),
            minutes: rng.range(0.0, 720.0),
            skeleton: rng.below(4) == 0,
            rim: [Finish::BlackMetal, Finish::Wood, Finish::Brass, Finish::WhitePlastic][rng.below(4)],
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius, 0.045, 2.0 * self.radius)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let clock = b.object("wall_clock", Class::OtherProp, pose);
        let r = self.radius;
        let rim = [[r - 0.014, 0.0], [r, 0.0], [r, 0.03], [r - 0.003, 0.034], [r - 0.012, 0.034], [r - 0.014, 0.03], [r - 0.014, 0.0]];
        b.part(&clock, "rim", to_front(turned(&rim, 72)), self.rim);
        let face = 0.018;
        if self.skeleton {
            let spokes =
                around(4, 0.0).map(|d| rod([d.x * 0.03, 0.012, d.y * 0.03], [d.x * (r - 0.01), 0.012, d.y * (r - 0.01)], 0.004, 8));
            b.part(&clock, "spokes", all(spokes), self.rim);
            b.part(&clock, "works", to_front(cylinder(0.042, face + 0.002, 32)), self.rim);
        } else {
            b.part(
                &clock,
                "face",
                to_front(cylinder(r - 0.0135, face, 72)),
                if self.rim == Finish::WhitePlastic { Finish::Paper } else { Finish::WhiteLacquer },
            );
        }
        let dark = Finish::BlackMetal;
        // Without a face the rim holds the marks.
        let outer = if self.skeleton { r - 0.013 } else { 0.86 * r };
        let marks = around(12, 0.0).enumerate().map(|(k, d)| {
            let inner = 0.86 * r - if k % 3 == 0 { 0.14 * r } else { 0.08 * r };
            let middle = 0.5 * (inner + outer);
            bevelled_box(Vec3::new(outer - inner, 0.0016, 0.02 * r), 0.0003).turned(Vec3::Y, -d.to_angle()).moved(Vec3::new(
                d.x * middle,
                face + 0.0012,
                d.y * middle,
            ))
        });
        b.part(&clock, "marks", all(marks), dark);
        let hand = |turns: f32, length: f32, y: f32, w: f32| {
            // Clockwise for someone before the wall, who has +x to the left.
            let d = Vec2::new(-(TAU * turns).sin(), (TAU * turns).cos());
            let mesh = bevelled_box(Vec3::new(1.15 * length, 0.0016, w), 0.0004).turned(Vec3::Y, -d.to_angle());
            mesh.moved(Vec3::new(d.x * 0.425 * length, y, d.y * 0.425 * length))
        };
        b.part(&clock, "hour_hand", hand(self.minutes / 720.0, 0.5 * r, face + 0.005, 0.045 * r), dark);
        b.part(&clock, "minute_hand", hand(self.minutes / 60.0 % 1.0, 0.74 * r, face + 0.008, 0.03 * r), dark);
        b.part(&clock, "axle", to_front(cylinder(0.035 * r + 0.002, 0.012, 20)).moved(Vec3::new(0.0, face, 0.0)), self.rim);
    }
}
