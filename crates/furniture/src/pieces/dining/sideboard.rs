//! A long low cabinet of 130 to 190 × 74 to 82 cm on splayed legs, class cabinet: doors that are plain, fluted or filled with rattan, and
//! three drawers. The body is of wood; fronts may be lacquered. It is half the depth of its knobs behind the middle of the footprint.

use crate::builder::{Builder, Class};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::{all, to_front, turned};
use crate::pieces::joinery::{Knobbed, body_box};
use crate::pieces::{Furniture, Surface, board, grained, leg, on};
use crate::shape::{Reshape, bevelled_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A long low cabinet with doors and drawers.
#[derive(Clone, Copy, Debug)]
pub struct Sideboard {
    /// Width along x.
    pub width: f32,
    /// Height of the top's surface.
    pub height: f32,
    /// Style of the doors.
    pub doors: DoorStyle,
    /// Finish of doors and drawer fronts.
    pub fronts: Finish,
}

/// Styles of a sideboard's doors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum DoorStyle {
    Plain,
    /// Upright rounded slats.
    Fluted,
    Rattan,
}

/// Depth without the knobs, metres.
const DEPTH: f32 = 0.43;
/// How far knobs protrude beyond the top, metres.
const KNOB: f32 = 0.018;
/// Height of the legs, metres.
const LEG: f32 = 0.15;
/// Thickness of the boards, metres.
const BOARD: f32 = 0.02;
/// Thickness of doors and drawer fronts, metres.
const FRONT: f32 = 0.018;
/// Air between boards that meet, metres: it keeps faces out of one plane.
const GAP: f32 = 0.0002;

impl Sideboard {
    /// A door over `[x0, x1, z0, z1]` before the depth `y`.
    fn door(&self, b: &mut Builder, object: &crate::builder::Object, number: usize, [x0, x1, z0, z1]: [f32; 4], y: f32, rng: &mut Rng) {
        let name = format!("door_{number}");
        match self.doors {
            DoorStyle::Plain => b.part(object, &name, grained(board([x0, y, z0], [x1, y + FRONT, z1], 0.0012), rng), self.fronts),
            DoorStyle::Fluted => {
                let count = ((x1 - x0) / 0.022) as usize;
                let step = (x1 - x0) / count as f32;
                let slats = (0..count).map(|k| {
                    let x = x0 + (k as f32 + 0.5) * step;
                    bevelled_box(Vec3::new(step - 0.001, FRONT, z1 - z0), 0.0062).moved(Vec3::new(x, y + 0.5 * FRONT, 0.5 * (z0 + z1)))
                });
                b.part(object, &name, grained(all(slats), rng), self.fronts);
            }
            DoorStyle::Rattan => {
                let section = [[0.0, 0.0], [0.0, 0.017], [0.001, FRONT], [0.044, FRONT], [0.045, 0.017], [0.045, 0.0]];
                let at = Vec3::new(0.5 * (x0 + x1), y, 0.5 * (z0 + z1));
                b.part(object, &name, grained(crate::shape::picture_frame(x1 - x0, z1 - z0, &section).moved(at), rng), self.fronts);
                let panel = board([x0 + 0.043, y + 0.004, z0 + 0.043], [x1 - 0.043, y + 0.009, z1 - 0.043], 0.0005);
                b.part(object, &format!("panel_{number}"), panel, Finish::Rattan);
            }
        }
    }
}

impl Furniture for Sideboard {
    fn random(rng: &mut Rng) -> Self {
        let doors = [DoorStyle::Plain, DoorStyle::Fluted, DoorStyle::Rattan][rng.below(3)];
        let fronts = match doors {
            DoorStyle::Plain => [Finish::Wood, Finish::WhiteLacquer, Finish::ColoredLacquer(rng.below(4) as u8)][rng.below(3)],
            _ => Finish::Wood,
        };
        Self { width: rng.range(1.3, 1.9), height: rng.range(0.74, 0.82), doors, fronts }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH + KNOB, self.height)
    }

    fn reach(&self) -> f32 {
        0.7
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = Vec2::new(0.5 * self.width - 0.03, 0.5 * DEPTH - 0.03);
        vec![Surface { min: -half, max: half, z: self.height, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let pose = on(pose, Vec3::new(0.0, -0.5 * KNOB, 0.0), 0.0);
        let object = b.object("sideboard", Class::Cabinet, pose);
        let (half, back, front, top) = (0.5 * self.width, -0.5 * DEPTH, 0.5 * DEPTH, self.height);
        let wood = Finish::Wood;
        b.part(&object, "top", grained(board([-half, back, top - BOARD], [half, front, top], 0.002), rng), wood);
        b.part(&object, "bottom", grained(board([-half, back, LEG], [half, front, LEG + BOARD], 0.002), rng), wood);
        let side = |x: f32| board([x, back, LEG + BOARD + GAP], [x + BOARD, front, top - BOARD - GAP], 0.0015);
        b.part(&object, "sides", grained(side(-half).with(side(half - BOARD)), rng), wood);
        let (x0, x1, z0, z1) = (-half + BOARD, half - BOARD, LEG + BOARD, top - BOARD);
        let body = body_box(b, [x0, back + 0.004, z0 + GAP], [x1, front - 0.024, z1 - GAP], 0.001);
        b.part(&object, "body", body, wood);
        // Two doors, three drawers, one more door where there is room for it.
        let sections = if self.width > 1.55 { 4 } else { 3 };
        let w = (x1 - x0) / sections as f32;
        let y = front - 0.0235;
        let mut fronts = Knobbed::default();
        let knob = |x: f32, z: f32| {
            let profile = [[0.0, 0.0], [0.006, 0.0], [0.005, 0.01], [0.011, 0.016], [0.011, 0.021], [0.0, 0.023]];
            to_front(turned(&profile, 20)).moved(Vec3::new(x, y + 0.0178, z))
        };
        for k in 0..sections {
            let (a, c) = (x0 + w * k as f32 + 0.002, x0 + w * (k + 1) as f32 - 0.002);
            if k == 1 {
                for row in 0..3 {
                    let h = (z1 - z0 - 0.004) / 3.0;
                    let (low, high) = (z0 + 0.002 + h * row as f32 + 0.001, z0 + 0.002 + h * (row + 1) as f32 - 0.001);
                    let from = b.part_count();
                    b.part(
                        &object,
                        &format!("drawer_{}", row + 1),
                        grained(board([a, y, low], [c, y + FRONT, high], 0.0012), rng),
                        self.fronts,
                    );
                    let knob = knob(0.5 * (a + c), 0.5 * (low + high));
                    let name = format!("drawer_{}", row + 1);
                    fronts.drawer(b, &object, (&name, from), [a, c, low, high], [back + 0.04, y], knob);
                }
            } else {
                let from = b.part_count();
                self.door(b, &object, k + 1, [a, c, z0 + 0.003, z1 - 0.003], y, rng);
                let knob = knob(if k == 0 { c - 0.022 } else { a + 0.022 }, 0.5 * (z0 + z1) + 0.1);
                let (edge, side) = if k == 0 { (a, -1.0) } else { (c, 1.0) };
                fronts.door(b, &format!("door_{}", k + 1), from, Joint::cupboard(edge, y + FRONT, side), knob);
            }
        }
        fronts.add(b, &object, [Finish::Brass, Finish::BlackMetal][rng.below(2)]);
        for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
            let at = Vec3::new(s.x * (half - 0.12), s.y * (front - 0.075), 0.0);
            b.part(&object, &format!("leg_{}", i + 1), leg(LEG - GAP, [0.012, 0.02], s * 0.03).moved(at), wood);
        }
    }
}
