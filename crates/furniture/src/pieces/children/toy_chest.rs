//! A chest for toys of 60 to 85 × 40 × 42 cm, of class box, in wood or lacquer: closed with a lid that carries things, or open with a
//! blanket (other prop), a plush bear and a ball in it.

use super::{PlushBear, Toy};
use crate::builder::{Builder, Class};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::all;
use crate::pieces::{CONTACT, Furniture, Surface, board, grained, on};
use crate::shape::Reshape;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A chest for toys: closed with a lid to sit on, or open and full.
#[derive(Clone, Copy, Debug)]
pub struct ToyChest {
    /// Width along x.
    pub width: f32,
    /// Without a lid, and full.
    pub open: bool,
    /// Finish of walls and lid.
    pub finish: Finish,
}

/// Depth over the lid, metres.
const DEPTH: f32 = 0.40;
/// Height of the closed chest, metres: the same as a seat.
const HEIGHT: f32 = 0.42;
/// Angle to which the lid is lifted, radians: a stay holds it before it stands upright.
const LIFT: f64 = 1.4;
/// Thickness of the walls, metres.
const BOARD: f32 = 0.016;
/// Air between walls that meet, metres: it keeps faces out of one plane.
const GAP: f32 = 0.0002;

impl Furniture for ToyChest {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::WhiteLacquer, Finish::Wood, Finish::ColoredLacquer(rng.below(4) as u8)][rng.below(3)];
        Self { width: rng.range(0.6, 0.85), open: rng.below(2) == 0, finish }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH, HEIGHT + if self.open { 0.14 } else { 0.0 })
    }

    fn reach(&self) -> f32 {
        0.5
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = Vec2::new(0.5 * self.width - 0.04, 0.5 * DEPTH - 0.04);
        if self.open { Vec::new() } else { vec![Surface { min: -half, max: half, z: HEIGHT, headroom: f32::INFINITY }] }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chest = b.object("toy_chest", Class::Box, pose);
        let (x, y) = (0.5 * self.width - 0.01, 0.5 * DEPTH - 0.01);
        let (low, top) = (0.02, HEIGHT - 0.022);
        let walls = all([
            board([-x, y - BOARD, low], [x, y, top], 0.002),
            board([-x, -y, low], [x, BOARD - y, top], 0.002),
            board([-x, BOARD - y + GAP, low], [BOARD - x, y - BOARD - GAP, top], 0.002),
            board([x - BOARD, BOARD - y + GAP, low], [x, y - BOARD - GAP, top], 0.002),
            board([BOARD - x, BOARD - y, 0.03], [x - BOARD, y - BOARD, 0.044], 0.001),
        ]);
        b.part(&chest, "walls", grained(walls, rng), self.finish);
        b.part(&chest, "base", board([0.02 - x, 0.02 - y, 0.0], [x - 0.02, y - 0.02, 0.0302], 0.002), self.finish);
        let grip = |s: f32| board([s * 0.06 - 0.05, y - 0.0004, top - 0.075], [s * 0.06 + 0.05, y + 0.006, top - 0.055], 0.002);
        b.part(&chest, "grips", grip(-1.0).with(grip(1.0)), Finish::Wood);
        if !self.open {
            let lid = board([-x - 0.01, -y - 0.01, top + 0.0005], [x + 0.01, y + 0.01, HEIGHT], 0.004);
            b.part(&chest, "lid", grained(lid, rng), if self.finish == Finish::Wood { Finish::Wood } else { self.finish });
            b.joint(&chest, "lid", &Joint::lid(-y - 0.01, HEIGHT, LIFT, false), [b.part_count() - 1]);
            return;
        }
        // A blanket fills the chest; a bear on it looks out, and a ball lies beside the bear.
        let floor = HEIGHT - 0.18;
        let fill = board([BOARD - x + 0.002, BOARD - y + 0.002, 0.046], [x - BOARD - 0.002, y - BOARD - 0.002, floor], 0.01);
        let blanket = b.object("blanket", Class::OtherProp, pose);
        b.part(&blanket, "cloth", fill.uv_moved(Vec2::splat(rng.next_f32())), Finish::Accent(rng.below(3) as u8));
        let bear = PlushBear { height: 0.24, ..PlushBear::random(rng) };
        let bear = PlushBear { rabbit: false, ..bear };
        bear.build(b, on(pose, Vec3::new(0.14 - x + 0.5 * bear.size().x, 0.0, floor + CONTACT), 0.1), rng);
        Toy::Ball.build(b, on(pose, Vec3::new(x - 0.13, -0.03, floor + CONTACT), 0.0), rng);
    }
}
