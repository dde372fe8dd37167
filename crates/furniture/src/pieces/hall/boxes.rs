//! Boxes, all of class box: cardboard boxes in four common sizes, about 30 to 60 cm long, shut with tape or with open flaps, and storage
//! boxes of 26 to 40 cm in felt, wicker, cardboard, plastic or cloth, with a lid or with grips.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, loft, wire};
use crate::pieces::{CONTACT, Furniture, Surface, board};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec3};

/// A cardboard box, shut with tape or with its flaps open.
#[derive(Clone, Copy, Debug)]
pub struct CardboardBox {
    /// Width, depth and height of the body.
    pub size: Vec3,
    /// The flaps are open.
    pub open: bool,
}

/// Thickness of corrugated board, metres.
const BOARD: f32 = 0.004;
/// Half the width of the tape, metres.
const TAPE: f32 = 0.025;

impl CardboardBox {
    /// The long flaps' length: half the depth, so that they meet.
    fn flap(&self) -> f32 {
        0.5 * self.size.y
    }

    fn flaps(&self, rng: &mut Rng) -> enfilade_geometry::Mesh {
        let (x, y, top) = (0.5 * self.size.x, 0.5 * self.size.y, self.size.z);
        let long = |side: f32, angle: f32| {
            let sheet = board([-x + 0.002, 0.0, 0.0], [x - 0.002, self.flap() - 0.002, BOARD], 0.001);
            // The sheet points inward when it is shut, and turns about the upper edge of its wall.
            let turned = sheet.turned(Vec3::X, angle);
            let turned = if side > 0.0 { turned.turned(Vec3::Z, std::f32::consts::PI) } else { turned };
            turned.moved(Vec3::new(0.0, side * (y - 0.001), top + 0.0005))
        };
        let short = |side: f32, angle: f32| {
            let sheet = board([-y + 0.003, 0.0, 0.0], [y - 0.003, 0.9 * self.flap(), BOARD], 0.001);
            sheet.turned(Vec3::X, angle).turned(Vec3::Z, side * std::f32::consts::FRAC_PI_2).moved(Vec3::new(
                side * (x - 0.001),
                0.0,
                top + 0.0005,
            ))
        };
        let mut angle = || rng.range(1.9, 2.5);
        all([long(-1.0, angle()), long(1.0, angle()), short(1.0, angle()), short(-1.0, angle())])
    }
}

impl Furniture for CardboardBox {
    fn random(rng: &mut Rng) -> Self {
        let sizes = [Vec3::new(0.6, 0.33, 0.34), Vec3::new(0.45, 0.35, 0.3), Vec3::new(0.35, 0.25, 0.2), Vec3::new(0.3, 0.3, 0.3)];
        Self { size: sizes[rng.below(4)] * rng.range(0.92, 1.05), open: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        if self.open {
            self.size + Vec3::new(self.size.y, self.size.y, 0.5 * self.size.y)
        } else {
            self.size + Vec3::new(0.002, 0.002, 0.006)
        }
    }

    fn surfaces(&self) -> Vec<Surface> {
        if self.open {
            return Vec::new();
        }
        let half = 0.5 * self.size.truncate() - 0.01;
        vec![Surface { min: -half, max: half, z: self.size.z + 0.0055, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("cardboard_box", Class::Box, pose);
        let s = self.size;
        let ring = |inset: f32, z: f32| [s.x - 2.0 * inset, s.y - 2.0 * inset, 0.003, z];
        if self.open {
            let body = loft(&[ring(0.0, CONTACT), ring(0.0, s.z), ring(BOARD, s.z), ring(BOARD, BOARD)], 1);
            b.part(&object, "body", body, Finish::Cardboard);
            b.part(&object, "flaps", self.flaps(rng), Finish::Cardboard);
            return;
        }
        b.part(&object, "body", loft(&[ring(0.0, CONTACT), ring(0.0, s.z), ring(0.001, s.z + 0.001)], 1), Finish::Cardboard);
        // The flaps meet in a joint along the middle, which tape covers.
        let halves = [-1.0f32, 1.0].map(|side| {
            let (a, c) = (side * 0.0006, side * (0.5 * s.y - 0.0015));
            board([-0.5 * s.x + 0.0015, a.min(c), s.z + 0.0011], [0.5 * s.x - 0.0015, a.max(c), s.z + 0.0045], 0.0012)
        });
        b.part(&object, "flaps", all(halves), Finish::Cardboard);
        let tape = board([-0.5 * s.x + 0.001, -TAPE, s.z + 0.0046], [0.5 * s.x - 0.001, TAPE, s.z + 0.005], 0.0001);
        let ends = [-1.0f32, 1.0].map(|side| {
            let x = side * (0.5 * s.x + 0.0003);
            board([x - 0.0002, -TAPE, s.z - 0.06], [x + 0.0002, TAPE, s.z + 0.0005], 0.0001)
        });
        b.part(&object, "tape", all([tape].into_iter().chain(ends)), Finish::Plastic(1));
    }
}

/// A box to keep things in, with a lid or open with grips of cord.
#[derive(Clone, Copy, Debug)]
pub struct StorageBox {
    /// Width, depth and height.
    pub size: Vec3,
    /// The box has a lid.
    pub lid: bool,
    /// Finish of its body.
    pub finish: Finish,
}

impl Furniture for StorageBox {
    fn random(rng: &mut Rng) -> Self {
        let size = Vec3::new(rng.range(0.26, 0.40), rng.range(0.26, 0.33), rng.range(0.14, 0.28));
        let finish =
            [Finish::Felt, Finish::Wicker, Finish::Cardboard, Finish::Plastic(rng.below(6) as u8), Finish::Clothes(3)][rng.below(5)];
        Self { size, lid: rng.below(2) == 0, finish }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x + 0.03, self.size.y + 0.012, self.size.z + if self.lid { 0.012 } else { 0.002 })
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("storage_box", Class::Box, pose);
        let s = self.size;
        let ring = |w: f32, z: f32| [s.x - w, s.y - w, 0.02, z];
        let body = loft(
            &[ring(0.024, CONTACT), ring(0.018, 0.004), ring(0.0, s.z), ring(0.004, s.z + 0.001), ring(0.010, s.z), ring(0.030, 0.008)],
            5,
        );
        b.part(&object, "body", body, self.finish);
        if self.lid {
            let lid = loft(
                &[
                    [s.x - 0.012, s.y - 0.012, 0.02, s.z + 0.0012],
                    [s.x + 0.008, s.y + 0.008, 0.022, s.z + 0.0013],
                    [s.x + 0.008, s.y + 0.008, 0.022, s.z + 0.009],
                    [s.x, s.y, 0.02, s.z + 0.012],
                ],
                5,
            );
            b.part(&object, "lid", lid, self.finish);
            let label = rounded_box(Vec3::new(0.07, 0.0015, 0.04), 0.0005, 1).moved(Vec3::new(0.0, 0.5 * s.y - 0.0015, 0.62 * s.z));
            b.part(&object, "label", label.moved(Vec3::Y * 0.0005), Finish::Paper);
            return;
        }
        let grips = [-1.0f32, 1.0].map(|side| {
            let x = side * (0.5 * s.x - 0.004);
            let p = |out: f32, y: f32, z: f32| [x + side * out, y, s.z + z];
            wire(
                &[p(-0.004, -0.05, -0.035), p(0.008, -0.045, -0.04), p(0.012, 0.0, -0.06), p(0.008, 0.045, -0.04), p(-0.004, 0.05, -0.035)],
                0.0045,
                10,
            )
        });
        b.part(&object, "grips", all(grips), if rng.below(2) == 0 { Finish::LeatherBag(0) } else { self.finish });
    }
}
