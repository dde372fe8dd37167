//! A low cabinet of wood, 155 to 180 cm wide, with two doors of wood or white lacquer and a player in the open compartment between them
//! (class cabinet; the player is other prop), and a television on it (class television) whose 16:9 screen is 98 to 115 cm wide.

use super::{CONTACT, Furniture, board, grained, leg, on};
use crate::builder::{Builder, Class};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A low cabinet with a television on it.
#[derive(Clone, Copy, Debug)]
pub struct TelevisionBench {
    /// Width of the cabinet.
    pub width: f32,
    /// Width of the screen.
    pub screen: f32,
    /// Fronts in white lacquer instead of wood.
    pub white: bool,
}

/// Depth of the cabinet, metres.
const DEPTH: f32 = 0.40;
/// Height of the legs, metres.
const LEG: f32 = 0.14;
/// Height of the cabinet's top, metres: television cabinets are 40 to 60 cm high.
const TOP: f32 = 0.50;
/// Thickness of the boards, metres.
const BOARD: f32 = 0.022;
/// Position at which uprights meet the boards below and above them, metres from the outer face: the board and air that keeps faces out of
/// one plane.
const INNER: f32 = 0.0222;

impl TelevisionBench {
    /// Height of the surface that things stand on.
    pub const TOP: f32 = TOP;

    fn cabinet(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let cabinet = b.object("tv_bench", Class::Cabinet, pose);
        let (half, wood) = (0.5 * self.width, Finish::Wood);
        let (back, front) = (-0.5 * DEPTH, 0.5 * DEPTH);
        b.part(&cabinet, "top", grained(board([-half, back, TOP - BOARD], [half, front, TOP], 0.002), rng), wood);
        b.part(&cabinet, "bottom", grained(board([-half, back, LEG], [half, front, LEG + BOARD], 0.002), rng), wood);
        let side = |x: f32| board([x - 0.5 * BOARD, back, LEG + INNER], [x + 0.5 * BOARD, front, TOP - INNER], 0.002);
        b.part(&cabinet, "side_left", grained(side(-half + 0.5 * BOARD), rng), wood);
        b.part(&cabinet, "side_right", grained(side(half - 0.5 * BOARD), rng), wood);
        let inner = self.width - 2.0 * BOARD;
        let rear = board([-0.5 * inner, back + 0.002, LEG + INNER], [0.5 * inner, back + 0.012, TOP - INNER], 0.001);
        b.part(&cabinet, "rear", rear, wood);
        let fronts = if self.white { Finish::WhiteLacquer } else { wood };
        // Two doors, and an open compartment between them for the player.
        let third = inner / 3.0;
        for (i, x) in [(1, -third), (2, third)] {
            let door = board(
                [x - 0.5 * third + 0.003, front - 0.019, LEG + 0.0255],
                [x + 0.5 * third - 0.003, front - 0.001, TOP - 0.0255],
                0.0015,
            );
            let from = b.part_count();
            b.part(&cabinet, &format!("door_{i}"), grained(door, rng), fronts);
            let knob =
                leg(0.022, [0.011, 0.007], Vec2::ZERO).moved(Vec3::new(0.0, 0.0, -0.022)).turned(Vec3::X, std::f32::consts::FRAC_PI_2);
            let at = Vec3::new(x - x.signum() * (0.5 * third - 0.045), front - 0.0012, TOP - 0.075);
            b.part(&cabinet, &format!("knob_{i}"), knob.moved(at), Finish::Brass);
            // The knob is towards the middle, the hinges are at the outer edge.
            let edge = x + x.signum() * (0.5 * third - 0.003);
            b.joint(&cabinet, &format!("door_{i}"), &Joint::cupboard(edge, front - 0.001, x.signum()), from..b.part_count());
            let wall = 0.5 * third * x.signum();
            let divider = board([wall - 0.009, back + 0.0125, LEG + INNER], [wall + 0.009, front - 0.002, TOP - INNER], 0.0015);
            b.part(&cabinet, &format!("divider_{i}"), grained(divider, rng), wood);
        }
        let shelf = board([-0.5 * third + 0.0092, back + 0.0125, 0.31], [0.5 * third - 0.0092, front - 0.02, 0.326], 0.0015);
        b.part(&cabinet, "shelf", grained(shelf, rng), wood);
        for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
            let at = on(DAffine3::IDENTITY, Vec3::new(s.x * (half - 0.12), s.y * (front - 0.07), 0.0), 0.0);
            b.part_at(&cabinet, &format!("leg_{}", i + 1), leg(LEG - 0.0002, [0.013, 0.02], s * 0.03), at, wood);
        }
        let player = b.object("player", Class::OtherProp, on(pose, Vec3::new(0.02, 0.02, 0.326 + CONTACT), 0.01));
        b.part(
            &player,
            "housing",
            rounded_box(Vec3::new(0.36, 0.26, 0.055), 0.004, 2).moved(Vec3::new(0.0, 0.0, 0.0275)),
            Finish::BlackPlastic,
        );
    }

    fn television(&self, b: &mut Builder, pose: DAffine3) {
        let tv = b.object("television", Class::Television, pose);
        let (half, height) = (0.5 * self.screen, self.screen * 9.0 / 16.0 + 0.012);
        let bottom = 0.062;
        let black = Finish::BlackPlastic;
        b.part(
            &tv,
            "housing",
            rounded_box(Vec3::new(self.screen, 0.035, height), 0.004, 2).moved(Vec3::new(0.0, 0.0, bottom + 0.5 * height)),
            black,
        );
        b.part(
            &tv,
            "back",
            rounded_box(Vec3::new(0.6 * self.screen, 0.04, 0.6 * height), 0.012, 2).moved(Vec3::new(0.0, -0.03, bottom + 0.4 * height)),
            black,
        );
        let glass = board([-half + 0.007, 0.0165, bottom + 0.018], [half - 0.007, 0.0185, bottom + height - 0.007], 0.0006);
        b.part(&tv, "screen", glass, Finish::Screen);
        for (name, x) in [("foot_left", -0.62 * half), ("foot_right", 0.62 * half)] {
            let foot = board([x - 0.011, -0.11, 0.0], [x + 0.011, 0.11, 0.008], 0.002).with(board(
                [x - 0.009, -0.012, 0.0082],
                [x + 0.009, 0.012, bottom + 0.01],
                0.002,
            ));
            b.part(&tv, name, foot, black);
        }
    }
}

impl Furniture for TelevisionBench {
    fn random(rng: &mut Rng) -> Self {
        Self { width: rng.range(1.55, 1.8), screen: rng.range(0.98, 1.15), white: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH + 0.042, TOP + 0.08 + self.screen * 9.0 / 16.0)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        self.cabinet(b, pose, rng);
        self.television(b, on(pose, Vec3::new(0.0, -0.02, TOP + CONTACT), 0.0));
    }
}
