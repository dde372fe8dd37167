//! More of shops and cafés: a rail with clothes (class other furniture; each garment is of class clothes), a refrigerator with glass doors and
//! bottles (class refrigerator), a low table with piles of books or folded clothes (class table), and small café tables (class table).

use super::goods::stock;
use crate::builder::{Builder, Class};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::bedroom::{Garment, hang_garment};
use crate::pieces::form::{all, cut_out, cylinder, picture, rod, rounded_rectangle};
use crate::pieces::{Furniture, Surface, board, grained, on};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A rail with clothes on hangers.
#[derive(Clone, Copy, Debug)]
pub struct ClothesRail {
    /// Length of the rail.
    pub length: f32,
    /// What hangs on it.
    pub garment: Garment,
    /// Finish of the frame.
    pub metal: Finish,
}

/// Height of the rail and radius of its tube, metres.
const RAIL: f32 = 1.42;
const TUBE: f32 = 0.0125;

impl Furniture for ClothesRail {
    fn random(rng: &mut Rng) -> Self {
        let garment = [Garment::Shirt, Garment::Shirt, Garment::Jacket, Garment::Dress, Garment::Trousers][rng.below(5)];
        Self { length: rng.range(0.9, 1.5), garment, metal: [Finish::Chrome, Finish::BlackMetal, Finish::Brass][rng.below(3)] }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length, 0.61, RAIL + 0.03)
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("clothes_rail", Class::OtherFurniture, pose);
        let x = 0.5 * self.length - 0.02;
        let side = |s: f32| {
            let foot = rod([s * x, -0.28, 0.0135], [s * x, 0.28, 0.0135], TUBE, 12);
            foot.with(rod([s * x, 0.0, 0.012], [s * x, 0.0, RAIL], TUBE, 12))
        };
        let rail = rod([-x, 0.0, RAIL], [x, 0.0, RAIL], TUBE, 12);
        let low = rod([-x, 0.0, 0.16], [x, 0.0, 0.16], 0.8 * TUBE, 10);
        b.part(&object, "frame", all([side(-1.0), side(1.0), rail, low]), self.metal);
        let step = if matches!(self.garment, Garment::Jacket | Garment::Coat) { 0.105 } else { 0.07 };
        let mut at = 0.09 - x;
        while at < x - 0.08 {
            // Garments hang across the rail: it runs along y in their own space.
            let place = on(pose, Vec3::new(at, 0.0, RAIL), 0.0) * DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_2);
            hang_garment(b, place, self.garment, rng);
            at += step * rng.range(1.0, 1.5);
        }
    }
}

/// A refrigerator with glass doors.
#[derive(Clone, Copy, Debug)]
pub struct BottleFridge {
    /// Doors beside each other.
    pub doors: usize,
    /// Finish of the case.
    pub case: Finish,
}

impl Furniture for BottleFridge {
    fn random(rng: &mut Rng) -> Self {
        Self { doors: 1 + rng.below(2), case: [Finish::BlackMetal, Finish::CoatedWhite, Finish::ColoredMetal(0)][rng.below(3)] }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.62 * self.doors as f32, 0.62, 1.95)
    }

    fn reach(&self) -> f32 {
        0.7
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("bottle_fridge", Class::Refrigerator, pose);
        let (x, y, top) = (0.31 * self.doors as f32, 0.31, 1.95);
        let t = 0.035;
        let front = y - 0.05;
        let walls = [
            board([-x, -y, 0.0], [x, front, 0.16], 0.003),
            board([-x, -y, 1.72], [x, front, top], 0.003),
            board([-x, -y, 0.1598], [t - x, front, 1.7202], 0.002),
            board([x - t, -y, 0.1598], [x, front, 1.7202], 0.002),
        ];
        b.part(&object, "case", all(walls), self.case);
        b.part(&object, "lining", board([t - x - 0.001, -y + 0.002, 0.159], [x - t + 0.001, 0.03 - y, 1.721], 0.001), Finish::WhitePlastic);
        let sign = board([0.02 - x, front - 0.001, 1.74], [x - 0.02, front + 0.012, 1.93], 0.003);
        b.part(&object, "sign", sign, [Finish::Plastic(0), Finish::Plastic(2), Finish::WhitePlastic][rng.below(3)]);
        let strip = board([0.05 - x, -0.05, 1.706], [x - 0.05, 0.0, 1.7198], 0.002);
        b.part(&object, "light", strip, Finish::OpalGlobe);
        let levels = [0.16f32, 0.55, 0.86, 1.17, 1.43];
        let shelves = levels[1..]
            .iter()
            .map(|&z| board([t - x + 0.002 - 0.003, 0.03 - y - 0.001, z - 0.008], [x - t + 0.001, front - 0.06, z], 0.001));
        b.part(&object, "shelves", all(shelves), Finish::Steel);
        for door in 0..self.doors {
            let at = 0.62 * (door as f32 - 0.5 * (self.doors - 1) as f32);
            let from = b.part_count();
            let frame = crate::shape::picture_frame(0.612, 1.55, &[[0.0, 0.0], [0.0, 0.036], [0.04, 0.036], [0.04, 0.0]]);
            b.part(&object, &format!("door_{}", door + 1), frame.moved(Vec3::new(at, front + 0.001, 0.945)), Finish::BlackPlastic);
            let pane = picture(0.54, 1.48).moved(Vec3::new(at, front + 0.02, 0.945));
            b.part(&object, &format!("pane_{}", door + 1), pane, Finish::Glass);
            let handle = rod([at - 0.285, front + 0.045, 0.8], [at - 0.285, front + 0.045, 1.15], 0.0045, 10);
            let ends = [0.81f32, 1.14].map(|z| rod([at - 0.285, front + 0.03, z], [at - 0.285, front + 0.045, z], 0.004, 8));
            b.part(&object, &format!("handle_{}", door + 1), handle.with(all(ends)), Finish::Steel);
            let hinge = Joint::cupboard(at + 0.306, front + 0.037, 1.0);
            b.joint(&object, &format!("door_{}", door + 1), &hinge, from..b.part_count());
        }
        for (level, &z) in levels.iter().enumerate() {
            let next = levels.get(level + 1).copied().unwrap_or(1.7);
            let at = Vec3::new(t - x + 0.004, front - 0.065, z);
            stock(b, pose, at, [2.0 * (x - t) - 0.008, 0.4, next - z - 0.03], rng);
        }
    }
}

/// A low table on which goods lie.
#[derive(Clone, Copy, Debug)]
pub struct DisplayTable {
    /// Width and depth.
    pub size: Vec2,
    /// Height of its top.
    pub top: f32,
    /// Finish of its top.
    pub finish: Finish,
}

impl Furniture for DisplayTable {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::Wood, Finish::DarkWood, Finish::WhiteLacquer, Finish::Wood][rng.below(4)];
        Self { size: Vec2::new(rng.range(1.1, 1.8), rng.range(0.7, 0.95)), top: rng.range(0.7, 0.85), finish }
    }

    fn size(&self) -> Vec3 {
        self.size.extend(self.top)
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = 0.5 * self.size - 0.03;
        vec![Surface { min: -half, max: half, z: self.top, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("display_table", Class::Table, pose);
        let (half, under) = (0.5 * self.size, self.top - 0.032);
        b.part(&object, "top", grained(board([-half.x, -half.y, under], [half.x, half.y, self.top], 0.003), rng), self.finish);
        let legs = [(-1.0f32, -1.0f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(sx, sy)| {
            let (x, y) = (sx * (half.x - 0.05), sy * (half.y - 0.05));
            board([x - 0.03, y - 0.03, 0.0], [x + 0.03, y + 0.03, under + 0.0002], 0.003)
        });
        b.part(&object, "legs", grained(all(legs), rng), self.finish);
        let shelf = board([0.055 - half.x, 0.055 - half.y, 0.2], [half.x - 0.055, half.y - 0.055, 0.224], 0.002);
        b.part(&object, "shelf", grained(shelf, rng), self.finish);
    }
}

/// A table of a café for two to four.
#[derive(Clone, Copy, Debug)]
pub struct BistroTable {
    /// Width of its top.
    pub width: f32,
    /// Round instead of square.
    pub round: bool,
    /// Finish of its top.
    pub finish: Finish,
    /// Four flat feet instead of a round plate.
    pub cross: bool,
}

/// Height of café tables, metres.
const CAFE: f32 = 0.745;

impl Furniture for BistroTable {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::Wood, Finish::MarbleTop, Finish::DarkWood, Finish::WhiteLacquer, Finish::Wood][rng.below(5)];
        Self { width: rng.range(0.62, 0.82), round: rng.below(2) == 0, finish, cross: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, self.width, CAFE)
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = Vec2::splat(if self.round { 0.33 * self.width } else { 0.45 * self.width });
        vec![Surface { min: -half, max: half, z: CAFE, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("bistro_table", Class::Table, pose);
        let top = if self.round {
            cylinder(0.5 * self.width, 0.026, 56)
        } else {
            cut_out(&rounded_rectangle(self.width, self.width, 0.025, 4), 0.026, 0.002)
        };
        b.part(&object, "top", grained(top.moved(Vec3::new(0.0, 0.0, CAFE - 0.026)), rng), self.finish);
        let column = cylinder(0.03, CAFE - 0.035, 24).moved(Vec3::new(0.0, 0.0, 0.012));
        let head = rounded_box(Vec3::new(0.24, 0.24, 0.012), 0.004, 2).moved(Vec3::new(0.0, 0.0, CAFE - 0.0322));
        let foot = if self.cross {
            let bar =
                |turn: f32| rounded_box(Vec3::new(0.56, 0.06, 0.016), 0.005, 2).turned(Vec3::Z, turn).moved(Vec3::new(0.0, 0.0, 0.008));
            bar(0.785).with(bar(-0.785))
        } else {
            cylinder(0.21, 0.016, 48)
        };
        b.part(&object, "stand", all([column, head, foot]), Finish::BlackMetal);
    }
}
