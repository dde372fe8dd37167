//! Lamps on a wall, class lamp: a globe on an arm, a box that lights the wall above and below it, or a small cloth shade. Sizes are fixed;
//! the metal varies. The origin is the middle of the back on the wall's face.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::Furniture;
use crate::pieces::form::{all, cylinder, rod, to_front, turned, wire};
use crate::pieces::lamp::carrier;
use crate::shape::{Reshape, rounded_box, sphere};
use enfilade_math::{DAffine3, Rng, Vec3};

/// A lamp on the wall; its origin is the middle of its back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum WallLamp {
    /// A globe on an arm.
    Globe,
    /// A box that throws light up and down along the wall.
    Box,
    /// A small cloth shade.
    Shade,
}

impl Furniture for WallLamp {
    fn random(rng: &mut Rng) -> Self {
        [Self::Globe, Self::Box, Self::Shade][rng.below(3)]
    }

    fn size(&self) -> Vec3 {
        Vec3::from_array(match self {
            Self::Globe => [0.14, 0.22, 0.26],
            Self::Box => [0.1, 0.1, 0.18],
            Self::Shade => [0.17, 0.23, 0.28],
        })
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let lamp = b.object("wall_lamp", Class::Lamp, pose);
        let metal = [Finish::Brass, Finish::BlackMetal, Finish::Chrome][rng.below(3)];
        let plate = to_front(cylinder(0.05, 0.018, 36));
        match self {
            Self::Globe => {
                let y = 0.15;
                let arm = wire(&[[0.0, 0.015, -0.06], [0.0, 0.1, -0.07], [0.0, 0.145, -0.055], [0.0, y, -0.01]], 0.006, 10);
                let cup =
                    turned(&[[0.0, -0.02], [0.02, -0.018], [0.034, 0.0], [0.034, 0.004], [0.0, 0.004]], 28).moved(Vec3::new(0.0, y, 0.0));
                b.part(&lamp, "arm", all([plate.moved(Vec3::new(0.0, 0.0, -0.06)), arm, cup]), metal);
                b.part(&lamp, "globe", sphere(0.065, 32).moved(Vec3::new(0.0, y, 0.06)), Finish::OpalGlobe);
            }
            Self::Box => {
                let (w, d, h, t) = (0.098, 0.096, 0.178, 0.004);
                let wall = |size: Vec3, at: Vec3| rounded_box(size, 0.0015, 1).moved(at);
                let shell = all([
                    wall(Vec3::new(w, t, h), Vec3::new(0.0, 0.5 * t, 0.0)),
                    wall(Vec3::new(w, t, h), Vec3::new(0.0, d - 0.5 * t, 0.0)),
                    wall(Vec3::new(t, d - 2.0 * t - 0.0004, h), Vec3::new(0.5 * (w - t), 0.5 * d, 0.0)),
                    wall(Vec3::new(t, d - 2.0 * t - 0.0004, h), Vec3::new(-0.5 * (w - t), 0.5 * d, 0.0)),
                ]);
                b.part(&lamp, "shell", shell, if metal == Finish::Chrome { Finish::CoatedWhite } else { metal });
                let inner =
                    rounded_box(Vec3::new(w - 2.0 * t - 0.002, d - 2.0 * t - 0.002, 0.06), 0.004, 2).moved(Vec3::new(0.0, 0.5 * d, 0.0));
                b.part(&lamp, "light", inner, Finish::OpalGlobe);
            }
            Self::Shade => {
                let y = 0.14;
                let arm = rod([0.0, 0.015, -0.08], [0.0, y, -0.08], 0.006, 10).with(rod([0.0, y, -0.083], [0.0, y, 0.0], 0.006, 10));
                b.part(&lamp, "arm", plate.moved(Vec3::new(0.0, 0.0, -0.08)).with(arm), metal);
                // Half the thickness of the cloth.
                let t = 0.0012;
                let shade = [
                    [0.083, -0.03],
                    [0.083 + t, -0.029],
                    [0.058 + t, 0.129],
                    [0.058, 0.13],
                    [0.058 - t, 0.129],
                    [0.083 - t, -0.029],
                    [0.083, -0.03],
                ];
                b.part(&lamp, "shade", turned(&shade, 48).moved(Vec3::new(0.0, y, 0.0)), Finish::Lampshade);
                b.part(&lamp, "carrier", carrier(0.073, 0.012).moved(Vec3::new(0.0, y, 0.0)), metal);
                b.part(&lamp, "bulb", sphere(0.028, 18).moved(Vec3::new(0.0, y, 0.05)), Finish::Bulb);
                b.part(&lamp, "socket", cylinder(0.013, 0.026, 16).moved(Vec3::new(0.0, y, -0.002)), metal);
            }
        }
    }
}
