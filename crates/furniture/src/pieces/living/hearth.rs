//! Fires: an open fireplace with a surround and a mantelpiece of 130 to 155 cm, and an iron stove 82 to 110 cm high whose pipe ends at the
//! ceiling; class other structure. The logs in the fireplace are other prop. The wall is at −y, and a hearth or floor plate is in front of
//! the fire.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, plate_with_holes, rod};
use crate::pieces::{Furniture, Surface, board, grained, on};
use crate::shape::{Reshape, grid, picture_frame, rounded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// Logs that lie along x on z = 0, two below and one above.
fn logs(length: f32, rng: &mut Rng) -> Mesh {
    // `at` is the middle of the lowest line of a log.
    let mut log = |at: Vec3, yaw: f32| {
        let r = rng.range(0.042, 0.052);
        cylinder(r, length * rng.range(0.85, 1.0), 18)
            .moved(Vec3::new(0.0, 0.0, -0.5 * length))
            .turned(Vec3::Y, FRAC_PI_2)
            .turned(Vec3::Z, yaw)
            .moved(at + Vec3::Z * r)
    };
    all([log(Vec3::new(0.0, -0.05, 0.0), 0.06), log(Vec3::new(0.0, 0.055, 0.0), -0.08), log(Vec3::new(0.01, 0.0, 0.083), 0.25)])
}

/// An open fireplace in a surround with a mantelpiece, on a hearth.
#[derive(Clone, Copy, Debug)]
pub struct Fireplace {
    /// Width of the mantelpiece.
    pub width: f32,
    /// Finish of the surround.
    pub surround: Finish,
    /// The surround has framed panels instead of plain slabs.
    pub panelled: bool,
}

/// Depth of the fireplace without the front part of its hearth, metres.
const DEPTH: f32 = 0.40;
/// Length of the hearth in front of that, metres: sparks fall on it.
const HEARTH: f32 = 0.35;
/// Height of the mantelpiece, metres.
const MANTEL: f32 = 1.12;
/// Width and height of the opening, metres.
const OPENING: [f32; 2] = [0.66, 0.68];

impl Furniture for Fireplace {
    fn random(rng: &mut Rng) -> Self {
        let surround = [Finish::WhiteLacquer, Finish::MarbleTop, Finish::Stone, Finish::Brick][rng.below(4)];
        Self { width: rng.range(1.3, 1.55), surround, panelled: surround == Finish::WhiteLacquer }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH + HEARTH, MANTEL)
    }

    fn reach(&self) -> f32 {
        0.5
    }

    fn surfaces(&self) -> Vec<Surface> {
        let back = -0.5 * (DEPTH + HEARTH);
        let half = 0.5 * self.width - 0.03;
        vec![Surface { min: Vec2::new(-half, back + 0.02), max: Vec2::new(half, back + 0.24), z: MANTEL, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let pose = on(pose, Vec3::new(0.0, -0.5 * (DEPTH + HEARTH), 0.0), 0.0);
        let fire = b.object("fireplace", Class::OtherStructure, pose);
        let (half, [w, h]) = (0.5 * self.width, OPENING);
        let low = 0.05;
        // The chimney breast is 28 cm in front of the wall and is open in the middle.
        let front = 0.28;
        let leg = half - 0.07;
        let face = plate_with_holes(Vec2::new(-leg, low), Vec2::new(leg, MANTEL - 0.05), 0.04, 0.003, &[[-0.5 * w, 0.5 * w, low, low + h]]);
        let upright = |mesh: Mesh| mesh.turned(Vec3::X, FRAC_PI_2).turned(Vec3::Z, std::f32::consts::PI);
        b.part(&fire, "surround", upright(face).moved(Vec3::new(0.0, front, 0.0)), self.surround);
        let cheeks = all([-1.0f32, 1.0].map(|s| {
            let x = [s * (0.5 * w + 0.0002), s * leg];
            board([x[0].min(x[1]), 0.001, low], [x[0].max(x[1]), front - 0.0402, MANTEL - 0.0502], 0.002)
        }));
        b.part(
            &fire,
            "cheeks",
            cheeks.with(board([-0.5 * w, 0.001, low + h], [0.5 * w, front - 0.0402, MANTEL - 0.0502], 0.002)),
            self.surround,
        );
        let lining = all([
            board([-0.5 * w, 0.001, low], [0.5 * w, 0.03, low + h - 0.0002], 0.002),
            board([-0.5 * w, 0.03, low], [0.5 * w, front - 0.041, low + 0.012], 0.001),
        ]);
        b.part(&fire, "lining", lining, Finish::Brick);
        let shelf = board([-half, 0.001, MANTEL - 0.05], [half, front + 0.05, MANTEL], 0.006);
        b.part(&fire, "mantelpiece", grained(shelf, rng), if self.surround == Finish::Brick { Finish::DarkWood } else { self.surround });
        b.part(
            &fire,
            "hearth",
            board([-half, 0.001, 0.0], [half, DEPTH + HEARTH, low - 0.0002], 0.006),
            if self.panelled { Finish::Stone } else { self.surround },
        );
        if self.panelled {
            let pilaster = |s: f32| {
                let x = s * 0.25 * (w + 2.0 * leg);
                picture_frame(
                    0.5 * (2.0 * leg - w) - 0.06,
                    h - 0.06,
                    &[[0.0, -0.001], [0.0, 0.008], [0.012, 0.012], [0.02, 0.004], [0.02, -0.001]],
                )
                .moved(Vec3::new(x, front, low + 0.5 * h))
            };
            b.part(&fire, "mouldings", pilaster(-1.0).with(pilaster(1.0)), self.surround);
        }
        let wood = b.object("logs", Class::OtherProp, on(pose, Vec3::new(0.0, 0.14, low + 0.045), 0.0));
        b.part(&wood, "logs", logs(0.42, rng), Finish::Bark);
        let bars = (0..7).map(|k| rod([0.06 * (k as f32 - 3.0), -0.1, -0.006], [0.06 * (k as f32 - 3.0), 0.11, -0.006], 0.006, 8));
        let ends = [-0.18f32, 0.18]
            .map(|x| rod([x, 0.1, 0.0], [x, 0.1, -0.033], 0.008, 8).with(rod([x, -0.09, 0.0], [x, -0.09, -0.033], 0.008, 8)));
        let across = [-0.09f32, 0.1].map(|y| rod([-0.18, y, -0.016], [0.18, y, -0.016], 0.006, 8));
        b.part(&wood, "grate", all(bars.chain(ends).chain(across)), Finish::BlackMetal);
    }
}

/// An iron stove with a window, its pipe up to the ceiling.
#[derive(Clone, Copy, Debug)]
pub struct Stove {
    /// Round instead of square.
    pub round: bool,
    /// Height of the body.
    pub height: f32,
    /// Height at which the pipe ends above the floor.
    pub pipe: f32,
}

impl Furniture for Stove {
    fn random(rng: &mut Rng) -> Self {
        Self { round: rng.below(2) == 0, height: rng.range(0.82, 1.1), pipe: 2.4 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.62, 0.80, self.pipe)
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn fit(&mut self, height: f32) {
        self.pipe = height;
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let stove = b.object("stove", Class::OtherStructure, pose);
        let (h, iron) = (self.height, Finish::BlackMetal);
        b.part(
            &stove,
            "floor_plate",
            rounded_box(Vec3::new(0.62, 0.80, 0.008), 0.003, 2).moved(Vec3::new(0.0, 0.0, 0.004)),
            Finish::GlossBlack,
        );
        let at = Vec3::new(0.0, -0.12, 0.0085);
        let r = 0.23;
        if self.round {
            let body = crate::pieces::form::turned(
                &[
                    [0.0, 0.06],
                    [r - 0.03, 0.06],
                    [r - 0.01, 0.09],
                    [r, 0.1],
                    [r, h - 0.03],
                    [r - 0.01, h - 0.012],
                    [r + 0.012, h - 0.008],
                    [r + 0.012, h],
                    [0.0, h],
                ],
                56,
            );
            b.part(&stove, "body", body.moved(at), iron);
            b.part(&stove, "foot", cylinder(r - 0.06, 0.0602, 48).moved(at), iron);
            // A bent pane and the frame around it.
            let pane = |out: f32, half: f32, z0: f32, z1: f32| {
                grid(
                    16,
                    2,
                    |i, j| {
                        let a = half * (1.0 - i as f32 / 8.0);
                        Vec3::new((r + out) * a.sin(), (r + out) * a.cos(), z0 + (z1 - z0) * j as f32 / 2.0)
                    },
                    |i, j| Vec2::new(i as f32 * 0.02, j as f32 * 0.2),
                )
                .smoothed(60.0)
            };
            b.part(&stove, "frame", pane(0.003, 0.75, 0.42 * h, 0.92 * h).moved(at), Finish::Steel);
            b.part(&stove, "window", pane(0.005, 0.68, 0.45 * h, 0.895 * h).moved(at), Finish::GlossBlack);
        } else {
            let body = rounded_box(Vec3::new(0.46, 0.40, h - 0.1), 0.012, 2).moved(at + Vec3::new(0.0, 0.0, 0.5 * h + 0.03));
            b.part(&stove, "body", body, iron);
            b.part(&stove, "top", rounded_box(Vec3::new(0.5, 0.44, 0.02), 0.005, 2).moved(at + Vec3::new(0.0, 0.0, h - 0.01)), iron);
            let legs = [(-1.0f32, -1.0f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| cylinder(0.018, 0.082, 14).moved(at + Vec3::new(0.19 * x, 0.16 * y, 0.0)));
            b.part(&stove, "legs", all(legs), iron);
            let (z0, z1) = (0.4 * h, 0.9 * h);
            let section = [[0.0, -0.001], [0.0, 0.014], [0.002, 0.016], [0.033, 0.016], [0.035, 0.014], [0.035, -0.001]];
            let middle = at + Vec3::new(0.0, 0.2, 0.5 * (z0 + z1));
            b.part(&stove, "door", picture_frame(0.42, z1 - z0, &section).moved(middle), iron);
            let window = board([-0.178, 0.0005, -0.5 * (z1 - z0) + 0.033], [0.178, 0.006, 0.5 * (z1 - z0) - 0.033], 0.001);
            b.part(&stove, "window", window.moved(middle), Finish::GlossBlack);
        }
        let (x, y) = (0.165, 0.25);
        let handle = rod([x, y, 0.58 * h], [x, y, 0.74 * h], 0.008, 12).with(rod([x, 0.15, 0.6 * h], [x, y, 0.6 * h], 0.005, 8));
        b.part(&stove, "handle", handle.moved(at), Finish::Steel);
        let pipe = cylinder(0.075, self.pipe - h - 0.008, 32).moved(at + Vec3::new(0.0, -0.02, h - 0.0004));
        let collar = cylinder(0.088, 0.03, 32).moved(at + Vec3::new(0.0, -0.02, h - 0.0002));
        b.part(&stove, "pipe", pipe.with(collar), iron);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::piece_tests::{bounds_of, scene_of};

    #[test]
    fn the_pipe_of_a_stove_ends_at_the_ceiling_of_its_room() {
        for round in [false, true] {
            let mut stove = Stove { round, height: 0.9, pipe: 2.4 };
            stove.fit(2.75);
            let top = bounds_of(&scene_of(&stove, 0), "stove_1/pipe").max.z;
            assert!((top - 2.75).abs() < 0.001, "it ends at {top} m");
            assert_eq!(stove.size().z, 2.75);
        }
    }
}
