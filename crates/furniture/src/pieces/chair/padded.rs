//! A chair that is padded all over, 47 × 60 cm and 92 to 104 cm high, class chair: a box to sit on and a straight back down to it, on square
//! legs, or with a loose cover that hangs to the floor.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::board;
use crate::pieces::form::corners;
use crate::pieces::seating::{buttoned, skirt, upright};
use crate::shape::{Reshape, padded_box, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A chair that is padded all over.
#[derive(Clone, Copy, Debug)]
pub struct PaddedChair {
    /// Height of the back.
    pub top: f32,
    /// Finish of the padding.
    pub cover: Finish,
    /// A loose cover hangs to the floor.
    pub covered: bool,
    /// The back is buttoned.
    pub buttoned: bool,
}

/// Height of the seat, metres.
const SEAT: f32 = 0.465;
/// Half the width, metres.
const HALF: f32 = 0.23;
/// Rear side of the back and front of the seat, metres.
const Y: [f32; 2] = [-0.245, 0.245];

impl PaddedChair {
    /// A random one.
    pub fn random(rng: &mut Rng) -> Self {
        let covered = rng.below(4) == 0;
        let cover = if covered {
            Finish::CurtainLinen
        } else {
            [Finish::Leather, Finish::ArmchairCloth, Finish::Velvet, Finish::SofaCloth][rng.below(4)]
        };
        Self { top: rng.range(0.92, 1.04), cover, covered, buttoned: !covered && rng.below(3) == 0 }
    }

    /// Size of the box around it.
    pub fn size(&self) -> Vec3 {
        Vec3::new(2.0 * HALF + 0.01, 0.56, self.top + 0.015)
    }

    /// Adds its parts.
    pub fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("chair", Class::Chair, pose);
        let offset = Vec2::splat(rng.next_f32());
        let base = rounded_box(Vec3::new(2.0 * HALF - 0.006, Y[1] - Y[0] - 0.004, 0.07), 0.012, 2);
        b.part(&chair, "base", base.moved(Vec3::new(0.0, 0.0, SEAT - 0.115)), self.cover);
        let depth = Y[1] - Y[0] - 0.07;
        let seat = padded_box(Vec3::new(2.0 * HALF, depth, 0.075), 0.028, 0.012).uv_moved(offset);
        b.part(&chair, "seat", seat.moved(Vec3::new(0.0, Y[1] - 0.5 * depth, SEAT - 0.047)), self.cover);
        let (low, tall) = (SEAT - 0.1, self.top - SEAT + 0.1);
        let lean = |p: Vec3| Vec3::new(p.x, p.y - 0.03 * (p.z / tall + 0.5).powi(2), p.z);
        let back = upright(padded_box(Vec3::new(2.0 * HALF - 0.004, tall, 0.06), 0.026, 0.006)).deformed(lean).smoothed(60.0);
        let at = Vec3::new(0.0, Y[0] + 0.042, low + 0.5 * tall);
        b.part(&chair, "back", back.uv_moved(offset).moved(at), self.cover);
        if self.buttoned {
            let high = tall - 0.14;
            let [panel, buttons] = buttoned(Vec2::new(2.0 * HALF - 0.06, high), 0.035, Vec2::new(0.15, 0.11));
            let place = |mesh: enfilade_geometry::Mesh| {
                mesh.moved(Vec3::new(0.0, 0.02, 0.5 * (tall - high) - 0.03)).deformed(lean).smoothed(60.0).moved(at)
            };
            b.part(&chair, "back_pad", place(panel.uv_moved(offset)), self.cover);
            b.part(&chair, "back_buttons", place(buttons), self.cover);
        }
        let legs = corners(Vec2::new(HALF - 0.035, Y[1] - 0.035));
        for (i, at) in legs.into_iter().enumerate() {
            let leg = board([at.x - 0.021, at.y - 0.021, 0.0], [at.x + 0.021, at.y + 0.021, SEAT - 0.14], 0.003);
            b.part(&chair, &format!("leg_{}", i + 1), leg, Finish::DarkWood);
        }
        if self.covered {
            let folds = skirt(Vec2::new(2.0 * HALF + 0.008, Y[1] - Y[0] + 0.006), [0.012, SEAT - 0.085]);
            b.part(&chair, "skirt", folds, self.cover);
        }
    }
}
