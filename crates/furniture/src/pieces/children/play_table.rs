//! A low table of 60 to 72 cm, round or square, for children of three to six (class table), and a chair that fits it (class chair). Legs
//! are of wood, tops, seats and backs of wood or lacquer.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::{Furniture, Surface, board, grained, leg};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A table for children of three to six.
#[derive(Clone, Copy, Debug)]
pub struct PlayTable {
    /// Diameter, or edge length.
    pub width: f32,
    /// Round instead of square.
    pub round: bool,
    /// Finish of the top.
    pub top: Finish,
}

/// Height of the table, metres, by EN 1729 size mark 1.
const TABLE: f32 = 0.46;
/// Thickness of the top, metres.
const BOARD: f32 = 0.022;
/// Height of the seat, metres, by EN 1729 size mark 1.
const SEAT: f32 = 0.26;

impl Furniture for PlayTable {
    fn random(rng: &mut Rng) -> Self {
        let top = [Finish::WhiteLacquer, Finish::Wood, Finish::ColoredLacquer(rng.below(4) as u8)][rng.below(3)];
        Self { width: rng.range(0.6, 0.72), round: rng.below(2) == 0, top }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, self.width, TABLE)
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = Vec2::splat(if self.round { 0.34 } else { 0.46 } * self.width);
        vec![Surface { min: -half, max: half, z: TABLE, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let table = b.object("play_table", Class::Table, pose);
        let half = 0.5 * self.width;
        let top = if self.round {
            crate::pieces::form::cylinder(half, BOARD, 64).moved(Vec3::new(0.0, 0.0, TABLE - BOARD))
        } else {
            rounded_box(Vec3::new(self.width, self.width, BOARD), 0.008, 3).moved(Vec3::new(0.0, 0.0, TABLE - 0.5 * BOARD))
        };
        b.part(&table, "top", grained(top, rng), self.top);
        let stand = if self.round { 0.56 } else { 0.78 } * half;
        for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
            let mesh = leg(TABLE - 0.0222, [0.016, 0.022], s * 0.025).moved((s * stand).extend(0.0));
            b.part(&table, &format!("leg_{}", i + 1), grained(mesh, rng), Finish::Wood);
        }
    }
}

/// The chair that goes with a [`PlayTable`].
#[derive(Clone, Copy, Debug)]
pub struct ToyChair {
    /// Finish of seat and back.
    pub finish: Finish,
}

impl Furniture for ToyChair {
    fn random(rng: &mut Rng) -> Self {
        Self { finish: [Finish::WhiteLacquer, Finish::Wood, Finish::ColoredLacquer(rng.below(4) as u8)][rng.below(3)] }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.29, 0.33, 0.53)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("toy_chair", Class::Chair, pose);
        b.part(
            &chair,
            "seat",
            grained(rounded_box(Vec3::new(0.28, 0.27, 0.02), 0.008, 3).moved(Vec3::new(0.0, 0.015, SEAT - 0.01)), rng),
            self.finish,
        );
        for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
            let mesh = leg(SEAT - 0.0202, [0.012, 0.016], s * 0.02).moved((s * Vec2::new(0.108, 0.1) + Vec2::new(0.0, 0.012)).extend(0.0));
            b.part(&chair, &format!("leg_{}", i + 1), grained(mesh, rng), Finish::Wood);
        }
        let bent = |x: f32| -0.115 + 0.9 * x * x;
        let back = rounded_box(Vec3::new(0.27, 0.016, 0.13), 0.007, 3)
            .deformed(|p| Vec3::new(p.x, p.y + bent(p.x) - 0.03 - 0.1 * p.z, p.z + 0.455))
            .smoothed(40.0);
        b.part(&chair, "back", grained(back, rng), self.finish);
        for (i, x) in [-0.085f32, 0.085].into_iter().enumerate() {
            let post = board([x - 0.014, bent(x) - 0.024, SEAT - 0.005], [x + 0.014, bent(x) - 0.008, 0.47], 0.004);
            b.part(&chair, &format!("post_{}", i + 1), grained(post, rng), Finish::Wood);
        }
    }
}
