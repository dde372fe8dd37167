//! A narrow table 80 to 125 cm long for a hall (class table), with or without drawers, two in three with a bowl for keys; tall mirrors of
//! 45 to 75 × 150 to 180 cm that lean against a wall (class mirror), their glass rectangular, rounded or arched; and boards with three to
//! five hooks for keys. The origin of a key board is the middle of its back, on the wall.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, rod, rounded_rectangle, to_front, wire};
use crate::pieces::joinery::{Handle, body_box, front, pull};
use crate::pieces::{Bowl, CONTACT, Furniture, Surface, board, grained, on};
use crate::shape::{Reshape, rounded_box, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// A narrow table along the wall of a hall, with a bowl for keys.
#[derive(Clone, Copy, Debug)]
pub struct Console {
    /// Length of the table.
    pub length: f32,
    /// Two drawers are below the top.
    pub drawer: bool,
    /// Stands on metal frames instead of wooden legs.
    pub metal: bool,
    /// A bowl with keys stands on the top.
    pub keys: bool,
}

/// Height of the console's top, metres.
const TOP: f32 = 0.8;
/// Depth of the console with its knobs, metres: people pass before it.
const DEPTH: f32 = 0.34;
/// Thickness of the top, metres.
const BOARD: f32 = 0.024;
/// Distance by which the box of the drawers is set back from the ends of the top, metres.
const INSET: f32 = 0.012;

impl Furniture for Console {
    fn random(rng: &mut Rng) -> Self {
        Self { length: rng.range(0.8, 1.25), drawer: rng.below(2) == 0, metal: rng.below(2) == 0, keys: rng.below(3) > 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length, DEPTH, if self.keys { TOP + 0.07 } else { TOP })
    }

    fn reach(&self) -> f32 {
        0.5
    }

    fn surfaces(&self) -> Vec<Surface> {
        let (x, y) = (0.5 * self.length, 0.5 * DEPTH);
        let left = if self.keys { -x + 0.34 } else { -x + 0.02 };
        vec![Surface { min: Vec2::new(left, 0.02 - y), max: Vec2::new(x - 0.02, y - 0.05), z: TOP, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let console = b.object("console", Class::Table, pose);
        let wood = [Finish::Wood, Finish::DarkWood, Finish::WhiteLacquer][rng.below(3)];
        let (x, y) = (0.5 * self.length, 0.5 * DEPTH);
        let face = y - Handle::DEPTH;
        b.part(&console, "top", grained(board([-x, -y, TOP - BOARD], [x, face, TOP], 0.0025), rng), wood);
        let low = if self.drawer { TOP - BOARD - 0.12 } else { TOP - BOARD };
        if self.drawer {
            let box_ = body_box(b, [-x + INSET, -y + 0.006, low], [x - INSET, face - 0.0215, TOP - 0.0242], 0.0015);
            b.part(&console, "body", grained(box_, rng), wood);
            for k in 0..2 {
                let from = -x + INSET + k as f32 * (x - INSET);
                let rect = [from + 0.0015, from + x - 0.0135, low + 0.001, TOP - 0.0262];
                let from_part = b.part_count();
                b.part(&console, &format!("drawer_{}", k + 1), front(rect, face - 0.0205, 0.018, false, rng), wood);
                let at = Vec3::new(0.5 * (rect[0] + rect[1]), face - 0.0025, 0.5 * (rect[2] + rect[3]));
                Handle::Knob(Finish::Brass).add(b, &console, &format!("knob_{}", k + 1), at, 0.1, false);
                let depth = face - 0.0205 + y - 0.03;
                pull(b, &console, &format!("drawer_{}", k + 1), from_part, rect, face - 0.0205, depth, wood);
            }
        }
        let (back, front_y) = (-y + 0.02, face - 0.03);
        let finish = if self.metal { Finish::BlackMetal } else { wood };
        for (name, s) in [("frame_left", -1.0f32), ("frame_right", 1.0)] {
            let at = |py: f32, z: f32| Vec3::new(s * (x - 0.05), py, z);
            let thick = if self.metal { 0.022 } else { 0.036 };
            let (under, floor) = (low - 0.5 * thick - 0.0002, 0.5 * thick);
            let corners = [at(back, floor), at(back, under), at(front_y, under), at(front_y, floor)];
            // Metal frames are closed at the floor, wooden ones stand on two legs.
            let sides = if self.metal { 4 } else { 3 };
            let bars = (0..sides).map(|k| {
                let (a, c) = (corners[k], corners[(k + 1) % 4]);
                rounded_box((a - c).abs() + Vec3::splat(thick), 0.003, 2).moved(0.5 * (a + c))
            });
            b.part(&console, name, grained(all(bars), rng), finish);
        }
        if self.keys {
            let place = on(pose, Vec3::new(-x + 0.18, -0.02, TOP), 0.0);
            Bowl { radius: 0.1 }.build(b, place, rng);
            keys(b, on(place, Vec3::new(0.01, 0.0, 0.012), 0.0), rng);
        }
    }
}

/// Keys on a ring, lying in a bowl.
fn keys(b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
    let object = b.object("keys", Class::OtherProp, pose);
    let ring: Vec<Vec3> = (0..=20).map(|k| (Vec2::from_angle(TAU * k as f32 / 20.0) * 0.014).extend(0.0015)).collect();
    let mut mesh = tube(&ring, 0.0011, 6);
    for k in 0..3 {
        let turn = rng.range(-0.5, 0.5) + 0.7 * k as f32;
        let blade = board([0.026, -0.004, 0.0], [0.055, 0.004, 0.002], 0.0004);
        let bow = crate::pieces::form::cylinder(0.0115, 0.0022, 20).moved(Vec3::new(0.0235, 0.0, 0.0));
        mesh = mesh.with(blade.with(bow).turned(Vec3::Z, turn).moved(Vec3::Z * (0.001 + 0.0026 * k as f32)));
    }
    b.part(&object, "keys", mesh.moved(Vec3::Z * CONTACT), Finish::Steel);
}

/// A tall mirror that stands on the floor and leans against the wall.
#[derive(Clone, Copy, Debug)]
pub struct TallMirror {
    /// Width and height.
    pub size: Vec2,
    /// Radius of its corners; half the width for an arch or an oval.
    pub corner: f32,
    /// Finish of its frame.
    pub frame: Finish,
}

/// How far a tall mirror leans back, radians.
const LEAN: f32 = 0.10;

impl Furniture for TallMirror {
    fn random(rng: &mut Rng) -> Self {
        let size = Vec2::new(rng.range(0.45, 0.75), rng.range(1.5, 1.8));
        let frame = [Finish::Wood, Finish::BlackMetal, Finish::Brass, Finish::DarkWood][rng.below(4)];
        Self { size, corner: [0.004, 0.06, 0.5 * size.x - 0.002][rng.below(3)], frame }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x, self.size.y * LEAN.sin() + 0.05, self.size.y + 0.002)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let mirror = b.object("tall_mirror", Class::Mirror, pose);
        let plate = |inset: f32, thickness: f32| {
            let outline = rounded_rectangle(self.size.x - 2.0 * inset, self.size.y - 2.0 * inset, (self.corner - inset).max(0.003), 14);
            to_front(crate::pieces::form::cut_out(&outline, thickness, 0.002))
        };
        // The lower edge is away from the wall, and the mirror leans back against it.
        let half = 0.5 * self.size.y;
        let foot = 0.5 * self.size().y - 0.034;
        let place = |mesh: enfilade_geometry::Mesh| mesh.moved(Vec3::Z * half).turned(Vec3::X, LEAN).moved(Vec3::new(0.0, foot, 0.0005));
        b.part(&mirror, "frame", place(plate(0.0, 0.026)), self.frame);
        b.part(&mirror, "glass", place(plate(0.02, 0.003).moved(Vec3::Y * 0.0255)), Finish::Mirror);
    }
}

/// Keys on hooks below a small board; the origin is the middle of its back.
#[derive(Clone, Copy, Debug)]
pub struct KeyBoard {
    /// Hooks.
    pub hooks: usize,
}

impl Furniture for KeyBoard {
    fn random(rng: &mut Rng) -> Self {
        Self { hooks: 3 + rng.below(3) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.06 * self.hooks as f32 + 0.04, 0.05, 0.24)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("key_board", Class::OtherProp, pose);
        let x = 0.5 * self.size().x;
        b.part(&object, "board", grained(board([-x, 0.0, 0.04], [x, 0.016, 0.12], 0.002), rng), Finish::Wood);
        let at = |k: usize| 0.06 * (k as f32 - 0.5 * (self.hooks as f32 - 1.0));
        let hooks = (0..self.hooks)
            .map(|k| wire(&[[at(k), 0.015, 0.07], [at(k), 0.03, 0.064], [at(k), 0.034, 0.072], [at(k), 0.034, 0.08]], 0.0022, 8));
        b.part(&object, "hooks", all(hooks), Finish::Brass);
        for k in 0..self.hooks {
            if rng.below(3) == 0 {
                continue;
            }
            let keys = b.object("keys", Class::OtherProp, pose);
            let ring: Vec<Vec3> = (0..=20)
                .map(|i| Vec2::from_angle(TAU * i as f32 / 20.0) * 0.013)
                .map(|p| Vec3::new(at(k) + p.x, 0.03, 0.057 + p.y))
                .collect();
            let blades = (0..2).map(|i| {
                let way = Vec3::new(0.3 * i as f32 - 0.15 + rng.range(-0.1, 0.1), 0.0, -1.0).normalize();
                let top = Vec3::new(at(k), 0.0265 + 0.006 * i as f32, 0.046);
                rod(top.to_array(), (top + 0.055 * way).to_array(), 0.0028, 8)
            });
            b.part(&keys, "ring", all([tube(&ring, 0.001, 6)].into_iter().chain(blades)), Finish::Steel);
        }
    }
}
