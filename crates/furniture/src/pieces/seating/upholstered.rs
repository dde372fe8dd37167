//! Upholstered sofas and easy chairs: arms, back, seat and feet as a row of a table of styles combines them. Depths are 80 to 105 cm, seats
//! 38 to 48 cm high (Neufert, Architects' Data: 40 to 45 cm); what is loose on them are objects of class pillow.

use super::arms::{ArmSpan, Arms};
use super::back::{Back, BackSpan};
use super::feet::SeatFeet;
use super::quilt::upright;
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::rod;
use crate::pieces::{CONTACT, on};
use crate::shape::{Reshape, padded_box, pillow, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A style of upholstered seats. Lengths are in metres.
#[derive(Clone, Copy, Debug)]
pub struct Seat {
    /// Shape of the arms.
    pub arms: Arms,
    /// Width of an arm.
    pub arm: f32,
    /// Height of the arms.
    pub arm_height: f32,
    /// The back.
    pub back: Back,
    /// Height of the back.
    pub top: f32,
    /// One cushion over all seats instead of one for each.
    pub bench: bool,
    /// What it stands on.
    pub feet: SeatFeet,
    /// Height of the feet.
    pub leg: f32,
    /// Depth from the back to the front.
    pub depth: f32,
    /// Height of the seat.
    pub seat: f32,
    /// Each seat has a foot rest that is folded in, and a lever.
    pub reclines: bool,
    /// Smallest and largest number of seats.
    pub seats: [usize; 2],
    /// Smallest and largest width of a seat.
    pub wide: [f32; 2],
    /// Covers, equally frequent.
    pub covers: &'static [Finish],
}

/// An upholstered sofa or easy chair.
#[derive(Clone, Copy, Debug)]
pub struct Upholstered {
    /// The style.
    pub style: Seat,
    /// Places to sit: one is an easy chair.
    pub seats: usize,
    /// Width of one seat.
    pub seat_width: f32,
    /// Finish of everything but the feet.
    pub cover: Finish,
    /// Scatter cushions.
    pub pillows: usize,
}

impl Upholstered {
    /// A seat of this style.
    pub fn of(style: Seat, rng: &mut Rng) -> Self {
        let [low, high] = style.seats;
        let seats = low + rng.below(high - low + 1);
        let pillows = if seats == 1 { rng.below(2) } else { rng.below(5) };
        let cover = style.covers[rng.below(style.covers.len())];
        let seat_width = rng.range(style.wide[0], style.wide[1]);
        // Cushions stand side by side: two at the ends, then more where there is room between these.
        let room = match seats as f32 * seat_width {
            ..1.3 => 2,
            1.3..1.72 => 3,
            _ => 4,
        };
        Self { style, seats, seat_width, cover, pillows: pillows.min(room) }
    }

    fn inner(&self) -> f32 {
        self.seats as f32 * self.seat_width
    }

    /// Width with the arms.
    fn outer(&self) -> f32 {
        let arm = if self.style.arms == Arms::None { 0.0 } else { self.style.arm };
        self.inner() + 2.0 * arm
    }

    /// Size of the box around it.
    pub fn size(&self) -> Vec3 {
        let style = &self.style;
        let high = if self.pillows > 0 { (style.seat + 0.5).max(style.top + 0.08) } else { style.top + 0.08 };
        // Cushions swell where no arm is beside them.
        let aside = if style.arms == Arms::None { 0.01 } else { style.arms.overhang() + 0.002 };
        Vec3::new(self.outer() + 2.0 * aside, style.depth + 0.028, high.max(style.arm_height + 0.03))
    }

    /// Adds its parts, as an object of `family`.
    pub fn build(&self, b: &mut Builder, family: &str, pose: DAffine3, rng: &mut Rng) {
        let (style, cover) = (&self.style, self.cover);
        let object = b.object(family, if self.seats == 1 { Class::Chair } else { Class::Sofa }, pose);
        let (rear, front) = (-0.5 * style.depth, 0.5 * style.depth);
        let (inner, base) = (self.inner(), style.seat - 0.14);
        let frame = rounded_box(Vec3::new(inner - 0.004, style.depth - 0.03, base - style.leg), 0.02, 2);
        b.part(&object, "base", frame.moved(Vec3::new(0.0, 0.003, 0.5 * (base + style.leg))), cover);
        let z = [style.leg + 0.001, style.arm_height];
        let span = ArmSpan { inner: 0.5 * inner, wide: style.arm, y: [rear, front], z, top: style.top };
        style.arms.add(b, &object, span, cover);
        let span = BackSpan { width: inner, seats: self.seats, rear, low: style.leg + 0.002, seat: style.seat, top: style.top };
        style.back.add(b, &object, span, cover, rng);
        self.cushions(b, &object, rng);
        style.feet.add(b, &object, Vec2::new(0.5 * self.outer(), front), style.leg, cover);
        if style.reclines {
            self.rests(b, &object);
        }
        self.scatter(b, pose, rng);
    }

    fn cushions(&self, b: &mut Builder, object: &Object, rng: &mut Rng) {
        let style = &self.style;
        let (back, front) = (style.back.thick() - 0.5 * style.depth - 0.004, 0.5 * style.depth + 0.004);
        let (count, thick) = (if style.bench { 1 } else { self.seats }, 0.13);
        let wide = self.inner() / count as f32;
        for k in 0..count {
            let swell = rng.range(0.016, 0.024);
            let mesh = padded_box(Vec3::new(wide - 0.006, front - back, thick), 0.035, swell).uv_moved(Vec2::splat(rng.next_f32()));
            let at =
                Vec3::new((k as f32 + 0.5) * wide - 0.5 * self.inner(), 0.5 * (front + back), style.seat - 0.14 + CONTACT + 0.5 * thick);
            b.part(object, &format!("seat_cushion_{}", k + 1), mesh.moved(at), self.cover);
        }
    }

    /// Folded foot rests before the base, and the lever that lets them out.
    fn rests(&self, b: &mut Builder, object: &Object) {
        let style = &self.style;
        let front = 0.5 * style.depth - 0.012;
        let (low, high) = (style.leg + 0.02, style.seat - 0.13);
        for k in 0..self.seats {
            let pad = upright(padded_box(Vec3::new(self.seat_width - 0.012, high - low, 0.036), 0.015, 0.004));
            let x = (k as f32 + 0.5) * self.seat_width - 0.5 * self.inner();
            b.part(object, &format!("foot_rest_{}", k + 1), pad.moved(Vec3::new(x, front + 0.004, 0.5 * (low + high))), self.cover);
        }
        // Its plate lies in the side of the arm; the handle does not protrude.
        let x = 0.5 * self.outer() - 0.006;
        let lever = rod([x, 0.1, 0.34], [x, 0.22, 0.36], 0.008, 10);
        b.part(object, "lever", lever, Finish::BlackPlastic);
    }

    fn scatter(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let half = 0.5 * self.inner();
        let ends = [-half + 0.26, half - 0.26, -half + 0.66, half - 0.66];
        let places = if self.seats == 1 { [0.0; 4] } else { ends };
        for (i, &x) in places.iter().take(self.pillows).enumerate() {
            let size = if self.seats > 1 && i < 2 { rng.range(0.43, 0.5) } else { rng.range(0.34, 0.4) };
            let (lean, fat) = (rng.range(0.3, 0.4), rng.range(0.13, 0.16));
            let mesh = pillow(Vec2::splat(size), fat, rng).uv_moved(Vec2::splat(rng.next_f32()));
            let y = self.style.back.front() - 0.5 * self.style.depth + 0.13 + if i < 2 { 0.0 } else { 0.08 };
            let at = Vec3::new(x + rng.range(-0.02, 0.02), y, self.style.seat + 0.02 + 0.46 * size * lean.cos());
            let turn = if self.seats == 1 { rng.range(-0.1, 0.1) } else { x.signum() * rng.range(0.08, 0.26) };
            let local = on(pose, at, turn)
                * DAffine3::from_rotation_x(f64::from(FRAC_PI_2 + lean))
                * DAffine3::from_rotation_z(f64::from(rng.range(-0.07, 0.07)));
            let object = b.object("cushion", Class::Pillow, local);
            b.part(&object, "cover", mesh, Finish::Accent((i % 3) as u8));
        }
    }
}
