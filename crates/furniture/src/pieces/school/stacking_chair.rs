//! Chairs that are stacked, as schools, meeting rooms and waiting rooms have them, all of class chair: a seat and a back of plywood or plastic,
//! or padded, on four legs of steel tube, on a cantilever, or on skids. The sitter looks to +y.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod, wire};
use crate::pieces::{Furniture, grained, standing};
use crate::shape::{Reshape, padded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A chair of steel tube with a seat and a back.
#[derive(Clone, Copy, Debug)]
pub struct StackingChair {
    /// The frame.
    pub frame: ChairFrame,
    /// Seat and back are padded.
    pub padded: bool,
    /// Finish of seat and back.
    pub finish: Finish,
    /// Finish of the frame.
    pub metal: Finish,
    /// The chair has arms.
    pub arms: bool,
}

/// The frame of a chair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChairFrame {
    /// Four legs.
    Legs,
    /// A bent tube without rear legs.
    Cantilever,
    /// Legs on two skids.
    Skids,
}

/// Height of the seat's frame, metres (EN 1729: 43 cm for people of 1.6 to 1.9 m; the seat is on it).
const SEAT: f32 = 0.432;
/// Radius of the tube, metres.
const TUBE: f32 = 0.011;
/// Half the distance between the two sides of the frame, metres.
const HALF: f32 = 0.205;

impl StackingChair {
    /// A chair of a school: plywood or plastic, without arms.
    pub fn of_school(rng: &mut Rng) -> Self {
        let finish = [Finish::Wood, Finish::Plastic(2), Finish::Plastic(3), Finish::BlackPlastic, Finish::Plastic(0)][rng.below(5)];
        let frame = [ChairFrame::Legs, ChairFrame::Skids, ChairFrame::Cantilever][rng.below(3)];
        Self { frame, padded: false, finish, arms: false, ..Self::random(rng) }
    }

    /// The tubes of one side.
    fn side(&self, s: f32) -> Mesh {
        let x = s * HALF;
        let upright = [[x, -0.166, SEAT], [x, -0.185, 0.56], [0.97 * x, -0.225, 0.8]];
        let tube = |points: &[[f32; 3]]| wire(points, TUBE, 10);
        let feet = |y: f32| cylinder(0.015, 0.02, 14).moved(Vec3::new(1.04 * x, y, 0.0));
        match self.frame {
            ChairFrame::Legs => {
                let front = [[1.04 * x, 0.205, 0.008], [x, 0.185, SEAT - 0.03], [x, 0.16, SEAT], [x, -0.1, SEAT], [x, -0.168, SEAT]];
                let rear = rod([1.04 * x, -0.255, 0.008], [x, -0.15, SEAT], TUBE, 10);
                all([tube(&front), tube(&upright), rear, feet(0.205), feet(-0.255)])
            }
            ChairFrame::Skids => {
                let z = TUBE + 0.0005;
                let front = [[x, -0.168, SEAT], [x, 0.14, SEAT], [x, 0.175, SEAT - 0.03], [x, 0.205, 0.06], [x, 0.18, z], [x, 0.1, z]];
                let skid = rod([x, 0.105, z], [x, -0.2, z], TUBE, 10);
                let rear = tube(&[[x, -0.195, z], [x, -0.235, z + 0.01], [x, -0.225, 0.06], [x, -0.15, SEAT]]);
                all([tube(&front), skid, rear, tube(&upright)])
            }
            ChairFrame::Cantilever => {
                let z = TUBE + 0.0005;
                let front = [[x, -0.168, SEAT], [x, 0.15, SEAT], [x, 0.205, SEAT - 0.05], [x, 0.215, 0.08], [x, 0.18, z], [x, 0.1, z]];
                all([tube(&front), rod([x, 0.105, z], [x, -0.225, z], TUBE, 10), tube(&upright)])
            }
        }
    }

    fn seat(&self, thick: f32) -> Mesh {
        let swell = if self.padded { 0.008 } else { 0.0 };
        padded_box(Vec3::new(0.43, 0.42, thick), 0.42 * thick, swell)
            .deformed(|p| {
                let hollow = 0.012 * (1.0 - (p.x / 0.215).powi(2)).max(0.0) * (1.0 - (p.y / 0.21).powi(2)).max(0.0);
                let fall = 0.9 * (p.y - 0.13).max(0.0).powi(2);
                Vec3::new(p.x, p.y, p.z - if self.padded { 0.0 } else { hollow } - 3.0 * fall)
            })
            .smoothed(60.0)
            .moved(Vec3::new(0.0, 0.005, SEAT + TUBE + 0.5 * thick - 0.001))
    }

    fn back(&self, thick: f32) -> Mesh {
        let height = if self.padded { 0.34 } else { 0.2 };
        let pad = padded_box(Vec3::new(0.425, height, thick), 0.42 * thick, if self.padded { 0.006 } else { 0.0 });
        let lean = (0.04f32 / 0.24).atan();
        pad.turned(Vec3::X, FRAC_PI_2)
            .deformed(|p| Vec3::new(p.x, p.y - 0.3 * (0.045 - p.x * p.x), p.z))
            .smoothed(60.0)
            .turned(Vec3::X, lean)
            .moved(Vec3::new(0.0, -0.2 + 0.5 * thick, 0.795 - 0.5 * height))
    }
}

impl Furniture for StackingChair {
    fn random(rng: &mut Rng) -> Self {
        let padded = rng.below(2) == 0;
        let hard = [Finish::Wood, Finish::BlackPlastic, Finish::Plastic(2), Finish::WhitePlastic];
        let soft = [Finish::SofaCloth, Finish::ArmchairCloth, Finish::Felt, Finish::Leather];
        Self {
            frame: [ChairFrame::Legs, ChairFrame::Cantilever, ChairFrame::Skids][rng.below(3)],
            padded,
            finish: if padded { soft[rng.below(4)] } else { hard[rng.below(4)] },
            metal: [Finish::Chrome, Finish::BlackMetal, Finish::Aluminium][rng.below(3)],
            arms: rng.below(3) == 0,
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(if self.arms { 0.53 } else { 0.46 }, 0.56, 0.825)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("stacking_chair", Class::Chair, pose);
        let rails = [0.13f32, -0.12].map(|y| rod([-HALF, y, SEAT], [HALF, y, SEAT], 0.9 * TUBE, 10));
        let mut frame = standing(all([self.side(-1.0), self.side(1.0)])).with(all(rails));
        if self.frame == ChairFrame::Cantilever {
            frame = frame.with(rod([-HALF, -0.222, TUBE + 0.0005], [HALF, -0.222, TUBE + 0.0005], TUBE, 10));
        }
        b.part(&chair, "frame", frame, self.metal);
        let thick = if self.padded { 0.045 } else { 0.013 };
        b.part(&chair, "seat", grained(self.seat(thick), rng), self.finish);
        b.part(&chair, "back", grained(self.back(if self.padded { 0.036 } else { 0.012 }), rng), self.finish);
        if self.arms {
            let arm = |s: f32| {
                let x = s * 0.245;
                let path = [[s * HALF, -0.19, 0.6], [x, -0.17, 0.64], [x, 0.1, 0.64], [x, 0.16, 0.61], [s * HALF, 0.165, SEAT]];
                wire(&path, 0.95 * TUBE, 10)
            };
            b.part(&chair, "arms", arm(-1.0).with(arm(1.0)), self.metal);
        }
    }
}
