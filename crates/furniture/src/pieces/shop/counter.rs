//! A counter, 1.4 to 3 m wide and 1.05 m high, class counter: a front and ends of boards, a top, and a lower working top behind a raised edge.
//! Customers are at +y, people who work at −y. On it may be a till, or a glass case with cakes and a coffee machine.

use crate::builder::{Builder, Class, Object};
use crate::joint::{Axis, Joint, JointKind};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, picture, rod, to_front, turned};
use crate::pieces::joinery::{INSIDE, drawer_box, hollow_box};
use crate::pieces::{CONTACT, Furniture, Surface, board, grained, on};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, DVec3, Rng, Vec2, Vec3};

/// A counter between customers and people who work.
#[derive(Clone, Copy, Debug)]
pub struct Counter {
    /// Width.
    pub width: f32,
    /// Finish of front and ends.
    pub front: Finish,
    /// Finish of the top.
    pub top: Finish,
    /// Upright strips cover the front.
    pub strips: bool,
    /// The lower top behind the raised edge, for people who sit; else all of the top is high.
    pub raised: bool,
}

/// Heights of the high and the low top, thickness of tops, and depth, metres.
const HIGH: f32 = 1.06;
const LOW: f32 = 0.76;
const TOP: f32 = 0.035;
const DEPTH: f32 = 0.68;
/// Depth of the raised part, metres.
const EDGE: f32 = 0.26;
/// Width of the drawers, metres.
const DRAWERS: f32 = 0.42;

impl Counter {
    /// The height of what customers see.
    pub const HEIGHT: f32 = HIGH;

    fn body(&self, b: &mut Builder, object: &Object, rng: &mut Rng) {
        let (x, y) = (0.5 * self.width, 0.5 * DEPTH);
        let under = HIGH - TOP - 0.0002;
        let front = board([-x + 0.02, y - 0.07, 0.08], [x - 0.02, y - 0.045, under], 0.002);
        b.part(object, "front", grained(front, rng), self.front);
        for (name, s) in [("left", -1.0f32), ("right", 1.0)] {
            let ends = [s * (x - 0.045), s * (x - 0.0202)];
            let back = if self.raised { y - EDGE - 0.02 } else { 0.03 - y };
            let high = board([ends[0].min(ends[1]), back, 0.0], [ends[0].max(ends[1]), y - 0.0702, under], 0.002);
            let low = board([ends[0].min(ends[1]), 0.03 - y, 0.0], [ends[0].max(ends[1]), back - 0.0002, LOW - TOP], 0.002);
            let end = if self.raised { high.with(low) } else { high };
            b.part(object, &format!("end_{name}"), grained(end, rng), self.front);
        }
        b.part(object, "plinth", board([0.05 - x, y - 0.1, 0.0], [x - 0.05, y - 0.066, 0.082], 0.001), Finish::BlackPlastic);
        if self.strips {
            let count = ((self.width - 0.06) / 0.05) as usize;
            let strip = |k: usize| {
                let at = -x + 0.03 + 0.05 * (k as f32 + 0.5);
                board([at - 0.017, y - 0.0452, 0.085], [at + 0.017, y - 0.032, under - 0.004], 0.002)
            };
            b.part(object, "strips", grained(all((0..count).map(strip)), rng), self.front);
        }
        let from = if self.has_drawers() { 0.052 - x + DRAWERS } else { 0.05 - x };
        let shelf = board([from, 0.06 - y, 0.36], [x - 0.05, y - 0.0704, 0.38], 0.001);
        b.part(object, "shelf", grained(shelf, rng), self.front);
        if self.has_drawers() {
            self.drawers(b, object);
        }
    }

    fn has_drawers(&self) -> bool {
        self.width > 1.5
    }

    /// Three drawers below the top where people work.
    fn drawers(&self, b: &mut Builder, object: &Object) {
        // They are made open to +y, and turned.
        let turned = |mesh: enfilade_geometry::Mesh| mesh.turned(Vec3::Z, std::f32::consts::PI);
        let (x1, front) = (0.5 * self.width - 0.0515, 0.5 * DEPTH - 0.055);
        let (x0, top) = (x1 - DRAWERS, if self.raised { LOW } else { HIGH } - TOP - 0.0008);
        let (low, high) = ([x0, front - 0.45, 0.09], [x1, front, top]);
        let case = if b.has_joints() { hollow_box(low, high, INSIDE) } else { board(low, high, 0.001) };
        b.part(object, "drawers", turned(case), self.front);
        let height = (top - 0.09) / 3.0;
        for k in 0..3 {
            let z = 0.09 + height * k as f32;
            let rect = [x0 + 0.0015, x1 - 0.0015, z + 0.0015, z + height - 0.0015];
            let from = b.part_count();
            let face = board([rect[0], front + 0.0004, rect[2]], [rect[1], front + 0.018, rect[3]], 0.0015);
            b.part(object, &format!("drawer_{}", k + 1), turned(face), self.front);
            let grip = board([x0 + 0.12, front + 0.0178, rect[3] - 0.05], [x1 - 0.12, front + 0.034, rect[3] - 0.038], 0.002);
            b.part(object, &format!("drawer_{}_grip", k + 1), turned(grip), Finish::Steel);
            if b.has_joints() {
                b.part(object, &format!("drawer_{}_box", k + 1), turned(drawer_box(rect, front, 0.42)), Finish::WhiteLacquer);
            }
            let joint = Joint { kind: JointKind::Drawer, axis: Axis::Slide(DVec3::NEG_Y), limits: [0.0, 0.33] };
            b.joint(object, &format!("drawer_{}", k + 1), &joint, from..b.part_count());
        }
    }

    fn tops(&self, b: &mut Builder, object: &Object, rng: &mut Rng) {
        let (x, y) = (0.5 * self.width, 0.5 * DEPTH);
        let from = if self.raised { y - EDGE } else { -y };
        b.part(object, "top", grained(board([-x, from, HIGH - TOP], [x, y, HIGH], 0.003), rng), self.top);
        if self.raised {
            let low = board([0.021 - x, -y, LOW - TOP + 0.0002], [x - 0.021, y - 0.0704, LOW], 0.002);
            b.part(object, "worktop", grained(low, rng), self.top);
            let back = board([0.046 - x, y - EDGE - 0.001, LOW + 0.0002], [x - 0.046, y - EDGE + 0.02, HIGH - TOP - 0.0002], 0.001);
            b.part(object, "upstand", grained(back, rng), self.front);
        }
    }
}

impl Furniture for Counter {
    fn random(rng: &mut Rng) -> Self {
        let front =
            [Finish::Wood, Finish::DarkWood, Finish::WhiteLacquer, Finish::ColoredLacquer(0), Finish::KitchenFront(0)][rng.below(5)];
        let top = [Finish::Wood, Finish::MarbleTop, Finish::WhiteLacquer, Finish::DarkWood, Finish::Stone][rng.below(5)];
        Self { width: rng.range(1.4, 3.0), front, top, strips: rng.below(3) == 0, raised: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH, HIGH)
    }

    fn reach(&self) -> f32 {
        0.8
    }

    fn surfaces(&self) -> Vec<Surface> {
        let (x, y) = (0.5 * self.width - 0.06, 0.5 * DEPTH - 0.03);
        let of = |low: f32, high: f32, z: f32| Surface { min: Vec2::new(-x, low), max: Vec2::new(x, high), z, headroom: f32::INFINITY };
        if self.raised { vec![of(-y, y - EDGE, LOW), of(y - EDGE + 0.06, y, HIGH)] } else { vec![of(-y, y, HIGH)] }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("counter", Class::Counter, pose);
        self.body(b, &object, rng);
        self.tops(b, &object, rng);
    }
}

/// A till: a drawer, a screen for the person at −y, and a terminal for cards.
#[derive(Clone, Copy, Debug)]
pub struct Till;

impl Till {
    /// The drawer for cash, which is pulled out to −y, in its case.
    fn drawer(b: &mut Builder, object: &Object) {
        // Boxes are open to +y, and turned.
        let turned = |mesh: enfilade_geometry::Mesh| mesh.turned(Vec3::Z, std::f32::consts::PI);
        let case = if b.has_joints() {
            turned(hollow_box([-0.2, -0.2, 0.0], [0.2, 0.19, 0.1], 0.006))
        } else {
            board([-0.2, -0.19, 0.0], [0.2, 0.2, 0.1], 0.005)
        };
        b.part(object, "drawer", case, Finish::BlackMetal);
        let from = b.part_count();
        b.part(object, "drawer_front", board([-0.196, -0.2, 0.012], [0.196, -0.1898, 0.092], 0.002), Finish::BlackPlastic);
        if b.has_joints() {
            let inside = drawer_box([-0.196, 0.196, 0.0, 0.1], 0.1898, 0.34);
            b.part(object, "drawer_box", turned(inside), Finish::BlackPlastic);
        }
        let joint = Joint { kind: JointKind::Drawer, axis: Axis::Slide(DVec3::NEG_Y), limits: [0.0, 0.27] };
        b.joint(object, "drawer", &joint, from..b.part_count());
    }
}

impl Furniture for Till {
    fn random(_rng: &mut Rng) -> Self {
        Self
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.62, 0.42, 0.42)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("till", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        Self::drawer(b, &object);
        let lean = |mesh: enfilade_geometry::Mesh| mesh.turned(Vec3::X, 0.35).moved(Vec3::new(0.0, 0.02, 0.27));
        b.part(&object, "housing", lean(rounded_box(Vec3::new(0.34, 0.03, 0.25), 0.008, 2)), Finish::BlackPlastic);
        let screen = picture(0.31, 0.21).turned(Vec3::Z, std::f32::consts::PI).moved(Vec3::new(0.0, -0.0156, 0.0));
        b.part(&object, "screen", lean(screen), Finish::ScreenOn(3));
        b.part(
            &object,
            "foot",
            board([-0.06, -0.02, 0.0998], [0.06, 0.1, 0.13], 0.006).with(rod([0.0, 0.06, 0.12], [0.0, 0.03, 0.27], 0.02, 14)),
            Finish::BlackPlastic,
        );
        let terminal = b.object("card_terminal", Class::OtherProp, on(pose, Vec3::new(0.25, 0.1, CONTACT), 0.2));
        b.part(
            &terminal,
            "body",
            rounded_box(Vec3::new(0.075, 0.16, 0.03), 0.008, 2).moved(Vec3::new(0.0, 0.0, 0.015)),
            Finish::BlackPlastic,
        );
        let keys = (0..12).map(|k| {
            let at = Vec3::new(0.02 * ((k % 3) as f32 - 1.0), 0.055 - 0.018 * (k / 3) as f32, 0.0305);
            rounded_box(Vec3::new(0.015, 0.012, 0.004), 0.0015, 1).moved(at)
        });
        b.part(&terminal, "keys", all(keys), Finish::WhitePlastic);
    }
}

/// A coffee machine of a café, with cups on it; people work at −y.
#[derive(Clone, Copy, Debug)]
pub struct EspressoMachine {
    /// Places for cups.
    pub groups: usize,
    /// Black ends instead of steel.
    pub dark: bool,
}

impl Furniture for EspressoMachine {
    fn random(rng: &mut Rng) -> Self {
        Self { groups: 2 + rng.below(2), dark: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.32 + 0.22 * self.groups as f32, 0.5, 0.6)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("espresso_machine", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let (x, end) = (0.5 * self.size().x, if self.dark { Finish::BlackPlastic } else { Finish::Steel });
        let base = board([0.03 - x, -0.24, 0.03], [x - 0.03, 0.23, 0.11], 0.006);
        let rear = board([0.03 - x, 0.0, 0.1098], [x - 0.03, 0.23, 0.46], 0.01);
        let head = board([0.03 - x, -0.2, 0.3], [x - 0.03, 0.0002, 0.46], 0.015);
        b.part(&object, "body", all([base, rear, head]), Finish::Steel);
        let ends =
            [-1.0f32, 1.0].map(|s| rounded_box(Vec3::new(0.03, 0.48, 0.44), 0.012, 3).moved(Vec3::new(s * (x - 0.0152), -0.005, 0.25)));
        b.part(&object, "ends", all(ends), end);
        let feet = [(-1.0f32, -1.0f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        b.part(
            &object,
            "feet",
            all(feet.map(|(sx, sy)| cylinder(0.022, 0.031, 16).moved(Vec3::new(sx * (x - 0.07), sy * 0.19, 0.0)))),
            Finish::BlackPlastic,
        );
        for k in 0..self.groups {
            let at = 0.22 * (k as f32 - 0.5 * (self.groups - 1) as f32);
            let group = cylinder(0.036, 0.05, 24).moved(Vec3::new(at, -0.12, 0.252));
            let basket = cylinder(0.034, 0.022, 24).moved(Vec3::new(at, -0.12, 0.231));
            b.part(&object, &format!("group_{}", k + 1), group.with(basket), Finish::Chrome);
            let handle = rod([at, -0.15, 0.242], [at, -0.249, 0.228], 0.011, 12);
            b.part(&object, &format!("handle_{}", k + 1), handle, Finish::BlackPlastic);
        }
        let rail = [[-x + 0.05, -0.17], [x - 0.05, -0.17], [x - 0.05, 0.21], [-x + 0.05, 0.21]];
        let rails = (0..4).map(|k| {
            let (p, q) = (rail[k], rail[(k + 1) % 4]);
            rod([p[0], p[1], 0.51], [q[0], q[1], 0.51], 0.004, 8).with(rod([p[0], p[1], 0.458], [p[0], p[1], 0.51], 0.004, 8))
        });
        b.part(&object, "rail", all(rails), Finish::Chrome);
        let gauges = [-0.05f32, 0.05]
            .map(|g| to_front(cylinder(0.022, 0.006, 24)).turned(Vec3::Z, std::f32::consts::PI).moved(Vec3::new(g, -0.1995, 0.41)));
        b.part(&object, "gauges", all(gauges), Finish::WhitePlastic);
        let columns = ((2.0 * x - 0.14) / 0.085) as usize;
        let cups = b.object("cups", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, 0.46 + 2.0 * CONTACT), 0.0));
        let cup = |column: usize, row: usize| {
            let at = Vec3::new(0.085 * (column as f32 - 0.5 * (columns - 1) as f32), -0.1 + 0.085 * row as f32, 0.0);
            turned(&[[0.0, 0.0], [0.036, 0.0], [0.037, 0.003], [0.022, 0.06], [0.014, 0.063], [0.0, 0.063]], 20).moved(at)
        };
        let all_cups = (0..columns).flat_map(|column| (0..4).map(move |row| (column, row))).filter(|_| rng.below(5) > 0);
        let places: Vec<(usize, usize)> = all_cups.collect();
        b.part(&cups, "cups", all(places.into_iter().map(|(column, row)| cup(column, row))), Finish::Porcelain);
    }
}

/// A glass case with cakes; customers look in from +y.
#[derive(Clone, Copy, Debug)]
pub struct CakeCase {
    /// Width.
    pub width: f32,
}

impl Furniture for CakeCase {
    fn random(rng: &mut Rng) -> Self {
        Self { width: rng.range(0.6, 1.1) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, 0.42, 0.46)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("cake_case", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let (x, y, top) = (0.5 * self.width, 0.21, 0.455);
        b.part(&object, "floor", board([-x, -y, 0.0], [x, y, 0.03], 0.003), Finish::Steel);
        let posts = [(-1.0f32, -1.0f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let posts = posts
            .map(|(sx, sy)| rod([sx * (x - 0.008), sy * (y - 0.008), 0.028], [sx * (x - 0.008), sy * (y - 0.008), top - 0.012], 0.006, 8));
        b.part(&object, "posts", all(posts), Finish::Steel);
        b.part(&object, "lid", board([-x, -y, top - 0.014], [x, y, top], 0.003), Finish::Steel);
        let front = picture(2.0 * x - 0.016, top - 0.04).moved(Vec3::new(0.0, y - 0.008, 0.5 * top + 0.008));
        let side = |s: f32| {
            picture(2.0 * y - 0.016, top - 0.04).turned(Vec3::Z, -s * std::f32::consts::FRAC_PI_2).moved(Vec3::new(
                s * (x - 0.008),
                0.0,
                0.5 * top + 0.008,
            ))
        };
        b.part(&object, "panes", all([front, side(-1.0), side(1.0)]), Finish::Glass);
        let shelf = board([0.004 - x, 0.03 - y, 0.232], [x - 0.004, y - 0.03, 0.238], 0.001);
        b.part(&object, "shelf", shelf, Finish::Steel);
        for z in [0.03, 0.238] {
            let count = ((self.width - 0.1) / 0.27) as usize;
            for k in 0..count {
                let at = Vec3::new(0.27 * (k as f32 - 0.5 * (count - 1) as f32), 0.0, z + 3.0 * CONTACT);
                cake(b, on(pose, at, 0.0), rng);
            }
        }
    }
}

/// A cake on its plate, some pieces of which were sold.
fn cake(b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
    let object = b.object("cake", Class::OtherProp, pose);
    let plate = turned(&[[0.0, 0.0], [0.08, 0.0], [0.125, 0.009], [0.126, 0.011], [0.08, 0.004], [0.0, 0.004]], 40);
    b.part(&object, "plate", plate, Finish::Porcelain);
    let high = rng.range(0.045, 0.09);
    let body = turned(&[[0.0, 0.0], [0.098, 0.0], [0.1, 0.004], [0.1, high - 0.006], [0.094, high], [0.0, high]], 40);
    let finish = [Finish::Bread, Finish::Wax, Finish::Petal(0), Finish::DarkWood, Finish::Petal(1)][rng.below(5)];
    b.part(&object, "body", body.moved(Vec3::new(0.0, 0.0, 0.0042)), finish);
    let berries = crate::pieces::form::around(8, 0.2).map(|d| crate::shape::sphere(0.011, 12).moved((0.075 * d).extend(high + 0.011)));
    b.part(&object, "berries", all(berries), Finish::Fruit(rng.below(3) as u8));
}
