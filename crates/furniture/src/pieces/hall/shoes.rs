//! Pairs of shoes, 25 to 29.5 cm long: low shoes and boots of leather, and sports shoes of cloth on a thick white sole (class other prop,
//! toes to +y); and a shallow cabinet, 60 to 100 cm wide, with two or three tilting compartments for them (class cabinet).

use crate::builder::{Builder, Class};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::joinery::{Handle, body_finish, front};
use crate::pieces::{CONTACT, Furniture, Surface, board, grained, on};
use crate::shape::{Reshape, grid};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// A pair of shoes, toes to the front.
#[derive(Clone, Copy, Debug)]
pub struct Shoes {
    /// Length of the sole.
    pub length: f32,
    /// Height of the rim at the heel: 7 to 9 cm for low shoes, more for boots.
    pub shaft: f32,
    /// Sports shoes with a thick white sole.
    pub sport: bool,
}

impl Shoes {
    /// Half the width of a foot at `t` from heel (0) to toe (1), and how far its middle bends inward.
    fn foot(&self, t: f32) -> (f32, f32) {
        let half = 0.5
            * 0.36
            * self.length
            * (0.72 + 0.36 * (t - 0.15).clamp(0.0, 0.55) / 0.55)
            * (1.0 - ((t - 0.62).max(0.0) / 0.42).powi(3)).max(0.0).sqrt()
            * (1.0 - ((0.13 - t).max(0.0) / 0.16).powi(2)).sqrt();
        (half, 0.012 * (TAU * 0.5 * t).sin())
    }

    fn sole(&self, side: f32, thickness: f32) -> Mesh {
        let (nu, nv) = (20, 28);
        let section = |i: usize, j: usize| {
            let t = (j as f32 / nv as f32).clamp(0.004, 0.996);
            let (half, bend) = self.foot(t);
            let (sin, cos) = (TAU * (i % nu) as f32 / nu as f32).sin_cos();
            let blunt = |v: f32| v.signum() * v.abs().powf(0.35);
            let rise = 0.012 * (t - 0.75).max(0.0) / 0.25;
            Vec3::new(side * bend + (half + 0.003) * blunt(cos), (t - 0.5) * self.length, 0.5 * thickness * (1.0 + blunt(sin)) + rise)
        };
        let point = |i: usize, j: usize| {
            let k = j.clamp(1, nv + 1) - 1;
            if j == 0 || j == nv + 2 {
                let p = section(0, k) + section(nu / 2, k);
                return 0.5 * p;
            }
            section(nu - i % nu, k)
        };
        grid(nu, nv + 2, point, |i, j| Vec2::new(i as f32 * 0.01, j as f32 * 0.01)).smoothed(50.0)
    }

    /// From the sole up and over the instep to the rim of the shaft, and down inside.
    fn upper(&self, side: f32, base: f32) -> Mesh {
        let (nu, nv) = (32, 14);
        let opening = 0.40;
        let point = |i: usize, j: usize| {
            let a = TAU * (i % nu) as f32 / nu as f32;
            let (sin, cos) = a.sin_cos();
            // Around the foot: the outline of the sole by its angle.
            let t = 0.5 + 0.5 * sin.signum() * sin.abs().powf(0.8);
            let (half, bend) = self.foot(t.clamp(0.01, 0.99));
            let out = Vec2::new(side * bend + half * cos.signum() * cos.abs().powf(0.5), (t - 0.5) * (self.length - 0.008));
            // The opening: an oval towards the heel.
            let rim = Vec2::new(0.034 * cos, (0.235 * opening - 0.5 + 0.24) * self.length * 0.9 + 0.062 * sin);
            let s = (j as f32 / (nv - 3) as f32).min(1.0);
            let arch = (0.25 * TAU * s).sin();
            let p = out.lerp(rim, 1.0 - (0.25 * TAU * s).cos().max(0.0).powf(1.15));
            let height = base + (self.shaft - base) * arch.powf(1.1) * (1.0 - 0.10 * sin.max(0.0));
            if j + 3 > nv {
                let inward = (j + 3 - nv) as f32 / 3.0;
                let q = rim * Vec2::new(1.0 - 0.12 * inward, 1.0);
                return q.extend(height - 0.5 * inward * (self.shaft - base));
            }
            p.extend(height)
        };
        grid(nu, nv, point, |i, j| Vec2::new(i as f32 * 0.01, j as f32 * 0.01)).smoothed(70.0)
    }
}

impl Furniture for Shoes {
    fn random(rng: &mut Rng) -> Self {
        let sport = rng.below(2) == 0;
        let shaft = if !sport && rng.below(3) == 0 { rng.range(0.13, 0.2) } else { rng.range(0.07, 0.09) };
        Self { length: rng.range(0.25, 0.295), shaft, sport }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.29, self.length + 0.05, self.shaft + 0.006)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let shoes = b.object("shoes", Class::OtherProp, pose);
        let upper = if self.sport { Finish::Clothes(rng.below(8) as u8) } else { Finish::LeatherBag(rng.below(4) as u8) };
        let (thick, sole) = if self.sport { (0.026, Finish::WhitePlastic) } else { (0.016, Finish::Rubber) };
        for (name, side) in [("left", -1.0f32), ("right", 1.0)] {
            let at = on(DAffine3::IDENTITY, Vec3::new(side * 0.066, rng.range(-0.012, 0.012), CONTACT), side * rng.range(-0.14, 0.02));
            b.part_at(&shoes, &format!("sole_{name}"), self.sole(-side, thick), at, sole);
            b.part_at(&shoes, &format!("upper_{name}"), self.upper(-side, 0.6 * thick), at, upper);
        }
    }
}

/// A shallow cabinet with tilting compartments for shoes.
#[derive(Clone, Copy, Debug)]
pub struct ShoeCabinet {
    /// Width.
    pub width: f32,
    /// Compartments above each other.
    pub rows: usize,
    /// Finish of carcass and fronts.
    pub finishes: [Finish; 2],
    /// Handle of each front.
    pub handle: Handle,
}

/// Depth of the cabinet with its handles, metres: shoes stand upright in compartments that tilt.
const DEPTH: f32 = 0.26;
/// Height of a compartment, metres: the length of a shoe and some more.
const ROW: f32 = 0.34;
/// Angle to which a compartment tilts, radians.
const TILT: f64 = 0.7;
/// Height of the lowest compartment above the floor, metres.
const FOOT: f32 = 0.12;
/// Upper end of sides and rear, metres below the upper face of the top: the board and air that keeps faces out of one plane.
const BELOW_TOP: f32 = 0.0222;
/// Distance of bottom and rear from the ends, metres: a side and such air.
const BESIDE: f32 = 0.0202;

impl ShoeCabinet {
    fn height(&self) -> f32 {
        FOOT + ROW * self.rows as f32 + 0.05
    }
}

impl Furniture for ShoeCabinet {
    fn random(rng: &mut Rng) -> Self {
        let body = body_finish(rng);
        let front = [body, Finish::WhiteLacquer][rng.below(2)];
        let metal = [Finish::BlackMetal, Finish::Brass][rng.below(2)];
        Self {
            width: rng.range(0.6, 1.0),
            rows: 2 + rng.below(2),
            finishes: [body, front],
            handle: [Handle::Knob(metal), Handle::Bar(metal), Handle::None][rng.below(3)],
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH, self.height())
    }

    fn reach(&self) -> f32 {
        0.5
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = Vec2::new(0.5 * self.width, 0.5 * DEPTH);
        vec![Surface { min: -half, max: half - Vec2::Y * Handle::DEPTH, z: self.height(), headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let cabinet = b.object("shoe_cabinet", Class::Cabinet, pose);
        let (x, rear, face) = (0.5 * self.width, -0.5 * DEPTH, 0.5 * DEPTH - Handle::DEPTH - 0.021);
        let high = self.height();
        for (name, min, max) in [
            ("top", [-x, rear, high - 0.022], [x, face + 0.021, high]),
            ("side_left", [-x + 0.002, rear, 0.0], [-x + 0.02, face, high - BELOW_TOP]),
            ("side_right", [x - 0.02, rear, 0.0], [x - 0.002, face, high - BELOW_TOP]),
            ("bottom", [-x + BESIDE, rear + 0.01, FOOT - 0.018], [x - BESIDE, face, FOOT]),
            ("rear", [-x + BESIDE, rear + 0.002, FOOT + 0.0002], [x - BESIDE, rear + 0.009, high - BELOW_TOP]),
        ] {
            b.part(&cabinet, name, grained(board(min, max, 0.0015), rng), self.finishes[0]);
        }
        let row = (high - 0.0225 - FOOT) / self.rows as f32;
        for k in 0..self.rows {
            let z = FOOT + k as f32 * row;
            let rect = [-x + 0.0035, x - 0.0035, z + 0.0015, z + row - 0.0015];
            let from = b.part_count();
            b.part(&cabinet, &format!("flap_{}", k + 1), front(rect, face + 0.0008, 0.018, false, rng), self.finishes[1]);
            let at = Vec3::new(0.0, face + 0.0188, z + row - 0.06);
            self.handle.add(b, &cabinet, &format!("handle_{}", k + 1), at, 0.16, false);
            b.joint(&cabinet, &format!("flap_{}", k + 1), &Joint::flap(face + 0.0188, rect[2], TILT), from..b.part_count());
        }
    }
}
