//! A cable with a plug that lies in two to four loops of 5 to 8 cm radius, held by a tie; class other prop, of white or black plastic. The
//! plug is at +x.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod, wire};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, TAU};

/// A cable that lies in loops, its plug at one end.
#[derive(Clone, Copy, Debug)]
pub struct Cable {
    /// Radius of the loops.
    pub radius: f32,
    /// Number of loops on each other.
    pub loops: usize,
    /// White instead of black.
    pub white: bool,
}

impl Furniture for Cable {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.05, 0.08), loops: 2 + rng.below(3), white: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius + 0.2, 2.0 * self.radius + 0.06, 0.045)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let finish = if self.white { Finish::WhitePlastic } else { Finish::BlackPlastic };
        let cable = b.object("cable", Class::OtherProp, on(pose, Vec3::new(-0.06, 0.0, CONTACT), 0.0));
        // Radius of the cord.
        let r = 0.0027;
        let steps = 12 * self.loops;
        let (phase, wobble) = (rng.range(0.0, TAU), rng.range(0.004, 0.008));
        let mut points: Vec<[f32; 3]> = (0..=steps)
            .map(|k| {
                let a = TAU * k as f32 / 12.0;
                let radius = self.radius - 0.012 + 0.004 * k as f32 / 12.0 + wobble * (2.3 * a + phase).sin();
                let p = Vec2::from_angle(a) * radius;
                // Each loop lies on the one before it.
                [p.x, p.y, r + 2.0 * r * k as f32 / 12.0]
            })
            .collect();
        let top = r + 2.0 * r * self.loops as f32;
        points.extend([[self.radius + 0.015, 0.018, 0.6 * top], [self.radius + 0.05, 0.02, 0.012], [self.radius + 0.065, 0.02, 0.014]]);
        b.part(&cable, "cord", wire(&points, r, 8), finish);
        let plug = rounded_box(Vec3::new(0.04, 0.026, 0.024), 0.008, 3).moved(Vec3::new(self.radius + 0.083, 0.02, 0.0135));
        b.part(&cable, "plug", plug, finish);
        let pin = |y: f32| cylinder(0.0021, 0.018, 10).turned(Vec3::Y, FRAC_PI_2).moved(Vec3::new(self.radius + 0.1025, 0.02 + y, 0.0135));
        b.part(&cable, "pins", all([pin(-0.0085), pin(0.0085)]), Finish::Chrome);
        let tie = rod([self.radius - 0.03, -0.002, 0.5 * top], [self.radius + 0.004, -0.002, 0.5 * top], 0.0015, 6);
        b.part(&cable, "tie", tie, Finish::BlackPlastic);
    }
}
