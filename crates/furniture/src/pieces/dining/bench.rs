//! A wooden bench without a back for a long side of a table, 100 to 160 cm long, on slanted legs or on two boards with a rail; class other
//! furniture. Half of them have a cushion in an accent colour, an object of class pillow.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::all;
use crate::pieces::{CONTACT, Furniture, Surface, board, grained, leg};
use crate::shape::{Reshape, padded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A bench without a back, for a long side of a table.
#[derive(Clone, Copy, Debug)]
pub struct DiningBench {
    /// Length along x.
    pub length: f32,
    /// A cushion lies on the seat.
    pub cushion: bool,
    /// Stands on slanted legs instead of boards.
    pub legs: bool,
}

/// Height of the seat, metres: the same as for dining chairs.
const SEAT: f32 = 0.45;
/// Depth of the seat, metres.
const DEPTH: f32 = 0.36;
/// Distance of the boards that carry the seat from its ends, metres.
const OVERHANG: f32 = 0.12;

impl Furniture for DiningBench {
    fn random(rng: &mut Rng) -> Self {
        Self { length: rng.range(1.0, 1.6), cushion: rng.below(2) == 0, legs: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length, DEPTH, SEAT + if self.cushion { 0.055 } else { 0.0 })
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = Vec2::new(0.5 * self.length - 0.04, 0.5 * DEPTH - 0.03);
        if self.cushion { Vec::new() } else { vec![Surface { min: -half, max: half, z: SEAT, headroom: f32::INFINITY }] }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let bench = b.object("dining_bench", Class::OtherFurniture, pose);
        let half = 0.5 * self.length;
        b.part(&bench, "seat", grained(board([-half, -0.5 * DEPTH, SEAT - 0.035], [half, 0.5 * DEPTH, SEAT], 0.004), rng), Finish::Wood);
        if self.legs {
            for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
                let at = Vec3::new(s.x * (half - 0.13), s.y * (0.5 * DEPTH - 0.07), 0.0);
                b.part(
                    &bench,
                    &format!("leg_{}", i + 1),
                    grained(leg(SEAT - 0.0352, [0.014, 0.022], s * Vec2::new(0.05, 0.04)).moved(at), rng),
                    Finish::Wood,
                );
            }
        } else {
            let side = |x: f32| board([x - 0.018, -0.5 * DEPTH + 0.02, 0.0], [x + 0.018, 0.5 * DEPTH - 0.02, SEAT - 0.0352], 0.003);
            let rail = board([OVERHANG - half, -0.012, SEAT - 0.13], [half - OVERHANG, 0.012, SEAT - 0.0354], 0.002);
            b.part(&bench, "stand", grained(all([side(OVERHANG - half), side(half - OVERHANG), rail]), rng), Finish::Wood);
        }
        if self.cushion {
            let pad = padded_box(Vec3::new(self.length - 0.03, DEPTH - 0.02, 0.04), 0.016, 0.006).uv_moved(Vec2::splat(rng.next_f32()));
            let cushion = b.object("bench_cushion", Class::Pillow, pose);
            b.part(&cushion, "cover", pad.moved(Vec3::new(0.0, 0.0, SEAT + CONTACT + 0.026)), Finish::Accent(rng.below(3) as u8));
        }
    }
}
