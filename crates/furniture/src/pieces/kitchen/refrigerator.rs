//! Free-standing refrigerators of four kinds, 60 to 91 cm wide and 150 to 186 cm high, of class refrigerator: combined with a freezer below
//! or above, side by side with an ice dispenser, and with one round door in a colour. Half of them have notes under magnets on the upper
//! door, each an object of class paper.

use crate::builder::{Builder, Class, Object};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod};
use crate::pieces::joinery::hollow_box;
use crate::pieces::{CONTACT, Furniture, Surface, board};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A free-standing refrigerator.
#[derive(Clone, Copy, Debug)]
pub struct Refrigerator {
    /// Arrangement of its doors.
    pub kind: Kind,
    /// Finish of body and doors.
    pub finish: Finish,
    /// Number of notes on the door, each under a magnet.
    pub notes: usize,
}

/// Arrangements of a refrigerator's doors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A cooling compartment over a freezer.
    Combined,
    /// A small freezer over a cooling compartment.
    FreezerOnTop,
    /// Two tall doors, ice from the left one.
    SideBySide,
    /// One door with very round edges.
    Retro,
}

impl Refrigerator {
    fn body(&self) -> [f32; 3] {
        match self.kind {
            Kind::Combined => [0.595, 0.65, 1.86],
            Kind::FreezerOnTop => [0.60, 0.64, 1.68],
            Kind::SideBySide => [0.91, 0.70, 1.78],
            Kind::Retro => [0.60, 0.64, 1.50],
        }
    }

    /// Door rectangles `[x0, x1, z0, z1]` and the side of their handle.
    fn doors(&self) -> Vec<([f32; 4], f32)> {
        let [w, _, h] = self.body();
        let half = 0.5 * w;
        match self.kind {
            Kind::Combined => vec![([-half, half, 0.07, 0.72], 1.0), ([-half, half, 0.725, h], 1.0)],
            Kind::FreezerOnTop => vec![([-half, half, 0.07, 1.2], -1.0), ([-half, half, 1.205, h], -1.0)],
            Kind::SideBySide => vec![([-half, 0.08 - 0.0025, 0.07, h], 1.0), ([0.08 + 0.0025, half, 0.07, h], -1.0)],
            Kind::Retro => vec![([-half, half, 0.10, h], 1.0)],
        }
    }
}

impl Furniture for Refrigerator {
    fn random(rng: &mut Rng) -> Self {
        let kind = [Kind::Combined, Kind::Combined, Kind::FreezerOnTop, Kind::SideBySide, Kind::Retro][rng.below(5)];
        let finish = match kind {
            Kind::Retro => Finish::ColoredLacquer(rng.below(4) as u8),
            _ => [Finish::Steel, Finish::CoatedWhite, Finish::GlossBlack, Finish::CoatedWhite][rng.below(4)],
        };
        Self { kind, finish, notes: if rng.below(2) == 0 { 0 } else { 2 + rng.below(5) } }
    }

    fn size(&self) -> Vec3 {
        let [w, d, h] = self.body();
        Vec3::new(w, d + 0.05, h)
    }

    /// The door swings over its own width.
    fn reach(&self) -> f32 {
        0.75
    }

    fn surfaces(&self) -> Vec<Surface> {
        let [w, d, h] = self.body();
        let half = 0.5 * Vec2::new(w, d) - 0.07;
        if self.kind == Kind::Retro { Vec::new() } else { vec![Surface { min: -half, max: half, z: h, headroom: f32::INFINITY }] }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let fridge = b.object("refrigerator", Class::Refrigerator, pose);
        let [w, d, h] = self.body();
        let (back, door) = (-0.5 * (d + 0.05), 0.06);
        let front = back + d - door;
        let round: f32 = if self.kind == Kind::Retro { 0.055 } else { 0.006 };
        let low = self.doors()[0].0[2];
        let body = rounded_box(Vec3::new(w, front - back - 0.004, h - 0.05), round.min(0.03), 3);
        let body = body.moved(Vec3::new(0.0, 0.5 * (back + front) - 0.002, 0.05 + 0.5 * (h - 0.05)));
        if b.has_joints() {
            self.inside(b, &fridge, [back, front - 0.004], low);
        } else {
            b.part(&fridge, "body", body, self.finish);
        }
        b.part(
            &fridge,
            "grille",
            board([0.03 - 0.5 * w, front - 0.06, 0.012], [0.5 * w - 0.03, front + 0.02, low - 0.006], 0.002),
            Finish::BlackPlastic,
        );
        for (i, (x, y)) in [(-1.0, back + 0.06), (1.0, back + 0.06), (-1.0, front - 0.08), (1.0, front - 0.08)].into_iter().enumerate() {
            let at = Vec3::new(x * (0.5 * w - 0.05), y, 0.0);
            b.part(&fridge, &format!("foot_{}", i + 1), cylinder(0.018, 0.052, 16).moved(at), Finish::BlackPlastic);
        }
        let mut doors = Vec::new();
        for (i, (rect, side)) in self.doors().into_iter().enumerate() {
            let [x0, x1, z0, z1] = rect;
            let mesh = rounded_box(Vec3::new(x1 - x0, door, z1 - z0), round, 4);
            let at = Vec3::new(0.5 * (x0 + x1), front + 0.5 * door, 0.5 * (z0 + z1));
            let from = b.part_count();
            b.part(&fridge, &format!("door_{}", i + 1), mesh.moved(at), self.finish);
            let x = if side > 0.0 { x1 - 0.045 } else { x0 + 0.045 };
            let length = f32::min(0.5 * (z1 - z0), 0.5);
            let (lower, upper) = match self.kind {
                Kind::Combined if i == 0 => (z1 - 0.05 - length, z1 - 0.05),
                Kind::SideBySide => (0.75, 1.35),
                Kind::Retro => (1.0, 1.24),
                Kind::FreezerOnTop if i == 0 => (z1 - 0.06 - length, z1 - 0.06),
                _ => (z0 + 0.05, z0 + 0.05 + length),
            };
            b.part(&fridge, &format!("handle_{}", i + 1), bar(x, front + door, [lower, upper]), Finish::Chrome);
            let joint = Joint::cupboard(if side > 0.0 { x0 } else { x1 }, front + door, -side);
            doors.push((joint, from..b.part_count()));
        }
        let mut on_door = Vec::new();
        if self.kind == Kind::SideBySide {
            let niche = board([-0.33, front + door - 0.0002, 0.98], [-0.09, front + door + 0.004, 1.36], 0.002);
            on_door.push(b.part_count());
            b.part(&fridge, "dispenser", niche, Finish::GlossBlack);
        }
        for (i, (joint, parts)) in doors.into_iter().enumerate() {
            // Ice comes from the first of two doors.
            let more = on_door.iter().copied().filter(|_| i == 0);
            b.joint(&fridge, &format!("door_{}", i + 1), &joint, parts.chain(more));
        }
        self.notes(b, pose, front + door, rng);
    }
}

impl Refrigerator {
    /// The body of a refrigerator that can be opened, between two depths: walls, a lining with shelves, and a board between the compartments
    /// behind its doors, which begin at the height `low`.
    fn inside(&self, b: &mut Builder, fridge: &Object, [back, front]: [f32; 2], low: f32) {
        let [w, _, h] = self.body();
        let (x, wall) = (0.5 * w, 0.04);
        b.part(fridge, "body", hollow_box([-x, back, 0.05], [x, front, h], wall), self.finish);
        let (x0, x1, y0, y1) = (wall - x + 0.0004, x - wall - 0.0004, back + wall + 0.0004, front - 0.002);
        let (floor, roof) = (0.05 + wall + 0.0004, h - wall - 0.0004);
        b.part(fridge, "lining", hollow_box([x0, y0, floor], [x1, y1, roof], 0.004), Finish::CoatedWhite);
        let split = self.doors()[0].0[3];
        let levels = [low + 0.3, low + 0.6, low + 0.9, low + 1.2, low + 1.5].into_iter();
        let apart = |z: &f32| *z < roof - 0.15 && (self.kind == Kind::SideBySide || (z - split).abs() > 0.1);
        let shelf = |z: f32| board([x0 + 0.006, y0 + 0.006, z], [x1 - 0.006, y1 - 0.06, z + 0.005], 0.001);
        b.part(fridge, "shelves", all(levels.filter(apart).map(shelf)), Finish::Glass);
        match self.kind {
            Kind::Combined | Kind::FreezerOnTop => {
                let between = board([x0 + 0.0042, y0 + 0.0042, split - 0.02], [x1 - 0.0042, y1, split + 0.025], 0.002);
                b.part(fridge, "divider", between, Finish::CoatedWhite);
            }
            Kind::SideBySide => {
                let between = board([0.055, y0 + 0.0042, floor + 0.0042], [0.105, y1, roof - 0.0042], 0.002);
                b.part(fridge, "divider", between, Finish::CoatedWhite);
            }
            Kind::Retro => {}
        }
    }

    /// Sheets of paper on the upper door, each under a magnet.
    fn notes(&self, b: &mut Builder, pose: DAffine3, y: f32, rng: &mut Rng) {
        let [w, _, h] = self.body();
        for k in 0..self.notes.min(6) {
            let (column, row) = ((k % 2) as f32, (k / 2) as f32);
            let size = Vec2::new(rng.range(0.075, 0.12), rng.range(0.08, 0.15));
            let at = Vec3::new(0.25 * w * (column - 0.9) + rng.range(-0.02, 0.02), y, h - 0.22 - 0.19 * row + rng.range(-0.02, 0.02));
            let pose = super::super::on(pose, at, 0.0) * DAffine3::from_rotation_y(f64::from(rng.range(-0.06, 0.06)));
            let paper = b.object("note", Class::Paper, pose);
            let sheet = board([-0.5 * size.x, CONTACT, -size.y], [0.5 * size.x, CONTACT + 0.0004, 0.012], 0.0001);
            b.part(&paper, "sheet", sheet, Finish::Paper);
            let magnet = crate::pieces::form::to_front(cylinder(0.011, 0.006, 20)).moved(Vec3::new(0.0, CONTACT + 0.0005, 0.0));
            b.part(&paper, "magnet", magnet, Finish::Plastic(k as u8));
        }
    }
}

/// An upright bar handle on a door whose face is at depth `y`.
fn bar(x: f32, y: f32, [from, to]: [f32; 2]) -> enfilade_geometry::Mesh {
    let post = |z: f32| rod([x, y - 0.002, z], [x, y + 0.036, z], 0.006, 10);
    all([rod([x, y + 0.037, from], [x, y + 0.037, to], 0.009, 14), post(from + 0.04), post(to - 0.04)])
}
