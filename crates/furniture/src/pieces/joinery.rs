//! Parts that cabinets share: carcasses, drawer and door fronts, handles and feet. Fronts are in the xz plane and face +y; sizes are those
//! of common cabinets, and the caller gives thicknesses and finishes.

use super::form::{all, rod, turned};
use super::{board, grained, leg, on};
use crate::builder::{Builder, Object};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::shape::{Reshape, rounded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;
use std::ops::Range;

/// Air between boards that meet, and between feet and what they carry, metres: it keeps two faces out of one plane.
const GAP: f32 = 0.0002;
/// The handle of a drawer or door.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handle {
    /// A turned knob.
    Knob(Finish),
    /// A rod on two feet.
    Bar(Finish),
    /// A small cup of sheet metal, open below.
    Cup(Finish),
    /// None: the front is pushed or gripped behind.
    None,
}

impl Handle {
    /// How far handles protrude from the front at most, metres.
    pub const DEPTH: f32 = 0.032;

    /// A random kind; a third are bars, and knobs may be of wood.
    pub fn random(rng: &mut Rng) -> Self {
        let metal = [Finish::Brass, Finish::BlackMetal, Finish::Steel][rng.below(3)];
        [Self::Knob(metal), Self::Knob(Finish::Wood), Self::Bar(metal), Self::Bar(metal), Self::Cup(metal), Self::None][rng.below(6)]
    }

    /// Adds a handle to a front whose face is at y = `at.y`; bars are `length` long, along x or upright.
    pub fn add(self, b: &mut Builder, object: &Object, name: &str, at: Vec3, length: f32, upright: bool) {
        let (mesh, finish) = match self {
            Self::Knob(finish) => {
                let profile =
                    [[0.0, -0.002], [0.007, -0.002], [0.006, 0.008], [0.012, 0.016], [0.014, 0.022], [0.012, 0.028], [0.0, 0.0295]];
                (super::form::to_front(turned(&profile, 20)), finish)
            }
            Self::Bar(finish) => {
                let half = 0.5 * length;
                let bar = rod([-half, 0.026, 0.0], [half, 0.026, 0.0], 0.005, 12);
                let feet = [-1.0f32, 1.0].map(|s| rod([s * (half - 0.02), -0.002, 0.0], [s * (half - 0.02), 0.026, 0.0], 0.004, 10));
                let mesh = bar.with(all(feet));
                (if upright { mesh.turned(Vec3::Y, FRAC_PI_2) } else { mesh }, finish)
            }
            Self::Cup(finish) => {
                (super::form::to_front(turned(&[[0.0, -0.001], [0.03, -0.001], [0.028, 0.01], [0.018, 0.02], [0.0, 0.024]], 24)), finish)
            }
            Self::None => return,
        };
        b.part(object, name, mesh.moved(at), finish);
    }
}

/// A carcass of boards: bottom, sides, top and rear, with its front edges in the plane y = `front`.
#[derive(Clone, Copy, Debug)]
pub struct Carcass {
    /// Left, right.
    pub x: [f32; 2],
    /// Rear, front.
    pub y: [f32; 2],
    /// Lower and upper face.
    pub z: [f32; 2],
    /// Thickness of the boards.
    pub thick: f32,
    /// Finish of all boards.
    pub finish: Finish,
}

impl Carcass {
    /// Adds its boards.
    pub fn add(&self, b: &mut Builder, object: &Object, rng: &mut Rng) {
        let ([x0, x1], [y0, y1], [z0, z1], t) = (self.x, self.y, self.z, self.thick);
        let e = GAP;
        let boards = [
            ("bottom", [x0, y0, z0], [x1, y1, z0 + t]),
            ("top", [x0, y0, z1 - t], [x1, y1, z1]),
            ("side_left", [x0, y0, z0 + t + e], [x0 + t, y1, z1 - t - e]),
            ("side_right", [x1 - t, y0, z0 + t + e], [x1, y1, z1 - t - e]),
            ("rear", [x0 + t, y0 + 0.004, z0 + t + e], [x1 - t, y0 + 0.010, z1 - t - e]),
        ];
        for (name, min, max) in boards {
            b.part(object, name, grained(board(min, max, 0.0015), rng), self.finish);
        }
    }

    /// The open space between its boards: left, right, low, high.
    pub fn inside(&self) -> [f32; 4] {
        let t = self.thick;
        [self.x[0] + t, self.x[1] - t, self.z[0] + t, self.z[1] - t]
    }
}

/// The feet of furniture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feet {
    /// Four round, splayed legs.
    Round(Finish),
    /// A frame of square metal tube.
    Runners(Finish),
    /// A plinth, set back.
    Plinth,
}

impl Feet {
    /// A random kind.
    pub fn random(rng: &mut Rng) -> Self {
        [Self::Round(Finish::Wood), Self::Round(Finish::BlackMetal), Self::Runners(Finish::BlackMetal), Self::Plinth][rng.below(4)]
    }

    /// Adds feet `height` high below a body of this half width and half depth whose middle is the origin.
    pub fn add(self, b: &mut Builder, object: &Object, half: Vec2, height: f32, body: Finish) {
        match self {
            Self::Round(finish) => {
                for (i, s) in
                    [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate()
                {
                    let at = on(DAffine3::IDENTITY, (s * (half - 0.05)).extend(0.0), 0.0);
                    b.part_at(object, &format!("leg_{}", i + 1), leg(height - GAP, [0.011, 0.018], s * 0.025), at, finish);
                }
            }
            Self::Runners(finish) => {
                for (name, s) in [("runner_left", -1.0f32), ("runner_right", 1.0)] {
                    let (x, y) = (s * (half.x - 0.03), half.y - 0.02);
                    let bar = |min: [f32; 3], max: [f32; 3]| board([x - 0.0125, min[1], min[2]], [x + 0.0125, max[1], max[2]], 0.002);
                    let parts = [
                        bar([0.0, -y, 0.0], [0.0, y, 0.025]),
                        bar([0.0, -y, height - 0.0252], [0.0, y, height - GAP]),
                        bar([0.0, -y, 0.0252], [0.0, -y + 0.025, height - 0.0254]),
                        bar([0.0, y - 0.025, 0.0252], [0.0, y, height - 0.0254]),
                    ];
                    b.part(object, name, all(parts), finish);
                }
            }
            Self::Plinth => {
                let mesh = rounded_box(Vec3::new(2.0 * half.x - 0.03, 2.0 * half.y - 0.05, height - GAP), 0.001, 1);
                b.part(object, "plinth", mesh.moved(Vec3::new(0.0, -0.015, 0.5 * height - 0.0001)), body);
            }
        }
    }
}

/// Distance of a framed front's panel behind its frame, metres.
const RECESS: f32 = 0.007;

/// True when a front has a panel: small ones are plain even where `framed` ones are wanted.
fn has_panel([x0, x1, z0, z1]: [f32; 4], framed: bool) -> bool {
    framed && x1 - x0 >= 0.2 && z1 - z0 >= 0.14
}

/// Thickness of a [`front`] in its middle, where handles are fixed.
pub fn thickness_at_middle(rect: [f32; 4], thick: f32, framed: bool) -> f32 {
    if has_panel(rect, framed) { thick - RECESS } else { thick }
}

/// A front board in the xz rectangle `[x0, x1, z0, z1]`, its back at y = `back`; framed fronts have a recessed panel.
pub fn front(rect: [f32; 4], back: f32, thick: f32, framed: bool, rng: &mut Rng) -> Mesh {
    let [x0, x1, z0, z1] = rect;
    let whole = |depth: f32, inset: f32| board([x0 + inset, back, z0 + inset], [x1 - inset, back + depth, z1 - inset], 0.0015);
    if !has_panel(rect, framed) {
        return grained(whole(thick, 0.0), rng);
    }
    let rail = 0.05f32.min(0.3 * (z1 - z0)).min(0.3 * (x1 - x0));
    let panel = grained(whole(thick - RECESS, rail - 0.004), rng);
    let piece = |min: [f32; 2], max: [f32; 2]| board([min[0], back, min[1]], [max[0], back + thick, max[1]], 0.0015);
    let e = 0.0001;
    let frame = [
        piece([x0, z0], [x0 + rail, z1]),
        piece([x1 - rail, z0], [x1, z1]),
        piece([x0 + rail + e, z0], [x1 - rail - e, z0 + rail]),
        piece([x0 + rail + e, z1 - rail], [x1 - rail - e, z1]),
    ];
    frame.into_iter().fold(panel, |mesh, part| mesh.with(grained(part, rng)))
}

/// Five boards around a box between two corners that is open to +y: the inside of what is closed by a front.
pub fn hollow_box(min: [f32; 3], max: [f32; 3], thick: f32) -> Mesh {
    let ([x0, y0, z0], [x1, y1, z1], t, e) = (min, max, thick, GAP);
    let bevel = 0.1 * t;
    all([
        board([x0, y0, z0], [x1, y1, z0 + t], bevel),
        board([x0, y0, z1 - t], [x1, y1, z1], bevel),
        board([x0, y0, z0 + t + e], [x0 + t, y1, z1 - t - e], bevel),
        board([x1 - t, y0, z0 + t + e], [x1, y1, z1 - t - e], bevel),
        board([x0 + t + e, y0, z0 + t + e], [x1 - t - e, y0 + t, z1 - t - e], bevel),
    ])
}

/// A solid box between two corners, or a hollow one where things can be opened.
pub fn body_box(b: &Builder, min: [f32; 3], max: [f32; 3], bevel: f32) -> Mesh {
    if b.has_joints() { hollow_box(min, max, INSIDE) } else { board(min, max, bevel) }
}

/// Thickness of the boards of hollow boxes, metres.
pub const INSIDE: f32 = 0.016;

/// The box of a drawer, open above: `rect` is that of its front, whose back is at y = `front`, and it is `depth` deep. It leaves room for
/// runners at its sides, and for the boards around it.
pub fn drawer_box([x0, x1, z0, z1]: [f32; 4], front: f32, depth: f32) -> Mesh {
    /// Distance from the edges of the front at the sides, below and above, metres.
    const ROOM: [f32; 3] = [0.033, 0.022, 0.034];
    /// Thickness of its boards, metres.
    const BOARD: f32 = 0.012;
    let ([x0, x1, z0, z1], y) = ([x0 + ROOM[0], x1 - ROOM[0], z0 + ROOM[1], z1 - ROOM[2]], [front - depth, front - GAP]);
    let (t, e) = (BOARD, GAP);
    let z1 = z1.max(z0 + 2.0 * t);
    all([
        board([x0, y[0], z0], [x1, y[1], z0 + 0.5 * t], 0.001),
        board([x0, y[0], z0 + 0.5 * t + e], [x0 + t, y[1], z1], 0.001),
        board([x1 - t, y[0], z0 + 0.5 * t + e], [x1, y[1], z1], 0.001),
        board([x0 + t + e, y[0], z0 + 0.5 * t + e], [x1 - t - e, y[0] + t, z1], 0.001),
    ])
}

/// Lets the drawer that consists of the parts from number `from` on be pulled out, and gives it a box, as [`boxed`] does.
pub fn pull(b: &mut Builder, object: &Object, name: &str, from: usize, rect: [f32; 4], front: f32, depth: f32, finish: Finish) {
    let joint = boxed(b, object, name, rect, front, depth, finish);
    b.joint(object, name, &joint, from..b.part_count());
}

/// Adds the box of a drawer where things have joints: `rect` is that of its front, whose back is at y = `front`; the box is `depth` deep.
/// Returns the drawer's joint.
pub fn boxed(b: &mut Builder, object: &Object, name: &str, rect: [f32; 4], front: f32, depth: f32, finish: Finish) -> Joint {
    /// Share of its depth by which a drawer can be pulled out.
    const OUT: f32 = 0.8;
    if b.has_joints() {
        b.part(object, &format!("{name}_box"), drawer_box(rect, front, depth), finish);
    }
    Joint::drawer(OUT * depth)
}

/// The fronts of a cabinet whose knobs are of one piece, unless things have joints.
#[derive(Default)]
pub struct Knobbed {
    knobs: Vec<Mesh>,
    fronts: Vec<(String, Joint, Range<usize>)>,
}

impl Knobbed {
    /// A door that consists of the parts from number `from` on.
    pub fn door(&mut self, b: &Builder, name: &str, from: usize, joint: Joint, knob: Mesh) {
        self.knobs.push(knob);
        self.fronts.push((name.into(), joint, from..b.part_count()));
    }

    /// A drawer that consists of the parts from number `from` on, with its box as [`pull`] adds it.
    pub fn drawer(&mut self, b: &mut Builder, object: &Object, (name, from): (&str, usize), rect: [f32; 4], y: [f32; 2], knob: Mesh) {
        let joint = boxed(b, object, name, rect, y[1], y[1] - y[0], Finish::Wood);
        self.door(b, name, from, joint, knob);
    }

    /// Adds the knobs, and lets the fronts open.
    pub fn add(self, b: &mut Builder, object: &Object, finish: Finish) {
        if !b.has_joints() {
            return b.part(object, "knobs", all(self.knobs), finish);
        }
        for (knob, (name, joint, parts)) in self.knobs.into_iter().zip(self.fronts) {
            b.part(object, &format!("{name}_knob"), knob, finish);
            b.joint(object, &name, &joint, parts.chain([b.part_count() - 1]));
        }
    }
}

/// A finish that bodies of bedroom furniture have, at random.
pub fn body_finish(rng: &mut Rng) -> Finish {
    [Finish::Wood, Finish::Wood, Finish::DarkWood, Finish::WhiteLacquer, Finish::WhiteLacquer, Finish::ColoredLacquer(0)][rng.below(6)]
}
