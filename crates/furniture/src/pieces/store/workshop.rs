//! A workshop: a bench with a vice and drawers (class table), a board on the wall with tools (class other prop), and a step ladder (class other
//! prop).

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, cut_out, cylinder, rod, to_front, wire};
use crate::pieces::joinery::{body_box, pull};
use crate::pieces::{Furniture, Surface, board, grained};
use crate::shape::{Reshape, bevelled_box, rounded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

/// A bench to work at; people stand at +y.
#[derive(Clone, Copy, Debug)]
pub struct Workbench {
    /// Width.
    pub width: f32,
    /// Drawers are at one side: −1 left, +1 right.
    pub side: i8,
    /// Finish of the frame.
    pub frame: Finish,
}

/// Height of the top, its thickness and depth, metres.
const TOP: f32 = 0.88;
const BOARD: f32 = 0.045;
const DEPTH: f32 = 0.68;

impl Furniture for Workbench {
    fn random(rng: &mut Rng) -> Self {
        let frame = [Finish::Wood, Finish::ColoredMetal(2), Finish::BlackMetal, Finish::Wood][rng.below(4)];
        Self { width: rng.range(1.4, 2.2), side: [-1, 1][rng.below(2)], frame }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH + 0.1, TOP + 0.13)
    }

    fn reach(&self) -> f32 {
        0.75
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = Vec2::new(0.5 * self.width - 0.06, 0.5 * DEPTH - 0.06);
        let s = f32::from(self.side);
        // The vice is at the other side than the drawers.
        let [low, high] = if s > 0.0 { [-half.x + 0.36, half.x] } else { [-half.x, half.x - 0.36] };
        vec![Surface { min: Vec2::new(low, -half.y), max: Vec2::new(high, half.y - 0.06), z: TOP, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("workbench", Class::Table, pose);
        let (x, back, front) = (0.5 * self.width, -0.5 * DEPTH - 0.05, 0.5 * DEPTH - 0.05);
        let under = TOP - BOARD - 0.0002;
        b.part(&object, "top", grained(board([-x, back, TOP - BOARD], [x, front, TOP], 0.004), rng), Finish::Wood);
        let leg = |sx: f32, y: f32| {
            let at = sx * (x - 0.09);
            board([at - 0.04, y - 0.04, 0.0], [at + 0.04, y + 0.04, under], 0.003)
        };
        let legs = [leg(-1.0, back + 0.08), leg(1.0, back + 0.08), leg(1.0, front - 0.08), leg(-1.0, front - 0.08)];
        let rail = |y: f32| board([0.1302 - x, y - 0.02, 0.16], [x - 0.1302, y + 0.02, 0.24], 0.002);
        b.part(&object, "frame", grained(all(legs).with(all([rail(back + 0.08), rail(front - 0.08)])), rng), self.frame);
        let shelf = board([0.14 - x, back + 0.05, 0.2402], [x - 0.14, front - 0.05, 0.262], 0.002);
        b.part(&object, "shelf", grained(shelf, rng), Finish::Wood);
        self.drawers(b, &object, [back + 0.12, front - 0.02], under, rng);
        self.vice(b, &object, front);
    }
}

impl Workbench {
    fn drawers(&self, b: &mut Builder, object: &Object, [back, front]: [f32; 2], under: f32, rng: &mut Rng) {
        let s = f32::from(self.side);
        let inner = 0.5 * self.width - 0.14;
        let (x0, x1) = if s > 0.0 { (inner - 0.46, inner) } else { (-inner, 0.46 - inner) };
        let low = under - 0.42;
        let case = body_box(b, [x0, back, low], [x1, front, under], 0.003);
        b.part(object, "case", case, self.frame);
        for k in 0..3 {
            let z = low + 0.01 + 0.135 * k as f32;
            let from = b.part_count();
            let face = board([x0 + 0.008, front - 0.0005, z], [x1 - 0.008, front + 0.018, z + 0.127], 0.003);
            b.part(object, &format!("drawer_{}", k + 1), grained(face, rng), self.frame);
            let handle = rounded_box(Vec3::new(0.14, 0.018, 0.02), 0.006, 2).moved(Vec3::new(0.5 * (x0 + x1), front + 0.0255, z + 0.085));
            b.part(object, &format!("pull_{}", k + 1), handle, Finish::BlackMetal);
            let rect = [x0 + 0.008, x1 - 0.008, z, z + 0.127];
            pull(b, object, &format!("drawer_{}", k + 1), from, rect, front, front - back - 0.03, Finish::Wood);
        }
    }

    fn vice(&self, b: &mut Builder, object: &Object, front: f32) {
        let at = Vec3::new(-f32::from(self.side) * (0.5 * self.width - 0.24), front - 0.13, TOP);
        let base = cylinder(0.075, 0.025, 28).with(rounded_box(Vec3::new(0.09, 0.16, 0.06), 0.01, 2).moved(Vec3::new(0.0, 0.0, 0.05)));
        let jaw = |y: f32| rounded_box(Vec3::new(0.16, 0.035, 0.075), 0.006, 2).moved(Vec3::new(0.0, y, 0.09));
        let slide = board([-0.025, 0.02, 0.03], [0.025, 0.19, 0.07], 0.004);
        b.part(object, "vice", all([base, jaw(0.07), jaw(0.12), slide]).moved(at), Finish::ColoredMetal(2));
        let screw = rod([0.0, 0.13, 0.05], [0.0, 0.222, 0.05], 0.013, 14).with(rod([-0.1, 0.212, 0.05], [0.1, 0.212, 0.05], 0.006, 10));
        b.part(object, "screw", screw.moved(at), Finish::Steel);
    }
}

/// A perforated board with tools; its origin is the middle of its back.
#[derive(Clone, Copy, Debug)]
pub struct ToolBoard {
    /// Width and height.
    pub size: Vec2,
    /// Finish of the board.
    pub finish: Finish,
}

/// Front of the board, metres.
const FRONT: f32 = 0.016;

impl Furniture for ToolBoard {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::ColoredMetal(2), Finish::Wood, Finish::CoatedWhite, Finish::BlackMetal][rng.below(4)];
        Self { size: Vec2::new(rng.range(1.0, 1.8), rng.range(0.8, 0.95)), finish }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x, 0.07, self.size.y)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("tool_board", Class::OtherProp, pose);
        let half = 0.5 * self.size;
        b.part(&object, "board", board([-half.x, 0.0, -half.y], [half.x, FRONT, half.y], 0.002), self.finish);
        let (columns, rows) = ((self.size.x / 0.05) as usize, (self.size.y / 0.05) as usize);
        let hole = |k: usize| {
            let at = Vec2::new((k % columns) as f32 + 0.5, (k / columns) as f32 + 0.5) / Vec2::new(columns as f32, rows as f32) - 0.5;
            to_front(cylinder(0.004, 0.0012, 8)).moved(Vec3::new(at.x * self.size.x, FRONT - 0.0006, at.y * self.size.y))
        };
        b.part(&object, "holes", all((0..columns * rows).map(hole)), Finish::BlackPlastic);
        // Tools hang in two rows; long ones in the upper one.
        for (row, z) in [half.y - 0.23, 0.22 - half.y].into_iter().enumerate() {
            let mut x = 0.07 - half.x;
            let mut count = 0;
            while x < half.x - 0.07 {
                let (width, parts) = tool(if row == 0 { 5 } else { 4 }, rng);
                if x + width > half.x - 0.03 {
                    break;
                }
                count += 1;
                for (part, mesh, finish) in parts {
                    let name = format!("tool_{}_{count}_{part}", row + 1);
                    b.part(&object, &name, mesh.moved(Vec3::new(x + 0.5 * width, FRONT, z)), finish);
                }
                x += width + rng.range(0.03, 0.07);
            }
        }
    }
}

/// One of the first `kinds` tools before the board, its width, and its parts: all touch the plane y = 0, about z = 0.
fn tool(kinds: usize, rng: &mut Rng) -> (f32, Vec<(&'static str, Mesh, Finish)>) {
    let grip = [Finish::Plastic(0), Finish::Plastic(2), Finish::Wood, Finish::BlackPlastic][rng.below(4)];
    match rng.below(kinds) {
        0 => {
            // A hammer.
            let handle = rod([0.0, 0.0135, -0.2], [0.0, 0.0135, 0.06], 0.014, 14);
            let head = rounded_box(Vec3::new(0.11, 0.03, 0.032), 0.006, 2).moved(Vec3::new(0.0, 0.0148, 0.075));
            (0.12, vec![("handle", handle, Finish::Wood), ("head", head, Finish::Steel)])
        }
        1 => {
            // A screwdriver.
            let handle = rod([0.0, 0.0148, 0.0], [0.0, 0.0148, 0.1], 0.015, 14);
            (0.035, vec![("handle", handle, grip), ("blade", rod([0.0, 0.0148, -0.14], [0.0, 0.0148, 0.002], 0.0035, 10), Finish::Steel)])
        }
        2 => {
            // A spanner.
            let shaft = bevelled_box(Vec3::new(0.016, 0.006, 0.2), 0.002).moved(Vec3::new(0.0, 0.0029, 0.0));
            let ends = [-0.1f32, 0.1].map(|z| to_front(cylinder(0.02, 0.008, 20)).moved(Vec3::new(0.0, 0.0, z)));
            (0.045, vec![("shaft", shaft.with(all(ends)), Finish::Chrome)])
        }
        3 => {
            // Pliers.
            let leg = |s: f32| wire(&[[s * 0.03, 0.0075, -0.11], [s * 0.026, 0.0075, -0.05], [0.0, 0.0075, 0.0]], 0.0078, 10);
            let head = rounded_box(Vec3::new(0.028, 0.014, 0.07), 0.005, 2).moved(Vec3::new(0.0, 0.0069, 0.03));
            (0.08, vec![("handles", leg(-1.0).with(leg(1.0)), grip), ("head", head, Finish::Steel)])
        }
        _ => {
            // A hand saw.
            let outline = [[-0.025, -0.25], [0.025, -0.25], [0.065, 0.1], [-0.065, 0.1]].map(Vec2::from);
            let blade = to_front(cut_out(&outline, 0.002, 0.0004)).turned(Vec3::Y, PI);
            let handle = wire(&[[-0.055, 0.0125, 0.09], [-0.055, 0.0125, 0.19], [0.05, 0.0125, 0.2], [0.05, 0.0125, 0.09]], 0.0128, 12);
            (0.14, vec![("blade", blade, Finish::Steel), ("handle", handle, grip)])
        }
    }
}

/// A step ladder that stands open.
#[derive(Clone, Copy, Debug)]
pub struct StepLadder {
    /// Steps.
    pub steps: usize,
}

/// From one step to the next, metres, and the lean of its sides.
const STEP: f32 = 0.24;
const LEAN: f32 = 0.27;

impl Furniture for StepLadder {
    fn random(rng: &mut Rng) -> Self {
        Self { steps: 3 + rng.below(4) }
    }

    fn size(&self) -> Vec3 {
        let top = STEP * self.steps as f32;
        Vec3::new(0.52, 2.0 * LEAN * top + 0.16, top + 0.03)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("step_ladder", Class::OtherProp, pose);
        let top = STEP * self.steps as f32;
        // Half the width between the stiles, which are apart farther below.
        let half = |z: f32| 0.16 + 0.08 * (1.0 - z / top);
        let stile = |sx: f32, sy: f32| {
            let from = [sx * half(0.0), sy * (LEAN * top + 0.05), 0.012];
            let to = [sx * half(top), sy * 0.04, top - 0.012];
            rod(from, to, 0.0125, 12)
        };
        let sides = all([stile(-1.0, 1.0), stile(1.0, 1.0), stile(-1.0, -1.0), stile(1.0, -1.0)]);
        b.part(&object, "stiles", sides, Finish::Aluminium);
        let y = |z: f32| 0.05 + LEAN * (top - z) - 0.01 * z / top;
        let tread = |k: usize| {
            let z = STEP * k as f32;
            rounded_box(Vec3::new(2.0 * half(z) + 0.01, 0.085, 0.024), 0.006, 2).moved(Vec3::new(0.0, y(z), z))
        };
        b.part(&object, "treads", all((1..self.steps).map(tread)), Finish::Aluminium);
        b.part(&object, "top", rounded_box(Vec3::new(0.37, 0.16, 0.03), 0.008, 2).moved(Vec3::new(0.0, 0.0, top)), Finish::BlackPlastic);
        let bar = |z: f32| rod([-half(z), -y(z), z], [half(z), -y(z), z], 0.008, 10);
        b.part(&object, "bars", all([bar(0.3), bar(0.62 * top)]), Finish::Aluminium);
        let feet = [(-1.0f32, -1.0f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(sx, sy)| {
            cylinder(0.018, 0.03, 14).turned(Vec3::Z, FRAC_PI_2).moved(Vec3::new(sx * half(0.0), sy * (LEAN * top + 0.05), 0.0))
        });
        b.part(&object, "feet", all(feet), Finish::Rubber);
    }
}
