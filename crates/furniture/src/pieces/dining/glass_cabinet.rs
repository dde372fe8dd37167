//! A cabinet of 80 to 100 × 175 to 205 cm with glazed doors over closed ones, class cabinet, of wood or lacquer with brass knobs. Crockery
//! stands on three shelves behind the glass. The cabinet is half the depth of its knobs behind the middle of the footprint.

use crate::builder::{Builder, Class};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::{all, to_front, turned};
use crate::pieces::joinery::Knobbed;
use crate::pieces::tableware::shelf_of_crockery;
use crate::pieces::{Furniture, board, grained, on};
use crate::shape::{Reshape, grid, picture_frame};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A cabinet with glazed doors over closed ones, crockery behind the glass.
#[derive(Clone, Copy, Debug)]
pub struct GlassCabinet {
    /// Width along x, for two doors.
    pub width: f32,
    /// Height of the whole cabinet.
    pub height: f32,
    /// Finish of all but glass and knobs.
    pub finish: Finish,
}

/// Depth without the knobs, metres.
const DEPTH: f32 = 0.40;
/// How far knobs protrude beyond the top, metres.
const KNOB: f32 = 0.022;
/// Thickness of the boards, metres.
const BOARD: f32 = 0.02;
/// Upper edge of the closed part, metres.
const CLOSED: f32 = 0.72;

impl Furniture for GlassCabinet {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::Wood, Finish::DarkWood, Finish::WhiteLacquer, Finish::ColoredLacquer(rng.below(4) as u8)][rng.below(4)];
        Self { width: rng.range(0.8, 1.0), height: rng.range(1.75, 2.05), finish }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH + KNOB, self.height)
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let pose = on(pose, Vec3::new(0.0, -0.5 * KNOB, 0.0), 0.0);
        let object = b.object("glass_cabinet", Class::Cabinet, pose);
        let (half, back, front, top) = (0.5 * self.width, -0.5 * DEPTH, 0.5 * DEPTH, self.height);
        let side = |x: f32| board([x, back, 0.0], [x + BOARD, front - 0.022, top - BOARD - 0.0002], 0.0015);
        let level = |z: f32, y: f32| board([BOARD - half, back + 0.008, z], [half - BOARD, y, z + BOARD], 0.0012);
        let inner = front - 0.03;
        let step = (top - BOARD - CLOSED) / 3.0;
        let shelves: Vec<f32> = (0..3).map(|k| CLOSED + step * k as f32 - if k == 0 { BOARD } else { 0.0 }).collect();
        b.part(&object, "top", grained(board([-half, back, top - BOARD], [half, front, top], 0.003), rng), self.finish);
        b.part(&object, "sides", grained(side(-half).with(side(half - BOARD)), rng), self.finish);
        b.part(&object, "shelves", grained(all(shelves.iter().map(|&z| level(z, inner)).chain([level(0.06, inner)])), rng), self.finish);
        let rear = board([BOARD - half, back + 0.001, 0.02], [half - BOARD, back + 0.0078, top - BOARD], 0.0005);
        b.part(&object, "rear", grained(rear, rng), self.finish);
        b.part(&object, "plinth", board([BOARD - half, inner - 0.03, 0.0], [half - BOARD, inner - 0.012, 0.058], 0.001), self.finish);
        let y = front - 0.0215;
        let mut fronts = Knobbed::default();
        for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
            let (w, x) = (half - 0.003, s * 0.5 * half);
            let knob = to_front(turned(&[[0.0, 0.0], [0.005, 0.0], [0.005, 0.01], [0.011, 0.016], [0.009, 0.022], [0.0, 0.023]], 20));
            for (name, z0, z1, glazed) in
                [("door", 0.062, CLOSED - 0.002, false), ("glass_door", CLOSED + 0.002, top - BOARD - 0.003, true)]
            {
                let at = Vec3::new(x, y, 0.5 * (z0 + z1));
                let rail = 0.05;
                let from = b.part_count();
                let section = [[0.0, 0.0], [0.0, 0.019], [0.001, 0.02], [rail - 0.001, 0.02], [rail, 0.019], [rail, 0.0]];
                b.part(&object, &format!("{name}_{}", i + 1), grained(picture_frame(w, z1 - z0, &section).moved(at), rng), self.finish);
                let inside = Vec2::new(0.5 * w - rail + 0.003, 0.5 * (z1 - z0) - rail + 0.003);
                if glazed {
                    let corner = |i: usize, j: usize| Vec2::new(1.0 - 2.0 * i as f32, 2.0 * j as f32 - 1.0);
                    let pane = grid(1, 1, |i, j| Vec3::new(inside.x * corner(i, j).x, 0.01, inside.y * corner(i, j).y), corner);
                    b.part(&object, &format!("pane_{}", i + 1), pane.moved(at), Finish::Glass);
                    let bar = board([-inside.x, 0.004, -0.008], [inside.x, 0.018, 0.008], 0.002).moved(at);
                    b.part(&object, &format!("glazing_bar_{}", i + 1), bar, self.finish);
                } else {
                    let panel = board([-inside.x, 0.002, -inside.y], [inside.x, 0.011, inside.y], 0.001).moved(at);
                    b.part(&object, &format!("panel_{}", i + 1), grained(panel, rng), self.finish);
                }
                let z = if glazed { z0 + 0.35 } else { z1 - 0.09 };
                let knob = knob.clone().moved(Vec3::new(s * 0.026, y + 0.0198, z));
                fronts.door(b, &format!("{name}_{}", i + 1), from, Joint::cupboard(x + s * 0.5 * w, y + 0.02, s), knob);
            }
        }
        fronts.add(b, &object, Finish::Brass);
        for z in shelves {
            shelf_of_crockery(b, on(pose, Vec3::new(0.0, -0.02, z + BOARD), 0.0), self.width - 0.12, rng);
        }
    }
}
