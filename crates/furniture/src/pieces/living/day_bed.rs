//! A narrow couch to lie on by day, 185 to 205 × 82 cm, class sofa: a wooden frame on splayed legs and a mattress, with one or two bolsters
//! at its ends (class pillow) and perhaps a throw (class other prop). The first bolster is at +x.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, rod, turned};
use crate::pieces::{CONTACT, Furniture, board, grained, leg, on};
use crate::shape::{Reshape, padded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A narrow couch to lie on by day, with a bolster at one or either end.
#[derive(Clone, Copy, Debug)]
pub struct DayBed {
    /// Length along x.
    pub length: f32,
    /// Bolsters: one or two.
    pub bolsters: usize,
    /// Finish of mattress and bolsters.
    pub cover: Finish,
    /// A throw lies over the foot.
    pub throw: bool,
}

/// Depth of the frame, metres.
const DEPTH: f32 = 0.82;
/// Height of the frame's upper edge, metres.
const FRAME: f32 = 0.26;
/// Thickness of the mattress, metres.
const PAD: f32 = 0.14;

impl Furniture for DayBed {
    fn random(rng: &mut Rng) -> Self {
        let cover = [Finish::Leather, Finish::ArmchairCloth, Finish::SofaCloth, Finish::Velvet][rng.below(4)];
        Self { length: rng.range(1.85, 2.05), bolsters: 1 + rng.below(2), cover, throw: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length, DEPTH + if self.throw { 0.034 } else { 0.0 }, FRAME + PAD + 0.22)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let bed = b.object("day_bed", Class::Sofa, pose);
        let half = Vec2::new(0.5 * self.length, 0.5 * DEPTH);
        // Thickness of the rails, that and the air where they meet, and their lower edge.
        let (thick, inner, low) = (0.03, 0.0302, FRAME - 0.09);
        let rails = all([
            board([-half.x, half.y - thick, low], [half.x, half.y, FRAME], 0.003),
            board([-half.x, -half.y, low], [half.x, thick - half.y, FRAME], 0.003),
            board([-half.x, inner - half.y, low], [thick - half.x, half.y - inner, FRAME], 0.003),
            board([half.x - thick, inner - half.y, low], [half.x, half.y - inner, FRAME], 0.003),
            board([thick - half.x, thick - half.y, FRAME - 0.03], [half.x - thick, half.y - thick, FRAME - 0.002], 0.001),
        ]);
        b.part(&bed, "frame", grained(rails, rng), Finish::Wood);
        for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
            let at = (s * (half - Vec2::new(0.14, 0.07))).extend(0.0);
            // Legs reach up to the board between the rails.
            b.part(&bed, &format!("leg_{}", i + 1), leg(FRAME - 0.0298, [0.014, 0.022], s * 0.03).moved(at), Finish::Wood);
        }
        let pad = padded_box(Vec3::new(self.length - 0.03, DEPTH - 0.03, PAD - 0.024), 0.035, 0.012).uv_moved(Vec2::splat(rng.next_f32()));
        b.part(&bed, "mattress", pad.moved(Vec3::new(0.0, 0.0, FRAME + CONTACT + 0.5 * PAD)), self.cover);
        let (r, w) = (0.1, DEPTH - 0.1);
        let roll = [[0.0, -0.5 * w], [r - 0.02, -0.5 * w], [r, 0.02 - 0.5 * w], [r, 0.5 * w - 0.02], [r - 0.02, 0.5 * w], [0.0, 0.5 * w]];
        for k in 0..self.bolsters {
            let x = (half.x - 0.03 - r) * if k == 0 { 1.0 } else { -1.0 };
            let bolster = b.object("bolster", Class::Pillow, on(pose, Vec3::new(x, 0.0, FRAME + PAD + r - 0.0065), 0.0));
            let mesh = turned(&roll, 36).turned(Vec3::X, FRAC_PI_2);
            b.part(&bolster, "cover", mesh, self.cover);
            let strap = |y: f32| rod([-0.012, y, r + 0.002], [0.012, y, r + 0.002], 0.003, 6);
            b.part(&bolster, "straps", strap(-0.2).with(strap(0.2)), Finish::Leather);
        }
        if self.throw {
            self.drape(b, pose, rng);
        }
    }
}

impl DayBed {
    /// A blanket across the mattress that falls over its front and back.
    fn drape(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let (width, phase) = (0.55, rng.range(0.0, 6.0));
        let half = 0.5 * DEPTH - 0.026;
        let top = FRAME + PAD + 0.003;
        let fall = 0.2;
        let total = 2.0 * (half + fall);
        let point = |i: usize, j: usize| {
            let (u, s) = (i as f32 / 16.0 - 0.5, (j as f32 / 48.0 - 0.5) * total);
            let over = (s.abs() - half).max(0.0);
            // Radius of the bend over the edge, and about a quarter turn.
            let (round, quarter) = (0.03f32, 1.57);
            let bend = (over / (round * quarter)).min(1.0) * quarter;
            let hang = (over - round * quarter).max(0.0);
            let ripple = 0.006 * (1.0 + (u * 20.0 + phase).sin()) * (hang / fall).min(1.0);
            let y = s.signum() * ((s.abs().min(half)) + round * bend.sin() + ripple);
            let z = top - round * (1.0 - bend.cos()) - hang + 0.002 * (u * 17.0 + s * 5.0 + phase).sin();
            Vec3::new(u * width * (1.0 + 0.04 * (s * 3.0).sin()), y, z)
        };
        let cloth = crate::shape::grid(16, 48, point, |i, j| Vec2::new(i as f32 / 16.0 * width, j as f32 / 48.0 * total)).smoothed(80.0);
        let throw = b.object("throw", Class::OtherProp, on(pose, Vec3::new(0.3 - 0.5 * self.length + 0.28, 0.0, 0.0), 0.0));
        b.part(&throw, "knit", cloth, Finish::KnittedThrow);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::piece_tests::{bounds_of, scene_of};

    #[test]
    fn a_throw_lies_on_the_mattress() {
        let bed = DayBed { length: 1.9, bolsters: 1, cover: Finish::Velvet, throw: true };
        let scene = scene_of(&bed, 0);
        let [knit, mattress] = ["throw_1/knit", "day_bed_1/mattress"].map(|part| bounds_of(&scene, part).max.z);
        assert!(knit > mattress && knit < mattress + 0.006, "{knit} {mattress}");
    }
}
