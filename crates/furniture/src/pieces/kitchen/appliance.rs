//! Appliances built into a kitchen: hobs of glass or for gas, ovens and microwave ovens, dishwashers, extractor hoods. Each is an object of
//! class other structure (a microwave oven: other prop) with a front of steel or black glass, as the kitchen's style asks. Widths are those
//! of their units; poses are those of a unit, with x from its left edge or middle, y from the wall and z up.

use super::front::KitchenStyle;
use super::{BOX, WALL_UNIT, WORKTOP};
use crate::builder::{Builder, Class, Object};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::{all, around, cylinder, loft, rod, to_front, turned};
use crate::pieces::joinery::body_box;
use crate::pieces::{CONTACT, board};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec3};

/// Adds a hob on the worktop; the pose is on the worktop, in the middle of the unit at the wall.
pub fn hob(b: &mut Builder, pose: DAffine3, width: f32, style: &KitchenStyle, rng: &mut Rng) {
    let hob = b.object("hob", Class::OtherStructure, pose);
    let gas = style.steel && rng.below(2) == 0;
    let half = 0.5 * width - 0.012;
    let (back, front) = (0.055, 0.565);
    let plate = board([-half, back, CONTACT], [half, front, if gas { 0.009 } else { 0.005 }], 0.0015);
    b.part(&hob, "plate", plate, if gas { Finish::Steel } else { Finish::GlossBlack });
    let places = [[-0.5, 0.19, 0.09], [0.5, 0.19, 0.0725], [-0.5, 0.43, 0.0725], [0.5, 0.43, 0.09]];
    for (i, [x, y, r]) in places.into_iter().enumerate() {
        let at = Vec3::new(x * half, y, 0.005 + CONTACT);
        if gas {
            burner(b, &hob, i + 1, at + Vec3::new(0.0, 0.0, 0.004), 0.5 * r);
        } else {
            let ring = turned(&[[r - 0.002, 0.0], [r, 0.0], [r, 0.0003], [r - 0.002, 0.0003], [r - 0.002, 0.0]], 48);
            b.part(&hob, &format!("zone_{}", i + 1), ring.moved(at), Finish::Aluminium);
        }
    }
    if gas {
        for (i, x) in [-0.12, -0.04, 0.04, 0.12].into_iter().enumerate() {
            let knob = cylinder(0.019, 0.022, 24).with(board([-0.004, -0.017, 0.02], [0.004, 0.017, 0.028], 0.001));
            b.part(&hob, &format!("knob_{}", i + 1), knob.moved(Vec3::new(x, front - 0.035, 0.009 + CONTACT)), Finish::BlackPlastic);
        }
    } else {
        let controls =
            all((0..8).map(|k| cylinder(0.0022, 0.0003, 10).moved(Vec3::new(0.024 * (k as f32 - 3.5), front - 0.03, 0.005 + CONTACT))));
        b.part(&hob, "controls", controls, Finish::WhitePlastic);
    }
}

fn burner(b: &mut Builder, hob: &Object, number: usize, at: Vec3, r: f32) {
    let crown = turned(&[[0.0, 0.0], [r, 0.0], [r, 0.012], [0.9 * r, 0.014], [0.0, 0.014]], 32);
    b.part(hob, &format!("burner_{number}"), crown.moved(at), Finish::Aluminium);
    b.part(hob, &format!("cap_{number}"), cylinder(0.75 * r, 0.007, 32).moved(at + Vec3::new(0.0, 0.0, 0.0142)), Finish::BlackMetal);
    let arms = around(4, 0.0).map(|d| {
        let [p, q] = [d * 0.028, d * 0.105];
        rod([p.x, p.y, 0.032], [q.x, q.y, 0.032], 0.005, 6).with(rod([q.x, q.y, 0.0], [q.x, q.y, 0.034], 0.005, 6))
    });
    b.part(hob, &format!("grid_{number}"), all(arms).moved(at), Finish::BlackMetal);
}

/// Adds a built-in oven over `[x0, x1, z0, z1]`, or a microwave oven where it is low; `y` is the depth of the units' boxes.
pub fn oven(b: &mut Builder, pose: DAffine3, rect: [f32; 4], style: &KitchenStyle) {
    let [x0, x1, z0, z1] = [rect[0] + 0.002, rect[1] - 0.002, rect[2] + 0.002, rect[3] - 0.002];
    let low = z1 - z0 < 0.5;
    let oven = if low { b.object("built_in_microwave", Class::OtherProp, pose) } else { b.object("oven", Class::OtherStructure, pose) };
    let (body, glass) = if style.steel { (Finish::Steel, Finish::GlossBlack) } else { (Finish::GlossBlack, Finish::GlossBlack) };
    let y = BOX;
    let body_mesh = body_box(b, [x0 + 0.02, 0.04, z0 + 0.01], [x1 - 0.02, y, z1 - 0.01], 0.002);
    b.part(&oven, "body", body_mesh, Finish::Steel);
    if b.has_joints() {
        rack(b, &oven, "rack", [x0 + 0.04, x1 - 0.04], [0.07, y - 0.03], z0 + if low { 0.03 } else { 0.2 });
    }
    let fascia = if low { 0.0 } else { 0.095 };
    if !low {
        b.part(&oven, "fascia", board([x0, y - 0.0002, z1 - fascia], [x1, y + 0.02, z1], 0.0015), body);
        for (i, s) in [-1.0, 1.0].into_iter().enumerate() {
            let knob = to_front(turned(&[[0.0, 0.0], [0.021, 0.0], [0.021, 0.004], [0.017, 0.006], [0.016, 0.024], [0.0, 0.025]], 28));
            let at = Vec3::new(0.5 * (x0 + x1) + s * 0.17, y + 0.0198, z1 - 0.5 * fascia);
            b.part(&oven, &format!("knob_{}", i + 1), knob.moved(at), Finish::Steel);
        }
        let middle = 0.5 * (x0 + x1);
        let display = board([middle - 0.06, y + 0.0195, z1 - 0.065], [middle + 0.06, y + 0.0206, z1 - 0.03], 0.0004);
        b.part(&oven, "display", display, Finish::Screen);
    }
    let top = z1 - fascia - 0.003;
    let from = b.part_count();
    b.part(&oven, "door", board([x0, y - 0.0002, z0], [x1, y + 0.022, top], 0.0015), body);
    let right = if low { x1 - 0.13 } else { x1 - 0.035 };
    let window = board([x0 + 0.035, y + 0.0215, z0 + 0.05], [right, y + 0.0228, top - if low { 0.05 } else { 0.09 }], 0.0006);
    b.part(&oven, "window", window, glass);
    let bar = if low {
        let x = right + 0.035;
        all([
            rod([x, y + 0.055, z0 + 0.06], [x, y + 0.055, top - 0.06], 0.008, 12),
            rod([x, y + 0.021, z0 + 0.08], [x, y + 0.054, z0 + 0.08], 0.005, 8),
            rod([x, y + 0.021, top - 0.08], [x, y + 0.054, top - 0.08], 0.005, 8),
        ])
    } else {
        let z = top - 0.045;
        all([
            rod([x0 + 0.05, y + 0.06, z], [x1 - 0.05, y + 0.06, z], 0.009, 14),
            rod([x0 + 0.09, y + 0.021, z], [x0 + 0.09, y + 0.058, z], 0.006, 8),
            rod([x1 - 0.09, y + 0.021, z], [x1 - 0.09, y + 0.058, z], 0.006, 8),
        ])
    };
    b.part(&oven, "handle", bar, Finish::Steel);
    let face = y + 0.022;
    let joint = if low { Joint::cupboard(x0, face, -1.0) } else { Joint::level_flap(face, z0) };
    b.joint(&oven, "door", &joint, from..b.part_count());
}

/// A rack of wire at the height `z`, in an appliance that can be opened.
fn rack(b: &mut Builder, object: &Object, name: &str, [x0, x1]: [f32; 2], [y0, y1]: [f32; 2], z: f32) {
    let bars = (0..=12).map(|k| x0 + (x1 - x0) * k as f32 / 12.0).map(|x| rod([x, y0, z], [x, y1, z], 0.0015, 6));
    let rails = [y0, y1].map(|y| rod([x0 - 0.004, y, z - 0.003], [x1 + 0.004, y, z - 0.003], 0.002, 6));
    b.part(object, name, all(bars.chain(rails)), Finish::Steel);
}

/// Adds a dishwasher with a front of its own, over `[x0, x1]`.
pub fn dishwasher(b: &mut Builder, pose: DAffine3, x: [f32; 2], z: [f32; 2], style: &KitchenStyle) {
    let machine = b.object("dishwasher", Class::OtherStructure, pose);
    let ([x0, x1], [z0, z1], y) = ([x[0] + 0.003, x[1] - 0.003], [z[0] + 0.002, z[1] - 0.003], BOX);
    let finish = if style.steel { Finish::Steel } else { Finish::CoatedWhite };
    // Screwed to the worktop from below.
    let body = body_box(b, [x0, 0.03, z0], [x1, y, z[1] - 0.001], 0.002);
    b.part(&machine, "body", body, Finish::Steel);
    if b.has_joints() {
        rack(b, &machine, "rack_1", [x0 + 0.021, x1 - 0.021], [0.06, y - 0.03], z0 + 0.16);
        rack(b, &machine, "rack_2", [x0 + 0.021, x1 - 0.021], [0.06, y - 0.03], z0 + 0.44);
    }
    let from = b.part_count();
    b.part(&machine, "door", board([x0, y + CONTACT, z0], [x1, y + 0.022, z1 - 0.105], 0.003), finish);
    b.part(&machine, "fascia", board([x0, y + CONTACT, z1 - 0.102], [x1, y + 0.022, z1], 0.003), finish);
    let middle = 0.5 * (x0 + x1);
    b.part(
        &machine,
        "display",
        board([middle + 0.06, y + 0.0215, z1 - 0.075], [middle + 0.2, y + 0.0224, z1 - 0.045], 0.0004),
        Finish::Screen,
    );
    let z = z1 - 0.14;
    let bar = all([
        rod([x0 + 0.06, y + 0.055, z], [x1 - 0.06, y + 0.055, z], 0.008, 12),
        rod([x0 + 0.1, y + 0.02, z], [x0 + 0.1, y + 0.054, z], 0.005, 8),
        rod([x1 - 0.1, y + 0.02, z], [x1 - 0.1, y + 0.054, z], 0.005, 8),
    ]);
    b.part(&machine, "handle", bar, Finish::Steel);
    b.joint(&machine, "door", &Joint::level_flap(y + 0.022, z0), from..b.part_count());
}

/// Adds an extractor hood against the wall; the pose is on the floor, in the middle of the unit at the wall.
pub fn hood(b: &mut Builder, pose: DAffine3, width: f32, style: &KitchenStyle, rng: &mut Rng) {
    let low = WORKTOP + 0.66;
    let top = WALL_UNIT[1];
    let hood = b.object("extractor_hood", Class::OtherStructure, pose);
    let (w, finish) = (width - 0.004, if style.steel { Finish::Steel } else { Finish::BlackMetal });
    let d = 0.47;
    let kind = rng.below(3);
    // The shaft stands on a flat canopy and comes out of the other kinds.
    let foot = if kind == 1 { 0.0748 } else { 0.1 };
    let shaft = board([-0.14, CONTACT, low + foot], [0.14, 0.27, top], 0.002);
    match kind {
        0 => {
            let skirt = board([-0.5 * w, CONTACT, low], [0.5 * w, d, low + 0.05], 0.002);
            let roof =
                loft(&[[w - 0.006, d - 0.006, 0.002, low + 0.049], [0.3, 0.28, 0.002, low + 0.26], [0.28, 0.27, 0.002, low + 0.262]], 1)
                    .deformed(|p| {
                        // The loft is symmetric: moved so that its back stays on the wall while its front recedes.
                        let t = ((p.z - low - 0.049) / 0.213).clamp(0.0, 1.0);
                        Vec3::new(p.x, p.y + 0.5 * (d - 0.006) * (1.0 - t) + 0.5 * 0.28 * t + 0.003, p.z)
                    })
                    .smoothed(20.0);
            b.part(&hood, "skirt", skirt, finish);
            b.part(&hood, "roof", roof, finish);
        }
        1 => b.part(&hood, "canopy", board([-0.5 * w, CONTACT, low], [0.5 * w, d, low + 0.075], 0.003), finish),
        _ => {
            let pane = rounded_box(Vec3::new(w, 0.022, 0.50), 0.004, 2).turned(Vec3::X, 0.62).moved(Vec3::new(0.0, 0.235, low + 0.23));
            b.part(&hood, "pane", pane, Finish::GlossBlack);
            b.part(&hood, "body", board([-0.5 * w + 0.06, CONTACT, low + 0.09], [0.5 * w - 0.06, 0.18, low + 0.38], 0.003), finish);
        }
    }
    b.part(&hood, "shaft", shaft, finish);
    if kind < 2 {
        let filter = |s: f32| board([s * 0.13 - 0.12, 0.09, low - 0.002], [s * 0.13 + 0.12, 0.40, low + 0.001], 0.0005);
        b.part(&hood, "filters", all([filter(-1.0), filter(1.0)]), Finish::Aluminium);
    }
}
