//! A sofa of two or three seats on wooden legs, 57 to 64 cm high at the arms, with loose seat and back cushions (class sofa, one object),
//! two to four scatter cushions (class pillow) and, two times in three, a knitted throw over one arm (class other prop). The seats are 82
//! to 92 cm wide for two and 62 to 68 cm for three, an arm 13 to 20 cm.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::{CONTACT, Furniture, leg, on};
use crate::shape::{Reshape, grid, padded_box, pillow, rounded_box, rounded_loop, tube};
use enfilade_math::{DAffine3, DVec3, Rng, Vec2, Vec3};
use std::f32::consts::PI;

/// A sofa with loose seat and back cushions, scatter cushions and perhaps a throw over one arm.
#[derive(Clone, Copy, Debug)]
pub struct LooseSofa {
    /// Places to sit.
    pub seats: usize,
    /// Width of one seat.
    pub seat_width: f32,
    /// Width of an arm.
    pub arm: f32,
    /// Height of the arms.
    pub arm_height: f32,
    /// Scatter cushions.
    pub pillows: usize,
    /// A throw over the left (−1) or right (+1) arm.
    pub throw: Option<f32>,
}

/// Depth from the back to the front of the arms, metres.
const DEPTH: f32 = 0.92;
/// Height of the legs, metres.
const LEG: f32 = 0.13;
/// Height of the seat where the cushions are sewn, metres; in their middle they swell 2 cm above it.
const SEAT: f32 = 0.43;
/// Height of the back, metres: its frame ends 6 cm below, its cushions rise above.
const BACK: f32 = 0.80;
/// Thickness of the frame behind the back cushions, metres.
const BACK_FRAME: f32 = 0.17;
/// Height of the upholstered base between legs and seat cushions, metres.
const BASE: f32 = 0.14;

impl LooseSofa {
    fn inner_width(&self) -> f32 {
        self.seats as f32 * self.seat_width
    }

    fn frame(&self, b: &mut Builder, sofa: &crate::builder::Object) {
        let (cloth, inner) = (Finish::SofaCloth, self.inner_width());
        let front = 0.5 * DEPTH;
        let base_depth = DEPTH - BACK_FRAME - 0.012;
        let base = rounded_box(Vec3::new(inner - 0.004, base_depth, BASE), 0.02, 2);
        b.part(sofa, "base", base.moved(Vec3::new(0.0, front - 0.01 - 0.5 * base_depth, LEG + 0.5 * BASE)), cloth);
        let back = rounded_box(Vec3::new(inner - 0.004, BACK_FRAME, BACK - LEG - 0.06), 0.045, 3);
        b.part(sofa, "back", back.moved(Vec3::new(0.0, 0.5 * BACK_FRAME - front, 0.5 * (BACK - 0.06 + LEG))), cloth);
        for (name, side) in [("arm_left", -1.0), ("arm_right", 1.0)] {
            let arm = rounded_box(Vec3::new(self.arm, DEPTH, self.arm_height - LEG), 0.045, 3);
            let x = side * 0.5 * (inner + self.arm);
            b.part(sofa, name, arm.moved(Vec3::new(x, 0.0, 0.5 * (self.arm_height + LEG))), cloth);
            for (end, y) in [("front", front - 0.09), ("back", 0.09 - front)] {
                let mesh = leg(LEG + 0.002, [0.014, 0.022], Vec2::new(side * 0.02, 0.025 * y.signum()));
                let at = DAffine3::from_translation(DVec3::new(f64::from(x - side * 0.01), f64::from(y), 0.0));
                b.part_at(sofa, &format!("leg_{end}_{}", &name[4..]), mesh, at, Finish::Wood);
            }
        }
    }

    fn cushions(&self, b: &mut Builder, sofa: &crate::builder::Object, rng: &mut Rng) {
        let cloth = Finish::SofaCloth;
        let depth = DEPTH - BACK_FRAME - 0.004;
        let (width, thickness) = (self.seat_width - 0.006, SEAT - LEG - BASE - 0.012);
        for i in 0..self.seats {
            let x = (i as f32 + 0.5) * self.seat_width - 0.5 * self.inner_width();
            let swell = rng.range(0.018, 0.026);
            let seat = padded_box(Vec3::new(width, depth, thickness), 0.035, swell)
                .with(piping(Vec2::new(width, depth), 0.5 * thickness - 0.026))
                .uv_moved(Vec2::splat(rng.next_f32()));
            let at = Vec3::new(x, 0.5 * DEPTH - 0.5 * depth + 0.004, LEG + BASE + CONTACT + 0.5 * thickness);
            b.part(sofa, &format!("seat_cushion_{}", i + 1), seat.moved(at), cloth);
            let (height, fat) = (rng.range(0.41, 0.425), 0.15);
            let lean = rng.range(0.17, 0.21);
            let back = padded_box(Vec3::new(width, height, fat), 0.05, rng.range(0.03, 0.042))
                .with(piping(Vec2::new(width, height), 0.5 * fat - 0.038))
                .turned(Vec3::Z, rng.range(-0.008, 0.008))
                .turned(Vec3::X, 0.5 * PI)
                .turned(Vec3::Z, PI)
                .turned(Vec3::X, lean)
                .uv_moved(Vec2::splat(rng.next_f32()));
            let at = Vec3::new(x, BACK_FRAME - 0.5 * DEPTH + 0.5 * fat + 0.035, SEAT + 0.012 + 0.5 * height * lean.cos());
            b.part(sofa, &format!("back_cushion_{}", i + 1), back.moved(at), cloth);
        }
    }

    fn scatter(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let half = 0.5 * self.inner_width();
        let places = [-half + 0.25, half - 0.25, -half + 0.67, half - 0.67];
        for (i, &x) in places.iter().take(self.pillows).enumerate() {
            let size = if i < 2 { 0.47 } else { 0.38 };
            let side = x.signum();
            let mesh = pillow(Vec2::new(size, size * if i == 2 { 0.72 } else { 1.0 }), rng.range(0.14, 0.17), rng);
            let tall = if i == 2 { 0.72 * size } else { size };
            let lean = rng.range(0.30, 0.40);
            let y = BACK_FRAME - 0.5 * DEPTH + 0.15 + if i < 2 { 0.155 } else { 0.235 };
            let at = Vec3::new(x + rng.range(-0.03, 0.03), y, SEAT + 0.024 + 0.46 * tall * lean.cos());
            let local = on(pose, at, side * rng.range(0.12, 0.3))
                * DAffine3::from_rotation_x(f64::from(0.5 * PI + lean))
                * DAffine3::from_rotation_z(f64::from(rng.range(-0.07, 0.07)));
            let object = b.object("cushion", Class::Pillow, local);
            b.part(&object, "cover", mesh.uv_moved(Vec2::splat(rng.next_f32())), Finish::Accent((i % 3) as u8));
        }
    }

    fn drape(&self, b: &mut Builder, pose: DAffine3, side: f32, rng: &mut Rng) {
        /// Air between the throw and the arm, metres: the knit must not cut into the cloth below.
        const GAP: f32 = 0.006;
        let (nu, nv) = (36, 24);
        let half = 0.5 * self.arm + GAP;
        let (top, round) = (self.arm_height + GAP, 0.051);
        // Up the inner side of the arm, over it, and down the outside.
        let inside = top - SEAT - 0.04;
        let arc = 0.5 * PI * round;
        let flat = 2.0 * (half - round);
        let total = inside - round + 2.0 * arc + flat + (top - 0.27 - round);
        let section = |s: f32| {
            let mut s = s * total;
            if s < inside - round {
                return Vec2::new(-half, top - inside + s);
            }
            s -= inside - round;
            if s < arc {
                let a = s / round;
                return Vec2::new(-half + round - round * a.cos(), top - round + round * a.sin());
            }
            s -= arc;
            if s < flat {
                return Vec2::new(-half + round + s, top);
            }
            s -= flat;
            if s < arc {
                let a = s / round;
                return Vec2::new(half - round + round * a.sin(), top - round + round * a.cos());
            }
            Vec2::new(half, top - round - (s - arc))
        };
        let (phase, width) = (rng.range(0.0, 6.0), rng.range(0.42, 0.52));
        let point = |i: usize, j: usize| {
            let (s, t) = (i as f32 / nu as f32, j as f32 / nv as f32);
            let p = section(s);
            let ripple = 0.004 * (1.0 + (t * 19.0 + phase + 1.5 * s).sin()) * (2.0 * (s - 0.45)).abs().min(1.0);
            let out = if p.x < 0.0 && p.y < top - round {
                -ripple
            } else if p.y < top - round {
                ripple
            } else {
                0.0
            };
            let y = (t - 0.5) * width * (1.0 + 0.05 * (s - 0.5)) + 0.02 * (s * 2.0 + phase).sin();
            Vec3::new(side * (p.x + out), side * y, p.y + 0.3 * ripple)
        };
        let mesh = grid(nu, nv, point, |i, j| Vec2::new(i as f32 / nu as f32 * total, j as f32 / nv as f32 * width)).smoothed(80.0);
        let at = Vec3::new(side * 0.5 * (self.inner_width() + self.arm), rng.range(0.02, 0.12), 0.0);
        let object = b.object("throw", Class::OtherProp, on(pose, at, 0.0));
        b.part(&object, "knit", mesh, Finish::KnittedThrow);
    }
}

/// The sewn edge around the upper rim of a cushion.
fn piping(size: Vec2, z: f32) -> enfilade_geometry::Mesh {
    tube(&rounded_loop(size.x - 0.012, size.y - 0.012, 0.03, 4), 0.0045, 6).moved(Vec3::new(0.0, 0.0, z))
}

impl Furniture for LooseSofa {
    fn random(rng: &mut Rng) -> Self {
        let seats = 2 + rng.below(2);
        let seat_width = if seats == 2 { rng.range(0.82, 0.92) } else { rng.range(0.62, 0.68) };
        let throw = [None, Some(-1.0), Some(1.0)][rng.below(3)];
        Self { seats, seat_width, arm: rng.range(0.13, 0.2), arm_height: rng.range(0.57, 0.64), pillows: 2 + rng.below(3), throw }
    }

    fn size(&self) -> Vec3 {
        let throw = if self.throw.is_some() { 0.03 } else { 0.0 };
        Vec3::new(self.inner_width() + 2.0 * self.arm + throw, DEPTH + 0.028, BACK + 0.1)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let sofa = b.object("sofa", Class::Sofa, pose);
        self.frame(b, &sofa);
        self.cushions(b, &sofa, rng);
        self.scatter(b, pose, rng);
        if let Some(side) = self.throw {
            self.drape(b, pose, side, rng);
        }
    }
}
