//! Weights and what belongs to them: a bench with a barbell on its rack, a rack of dumbbells (class other furniture), a mat on the floor (class
//! floor mat), a ball (class other prop), and a wall of mirrors (class mirror).

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cut_out, cylinder, rod, rounded_rectangle};
use crate::pieces::{CONTACT, Furniture, board, on};
use crate::shape::{Reshape, rounded_box, sphere};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A bench with a barbell over its head end, which is at −y.
#[derive(Clone, Copy, Debug)]
pub struct WeightBench {
    /// Plates on each end of the bar.
    pub plates: usize,
    /// Finish of the frame.
    pub frame: Finish,
}

/// Height of the bar, half its length, and height of the bench, metres.
const BAR: [f32; 2] = [0.98, 0.9];
const BENCH: f32 = 0.45;

/// A disk about the x axis, from its middle.
fn plate(x: f32, radius: f32, thick: f32, at: Vec3) -> Mesh {
    cylinder(radius, thick, 40).turned(Vec3::Y, FRAC_PI_2).moved(at + Vec3::new(x - 0.5 * thick, 0.0, 0.0))
}

impl Furniture for WeightBench {
    fn random(rng: &mut Rng) -> Self {
        Self { plates: 1 + rng.below(3), frame: [Finish::BlackMetal, Finish::ColoredMetal(0), Finish::CoatedWhite][rng.below(3)] }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * BAR[1], 1.5, 1.21)
    }

    fn reach(&self) -> f32 {
        0.5
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("weight_bench", Class::OtherFurniture, pose);
        let tube = |min: [f32; 3], max: [f32; 3]| board(min, max, 0.004);
        let mut frame = vec![
            tube([-0.03, -0.6, 0.06], [0.03, 0.64, 0.12]),
            tube([-0.3, 0.58, 0.0], [0.3, 0.64, 0.06]),
            tube([-0.6, -0.62, 0.0], [0.6, -0.56, 0.06]),
            tube([-0.03, -0.62, 0.0598], [0.03, -0.56, 0.12]),
            tube([-0.03, 0.58, 0.0598], [0.03, 0.64, 0.12]),
            tube([-0.03, 0.36, 0.1198], [0.03, 0.42, BENCH - 0.07]),
            tube([-0.03, -0.3, 0.1198], [0.03, -0.24, BENCH - 0.07]),
        ];
        for s in [-1.0f32, 1.0] {
            let x = s * 0.52;
            frame.push(tube([x - 0.03, -0.62, 0.0598], [x + 0.03, -0.56, BAR[0] - 0.02]));
            frame.push(tube([x - 0.03, -0.5602, BAR[0] - 0.06], [x + 0.03, -0.49, BAR[0] - 0.0155]));
            frame.push(tube([x - 0.03, -0.5, BAR[0] - 0.0157], [x + 0.03, -0.485, BAR[0] + 0.03]));
        }
        b.part(&object, "frame", all(frame), self.frame);
        let pad = rounded_box(Vec3::new(0.28, 1.15, 0.07), 0.022, 4).moved(Vec3::new(0.0, 0.06, BENCH - 0.036));
        b.part(&object, "pad", pad, Finish::Leather);
        let bar = b.object("barbell", Class::OtherProp, pose);
        let at = Vec3::new(0.0, -0.53, BAR[0]);
        b.part(&bar, "bar", rod([-BAR[1] + 0.002, at.y, at.z], [BAR[1] - 0.002, at.y, at.z], 0.0145, 16), Finish::Steel);
        let disks = (0..self.plates).flat_map(|k| {
            let radius = [0.22, 0.17, 0.12][k];
            [-1.0f32, 1.0].map(|s| plate(s * (0.66 + 0.037 * k as f32), radius, 0.034, at))
        });
        b.part(&bar, "plates", all(disks), Finish::Rubber);
    }
}

/// Dumbbells in pairs on a rack of two or three shelves.
#[derive(Clone, Copy, Debug)]
pub struct DumbbellRack {
    /// Shelves above each other.
    pub shelves: usize,
    /// Width.
    pub width: f32,
    /// Six-sided heads instead of round ones.
    pub hexagonal: bool,
}

impl Furniture for DumbbellRack {
    fn random(rng: &mut Rng) -> Self {
        Self { shelves: 2 + rng.below(2), width: rng.range(1.2, 1.9), hexagonal: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, 0.56, 0.3 + 0.34 * self.shelves as f32)
    }

    fn reach(&self) -> f32 {
        0.7
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("dumbbell_rack", Class::OtherFurniture, pose);
        let x = 0.5 * self.width;
        let top = self.size().z - 0.06;
        let side = |s: f32| {
            let at = s * (x - 0.035);
            board([at - 0.035, -0.27, 0.0], [at + 0.035, 0.27, 0.05], 0.004).with(board(
                [at - 0.03, -0.27, 0.0498],
                [at + 0.03, -0.2, top],
                0.004,
            ))
        };
        let level = |k: usize| 0.2 + 0.34 * k as f32;
        // Each shelf is of two rails, on which the handles' heads rest.
        let depth = |k: usize| 0.24 - 0.05 * k as f32;
        let rails = (0..self.shelves)
            .flat_map(|k| [-0.19, depth(k) - 0.1].map(|y| board([0.036 - x, y, level(k)], [x - 0.036, y + 0.1, level(k) + 0.014], 0.003)));
        let arms = (0..self.shelves).flat_map(|k| {
            [-1.0f32, 1.0].map(|s| {
                board([s * (x - 0.035) - 0.02, -0.2002, level(k) - 0.035], [s * (x - 0.035) + 0.02, depth(k), level(k) + 0.0002], 0.003)
            })
        });
        b.part(&object, "frame", all([side(-1.0), side(1.0)]).with(all(arms)), Finish::BlackMetal);
        b.part(&object, "rails", all(rails), Finish::BlackMetal);
        for k in 0..self.shelves {
            let large = 0.058 + 0.012 * (self.shelves - 1 - k) as f32;
            let pitch = 2.0 * large + 0.03;
            let count = ((self.width - 0.14) / pitch) as usize;
            for i in 0..count {
                if rng.below(9) == 0 {
                    continue;
                }
                let radius = large * (0.78 + 0.22 * i as f32 / count as f32);
                let at =
                    Vec3::new(pitch * (i as f32 - 0.5 * (count - 1) as f32), 0.5 * (depth(k) - 0.19), level(k) + 0.014 + radius + CONTACT);
                self.dumbbell(b, on(pose, at, 0.0), radius);
            }
        }
    }
}

impl DumbbellRack {
    /// A dumbbell along y whose middle is the origin.
    fn dumbbell(&self, b: &mut Builder, pose: DAffine3, radius: f32) {
        let object = b.object("dumbbell", Class::OtherProp, pose);
        let handle = rod([0.0, -0.1, 0.0], [0.0, 0.1, 0.0], 0.015, 16);
        b.part(&object, "handle", handle, Finish::Chrome);
        let sides = if self.hexagonal { 6 } else { 32 };
        let head = |s: f32| {
            let turn = if self.hexagonal { std::f32::consts::FRAC_PI_6 } else { 0.0 };
            let reach = if self.hexagonal { radius / turn.cos() } else { radius };
            let disk = cylinder(reach, 0.085, sides).turned(Vec3::Z, 0.0).turned(Vec3::X, FRAC_PI_2).turned(Vec3::Y, turn);
            disk.moved(Vec3::new(0.0, s * 0.105 + 0.0425, 0.0))
        };
        b.part(&object, "heads", head(-1.0).with(head(1.0)), Finish::Rubber);
    }
}

/// A mat to exercise on.
#[derive(Clone, Copy, Debug)]
pub struct ExerciseMat {
    /// Length along x.
    pub length: f32,
    /// Number of its colour.
    pub color: u8,
}

impl Furniture for ExerciseMat {
    fn random(rng: &mut Rng) -> Self {
        Self { length: rng.range(1.72, 1.9), color: rng.below(8) as u8 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length, 0.62, 0.011)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let mat = b.object("exercise_mat", Class::FloorMat, pose);
        let sheet = cut_out(&rounded_rectangle(self.length, 0.62, 0.03, 5), 0.01, 0.002).moved(Vec3::new(0.0, 0.0, CONTACT));
        b.part(&mat, "sheet", sheet, [Finish::Plastic(self.color), Finish::Accent(self.color % 3)][usize::from(self.color % 2)]);
    }
}

/// A large ball to sit and exercise on.
#[derive(Clone, Copy, Debug)]
pub struct ExerciseBall {
    /// Radius.
    pub radius: f32,
    /// Number of its colour.
    pub color: u8,
}

impl Furniture for ExerciseBall {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.27, 0.36), color: rng.below(8) as u8 }
    }

    fn size(&self) -> Vec3 {
        Vec3::splat(2.0 * self.radius)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let ball = b.object("exercise_ball", Class::OtherProp, pose);
        b.part(&ball, "skin", sphere(self.radius, 64).moved(Vec3::new(0.0, 0.0, self.radius)), Finish::Plastic(self.color));
    }
}

/// Mirrors beside each other on the wall; the origin is the middle of their back.
#[derive(Clone, Copy, Debug)]
pub struct MirrorWall {
    /// Width and height.
    pub size: Vec2,
}

impl Furniture for MirrorWall {
    fn random(rng: &mut Rng) -> Self {
        Self { size: Vec2::new(1.2 * (1 + rng.below(3)) as f32, rng.range(1.7, 2.0)) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x, 0.014, self.size.y)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("mirror_wall", Class::Mirror, pose);
        let count = (self.size.x / 1.2).round().max(1.0);
        let half = 0.5 * self.size;
        let width = self.size.x / count;
        for k in 0..count as usize {
            let x = -half.x + width * k as f32;
            let pane = board([x + 0.0008, 0.0, -half.y], [x + width - 0.0008, 0.006, half.y], 0.0008);
            b.part(&object, &format!("pane_{}", k + 1), pane, Finish::Mirror);
        }
        let strip = |z: f32| board([-half.x, 0.0, z - 0.008], [half.x, 0.014, z + 0.008], 0.001);
        b.part(&object, "strips", all([strip(0.008 - half.y), strip(half.y - 0.008)]), Finish::Aluminium);
    }
}
