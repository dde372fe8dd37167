//! A chaise longue, 155 to 175 × 72 cm, class sofa: a long padded seat with a raised end and a back that falls from there to the middle.
//! Dimensions are those of common models; the raised end is at −x or +x.

use super::feet::SeatFeet;
use super::quilt::{buttoned, upright};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::CONTACT;
use crate::pieces::form::turned;
use crate::shape::{Reshape, bendable_box, padded_box, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A long seat on which one person lies, with one raised end.
#[derive(Clone, Copy, Debug)]
pub struct ChaiseLongue {
    /// Length along x.
    pub length: f32,
    /// Raised end: −1 at −x, +1 at +x.
    pub side: f32,
    /// The seat is buttoned.
    pub buttoned: bool,
    /// What it stands on.
    pub feet: SeatFeet,
    /// Finish of all but the feet.
    pub cover: Finish,
}

/// Depth from the back to the front, metres.
const DEPTH: f32 = 0.72;
/// Height of the feet, metres.
const LEG: f32 = 0.16;
/// Height of the seat, metres.
const SEAT: f32 = 0.42;
/// Height of the raised end, metres.
const TOP: f32 = 0.76;
/// Radius of the roll on the raised end, metres.
const ROLL: f32 = 0.09;

impl ChaiseLongue {
    /// A random one.
    pub fn random(rng: &mut Rng) -> Self {
        Self {
            length: rng.range(1.55, 1.75),
            side: if rng.below(2) == 0 { -1.0 } else { 1.0 },
            buttoned: rng.below(2) == 0,
            feet: [SeatFeet::Buns(Finish::DarkWood), SeatFeet::Tapered(Finish::Wood), SeatFeet::Tapered(Finish::Brass)][rng.below(3)],
            cover: [Finish::Velvet, Finish::Leather, Finish::ArmchairCloth, Finish::Boucle][rng.below(4)],
        }
    }

    /// Size of the box around it.
    pub fn size(&self) -> Vec3 {
        Vec3::new(self.length + 0.02, DEPTH + 0.01, TOP + 0.02)
    }

    /// Adds its parts, as an object of `family`.
    pub fn build(&self, b: &mut Builder, family: &str, pose: DAffine3, rng: &mut Rng) {
        let object = b.object(family, Class::Sofa, pose);
        let (half, s) = (0.5 * self.length, self.side);
        let base = rounded_box(Vec3::new(self.length - 0.02, DEPTH - 0.01, SEAT - 0.1 - LEG), 0.03, 3);
        b.part(&object, "base", base.moved(Vec3::new(0.0, 0.0, 0.5 * (SEAT - 0.1 + LEG))), self.cover);
        // The end leans outward, and a roll closes it.
        let (wide, high) = (0.12, TOP - ROLL - SEAT + 0.11);
        let end = bendable_box(Vec3::new(wide, DEPTH - 0.004, high), 0.04, [1, 1, 6]);
        let end = end.deformed(|p| p + Vec3::X * s * 0.05 * (p.z / high + 0.5).powi(2)).smoothed(60.0);
        let x = s * (half - 0.135);
        b.part(&object, "end", end.moved(Vec3::new(x, 0.0, SEAT - 0.11 + 0.5 * high)), self.cover);
        let long = 0.5 * DEPTH;
        let profile = [[0.0, -long], [ROLL - 0.02, -long], [ROLL, 0.02 - long], [ROLL, long - 0.02], [ROLL - 0.02, long], [0.0, long]];
        let roll = turned(&profile, 40).turned(Vec3::X, FRAC_PI_2);
        b.part(&object, "end_roll", roll.moved(Vec3::new(s * (half - ROLL - 0.002), 0.0, TOP - ROLL)), self.cover);
        self.back(b, &object);
        let (from, to) = (0.012 - half, half - 0.19);
        let (thick, width) = (0.1, DEPTH - 0.09);
        let mut seat = padded_box(Vec3::new(to - from, width, thick), 0.035, 0.014);
        if self.buttoned {
            let [panel, buttons] = buttoned(Vec2::new(to - from, width), thick + 0.012, Vec2::new(0.2, 0.16));
            // A panel that stands is laid down.
            let lie = |mesh: enfilade_geometry::Mesh| mesh.turned(Vec3::X, FRAC_PI_2).moved(Vec3::new(0.0, 0.0, -0.5 * thick - 0.01));
            b.part(&object, "seat_buttons", lie(buttons).moved(Self::seat_middle(from, to, s)), self.cover);
            seat = lie(panel);
        }
        let seat = seat.uv_moved(Vec2::splat(rng.next_f32()));
        b.part(&object, "seat", seat.moved(Self::seat_middle(from, to, s)), self.cover);
        self.feet.add(b, &object, Vec2::new(half - 0.01, 0.5 * DEPTH), LEG, self.cover);
        let cushion = upright(padded_box(Vec3::new(0.34, 0.2, 0.12), 0.05, 0.02)).turned(Vec3::Z, s * FRAC_PI_2);
        let at = Vec3::new(s * (to - 0.075), 0.03, SEAT + 0.118);
        let bolster = b.object("cushion", Class::Pillow, crate::pieces::on(pose, at, 0.0));
        b.part(&bolster, "cover", cushion, Finish::Accent(rng.below(3) as u8));
    }

    fn seat_middle(from: f32, to: f32, s: f32) -> Vec3 {
        Vec3::new(s * 0.5 * (from + to), 0.035, SEAT - 0.05 + CONTACT)
    }

    /// The back: it falls from the raised end to the middle.
    fn back(&self, b: &mut Builder, object: &crate::builder::Object) {
        let (s, long, fat) = (self.side, 0.62 * self.length, 0.09);
        let high = TOP - 0.05 - SEAT + 0.11;
        let panel = upright(padded_box(Vec3::new(long, high, fat - 0.02), 0.03, 0.01));
        let panel = panel.deformed(|p| {
            let away = (0.5 - s * p.x / long).clamp(0.0, 1.0);
            let fall = 0.75 * away * away * (3.0 - 2.0 * away);
            Vec3::new(p.x, p.y, (p.z + 0.5 * high) * (1.0 - fall) - 0.5 * high)
        });
        let at = Vec3::new(s * (0.5 * self.length - 0.1 - 0.5 * long), -0.5 * DEPTH + 0.5 * fat, SEAT - 0.11 + 0.5 * high);
        b.part(object, "back", panel.smoothed(60.0).moved(at), self.cover);
    }
}
