//! Machines to run and to cycle on, class other furniture: a treadmill and an exercise bike. People look to −y, where the display is.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, picture, rod, wire};
use crate::pieces::{Furniture, board};
use crate::shape::{Reshape, padded_box, rounded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A treadmill; one steps onto it from +y.
#[derive(Clone, Copy, Debug)]
pub struct Treadmill {
    /// Length.
    pub length: f32,
    /// Finish of the frame.
    pub frame: Finish,
    /// What its display shows; `None` is off.
    pub shows: Option<u8>,
}

/// Width and height of the deck, metres.
const DECK: [f32; 2] = [0.78, 0.19];

impl Furniture for Treadmill {
    fn random(rng: &mut Rng) -> Self {
        Self {
            length: rng.range(1.75, 2.0),
            frame: [Finish::BlackMetal, Finish::Aluminium, Finish::CoatedWhite][rng.below(3)],
            shows: (rng.below(2) == 0).then(|| rng.below(4) as u8),
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.86, self.length, 1.5)
    }

    fn reach(&self) -> f32 {
        0.7
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("treadmill", Class::OtherFurniture, pose);
        let (x, y) = (0.5 * DECK[0], 0.5 * self.length);
        let rails = [-1.0f32, 1.0]
            .map(|s| rounded_box(Vec3::new(0.12, self.length - 0.02, 0.15), 0.02, 3).moved(Vec3::new(s * (x - 0.06), 0.0, 0.105)));
        b.part(&object, "rails", all(rails), self.frame);
        let feet = [(-1.0f32, -1.0f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let feet = feet.map(|(sx, sy)| cylinder(0.028, 0.034, 16).moved(Vec3::new(sx * (x - 0.06), sy * (y - 0.15), 0.0)));
        b.part(&object, "feet", all(feet), Finish::Rubber);
        b.part(&object, "belt", board([0.118 - x, 0.34 - y, 0.1], [x - 0.118, y - 0.03, 0.165], 0.01), Finish::Rubber);
        b.part(
            &object,
            "hood",
            rounded_box(Vec3::new(DECK[0], 0.36, 0.2), 0.05, 4).moved(Vec3::new(0.0, 0.19 - y, 0.15)),
            Finish::BlackPlastic,
        );
        let post = |s: f32| {
            let at = s * (x + 0.01);
            wire(&[[at, 0.14 - y, 0.1], [at, 0.2 - y, 0.6], [at, 0.32 - y, 1.16], [at, 0.36 - y, 1.24]], 0.028, 14)
        };
        let arm = |s: f32| {
            let at = s * (x + 0.01);
            wire(&[[at, 0.3 - y, 1.05], [at, 0.5 - y, 1.0], [at, 0.85 - y, 0.96], [at, 0.95 - y, 0.93]], 0.022, 12)
        };
        b.part(&object, "posts", all([post(-1.0), post(1.0)]), self.frame);
        b.part(&object, "arms", all([arm(-1.0), arm(1.0)]), Finish::BlackPlastic);
        let lean = |mesh: Mesh| mesh.turned(Vec3::X, 0.5).moved(Vec3::new(0.0, 0.33 - y, 1.28));
        b.part(&object, "console", lean(rounded_box(Vec3::new(0.82, 0.07, 0.34), 0.03, 4)), Finish::BlackPlastic);
        let screen = lean(picture(0.44, 0.22).moved(Vec3::new(0.0, 0.0356, 0.03)));
        b.part(&object, "screen", screen, self.shows.map_or(Finish::Screen, Finish::ScreenOn));
    }
}

/// An exercise bike.
#[derive(Clone, Copy, Debug)]
pub struct ExerciseBike {
    /// Finish of the frame.
    pub frame: Finish,
    /// Height of the saddle.
    pub saddle: f32,
}

impl Furniture for ExerciseBike {
    fn random(rng: &mut Rng) -> Self {
        let frame = [Finish::BlackMetal, Finish::ColoredMetal(0), Finish::Aluminium, Finish::ColoredMetal(2)][rng.below(4)];
        Self { frame, saddle: rng.range(0.88, 1.0) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.56, 1.16, 1.22)
    }

    fn reach(&self) -> f32 {
        0.5
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("exercise_bike", Class::OtherFurniture, pose);
        let bar = |y: f32| rounded_box(Vec3::new(0.54, 0.07, 0.05), 0.016, 3).moved(Vec3::new(0.0, y, 0.045));
        let foot = |x: f32, y: f32| cylinder(0.022, 0.024, 14).moved(Vec3::new(x, y, 0.0));
        b.part(&object, "feet", all([foot(-0.23, -0.5), foot(0.23, -0.5), foot(0.23, 0.5), foot(-0.23, 0.5)]), Finish::Rubber);
        let tube = |from: [f32; 3], to: [f32; 3], r: f32| rod(from, to, r, 16);
        let frame = [
            bar(-0.5),
            bar(0.5),
            tube([0.0, -0.5, 0.05], [0.0, 0.5, 0.05], 0.03),
            tube([0.0, 0.12, 0.05], [0.0, 0.26, self.saddle - 0.06], 0.03),
            tube([0.0, -0.28, 0.06], [0.0, -0.34, 1.0], 0.03),
            tube([0.0, -0.32, 0.52], [0.0, 0.17, 0.42], 0.026),
        ];
        b.part(&object, "frame", all(frame), self.frame);
        let wheel = cylinder(0.23, 0.045, 48).turned(Vec3::Y, FRAC_PI_2).moved(Vec3::new(-0.0225 + 0.055, -0.3, 0.34));
        b.part(&object, "wheel", wheel, Finish::Steel);
        let hub = cylinder(0.05, 0.11, 24).turned(Vec3::Y, FRAC_PI_2).moved(Vec3::new(-0.045, -0.3, 0.34));
        let cover = rounded_box(Vec3::new(0.05, 0.52, 0.2), 0.024, 4).moved(Vec3::new(-0.05, -0.1, 0.34));
        b.part(&object, "cover", cover.with(hub), Finish::BlackPlastic);
        let crank = |s: f32| {
            let (x, dz) = (s * 0.1, s * 0.17);
            tube([x, 0.08, 0.34], [x, 0.08 + 0.3 * dz, 0.34 + dz], 0.012)
                .with(rounded_box(Vec3::new(0.09, 0.09, 0.02), 0.005, 2).moved(Vec3::new(s * 0.145, 0.08 + 0.3 * dz, 0.34 + dz)))
        };
        let axle = tube([-0.11, 0.08, 0.34], [0.11, 0.08, 0.34], 0.014);
        b.part(&object, "cranks", all([crank(-1.0), crank(1.0), axle]), Finish::BlackPlastic);
        let saddle = padded_box(Vec3::new(0.2, 0.27, 0.06), 0.026, 0.01)
            .deformed(|p| Vec3::new(p.x * (1.0 + 1.6 * p.y.clamp(-0.13, 0.1)), p.y, p.z))
            .smoothed(60.0);
        b.part(&object, "saddle", saddle.moved(Vec3::new(0.0, 0.27, self.saddle - 0.035)), Finish::Leather);
        let handle =
            |s: f32| wire(&[[0.0, -0.34, 0.99], [s * 0.2, -0.33, 1.03], [s * 0.23, -0.2, 1.07], [s * 0.2, -0.06, 1.09]], 0.017, 12);
        b.part(&object, "handles", all([handle(-1.0), handle(1.0)]), Finish::Rubber);
        let lean = |mesh: Mesh| mesh.turned(Vec3::X, 0.6).moved(Vec3::new(0.0, -0.35, 1.11));
        b.part(&object, "console", lean(rounded_box(Vec3::new(0.2, 0.035, 0.2), 0.012, 3)), Finish::BlackPlastic);
        b.part(&object, "display", lean(picture(0.13, 0.08).moved(Vec3::new(0.0, 0.0179, 0.03))), Finish::Screen);
        let stem = tube([0.0, -0.34, 0.98], [0.0, -0.35, 1.06], 0.02);
        b.part(&object, "stem", stem, Finish::BlackPlastic);
    }
}
