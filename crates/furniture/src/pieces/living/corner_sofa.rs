//! A sofa around a corner, class sofa: a long side of 240 to 300 cm along the back, and at one end a chaise that reaches 150 to 180 cm to
//! the front. All but its black legs has one cover; the scatter cushions are objects of class pillow. Blocks are placed by their distance
//! from the back.

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::{CONTACT, Furniture, leg, on};
use crate::shape::{Reshape, padded_box, pillow, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

/// A sofa around a corner: a long side along the back and a chaise to the front at one end.
#[derive(Clone, Copy, Debug)]
pub struct CornerSofa {
    /// Width of the long side, with its arm.
    pub width: f32,
    /// Length of the chaise from the back to the front, metres.
    pub chaise: f32,
    /// Side of the chaise: −1 at −x, +1 at +x.
    pub side: f32,
    /// Finish of everything but the legs.
    pub cloth: Finish,
    /// Scatter cushions.
    pub pillows: usize,
}

/// Depth of the long side, metres.
const DEPTH: f32 = 0.95;
/// Width of the chaise, metres.
const CHAISE: f32 = 0.92;
/// Width of the arm, metres.
const ARM: f32 = 0.2;
/// Thickness of the back, metres.
const BACK: f32 = 0.2;
/// Height of the legs, metres.
const LEG: f32 = 0.07;
/// Height of the base's upper side, metres.
const BASE: f32 = 0.27;
/// Height of the seat, metres.
const SEAT: f32 = 0.42;
/// Height of the back without its cushions, metres.
const TOP: f32 = 0.68;

impl CornerSofa {
    /// The floor before the long side: its middle beside the middle of the sofa, its width, and its distance from the back.
    pub fn before(&self) -> [f32; 3] {
        [-0.5 * CHAISE * self.side, self.width - CHAISE, DEPTH]
    }

    /// Adds a box of the sofa between two corners, whose y is counted from the sofa's back.
    fn block(&self, b: &mut Builder, sofa: &Object, name: &str, min: [f32; 3], max: [f32; 3], round: f32) {
        let (min, max) = (Vec3::from_array(min), Vec3::from_array(max));
        let mesh = rounded_box(max - min, round, 3).moved(0.5 * (min + max) - Vec3::new(0.0, 0.5 * self.chaise, 0.0));
        b.part(sofa, name, mesh, self.cloth);
    }

    fn cushion(&self, b: &mut Builder, sofa: &Object, name: &str, min: Vec2, max: Vec2, rng: &mut Rng) {
        let size = (max - min - 0.006).extend(SEAT - BASE - 0.016);
        let mesh = padded_box(size, 0.04, rng.range(0.012, 0.02)).uv_moved(Vec2::splat(rng.next_f32()));
        let middle = 0.5 * (min + max) - Vec2::new(0.0, 0.5 * self.chaise);
        b.part(sofa, name, mesh.moved(middle.extend(0.5 * (SEAT + BASE))), self.cloth);
    }
}

impl Furniture for CornerSofa {
    fn random(rng: &mut Rng) -> Self {
        let cloth = [Finish::SofaCloth, Finish::SofaCloth, Finish::Leather, Finish::Velvet, Finish::Boucle][rng.below(5)];
        let side = if rng.below(2) == 0 { -1.0 } else { 1.0 };
        Self { width: rng.range(2.4, 3.0), chaise: rng.range(1.5, 1.8), side, cloth, pillows: 2 + rng.below(4) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width + 0.012, self.chaise + 0.012, 0.93)
    }

    fn reach(&self) -> f32 {
        0.4
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let sofa = b.object("corner_sofa", Class::Sofa, pose);
        let (half, s) = (0.5 * self.width, self.side);
        // Spans along x are written from the arm (−x) to the chaise (+x), and mirrored where the chaise is at −x.
        let along = |from: f32, to: f32| [(s * from).min(s * to), (s * from).max(s * to)];
        let [x0, x1] = along(-half, half);
        let [p0, p1] = along(ARM - half, half - CHAISE);
        let [c0, c1] = along(half - CHAISE, half);
        self.block(b, &sofa, "base", [p0.min(c0), BACK, LEG], [p1.max(c1), DEPTH - 0.01, BASE], 0.03);
        self.block(b, &sofa, "chaise", [c0, DEPTH - 0.03, LEG], [c1, self.chaise, BASE], 0.03);
        self.block(b, &sofa, "back", [x0, 0.0, LEG], [x1, BACK - 0.002, TOP], 0.06);
        let [a0, a1] = along(-half, ARM - half);
        self.block(b, &sofa, "arm", [a0, BACK, LEG], [a1, DEPTH, TOP - 0.08], 0.055);
        let seats = if p1 - p0 > 1.45 { 2 } else { 1 };
        for k in 0..seats {
            let x = [k, k + 1].map(|k| p0 + (p1 - p0) * k as f32 / seats as f32);
            self.cushion(b, &sofa, &format!("seat_{}", k + 1), Vec2::new(x[0], BACK), Vec2::new(x[1], DEPTH), rng);
        }
        self.cushion(b, &sofa, "chaise_seat", Vec2::new(c0, BACK), Vec2::new(c1, self.chaise), rng);
        let mut middles: Vec<(f32, f32)> =
            (0..seats).map(|k| (p0 + (p1 - p0) * (k as f32 + 0.5) / seats as f32, (p1 - p0) / seats as f32)).collect();
        middles.push((0.5 * (c0 + c1), c1 - c0));
        for (k, &(x, w)) in middles.iter().enumerate() {
            let (height, fat, lean) = (0.42, 0.17, rng.range(0.2, 0.24));
            let mesh = padded_box(Vec3::new(w - 0.012, height, fat), 0.06, 0.03)
                .turned(Vec3::X, FRAC_PI_2)
                .turned(Vec3::Z, PI)
                .turned(Vec3::X, lean);
            let at = Vec3::new(x, BACK + 0.5 * fat + 0.035 - 0.5 * self.chaise, SEAT + 0.5 * height * lean.cos() + 0.004);
            b.part(&sofa, &format!("back_cushion_{}", k + 1), mesh.uv_moved(Vec2::splat(rng.next_f32())).moved(at), self.cloth);
        }
        let inset = 0.07;
        for (k, (x, y)) in [(x0, 0.0), (x1, 0.0), (a0.max(-half), DEPTH), (c0, self.chaise), (c1, self.chaise)].into_iter().enumerate() {
            let at = Vec3::new(
                x.clamp(inset - half, half - inset),
                y.clamp(inset, self.chaise - inset) - if y == DEPTH { inset } else { 0.0 } - 0.5 * self.chaise,
                0.0,
            );
            b.part(&sofa, &format!("leg_{}", k + 1), leg(LEG + 0.002, [0.02, 0.025], Vec2::ZERO).moved(at), Finish::BlackMetal);
        }
        self.scatter(b, pose, &middles, rng);
    }
}

impl CornerSofa {
    fn scatter(&self, b: &mut Builder, pose: DAffine3, middles: &[(f32, f32)], rng: &mut Rng) {
        for k in 0..self.pillows {
            let (x, w) = middles[k % middles.len()];
            let size = rng.range(0.42, 0.5);
            let lean = rng.range(0.32, 0.42);
            let shift = w * if k < middles.len() { 0.16 } else { -0.2 };
            let at = Vec3::new(x + shift, BACK + 0.345 - 0.5 * self.chaise, SEAT + 0.02 + 0.46 * size * lean.cos());
            let local = on(pose, at, rng.range(-0.2, 0.2)) * DAffine3::from_rotation_x(f64::from(FRAC_PI_2 + lean));
            let object = b.object("cushion", Class::Pillow, local);
            let mesh = pillow(Vec2::splat(size), rng.range(0.13, 0.16), rng).uv_moved(Vec2::splat(rng.next_f32()));
            b.part(&object, "cover", mesh.moved(Vec3::new(0.0, 0.0, CONTACT)), Finish::Accent((k % 3) as u8));
        }
    }
}
