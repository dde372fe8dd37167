//! A desk of 100 to 170 × 60 to 80 cm, class desk, on drawers and legs, trestles, lifting columns, or as a writing desk with a shelf; with
//! nothing, a laptop, or a monitor with keyboard and mouse on it. The person sits at +y and has −x at the right hand.

use super::{Keyboard, Laptop, Monitor, Mouse};
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod};
use crate::pieces::joinery::{body_box, pull};
use crate::pieces::{Furniture, Surface, board, grained, leg, on};
use crate::shape::{Reshape, bevelled_box, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A desk; the person sits at its front (+y).
#[derive(Clone, Copy, Debug)]
pub struct Desk {
    /// Width along x.
    pub width: f32,
    /// Depth along y.
    pub depth: f32,
    /// The stand under the top.
    pub stand: DeskStand,
    /// Finish of the top.
    pub finish: Finish,
    /// The computer on the desk.
    pub computer: Computer,
}

/// The computer in front of a person at a desk.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "plain words")]
pub enum Computer {
    Nothing,
    Laptop(Laptop),
    Screen(Monitor, Keyboard, Mouse),
}

impl Computer {
    fn random(rng: &mut Rng) -> Self {
        match rng.below(4) {
            0 => Self::Nothing,
            1 => Self::Laptop(Laptop::random(rng)),
            _ => Self::Screen(
                Monitor::random(rng),
                Keyboard { columns: 15, ..Keyboard::random(rng) },
                Mouse { pad: false, ..Mouse::random(rng) },
            ),
        }
    }

    /// Half of the width that it takes.
    fn reach(&self) -> f32 {
        match self {
            Self::Nothing => 0.0,
            Self::Laptop(laptop) => 0.5 * laptop.width + 0.02,
            Self::Screen(monitor, keyboard, mouse) => (0.5 * monitor.width).max(0.5 * keyboard.size().x + 0.09 + mouse.size().x) + 0.02,
        }
    }
}

/// The stand under the top of a desk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeskStand {
    /// Drawers on one side (−1 or +1), two legs on the other.
    Drawers(i8),
    /// Two trestles.
    Trestles,
    /// Two lifting columns on feet, at the height of someone who sits.
    Columns,
    /// Slanted legs with a flat drawer under the top and a low shelf at the back.
    Writing,
}

/// Height of the top, metres: EN 527 has 740 mm for desks that do not adjust.
const TOP: f32 = 0.74;
/// Thickness of the top, metres.
const BOARD: f32 = 0.025;
/// Upper end of a stand, just below the top, metres: air keeps faces out of one plane.
const UNDER: f32 = TOP - BOARD - 0.0002;
/// Height of the shelf's surface at the back of a writing desk, metres.
const SHELF: f32 = TOP + 0.146;

impl Desk {
    /// Position of a chair that faces the desk.
    pub fn seat(&self) -> Vec2 {
        let aside = if let DeskStand::Drawers(side) = self.stand { -0.2 * f32::from(side) } else { 0.0 };
        Vec2::new(aside, 0.5 * self.depth + 0.22)
    }

    fn drawers(&self, b: &mut Builder, desk: &Object, side: f32, rng: &mut Rng) {
        let (half, back, front) = (0.5 * self.width, -0.5 * self.depth, 0.5 * self.depth);
        let (w, low, under) = (0.42, 0.04, UNDER);
        let (x0, x1) = if side > 0.0 { (half - w - 0.02, half - 0.02) } else { (0.02 - half, 0.02 - half + w) };
        let white = if self.finish == Finish::WhiteLacquer { Finish::WhiteLacquer } else { self.finish };
        let pedestal = body_box(b, [x0, back + 0.03, low], [x1, front - 0.042, under], 0.0015);
        b.part(desk, "pedestal", grained(pedestal, rng), white);
        b.part(desk, "plinth", board([x0 + 0.02, back + 0.05, 0.0], [x1 - 0.02, front - 0.07, low - 0.0002], 0.001), Finish::BlackPlastic);
        let cuts = [0.0, 0.44, 0.72, 1.0];
        let mut pulls = Vec::new();
        for k in 0..3 {
            let z = [cuts[k], cuts[k + 1]].map(|t| low + t * (under - low));
            let face = board([x0 + 0.001, front - 0.0415, z[0] + 0.0015], [x1 - 0.001, front - 0.022, z[1] - 0.0015], 0.0012);
            let from = b.part_count();
            b.part(desk, &format!("drawer_{}", k + 1), grained(face, rng), white);
            let rect = [x0 + 0.001, x1 - 0.001, z[0], z[1]];
            let (x, y, z) = (0.5 * (x0 + x1), front - 0.0222, z[1] - 0.045);
            let post = |x: f32| rod([x, y, z], [x, y + 0.019, z], 0.004, 8);
            let bar = all([rod([x - 0.07, y + 0.018, z], [x + 0.07, y + 0.018, z], 0.005, 10), post(x - 0.055), post(x + 0.055)]);
            if b.has_joints() {
                b.part(desk, &format!("pull_{}", k + 1), bar, Finish::Steel);
                let y = front - 0.0415;
                pull(b, desk, &format!("drawer_{}", k + 1), from, rect, y, y - back - 0.06, white);
            } else {
                pulls.push(bar);
            }
        }
        if !b.has_joints() {
            b.part(desk, "pulls", all(pulls), Finish::Steel);
        }
        for (i, y) in [back + 0.05, front - 0.05].into_iter().enumerate() {
            let x = -side * (half - 0.04);
            let post = board([x - 0.02, y - 0.02, 0.0], [x + 0.02, y + 0.02, under], 0.002);
            b.part(desk, &format!("leg_{}", i + 1), post, Finish::BlackMetal);
        }
        let screen = board([-half + 0.05, back + 0.034, 0.36], [half - 0.05, back + 0.05, under], 0.0015);
        b.part(desk, "modesty_panel", grained(screen, rng), white);
    }

    fn trestles(&self, b: &mut Builder, desk: &Object, rng: &mut Rng) {
        let under = UNDER;
        for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
            let (x, y) = (s * (0.5 * self.width - 0.28), 0.5 * self.depth - 0.09);
            let beam = bevelled_box(Vec3::new(0.045, 2.0 * y, 0.045), 0.003).moved(Vec3::new(x, 0.0, under - 0.0225));
            let mut parts = vec![beam];
            for q in [-1.0f32, 1.0] {
                for splay in [-1.0f32, 1.0] {
                    let foot = [x + 0.16 * splay, q * (y - 0.03), 0.0];
                    parts.push(crate::pieces::standing(rod(foot, [x + 0.012 * splay, q * (y - 0.07), under - 0.02], 0.015, 10)));
                }
                parts.push(rod([x - 0.11, q * (y - 0.043), 0.22], [x + 0.11, q * (y - 0.043), 0.22], 0.011, 8));
            }
            b.part(desk, &format!("trestle_{}", i + 1), grained(all(parts), rng), Finish::Wood);
        }
    }

    fn columns(&self, b: &mut Builder, desk: &Object) {
        let under = UNDER;
        let half = 0.5 * self.width - 0.2;
        for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
            let x = s * half;
            let foot = rounded_box(Vec3::new(0.07, self.depth - 0.06, 0.03), 0.006, 2).moved(Vec3::new(x, 0.0, 0.015));
            let outer = rounded_box(Vec3::new(0.075, 0.06, 0.45), 0.006, 2).moved(Vec3::new(x, 0.0, 0.03 + 0.2248));
            let inner = rounded_box(Vec3::new(0.065, 0.05, under - 0.44), 0.005, 2).moved(Vec3::new(x, 0.0, 0.5 * (under + 0.44)));
            let arm = bevelled_box(Vec3::new(0.05, self.depth - 0.1, 0.03), 0.002).moved(Vec3::new(x, 0.0, under - 0.015));
            b.part(desk, &format!("column_{}", i + 1), all([foot, outer, inner, arm]), Finish::BlackMetal);
        }
        b.part(
            desk,
            "rail",
            bevelled_box(Vec3::new(2.0 * half, 0.06, 0.04), 0.002).moved(Vec3::new(0.0, 0.0, under - 0.05)),
            Finish::BlackMetal,
        );
        let panel =
            rounded_box(Vec3::new(0.12, 0.03, 0.02), 0.004, 2).moved(Vec3::new(half - 0.12, 0.5 * self.depth - 0.03, under - 0.0102));
        b.part(desk, "switch", panel, Finish::BlackPlastic);
    }

    fn writing(&self, b: &mut Builder, desk: &Object, rng: &mut Rng) {
        let under = UNDER;
        let half = 0.5 * Vec2::new(self.width, self.depth);
        for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
            let mesh = leg(under - 0.09, [0.013, 0.021], s * Vec2::new(0.05, 0.03)).moved((s * (half - 0.07)).extend(0.0));
            b.part(desk, &format!("leg_{}", i + 1), grained(mesh, rng), self.finish);
        }
        let case = body_box(b, [-half.x + 0.03, -half.y + 0.03, under - 0.0902], [half.x - 0.03, half.y - 0.045, under], 0.0015);
        b.part(desk, "case", grained(case, rng), self.finish);
        for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
            let x = [0.002, half.x - 0.032].map(|x| s * x);
            let face = board([x[0].min(x[1]), half.y - 0.0445, under - 0.088], [x[0].max(x[1]), half.y - 0.026, under - 0.002], 0.0012);
            let from = b.part_count();
            b.part(desk, &format!("drawer_{}", i + 1), grained(face, rng), self.finish);
            let knob =
                crate::pieces::form::to_front(cylinder(0.009, 0.02, 18)).moved(Vec3::new(0.5 * s * half.x, half.y - 0.0262, under - 0.045));
            b.part(desk, &format!("knob_{}", i + 1), knob, Finish::Brass);
            let rect = [x[0].min(x[1]), x[0].max(x[1]), under - 0.088, under - 0.002];
            pull(b, desk, &format!("drawer_{}", i + 1), from, rect, half.y - 0.0445, 2.0 * half.y - 0.11, self.finish);
        }
        let (y0, y1, z) = (-half.y, -half.y + 0.17, TOP + 0.13);
        let post = |x: f32| board([x - 0.008, y0, TOP + 0.0003], [x + 0.008, y1, z - 0.0002], 0.001);
        let shelf = board([-half.x, y0, z], [half.x, y1, z + 0.016], 0.0015);
        let posts = all([-half.x + 0.008, -0.33 * half.x, 0.33 * half.x, half.x - 0.008].map(post));
        b.part(desk, "shelf", grained(shelf.with(posts), rng), self.finish);
    }
}

impl Furniture for Desk {
    fn random(rng: &mut Rng) -> Self {
        let stands = [DeskStand::Drawers(1), DeskStand::Drawers(-1), DeskStand::Trestles, DeskStand::Columns, DeskStand::Writing];
        let stand = stands[rng.below(5)];
        let (width, depth) =
            if stand == DeskStand::Writing { (rng.range(1.0, 1.25), 0.6) } else { (rng.range(1.3, 1.7), rng.range(0.68, 0.8)) };
        let finish = [Finish::Wood, Finish::WhiteLacquer, Finish::DarkWood][rng.below(3)];
        let computer = match Computer::random(rng) {
            // A writing desk's shelf leaves no room for a screen.
            Computer::Screen(..) if stand == DeskStand::Writing => Computer::Nothing,
            computer => computer,
        };
        Self { width, depth, stand, finish, computer }
    }

    fn size(&self) -> Vec3 {
        let carried = match self.computer {
            Computer::Nothing => 0.0,
            Computer::Laptop(laptop) => laptop.size().z,
            Computer::Screen(monitor, ..) => monitor.size().z,
        };
        let shelf = if self.stand == DeskStand::Writing { SHELF - TOP } else { 0.0 };
        Vec3::new(self.width, self.depth, TOP + carried.max(shelf))
    }

    /// Room to push a chair back: EN 527 asks for 0.85 m.
    fn reach(&self) -> f32 {
        0.85
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = 0.5 * Vec2::new(self.width, self.depth) - 0.03;
        let open = |min: Vec2, max: Vec2, z: f32| Surface { min, max, z, headroom: f32::INFINITY };
        let writing = self.stand == DeskStand::Writing;
        let back = if writing { 0.16 - half.y } else { -half.y };
        let mut free = match self.computer {
            Computer::Nothing => vec![open(Vec2::new(-half.x, back), half, TOP)],
            _ => {
                let (x, reach) = (self.seat().x, self.computer.reach());
                let right = open(Vec2::new(-half.x, back), Vec2::new(x - reach, half.y), TOP);
                vec![right, open(Vec2::new(x + reach, back), half, TOP)]
            }
        };
        free.retain(|s| s.max.x - s.min.x > 0.12);
        if writing {
            free.push(open(-half, Vec2::new(half.x, back - 0.03), SHELF));
        }
        free
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let desk = b.object("desk", Class::Desk, pose);
        let half = 0.5 * Vec2::new(self.width, self.depth);
        let top = board([-half.x, -half.y, TOP - BOARD], [half.x, half.y, TOP], 0.0025);
        b.part(&desk, "top", grained(top, rng), self.finish);
        match self.stand {
            DeskStand::Drawers(side) => self.drawers(b, &desk, f32::from(side), rng),
            DeskStand::Trestles => self.trestles(b, &desk, rng),
            DeskStand::Columns => self.columns(b, &desk),
            DeskStand::Writing => self.writing(b, &desk, rng),
        }
        let x = self.seat().x;
        let at = |x: f32, y: f32| on(pose, Vec3::new(x, y, TOP), 0.0);
        match self.computer {
            Computer::Nothing => {}
            Computer::Laptop(laptop) => laptop.build(b, at(x, half.y - 0.06 - 0.5 * laptop.size().y), rng),
            Computer::Screen(monitor, keyboard, mouse) => {
                monitor.build(b, at(x, 0.13 - half.y), rng);
                keyboard.build(b, at(x, half.y - 0.17), rng);
                // The person looks towards −y and has −x at the right hand.
                mouse.build(b, at(x - 0.5 * keyboard.size().x - 0.07, half.y - 0.18), rng);
            }
        }
    }
}
