//! A stool without a back, 36 to 38 cm wide and 46 cm high, class chair: a round or square seat on three or four legs that slant.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, around, rod, turned};
use crate::pieces::{grained, standing};
use crate::shape::{Reshape, rounded_box, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_4;

/// A stool without a back.
#[derive(Clone, Copy, Debug)]
pub struct Stool {
    /// A square seat on four legs instead of a round one on three.
    pub square: bool,
    /// Finish of the seat.
    pub seat: Finish,
    /// Finish of the legs.
    pub legs: Finish,
}

/// Height of the seat, metres.
const SEAT: f32 = 0.46;

impl Stool {
    /// Size of the box around it.
    pub const SIZE: Vec3 = Vec3::new(0.4, 0.4, SEAT);

    /// A random one.
    pub fn random(rng: &mut Rng) -> Self {
        let seat = [Finish::Wood, Finish::Wood, Finish::DarkWood, Finish::ColoredLacquer(rng.below(2) as u8)][rng.below(4)];
        Self { square: rng.below(2) == 0, seat, legs: [Finish::Wood, seat][rng.below(2)] }
    }

    /// Adds its parts.
    pub fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let stool = b.object("chair", Class::Chair, pose);
        let (thick, r) = (0.03, 0.17);
        let seat = if self.square {
            rounded_box(Vec3::new(2.0 * r, 2.0 * r, thick), 0.01, 3).moved(Vec3::Z * (SEAT - 0.5 * thick))
        } else {
            let low = SEAT - thick;
            let profile = [[0.0, low], [r - 0.006, low], [r, low + 0.008], [r, SEAT - 0.006], [r - 0.006, SEAT], [0.0, SEAT - 0.004]];
            let mut top = turned(&profile, 48);
            top.uvs.iter_mut().zip(&top.positions).for_each(|(uv, p)| *uv = Vec2::new(p.x, p.y + p.z));
            top
        };
        b.part(&stool, "seat", grained(seat, rng), self.seat);
        let (count, start) = if self.square { (4, FRAC_PI_4) } else { (3, 0.5) };
        let at = |d: Vec2, z: f32| (d * (0.185 - 0.07 * z / SEAT)).extend(z);
        let legs = around(count, start).map(|d| standing(tube(&[at(d, 0.0), at(d, SEAT - thick + 0.002)], 0.0145, 14)));
        let directions: Vec<Vec2> = around(count, start).collect();
        let bars = (0..count).map(|k| rod(at(directions[k], 0.17).to_array(), at(directions[(k + 1) % count], 0.17).to_array(), 0.008, 10));
        b.part(&stool, "legs", grained(all(legs.chain(bars)), rng), self.legs);
    }
}
