//! One kitchen unit or wall unit: plinth, box, and the doors, drawers and appliances in its front; of class cabinet, or refrigerator where
//! one is built in. A unit's space has x from its left edge, y from the wall and z from the floor.

use super::front::{FRONT, KitchenStyle, Opening, front};
use super::{BOX, PLINTH, TALL, THICKNESS, WALL_DEPTH, WORKTOP, appliance};
use crate::builder::{Builder, Class, Object};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::all;
use crate::pieces::joinery::body_box;
use crate::pieces::{CONTACT, board, grained, on};
use enfilade_math::{DAffine3, Rng, Vec3};

/// Thickness of the boards of hollow and glazed boxes, metres.
const SHELL: f32 = 0.016;
/// Distance of boxes and plinths from the lines of the grid, metres, so that faces of neighbours are not in one plane.
const APART: f32 = 0.0003;
/// Bevel of the boards behind fronts, metres.
const BEVEL: f32 = 0.0005;
/// Units wider than this, metres, are wider than the grid of 60 cm: they have two doors, or fillers beside an oven.
const WIDE: f32 = 0.61;
/// Height of the drawer below an oven, metres.
const OVEN_DRAWER: f32 = 0.13;
/// Upper edge of low units, metres: just below the worktop.
const UNDER_TOP: f32 = WORKTOP - THICKNESS - CONTACT;

/// A unit on the floor; a number is the width in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Unit {
    Doors(f32),
    Drawers(f32),
    Sink(f32),
    /// An oven below a hob.
    Oven(f32),
    Dishwasher,
    /// A closed end where another run meets this one.
    Corner(f32),
    /// A strip that fills what the grid leaves over.
    Filler(f32),
    Larder(f32),
    /// An oven and a microwave at the height of the hands.
    Tower,
    BuiltInRefrigerator,
}

impl Unit {
    /// Width of the unit along the wall, metres.
    pub fn width(self) -> f32 {
        match self {
            Self::Doors(w) | Self::Drawers(w) | Self::Sink(w) | Self::Oven(w) | Self::Corner(w) | Self::Filler(w) | Self::Larder(w) => w,
            Self::Dishwasher | Self::Tower | Self::BuiltInRefrigerator => 0.6,
        }
    }

    /// True for what reaches above the worktop.
    pub fn is_tall(self) -> bool {
        matches!(self, Self::Larder(_) | Self::Tower | Self::BuiltInRefrigerator)
    }
}

/// Adds the unit from the floor up, without worktop.
pub fn base(b: &mut Builder, pose: DAffine3, unit: Unit, style: &KitchenStyle, rng: &mut Rng) {
    let w = unit.width();
    let [low, top] = [PLINTH[0], if unit.is_tall() { TALL } else { UNDER_TOP }];
    let finish = if unit.is_tall() { style.upper } else { style.lower };
    let object = match unit {
        Unit::BuiltInRefrigerator => b.object("refrigerator", Class::Refrigerator, pose),
        _ => b.object("kitchen_unit", Class::Cabinet, pose),
    };
    plinth(b, &object, w, style);
    if unit == Unit::Dishwasher && !hides_appliances(style) {
        appliance::dishwasher(b, pose, [0.0, w], [low, top], style);
        return;
    }
    let hollow = matches!(unit, Unit::Sink(_) | Unit::Oven(_) | Unit::Tower);
    carcass(b, &object, w, [low, top], hollow, finish);
    if b.has_joints() {
        shelves(b, &object, unit, [low, top]);
    }
    let side = if rng.below(2) == 0 { -1.0 } else { 1.0 };
    let mut put = |name: &str, rect: [f32; 4], opening: Opening, rng: &mut Rng| {
        front(b, &object, name, rect, BOX + CONTACT, opening, style, finish, rng);
    };
    match unit {
        Unit::Doors(_) | Unit::Sink(_) if w > WIDE => {
            put("door_1", [0.0, 0.5 * w, low, top], Opening::Below(1.0), rng);
            put("door_2", [0.5 * w, w, low, top], Opening::Below(-1.0), rng);
        }
        Unit::Doors(_) => {
            put("drawer", [0.0, w, top - 0.155, top], Opening::Drawer, rng);
            put("door", [0.0, w, low, top - 0.155], Opening::Below(side), rng);
        }
        Unit::Sink(_) | Unit::Dishwasher => {
            put("door", [0.0, w, low, top], if unit == Unit::Dishwasher { Opening::Flap } else { Opening::Below(side) }, rng);
        }
        Unit::Drawers(_) => {
            let cuts = if rng.below(2) == 0 { [0.0, 0.37, 0.74, 1.0] } else { [0.0, 0.4, 0.8, 1.0] };
            for k in 0..3 {
                let z = [cuts[k], cuts[k + 1]].map(|t| low + t * (top - low));
                put(&format!("drawer_{}", k + 1), [0.0, w, z[0], z[1]], Opening::Drawer, rng);
            }
        }
        Unit::Oven(_) => {
            put("drawer", [0.0, w, low, low + OVEN_DRAWER], Opening::Drawer, rng);
            if w > WIDE {
                let rest = 0.5 * (w - 0.6);
                put("filler_1", [0.0, rest, low + OVEN_DRAWER, top], Opening::Fixed, rng);
                put("filler_2", [w - rest, w, low + OVEN_DRAWER, top], Opening::Fixed, rng);
            }
        }
        Unit::Larder(_) | Unit::BuiltInRefrigerator => {
            let split = if unit == Unit::BuiltInRefrigerator { 0.85 } else { 1.40 };
            put("door_1", [0.0, w, low, split], Opening::Below(side), rng);
            put("door_2", [0.0, w, split, top], Opening::Above(side), rng);
        }
        Unit::Tower => {
            put("drawer_1", [0.0, w, low, 0.42], Opening::Drawer, rng);
            put("drawer_2", [0.0, w, 0.42, 0.71], Opening::Drawer, rng);
            put("door", [0.0, w, 1.70, top], Opening::Above(side), rng);
        }
        Unit::Corner(_) | Unit::Filler(_) => {
            let panel = board([0.0005, BOX + CONTACT, low], [w - 0.0005, BOX + FRONT, top], 0.001);
            b.part(&object, "panel", grained(panel, rng), style.lower);
        }
    }
    match unit {
        Unit::Oven(_) => {
            let half = 0.5 * w;
            appliance::oven(b, pose, [half - 0.3, half + 0.3, low + OVEN_DRAWER, top], style);
        }
        Unit::Tower => {
            appliance::oven(b, pose, [0.0, w, 0.71, 1.31], style);
            appliance::oven(b, pose, [0.0, w, 1.31, 1.70], style);
        }
        _ => {}
    }
}

fn plinth(b: &mut Builder, object: &Object, w: f32, style: &KitchenStyle) {
    let y = BOX + FRONT - PLINTH[1];
    b.part(object, "plinth", board([APART, 0.02, 0.0], [w - APART, y, PLINTH[0] - 0.003], BEVEL), style.lower);
}

/// The box behind the fronts, hollow where something is built in.
fn carcass(b: &mut Builder, object: &Object, w: f32, [low, top]: [f32; 2], hollow: bool, finish: Finish) {
    let (x1, y0) = (w - APART, 0.003);
    let x0 = APART;
    let mesh = if hollow {
        all([
            board([x0, y0, low], [x0 + SHELL, BOX, top], BEVEL),
            board([x1 - SHELL, y0, low], [x1, BOX, top], BEVEL),
            board([x0 + SHELL, y0, low], [x1 - SHELL, BOX, low + SHELL], BEVEL),
            board([x0 + SHELL, y0, low + SHELL], [x1 - SHELL, y0 + 0.006, top], BEVEL),
        ])
    } else {
        body_box(b, [x0, y0, low], [x1, BOX, top], BEVEL)
    };
    b.part(object, "box", mesh, finish);
}

/// The boards behind the doors of a unit that can be opened.
fn shelves(b: &mut Builder, object: &Object, unit: Unit, [low, top]: [f32; 2]) {
    let levels: Vec<f32> = match unit {
        // Below the drawer.
        Unit::Doors(w) if w <= WIDE => vec![0.5 * (low + top - 0.155)],
        Unit::Doors(_) => vec![0.5 * (low + top)],
        Unit::Larder(_) | Unit::BuiltInRefrigerator => (1..6).map(|k| low + (top - low) * k as f32 / 6.0).collect(),
        _ => return,
    };
    let (x0, x1) = (APART + SHELL + 0.0002, unit.width() - APART - SHELL - 0.0002);
    let finish = if unit == Unit::BuiltInRefrigerator { Finish::Glass } else { Finish::WhiteLacquer };
    let level = |z: &f32| board([x0, 0.025, z - 0.5 * SHELL], [x1, BOX - 0.03, z + 0.5 * SHELL], BEVEL);
    b.part(object, "shelves", all(levels.iter().map(level)), finish);
}

/// Adds a wall unit with `doors` over the width `w`; glazed ones show what is in them.
pub fn wall_cabinet(b: &mut Builder, pose: DAffine3, w: f32, z: [f32; 2], glazed: bool, style: &KitchenStyle, rng: &mut Rng) {
    let object = b.object("wall_unit", Class::Cabinet, pose);
    let depth = WALL_DEPTH - FRONT - CONTACT;
    let doors = if w > WIDE { 2 } else { 1 };
    let [low, top] = z;
    if glazed {
        glazed_box(b, &object, w, depth, z);
    } else {
        let mesh = body_box(b, [APART, 0.002, low], [w - APART, depth, top], 0.0008);
        b.part(&object, "box", mesh, style.upper);
        if b.has_joints() {
            let z = 0.5 * (low + top);
            let shelf = board([APART + SHELL + 0.0002, 0.02, z], [w - APART - SHELL - 0.0002, depth - 0.02, z + SHELL], BEVEL);
            b.part(&object, "shelf", shelf, Finish::WhiteLacquer);
        }
    }
    let side = if rng.below(2) == 0 { -1.0 } else { 1.0 };
    for k in 0..doors {
        let x = [k as f32 / doors as f32 * w, (k + 1) as f32 / doors as f32 * w];
        let side = if doors == 2 { 1.0 - 2.0 * k as f32 } else { side };
        if glazed {
            glass_door(b, &object, (k + 1, side), [x[0], x[1], low, top], depth + CONTACT, style);
        } else {
            front(
                b,
                &object,
                &format!("door_{}", k + 1),
                [x[0], x[1], low, top],
                depth + CONTACT,
                Opening::Above(side),
                style,
                style.upper,
                rng,
            );
        }
    }
    if glazed {
        for z in [low + SHELL, 0.5 * (low + top) + 0.5 * SHELL] {
            super::super::tableware::shelf_of_crockery(b, on(pose, Vec3::new(0.5 * w, 0.5 * depth, z), 0.0), w - 0.08, rng);
        }
    }
}

fn glazed_box(b: &mut Builder, object: &Object, w: f32, depth: f32, [low, top]: [f32; 2]) {
    let (x0, x1) = (APART, w - APART);
    let middle = 0.5 * (low + top);
    let level = |z: f32| board([x0 + SHELL, 0.008, z - 0.5 * SHELL], [x1 - SHELL, depth, z + 0.5 * SHELL], BEVEL);
    let mesh = all([
        board([x0, 0.002, low], [x0 + SHELL, depth, top], BEVEL),
        board([x1 - SHELL, 0.002, low], [x1, depth, top], BEVEL),
        level(low + 0.5 * SHELL),
        level(middle),
        level(top - 0.5 * SHELL),
        board([x0 + SHELL, 0.002, low], [x1 - SHELL, 0.008, top], BEVEL),
    ]);
    b.part(object, "box", mesh, Finish::WhiteLacquer);
}

/// A door with a pane, hinged at the edge away from `side`.
fn glass_door(b: &mut Builder, object: &Object, (number, side): (usize, f32), rect: [f32; 4], y: f32, style: &KitchenStyle) {
    use crate::shape::{Reshape, grid, picture_frame};
    let [w, h] = [rect[1] - rect[0] - 0.003, rect[3] - rect[2] - 0.003];
    let at = Vec3::new(0.5 * (rect[0] + rect[1]), y, 0.5 * (rect[2] + rect[3]));
    let rail = 0.045;
    let section = [[0.0, 0.0], [0.0, FRONT - 0.001], [0.001, FRONT], [rail - 0.001, FRONT], [rail, FRONT - 0.001], [rail, 0.0]];
    let from = b.part_count();
    b.part(object, &format!("door_{number}"), picture_frame(w, h, &section).moved(at), style.upper);
    let half = enfilade_math::Vec2::new(0.5 * w - rail + 0.004, 0.5 * h - rail + 0.004);
    let corner = |i: usize, j: usize| enfilade_math::Vec2::new(1.0 - 2.0 * i as f32, 2.0 * j as f32 - 1.0);
    let pane = grid(1, 1, |i, j| Vec3::new(half.x * corner(i, j).x, 0.5 * FRONT, half.y * corner(i, j).y), corner);
    b.part(object, &format!("pane_{number}"), pane.moved(at), Finish::Glass);
    let joint = Joint::cupboard(at.x - side * 0.5 * w, y + FRONT, -side);
    b.joint(object, &format!("door_{number}"), &joint, from..b.part_count());
}

/// True where the dishwasher hides behind a front like those of the units: beside appliances of black glass.
fn hides_appliances(style: &KitchenStyle) -> bool {
    !style.steel
}
