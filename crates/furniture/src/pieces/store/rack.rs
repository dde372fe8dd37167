//! A rack of perforated steel posts with three to five boards, 0.9 to 1.8 m wide (class shelves), with cartons, crates, tins of paint and
//! binders on it.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, rod, turned};
use crate::pieces::{CONTACT, Furniture, board, grained, on};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec3};

/// A rack for what is stored.
#[derive(Clone, Copy, Debug)]
pub struct SteelRack {
    /// Width and depth.
    pub width: f32,
    /// Depth.
    pub depth: f32,
    /// Boards above each other.
    pub boards: usize,
    /// Finish of the posts.
    pub metal: Finish,
    /// Finish of the boards.
    pub board: Finish,
}

/// Height of the posts and of the lowest board, metres.
const HEIGHT: f32 = 1.95;
const LOWEST: f32 = 0.12;

impl SteelRack {
    fn level(&self, k: usize) -> f32 {
        LOWEST + (HEIGHT - LOWEST - 0.06) * k as f32 / (self.boards - 1) as f32
    }

    fn fill(&self, b: &mut Builder, pose: DAffine3, z: f32, room: f32, rng: &mut Rng) {
        let (mut x, end) = (0.06 - 0.5 * self.width, 0.5 * self.width - 0.06);
        while x < end - 0.1 {
            if rng.below(6) == 0 {
                x += rng.range(0.08, 0.25);
                continue;
            }
            let width = match rng.below(5) {
                0 => paint(b, pose, [x, z + CONTACT, end], rng),
                1 | 2 => crate_of_plastic(b, pose, [x, z + CONTACT, end], room, self.depth, rng),
                _ => carton(b, pose, [x, z + CONTACT, end], room, self.depth, rng),
            };
            x += width + rng.range(0.015, 0.05);
        }
    }
}

/// A closed carton, perhaps with a smaller one on it; the width that it takes.
fn carton(b: &mut Builder, pose: DAffine3, [x, z, end]: [f32; 3], room: f32, depth: f32, rng: &mut Rng) -> f32 {
    let size = Vec3::new(rng.range(0.22, 0.48).min(end - x), rng.range(0.25, 0.4).min(depth - 0.04), rng.range(0.16, 0.36).min(0.9 * room));
    let stacked = 2.0 * size.z < 0.9 * room && rng.below(2) == 0;
    for level in 0..=usize::from(stacked) {
        let share = if level == 0 { 1.0 } else { rng.range(0.85, 1.0) };
        let size = Vec3::new(share * size.x, share * size.y, size.z);
        let at = Vec3::new(x + 0.5 * size.x, rng.range(-0.02, 0.02), z + (size.z + CONTACT) * level as f32);
        let object = b.object("cardboard_box", Class::Box, on(pose, at, if level == 0 { 0.0 } else { rng.range(-0.05, 0.05) }));
        let lids = [-1.0f32, 1.0].map(|s| {
            let y = [s * 0.0012, s * (0.5 * size.y - 0.001)];
            board([-0.5 * size.x, y[0].min(y[1]), size.z - 0.004], [0.5 * size.x, y[0].max(y[1]), size.z], 0.0008)
        });
        let body = board([-0.5 * size.x, -0.5 * size.y, 0.0], [0.5 * size.x, 0.5 * size.y, size.z - 0.0035], 0.002);
        b.part(&object, "body", body.with(all(lids)), Finish::Cardboard);
        if rng.below(2) == 0 {
            let label = board([-0.07, 0.5 * size.y - 0.0005, 0.4 * size.z], [0.05, 0.5 * size.y + 0.0008, 0.75 * size.z], 0.0002);
            b.part(&object, "label", label, Finish::Paper);
        }
        let tape = board([-0.5 * size.x - 0.0005, -0.025, size.z - 0.03], [0.5 * size.x + 0.0005, 0.025, size.z + 0.0004], 0.0002);
        b.part(&object, "tape", tape, Finish::Wax);
    }
    size.x
}

/// A crate of plastic with a lid; the width that it takes.
fn crate_of_plastic(b: &mut Builder, pose: DAffine3, [x, z, end]: [f32; 3], room: f32, depth: f32, rng: &mut Rng) -> f32 {
    let size = Vec3::new(rng.range(0.28, 0.4).min(end - x), (depth - 0.06).min(0.5), rng.range(0.18, 0.3).min(0.85 * room));
    let object = b.object("storage_crate", Class::Box, on(pose, Vec3::new(x + 0.5 * size.x, 0.0, z), 0.0));
    let color = [Finish::Plastic(2), Finish::Plastic(0), Finish::WhitePlastic, Finish::Plastic(3), Finish::BlackPlastic][rng.below(5)];
    let body =
        rounded_box(Vec3::new(size.x - 0.024, size.y - 0.024, size.z - 0.02), 0.02, 3).moved(Vec3::new(0.0, 0.0, 0.5 * size.z - 0.01));
    let ribs = [0.35f32, 0.75]
        .map(|t| rounded_box(Vec3::new(size.x - 0.012, size.y - 0.012, 0.014), 0.005, 2).moved(Vec3::new(0.0, 0.0, t * size.z)));
    b.part(&object, "body", body.with(all(ribs)), color);
    let lid = rounded_box(Vec3::new(size.x, size.y, 0.022), 0.008, 3).moved(Vec3::new(0.0, 0.0, size.z - 0.0115));
    b.part(&object, "lid", lid, if rng.below(2) == 0 { color } else { Finish::BlackPlastic });
    size.x
}

/// One to three tins of paint; the width that they take.
fn paint(b: &mut Builder, pose: DAffine3, [x, z, end]: [f32; 3], rng: &mut Rng) -> f32 {
    let (radius, height) = ([0.055, 0.085, 0.09][rng.below(3)], [0.12, 0.19, 0.2][rng.below(3)]);
    let count = (((end - x) / (2.0 * radius + 0.012)) as usize).min(1 + rng.below(3));
    for k in 0..count {
        let at = Vec3::new(x + radius + (2.0 * radius + 0.012) * k as f32, rng.range(-0.04, 0.08), z);
        let tin = b.object("paint_tin", Class::OtherProp, on(pose, at, rng.range(-1.0, 1.0)));
        let r = radius;
        let body = [
            [0.0, 0.0],
            [r - 0.002, 0.0],
            [r, 0.003],
            [r, height - 0.008],
            [r + 0.002, height - 0.004],
            [r - 0.004, height],
            [r - 0.012, height - 0.006],
            [0.0, height - 0.006],
        ];
        b.part(&tin, "body", turned(&body, 40), Finish::Steel);
        let band = [[r + 0.0002, 0.02], [r + 0.0006, 0.02], [r + 0.0006, height - 0.03], [r + 0.0002, height - 0.03], [r + 0.0002, 0.02]];
        b.part(&tin, "label", turned(&band, 40), Finish::Plastic(rng.below(8) as u8));
    }
    2.0 * radius * count as f32 + 0.012 * count.saturating_sub(1) as f32
}

impl Furniture for SteelRack {
    fn random(rng: &mut Rng) -> Self {
        Self {
            width: rng.range(0.9, 1.8),
            depth: [0.4, 0.5, 0.6][rng.below(3)],
            boards: 4 + rng.below(2),
            metal: [Finish::Aluminium, Finish::ColoredMetal(2), Finish::BlackMetal, Finish::CoatedWhite][rng.below(4)],
            board: [Finish::Wood, Finish::Aluminium, Finish::Wood][rng.below(3)],
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, self.depth, HEIGHT)
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("steel_rack", Class::Shelves, pose);
        let (x, y) = (0.5 * self.width, 0.5 * self.depth);
        let post = |sx: f32, sy: f32| {
            // Angles of steel, open towards the middle.
            let (px, py) = (sx * x, sy * y);
            let a = board(
                [px.min(px - sx * 0.04), py.min(py - sy * 0.003), 0.0],
                [px.max(px - sx * 0.04), py.max(py - sy * 0.003), HEIGHT],
                0.0006,
            );
            let c = board(
                [px.min(px - sx * 0.003), py.min(py - sy * 0.04), 0.0],
                [px.max(px - sx * 0.003), py.max(py - sy * 0.04), HEIGHT],
                0.0006,
            );
            a.with(c)
        };
        b.part(&object, "posts", all([post(-1.0, -1.0), post(1.0, -1.0), post(1.0, 1.0), post(-1.0, 1.0)]), self.metal);
        let brace = |s: f32| rod([s * (x - 0.05), 0.004 - y, 0.2], [-s * (x - 0.05), 0.004 - y, 1.6], 0.003, 6);
        b.part(&object, "braces", all([brace(1.0), brace(-1.0)]), self.metal);
        for k in 0..self.boards {
            let z = self.level(k);
            let sheet = board([0.0035 - x, 0.0035 - y, z], [x - 0.0035, y - 0.0035, z + 0.03], 0.002);
            b.part(&object, &format!("board_{}", k + 1), grained(sheet, rng), self.board);
        }
        for k in 0..self.boards {
            let z = self.level(k) + 0.03;
            let room = if k + 1 < self.boards { self.level(k + 1) - z - 0.02 } else { 0.34 };
            if k + 1 < self.boards || rng.below(2) == 0 {
                self.fill(b, pose, z, room, rng);
            }
        }
    }
}
