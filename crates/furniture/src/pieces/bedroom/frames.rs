//! Frames of beds beside those of wooden rails, upholstery and plain metal: with four posts, with a curved head and foot, low platforms, frames
//! with drawers, and ornate metal. Coordinates are those of [`super::bed`]: the mattress is about the origin, its head at −y.

use super::bed_frame::Bed;
use crate::builder::{Builder, Object};
use crate::joint::{Axis, Joint, JointKind};
use crate::materials::Finish;
use crate::pieces::form::{all, rod, turned, wire};
use crate::pieces::joinery::{drawer_box, front};
use crate::pieces::{board, grained};
use crate::shape::{Reshape, bendable_box, sphere, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DVec3, Rng, Vec3};
use std::f32::consts::PI;

/// Distance from the mattress to what stands at its foot, metres: the duvet hangs between.
pub const FOOT: f32 = 0.15;
/// Distance from the mattress's sides to what stands beside them, metres.
pub const BESIDE: f32 = 0.13;
/// Height of a bed with four posts, metres.
pub const POSTS: f32 = 2.02;

/// Slats below a mattress whose lower face is at `base`, on two carriers; `out` from the mattress's edge they end in the sides.
pub(super) fn slats(bed: &Bed, base: f32, out: f32) -> Mesh {
    let (x, y) = (0.5 * bed.width + out, 0.5 * bed.length);
    let slat = |k: usize| {
        let at = -y + 0.08 + (2.0 * y - 0.16) * k as f32 / 13.0;
        board([-x, at - 0.03, base - 0.0245], [x, at + 0.03, base], 0.003)
    };
    let carriers =
        [-1.0f32, 1.0].map(|s| board([s * (x - 0.014) - 0.014, -y, base - 0.07], [s * (x - 0.014) + 0.014, y, base - 0.0243], 0.002));
    all((0..14).map(slat).chain(carriers))
}

/// Rails along both sides at `x`, from one end to the other.
pub(super) fn rails(x: f32, [from, to]: [f32; 2], [low, high]: [f32; 2]) -> Mesh {
    all([-1.0f32, 1.0].map(|s| board([s * x - 0.0125, from, low], [s * x + 0.0125, to, high], 0.004)))
}

/// A bed with four posts, joined by rods at their upper ends.
pub fn four_poster(bed: &Bed, b: &mut Builder, object: &Object, rng: &mut Rng) {
    let (x, head, foot) = (0.5 * bed.width + BESIDE, -0.5 * bed.length - 0.035, 0.5 * bed.length + FOOT);
    let finish = [Finish::Wood, Finish::DarkWood, Finish::BlackMetal, Finish::WhitePaint][rng.below(4)];
    let square = finish != Finish::DarkWood;
    let turned_post = [
        [0.0, 0.0],
        [0.03, 0.0],
        [0.036, 0.05],
        [0.036, 0.5],
        [0.026, 0.56],
        [0.036, 0.66],
        [0.028, 0.8],
        [0.022, 1.6],
        [0.032, 1.7],
        [0.024, 1.76],
        [0.024, POSTS - 0.05],
        [0.034, POSTS - 0.03],
        [0.0, POSTS],
    ];
    for (i, [sx, y]) in [[1.0f32, foot], [-1.0, foot], [-1.0, head], [1.0, head]].into_iter().enumerate() {
        let post = if square { board([-0.03, -0.03, 0.0], [0.03, 0.03, POSTS], 0.004) } else { turned(&turned_post, 24) };
        b.part(object, &format!("post_{}", i + 1), grained(post.moved(Vec3::new(sx * x, y, 0.0)), rng), finish);
    }
    let long = [rails(x, [head, foot], [0.16, 0.32]), rails(x, [head, foot], [POSTS - 0.1, POSTS - 0.06])];
    b.part(object, "rails", grained(all(long), rng), finish);
    let across = |y: f32, z: [f32; 2]| board([-x, y - 0.0124, z[0]], [x, y + 0.0124, z[1]], 0.004);
    let top = [POSTS - 0.1002, POSTS - 0.0602];
    b.part(object, "cross_rails", grained(all([across(foot, [0.1602, 0.3202]), across(foot, top), across(head, top)]), rng), finish);
    let panel = board([-x + 0.01, head - 0.012, 0.2], [x - 0.01, head + 0.012, bed.headboard], 0.006);
    b.part(object, "headboard", grained(panel, rng), finish);
    b.part(object, "slats", slats(bed, 0.26, BESIDE - 0.01), Finish::Wood);
}

/// A curved board across a bed: it leans out and rolls over at its upper end. Its lower end is at y = 0, and it leans to −y.
fn scroll(width: f32, top: f32) -> Mesh {
    let panel = bendable_box(Vec3::new(width, 0.035, top - 0.06), 0.008, [1, 1, 16]);
    let lean = |z: f32| -0.08 * (z / top).powi(2) + 0.05 * (PI * z / top).sin() * 0.5;
    let panel = panel.deformed(|p| {
        let z = p.z + 0.5 * (top - 0.06) + 0.02;
        Vec3::new(p.x, p.y + lean(z), z)
    });
    let at = top - 0.04;
    panel.smoothed(50.0).with(rod([-0.5 * width, lean(at) - 0.012, at], [0.5 * width, lean(at) - 0.012, at], 0.038, 20))
}

/// A sleigh bed: head and foot are curved boards.
pub fn sleigh(bed: &Bed, b: &mut Builder, object: &Object, rng: &mut Rng) {
    let finish = [Finish::DarkWood, Finish::DarkWood, Finish::Wood, Finish::WhitePaint][rng.below(4)];
    let (x, head, foot) = (0.5 * bed.width + 0.03, -0.5 * bed.length - 0.055, 0.5 * bed.length + FOOT);
    b.part(object, "headboard", grained(scroll(2.0 * x, bed.headboard).moved(Vec3::Y * head), rng), finish);
    let end = scroll(2.0 * x, 0.66).turned(Vec3::Z, PI).moved(Vec3::Y * foot);
    b.part(object, "footboard", grained(end, rng), finish);
    b.part(object, "rails", grained(rails(x - 0.014, [head - 0.005, foot + 0.005], [0.12, 0.3]), rng), finish);
    let feet = [[x - 0.06, head], [-x + 0.06, head], [x - 0.06, foot], [-x + 0.06, foot]];
    b.part(object, "feet", all(feet.map(|[x, y]| board([x - 0.03, y - 0.03, 0.0], [x + 0.03, y + 0.03, 0.06], 0.004))), finish);
    b.part(object, "slats", slats(bed, 0.26, 0.012), Finish::Wood);
}

/// A low platform of boards that reaches beyond the mattress on a plinth that is set back, with or without a headboard.
pub fn platform(bed: &Bed, b: &mut Builder, object: &Object, rng: &mut Rng) {
    let finish = [Finish::Wood, Finish::DarkWood, Finish::Wood, Finish::WhiteLacquer][rng.below(4)];
    let (x, head, foot) = (0.5 * bed.width + 0.11, -0.5 * bed.length - 0.004, 0.5 * bed.length + 0.11);
    b.part(object, "plinth", board([-x + 0.2, head + 0.1, 0.0], [x - 0.2, foot - 0.2, 0.131], 0.003), Finish::DarkWood);
    let count = 6;
    let wide = 2.0 * x / count as f32;
    let plank = |k: usize| {
        let left = wide * k as f32 - x;
        grained(board([left + 0.0005, head, 0.13], [left + wide - 0.0005, foot, 0.18], 0.003), &mut rng.fork(k as u64))
    };
    let planks = all((0..count).map(plank));
    b.part(object, "deck", planks, finish);
    if bed.headboard > 1.0 {
        let panel = board([-x, head - 0.034, 0.0], [x, head - 0.001, 0.72], 0.004);
        b.part(object, "headboard", grained(panel, rng), finish);
    }
}

/// A frame with two or three drawers below the mattress, and shelves in the headboard.
pub fn storage(bed: &Bed, b: &mut Builder, object: &Object, rng: &mut Rng) {
    let finish = [Finish::Wood, Finish::WhiteLacquer, Finish::WhiteLacquer, Finish::DarkWood][rng.below(4)];
    let (x, y) = (0.5 * bed.width, 0.5 * bed.length);
    let (high, t) = (0.34, 0.02);
    b.part(object, "deck", board([-x, -y, high - 0.018], [x, y, high], 0.002), finish);
    for (name, [x0, y0], [x1, y1]) in [
        ("end_head", [-x, -y], [x, t - y]),
        ("end_foot", [-x, y - t], [x, y]),
        ("middle", [-0.5 * t, t - y + 0.0002], [0.5 * t, y - t - 0.0002]),
    ] {
        b.part(object, name, grained(board([x0, y0, 0.0], [x1, y1, high - 0.0182], 0.002), rng), finish);
    }
    // Drawers are in the planes of the sides; their fronts are made facing +y and turned.
    let (count, from, to) = (if bed.length > 2.05 { 3 } else { 2 }, t - y, y - t);
    let wide = (to - from) / count as f32;
    for s in [-1.0f32, 1.0] {
        let side = if s < 0.0 { "left" } else { "right" };
        for k in 0..count {
            let (name, first) = (format!("drawer_{side}_{}", k + 1), b.part_count());
            let middle = from + wide * (k as f32 + 0.5);
            let rect = [0.003 - 0.5 * wide, 0.5 * wide - 0.003, 0.05, high - 0.022];
            let face = grained(front(rect, x - 0.02, 0.02, false, rng), rng);
            let turned = face.turned(Vec3::Z, -s * PI * 0.5).moved(Vec3::Y * middle);
            b.part(object, &name, turned, finish);
            let knob = sphere(0.016, 14).moved(Vec3::new(s * (x + 0.01), middle, 0.5 * high + 0.03));
            b.part(object, &format!("{name}_knob"), knob, Finish::Brass);
            let depth = x - 0.06;
            if b.has_joints() {
                let inside = drawer_box(rect, x - 0.02, depth).turned(Vec3::Z, -s * PI * 0.5).moved(Vec3::Y * middle);
                b.part(object, &format!("{name}_box"), inside, Finish::Wood);
            }
            let axis = Axis::Slide(DVec3::X * f64::from(s));
            let joint = Joint { kind: JointKind::Drawer, axis, limits: [0.0, f64::from(0.8 * depth)] };
            b.joint(object, &name, &joint, first..b.part_count());
        }
        b.part(
            object,
            &format!("plinth_{side}"),
            board([s * (x - 0.03) - 0.008, from, 0.0], [s * (x - 0.03) + 0.008, to, 0.0495], 0.001),
            finish,
        );
    }
    shelf_head(bed, b, object, finish, rng);
}

/// A headboard with a row of compartments, 20 cm deep.
fn shelf_head(bed: &Bed, b: &mut Builder, object: &Object, finish: Finish, rng: &mut Rng) {
    let (x, face, depth, t) = (0.5 * bed.width + 0.02, -0.5 * bed.length - 0.004, 0.2, 0.02);
    let rear = face - depth;
    let high = bed.headboard.min(1.0);
    let low = 0.66;
    let pieces = [
        board([-x, rear, 0.0], [x, face, low], 0.003),
        board([-x, rear, high - t], [x, face, high], 0.003),
        board([-x, rear, low + 0.0002], [t - x, face, high - t - 0.0002], 0.002),
        board([x - t, rear, low + 0.0002], [x, face, high - t - 0.0002], 0.002),
        board([t - x + 0.0002, rear + 0.002, low + 0.0004], [x - t - 0.0002, rear + 0.012, high - t - 0.0004], 0.001),
    ];
    b.part(object, "headboard", grained(all(pieces), rng), finish);
    let walls = [-1.0f32, 1.0]
        .map(|s| board([s * x / 3.0 - 0.009, rear + 0.0122, low + 0.0004], [s * x / 3.0 + 0.009, face - 0.004, high - t - 0.0004], 0.001));
    b.part(object, "walls", all(walls), finish);
}

/// Ornate metal: round arches at head and foot with bars and scrolls.
pub fn iron(bed: &Bed, b: &mut Builder, object: &Object, rng: &mut Rng) {
    let finish = [Finish::BlackMetal, Finish::WhiteEnamel, Finish::Brass][rng.below(3)];
    let (x, head, foot) = (0.5 * bed.width + 0.02, -0.5 * bed.length - 0.025, 0.5 * bed.length + FOOT);
    for (name, y, high) in [("head", head, bed.headboard + 0.1), ("foot", foot, 0.74)] {
        let post = |s: f32| {
            rod([s * x, y, 0.0], [s * x, y, high - 0.14], 0.0165, 16).with(sphere(0.026, 18).moved(Vec3::new(s * x, y, high - 0.125)))
        };
        let arch: Vec<Vec3> = (0..=24)
            .map(|k| {
                let a = PI * k as f32 / 24.0;
                Vec3::new(-x * a.cos(), y, high - 0.16 + 0.14 * a.sin())
            })
            .collect();
        let low = if name == "head" { 0.5 } else { 0.36 };
        let level = |z: f32| rod([-x, y, z], [x, y, z], 0.01, 12);
        let count = (2.0 * x / 0.13) as usize;
        let bars = (1..count).map(|k| {
            let t = k as f32 / count as f32;
            let at = 2.0 * x * t - x;
            let top = high - 0.16 + 0.14 * (1.0 - (at / x).powi(2)).max(0.0).sqrt();
            let ball = sphere(0.014, 12).moved(Vec3::new(at, y, 0.5 * (low + top)));
            rod([at, y, low], [at, y, top], 0.006, 10).with(ball)
        });
        let frame = all([post(-1.0), post(1.0), tube(&arch, 0.0125, 14), level(low), level(0.25)].into_iter().chain(bars));
        b.part(object, name, frame, finish);
    }
    b.part(object, "rails", rails(x, [head, foot], [0.22, 0.27]), finish);
    b.part(object, "slats", slats(bed, 0.26, 0.012), Finish::Wood);
}

/// A wire arch for headboards of rattan or bent tube, with sticks below it.
pub fn arched_head(bed: &Bed, b: &mut Builder, object: &Object, finish: Finish) {
    let (x, y, high) = (0.5 * bed.width + 0.02, -0.5 * bed.length - 0.025, bed.headboard);
    let path = [[-x, y, 0.0], [-x, y, 0.6], [-0.8 * x, y, high - 0.1], [0.0, y, high], [0.8 * x, y, high - 0.1], [x, y, 0.6], [x, y, 0.0]];
    let count = (2.0 * x / 0.07) as usize;
    let sticks = (1..count).map(|k| {
        let at = 2.0 * x * k as f32 / count as f32 - x;
        let top = high - 0.02 - 0.12 * (at / (0.8 * x)).powi(2).min(1.6);
        rod([at, y, 0.32], [at, y, top], 0.007, 8)
    });
    let frame = all([wire(&path, 0.018, 14), rod([-x, y, 0.33], [x, y, 0.33], 0.014, 12)].into_iter().chain(sticks));
    b.part(object, "headboard", frame, finish);
}
