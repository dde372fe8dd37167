//! Beds of children and guests: with a back along one side, and bunks. Coordinates are those of [`super::bed`].

use super::bed_frame::Bed;
use super::frames::{BESIDE, FOOT, rails, slats};
use crate::builder::{Builder, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, rod};
use crate::pieces::{board, grained};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{Rng, Vec3};

/// Heights of the lower faces of the mattresses in a bunk, metres: 70 to 90 cm are free to sit.
pub const BUNKS: [f32; 2] = [0.3, 1.3];
/// Height of the posts of a bunk, metres. Its guards end 18 cm above the mattress (EN 747: 16 cm or more).
pub const BUNK: f32 = 1.86;
/// A bed for one with a back along one long side and both ends, as people use it for a sofa by day.
pub fn sided(bed: &Bed, b: &mut Builder, object: &Object, rng: &mut Rng) {
    let finish = [Finish::WhiteLacquer, Finish::Wood, Finish::DarkWood][rng.below(3)];
    let (x, head, foot) = (0.5 * bed.width + BESIDE, -0.5 * bed.length - 0.03, 0.5 * bed.length + FOOT);
    let high = 0.78;
    for (name, y) in [("end_head", head), ("end_foot", foot)] {
        let panel = rounded_box(Vec3::new(2.0 * x, 0.035, high - 0.1), 0.012, 3).moved(Vec3::new(0.0, y, 0.5 * (high + 0.1)));
        let feet = [-1.0f32, 1.0].map(|s| board([s * (x - 0.05) - 0.03, y - 0.016, 0.0], [s * (x - 0.05) + 0.03, y + 0.016, 0.13], 0.003));
        b.part(object, name, grained(panel.with(all(feet)), rng), finish);
    }
    let back = rounded_box(Vec3::new(0.03, foot - head, high - 0.3), 0.01, 3).moved(Vec3::new(
        -x + 0.02,
        0.5 * (foot + head),
        0.5 * (high - 0.04 + 0.26),
    ));
    b.part(object, "back", grained(back, rng), finish);
    b.part(object, "rails", grained(rails(x - 0.02, [head, foot], [0.14, 0.3]), rng), finish);
    b.part(object, "slats", slats(bed, 0.26, BESIDE - 0.02), Finish::Wood);
}

/// A bunk: two beds, one above the other, with guards and a ladder at the front side.
pub fn bunk(bed: &Bed, b: &mut Builder, object: &Object, rng: &mut Rng) {
    let metal = rng.below(3) == 0;
    let finish =
        if metal { [Finish::BlackMetal, Finish::CoatedWhite][rng.below(2)] } else { [Finish::Wood, Finish::WhitePaint][rng.below(2)] };
    let (x, head, foot) = (0.5 * bed.width + BESIDE, -0.5 * bed.length - 0.04, 0.5 * bed.length + FOOT);
    let r = if metal { 0.02 } else { 0.035 };
    for (i, [sx, y]) in [[1.0f32, foot], [-1.0, foot], [-1.0, head], [1.0, head]].into_iter().enumerate() {
        let post = board([sx * x - r, y - r, 0.0], [sx * x + r, y + r, BUNK], 0.004);
        b.part(object, &format!("post_{}", i + 1), grained(post, rng), finish);
    }
    let mut boards = Vec::new();
    for (level, base) in ["lower", "upper"].into_iter().zip(BUNKS) {
        boards.push(rails(x, [head, foot], [base - 0.11, base + 0.03]));
        boards.extend([head, foot].map(|y| board([-x, y - 0.0122, base - 0.1102], [x, y + 0.0122, base + 0.0302], 0.003)));
        // Pillows lean against the panel at the head.
        boards.push(board([-x, head - 0.0122, base + 0.06], [x, head + 0.0122, base + 0.54], 0.003));
        boards.push(board([-x, foot - 0.0122, base + 0.2], [x, foot + 0.0122, base + 0.28], 0.003));
        b.part(object, &format!("slats_{level}"), slats(bed, base, BESIDE - 0.01), Finish::Wood);
    }
    // Guards along both sides; the front one leaves room for the ladder at the foot.
    let (low, high, open) = (BUNKS[1] + 0.22, BUNKS[1] + 0.34, foot - 0.5);
    boards.push(board([-x - 0.012, head, low], [-x + 0.012, foot, high], 0.003));
    boards.push(board([x - 0.012, head, low], [x + 0.012, open, high], 0.003));
    boards.push(board([x - 0.0122, open - 0.04, BUNKS[1]], [x + 0.0122, open + 0.0002, high + 0.0002], 0.003));
    b.part(object, "boards", grained(all(boards), rng), finish);
    let rung = |k: usize| {
        let z = 0.25 * (k + 1) as f32;
        rod([x + 0.03, open + 0.03, z], [x + 0.03, foot - 0.04, z], 0.014, 12)
    };
    let sides = [open + 0.03, foot - 0.05].map(|y| board([x + 0.0127, y - 0.015, 0.0], [x + 0.048, y + 0.015, BUNKS[1] + 0.2], 0.003));
    b.part(object, "ladder", grained(all((0..5).map(rung).chain(sides)), rng), finish);
}
