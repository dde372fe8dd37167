//! What is shown to many: a flat display on the wall (class television), a screen for a projector that hangs from its case on the wall (class
//! other structure), and the projector below the ceiling (class other prop).

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::Furniture;
use crate::pieces::board;
use crate::pieces::form::{all, cylinder, picture, rod, to_front};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A display on the wall; its origin is the middle of its back.
#[derive(Clone, Copy, Debug)]
pub struct WallDisplay {
    /// Width over its frame.
    pub width: f32,
    /// What it shows; `None` is off.
    pub shows: Option<u8>,
}

/// Depth of a display with its bracket, metres.
const DEPTH: f32 = 0.085;

impl Furniture for WallDisplay {
    fn random(rng: &mut Rng) -> Self {
        Self { width: rng.range(1.1, 1.9), shows: (rng.below(2) == 0).then(|| rng.below(4) as u8) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH, self.width * 9.0 / 16.0 + 0.02)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("wall_display", Class::Television, pose);
        let (w, h) = (self.width, self.width * 9.0 / 16.0 + 0.016);
        let body = rounded_box(Vec3::new(w, 0.03, h), 0.004, 2).moved(Vec3::new(0.0, DEPTH - 0.018, 0.0));
        b.part(&object, "housing", body, Finish::BlackPlastic);
        let bracket = board([-0.25, 0.0, -0.15], [0.25, 0.012, 0.15], 0.001)
            .with(all([-0.18f32, 0.18].map(|x| board([x - 0.02, 0.0118, -0.2], [x + 0.02, DEPTH - 0.032, 0.2], 0.001))));
        b.part(&object, "bracket", bracket, Finish::BlackMetal);
        let screen = picture(w - 0.018, h - 0.024).moved(Vec3::new(0.0, DEPTH - 0.0026, 0.002));
        b.part(&object, "screen", screen, self.shows.map_or(Finish::Screen, Finish::ScreenOn));
    }
}

/// A screen for a projector, let down from its case; its origin is the middle of its back.
#[derive(Clone, Copy, Debug)]
pub struct ProjectionScreen {
    /// Width and height of the sheet.
    pub sheet: Vec2,
}

/// Height and depth of its case, metres.
const CASE: [f32; 2] = [0.09, 0.1];

impl Furniture for ProjectionScreen {
    fn random(rng: &mut Rng) -> Self {
        let width = rng.range(1.6, 2.2);
        Self { sheet: Vec2::new(width, width * [0.75, 0.5625][rng.below(2)]) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.sheet.x + 0.16, CASE[1], self.sheet.y + CASE[0] + 0.03)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("projection_screen", Class::OtherStructure, pose);
        let size = self.size();
        let (top, half) = (0.5 * size.z, 0.5 * self.sheet.x);
        let case = rounded_box(Vec3::new(size.x, CASE[1], CASE[0]), 0.02, 3).moved(Vec3::new(0.0, 0.5 * CASE[1], top - 0.5 * CASE[0]));
        b.part(&object, "case", case, Finish::WhitePlastic);
        let y = 0.5 * CASE[1];
        let sheet = |x: f32, z: [f32; 2], front: f32| board([-x, y - front, z[0]], [x, y + front, z[1]], 0.0002);
        let (low, high) = (0.028 - top, top - CASE[0] + 0.004);
        b.part(&object, "border", sheet(half, [low, high], 0.0005), Finish::BlackPlastic);
        b.part(&object, "sheet", sheet(half - 0.04, [low + 0.05, high - 0.05], 0.0009), Finish::Paper);
        let bar = cylinder(0.014, self.sheet.x + 0.02, 16).turned(Vec3::Y, std::f32::consts::FRAC_PI_2);
        b.part(&object, "bar", bar.moved(Vec3::new(-half - 0.01, y, 0.0145 - top)), Finish::BlackPlastic);
        let string = rod([0.0, y, 0.002 - top], [0.0, y, 0.016 - top], 0.002, 6);
        b.part(&object, "string", string, Finish::WhitePlastic);
    }
}

/// A projector below the ceiling; its origin is on the ceiling, and it throws its picture to +y.
#[derive(Clone, Copy, Debug)]
pub struct Projector {
    /// Distance of its upper side from the ceiling.
    pub drop: f32,
    /// White instead of black.
    pub white: bool,
}

impl Furniture for Projector {
    fn random(rng: &mut Rng) -> Self {
        Self { drop: rng.range(0.15, 0.5), white: rng.below(3) > 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.36, 0.3, self.drop + 0.11)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("projector", Class::OtherProp, pose);
        let body = if self.white { Finish::WhitePlastic } else { Finish::BlackPlastic };
        let z = -self.drop - 0.0555;
        b.part(&object, "body", rounded_box(Vec3::new(0.35, 0.28, 0.105), 0.018, 3).moved(Vec3::new(0.0, -0.005, z)), body);
        let plate = cylinder(0.07, 0.012, 28).moved(Vec3::new(0.0, 0.0, -0.012));
        b.part(&object, "mount", plate.with(rod([0.0, 0.0, -0.01], [0.0, 0.0, z + 0.04], 0.018, 16)), Finish::CoatedWhite);
        let lens = to_front(cylinder(0.038, 0.02, 32)).moved(Vec3::new(0.07, 0.13, z + 0.005));
        b.part(&object, "lens_ring", lens, Finish::BlackPlastic);
        let glass = to_front(cylinder(0.029, 0.004, 32)).moved(Vec3::new(0.07, 0.147, z + 0.005));
        b.part(&object, "lens", glass, Finish::GlossBlack);
        let slots =
            (0..7).map(|k| board([-0.14, 0.1335, z - 0.03 + 0.01 * k as f32], [-0.02, 0.1355, z - 0.025 + 0.01 * k as f32], 0.0005));
        b.part(&object, "vents", all(slots), Finish::BlackPlastic);
    }
}
