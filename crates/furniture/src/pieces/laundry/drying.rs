//! To dry and iron: a drying rack on crossed legs, 85 to 105 cm long, with up to six pieces of laundry over its wires, and an ironing board
//! 82 to 92 cm high (both class other furniture; the laundry is of class towel or clothes). Their long side is along x; the nose of the
//! ironing board is at +x.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, rod};
use crate::pieces::soft::over_rod;
use crate::pieces::{Furniture, on, standing};
use crate::shape::{Reshape, grid, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A rack of wires on crossed legs with laundry on it.
#[derive(Clone, Copy, Debug)]
pub struct DryingRack {
    /// Length of the wires.
    pub length: f32,
    /// Pieces of laundry.
    pub laundry: usize,
}

/// Height of the wires above the floor, metres.
const HIGH: f32 = 0.95;
/// Width of the frame that holds the wires, along y, metres.
const WIDE: f32 = 0.54;
/// Radius of the tubes of frame and legs, metres.
const TUBE: f32 = 0.008;

impl Furniture for DryingRack {
    fn random(rng: &mut Rng) -> Self {
        Self { length: rng.range(0.85, 1.05), laundry: rng.below(7) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length + 0.04, WIDE + 0.08, HIGH + 0.02)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let rack = b.object("drying_rack", Class::OtherFurniture, pose);
        let (x, y) = (0.5 * self.length, 0.5 * WIDE);
        let finish = [Finish::WhiteEnamel, Finish::Steel][rng.below(2)];
        let frame = [
            rod([-x, -y, HIGH], [x, -y, HIGH], TUBE, 12),
            rod([-x, y, HIGH], [x, y, HIGH], TUBE, 12),
            rod([-x, -y, HIGH], [-x, y, HIGH], TUBE, 12),
            rod([x, -y, HIGH], [x, y, HIGH], TUBE, 12),
        ];
        b.part(&rack, "frame", all(frame), finish);
        let level = |k: usize| -y + WIDE * (k as f32 + 1.0) / 9.0;
        b.part(&rack, "wires", all((0..8).map(|k| rod([-x, level(k), HIGH], [x, level(k), HIGH], 0.0022, 8))), finish);
        let legs = [-1.0f32, 1.0].into_iter().flat_map(|s| {
            let px = s * (x - 0.03);
            let leg = |from: f32, inset: f32| {
                standing(tube(
                    &[Vec3::new(px - s * inset, -from * (y + 0.02), 0.003), Vec3::new(px - s * inset, from * y * 0.96, HIGH)],
                    TUBE,
                    12,
                ))
            };
            [leg(1.0, 0.0), leg(-1.0, 0.018)]
        });
        // At the height of the bars the slanting legs are that far inside the frame's edge.
        let bar = y - 0.007;
        let bars = [-1.0f32, 1.0].map(|s| rod([-x + 0.03, s * bar, 0.05], [x - 0.03, s * bar, 0.05], 0.006, 10));
        b.part(&rack, "legs", all(legs.chain(bars)), finish);
        let mut from = -x + 0.05;
        for k in 0..self.laundry {
            // Pieces hang over every second wire, from the left to the right and then in the next row.
            let row = 1 + 2 * ((k / 2) % 4).min(3);
            if k % 2 == 0 {
                from = -x + 0.05;
            }
            let wide = rng.range(0.26, 0.42).min(x + x - 0.1);
            if from + wide > x - 0.03 {
                continue;
            }
            let drop = rng.range(0.2, 0.48);
            let at = on(pose, Vec3::new(from + 0.5 * wide, level(row), HIGH), 0.0);
            let (name, class, cloth) = if rng.below(2) == 0 {
                ("towel", Class::Towel, Finish::Towel(rng.below(4) as u8))
            } else {
                ("clothes", Class::Clothes, Finish::Clothes(rng.below(8) as u8))
            };
            let piece = b.object(name, class, at);
            let mesh = over_rod(wide, drop, drop * rng.range(0.7, 1.0), 0.0022 + 0.0045, 0.004, rng);
            b.part(&piece, "cloth", mesh.deformed(|p| Vec3::new(p.x, p.y * 0.55, p.z)).smoothed(75.0), cloth);
            from += wide + rng.range(0.02, 0.06);
        }
    }
}

/// An ironing board, set up.
#[derive(Clone, Copy, Debug)]
pub struct IroningBoard {
    /// Height of the board.
    pub height: f32,
    /// The cloth of its cover.
    pub cover: Finish,
}

/// Length of the ironing board, metres.
const LENGTH: f32 = 1.22;
/// Largest breadth of the ironing board, metres.
const BREADTH: f32 = 0.38;

impl IroningBoard {
    /// Half the breadth at `t` from the blunt end (0) to the nose (1).
    fn half(t: f32) -> f32 {
        let nose = (1.0 - ((t - 0.45).max(0.0) / 0.56).powf(2.2)).max(0.0);
        let blunt = (1.0 - ((0.06 - t).max(0.0) / 0.065).powi(2)).max(0.0).sqrt();
        0.5 * BREADTH * nose.powf(0.62) * blunt
    }
}

impl Furniture for IroningBoard {
    fn random(rng: &mut Rng) -> Self {
        let cover = [Finish::Clothes(rng.below(8) as u8), Finish::Accent(1), Finish::BedLinen(1)][rng.below(3)];
        Self { height: rng.range(0.82, 0.92), cover }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(LENGTH, 0.46, self.height + 0.002)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("ironing_board", Class::OtherFurniture, pose);
        let (nu, nv, thick) = (18, 40, 0.026);
        let point = |i: usize, j: usize| {
            let k = j.clamp(1, nv + 1) - 1;
            let t = 0.004 + 0.992 * k as f32 / nv as f32;
            let x = (t - 0.5) * LENGTH;
            if j == 0 || j == nv + 2 {
                return Vec3::new(x, 0.0, self.height - 0.5 * thick);
            }
            let (sin, cos) = (std::f32::consts::TAU * (i % nu) as f32 / nu as f32).sin_cos();
            let blunt = |v: f32| v.signum() * v.abs().powf(0.4);
            Vec3::new(x, Self::half(t) * blunt(sin), self.height - 0.5 * thick + 0.5 * thick * -blunt(cos))
        };
        let uv = |i: usize, j: usize| Vec2::new(j as f32 / nv as f32 * LENGTH, i as f32 / nu as f32 * 2.0 * BREADTH);
        b.part(&object, "cover", grid(nu, nv + 2, point, uv).smoothed(60.0), self.cover);
        let under = self.height - thick;
        let strut = |from: f32, to: f32, y: f32| standing(tube(&[Vec3::new(from, y, 0.009), Vec3::new(to, y, under)], 0.0105, 12));
        let legs = [strut(-0.36, 0.26, -0.02), strut(-0.36, 0.26, 0.02), strut(0.34, -0.34, -0.055), strut(0.34, -0.34, 0.055)];
        let feet = [-0.36f32, 0.34].map(|x| rod([x, -0.21, 0.011], [x, 0.21, 0.011], 0.0105, 12));
        b.part(&object, "legs", all(legs.into_iter().chain(feet)), [Finish::WhiteEnamel, Finish::Steel][rng.below(2)]);
    }
}
