//! A light with tubes, 1.2 or 1.5 m long, class lamp: one or two bare tubes, tubes below white wings, or behind an opal cover; under the
//! ceiling or hung from it by two wires. The origin is on the ceiling.

use crate::builder::{Builder, Class};
use crate::lamplight::Glow;
use crate::materials::Finish;
use crate::pieces::Furniture;
use crate::pieces::form::{all, cylinder, rod};
use crate::shape::{Reshape, bevelled_box, rounded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A light with tubes along x.
#[derive(Clone, Copy, Debug)]
pub struct TubeLamp {
    /// Length: 1.2 m tubes have 36 W, 1.5 m tubes 58 W.
    pub length: f32,
    /// One or two tubes.
    pub tubes: u8,
    /// What is around them.
    pub around: Around,
    /// Distance of the body from the ceiling, metres; wires hold it.
    pub drop: f32,
}

/// What is around the tubes of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Around {
    /// Nothing.
    Nothing,
    /// White wings that throw the light down.
    Wings,
    /// An opal cover.
    Cover,
}

/// Height of the body above the tubes, metres.
const BODY: f32 = 0.05;
/// Radius of a tube, metres (T8).
const TUBE: f32 = 0.013;

impl TubeLamp {
    fn width(&self) -> f32 {
        match self.around {
            Around::Nothing => 0.1,
            Around::Wings => 0.24,
            Around::Cover => 0.17,
        }
    }

    fn lumens(&self) -> f32 {
        f32::from(self.tubes) * if self.length > 1.3 { 5200.0 } else { 3350.0 }
    }

    /// Sheets that slope from the body to both sides.
    fn wings(&self) -> Mesh {
        let wing = |s: f32| {
            bevelled_box(Vec3::new(self.length, 0.1, 0.0016), 0.0004).turned(Vec3::X, -s * 0.5).moved(Vec3::new(0.0, s * 0.073, -0.0685))
        };
        wing(-1.0).with(wing(1.0))
    }
}

impl Furniture for TubeLamp {
    fn random(rng: &mut Rng) -> Self {
        Self {
            length: [1.2, 1.5][rng.below(2)],
            tubes: 1 + rng.below(2) as u8,
            around: [Around::Nothing, Around::Wings, Around::Cover][rng.below(3)],
            drop: [0.0, 0.0, 0.35][rng.below(3)],
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length, self.width(), self.drop + 0.1)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let lamp = b.object("tube_lamp", Class::Lamp, pose * DAffine3::from_translation(enfilade_math::DVec3::Z * f64::from(-self.drop)));
        let body = rounded_box(Vec3::new(self.length, 0.075, BODY), 0.004, 2).moved(Vec3::new(0.0, 0.0, -0.5 * BODY));
        b.part(&lamp, "body", body, Finish::CoatedWhite);
        let wires = [-0.38f32, 0.38].map(|x| rod([x * self.length, 0.0, -0.002], [x * self.length, 0.0, self.drop], 0.0012, 6));
        if self.drop > 0.0 {
            b.part(&lamp, "wires", all(wires), Finish::Steel);
        }
        let glow = Glow { lumens: self.lumens(), ..Glow::WORK };
        if self.around == Around::Cover {
            let cover = rounded_box(Vec3::new(self.length - 0.02, self.width(), 0.05), 0.02, 4).moved(Vec3::new(0.0, 0.0, -BODY - 0.0255));
            let caps = [-1.0f32, 1.0].map(|s| {
                rounded_box(Vec3::new(0.012, self.width(), 0.049), 0.004, 2).moved(Vec3::new(
                    s * (0.5 * self.length - 0.006),
                    0.0,
                    -BODY - 0.025,
                ))
            });
            b.part(&lamp, "caps", all(caps), Finish::WhitePlastic);
            b.glow(&lamp, "cover", cover, glow);
            return;
        }
        let rows: &[f32] = if self.tubes > 1 { &[-0.03, 0.03] } else { &[0.0] };
        let z = -BODY - 0.02;
        let length = self.length - 0.05;
        let tubes = rows.iter().map(|&y| cylinder(TUBE, length, 18).turned(Vec3::Y, FRAC_PI_2).moved(Vec3::new(-0.5 * length, y, z)));
        b.glow(&lamp, "tubes", all(tubes), glow);
        let socket = |s: f32, y: f32| {
            rounded_box(Vec3::new(0.02, 0.03, 0.037), 0.004, 2).moved(Vec3::new(s * (0.5 * length + 0.0095), y, -BODY - 0.0165))
        };
        let sockets = rows.iter().flat_map(|&y| [socket(-1.0, y), socket(1.0, y)]);
        b.part(&lamp, "sockets", all(sockets), Finish::WhitePlastic);
        if self.around == Around::Wings {
            b.part(&lamp, "wings", self.wings(), Finish::CoatedWhite);
        }
    }
}
