//! The gym: machines in a row before mirrors or windows, weights, and mats.

use super::Furnisher;
use super::stations::Part;
use super::wishes::{centred, cornered, in_view};
use crate::place::{Floor, Piece, Spot};
use enfilade_furniture::Furniture;
use enfilade_furniture::gym::{ExerciseBike, ExerciseMat, MirrorWall, Treadmill, WeightBench};
use enfilade_math::Vec2;
use std::f32::consts::FRAC_PI_2;

/// Air between machines in a row, metres.
const BESIDE: f32 = 0.42;
/// Distance of machines from the wall before them, metres.
const BEFORE: f32 = 0.25;
/// Height of the middle of mirrors, metres.
const MIRROR: f32 = 1.15;

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    let mirrors = MirrorWall::random(&mut f.rng);
    let long = |floor: &Floor, s: &Spot| s.x.abs() - 0.3 * s.wall.map_or(0.0, |wall| floor.room().length(wall));
    for share in [1.0, 2.0 / 3.0, 1.0 / 3.0] {
        let width = (1.2 * (share * mirrors.size.x / 1.2).round()).max(1.2);
        if let Some(wall) = f.hang(&MirrorWall { size: Vec2::new(width, mirrors.size.y) }, MIRROR, &f.room.walls(), long) {
            f.accent = Some(wall);
            break;
        }
    }
    let treadmill = Treadmill { shows: None, ..Treadmill::random(&mut f.rng) };
    let lit = Treadmill { shows: Some(f.rng.below(4) as u8), ..treadmill };
    let bike = ExerciseBike::random(&mut f.rng);
    let counts = [0, 1].map(|_| 2 + f.rng.below(3));
    machines(f, [&treadmill, &lit], counts[0]);
    machines(f, [&bike, &bike], counts[1]);
    f.furnish("dumbbell_rack", centred);
    for _ in 0..1 + f.rng.below(2) {
        let bench = WeightBench::random(&mut f.rng);
        let parts = [Part::new(&bench, [0.0, 0.5 * bench.size().y + 0.1], 0.0).reached(0.4)];
        f.once(f.floor.along_walls(bench.size().x), &parts, |floor, s| floor.to_corner(s));
    }
    mats(f);
    for _ in 0..f.rng.below(3) {
        f.furnish("exercise_ball", cornered);
    }
    f.perhaps(0.5, "bench", in_view);
    f.perhaps(0.4, "water_dispenser", cornered);
    f.perhaps(0.4, "plant", cornered);
    f.hang_one(0.4, "wall_display", 2.0, |_, s| s.x.abs());
    f.art(2, |_, s| s.x.abs());
    f.public_things();
    f.work_lights();
}

/// Up to `most` equal machines beside each other before a wall, at which people look.
fn machines(f: &mut Furnisher, variants: [&dyn Furniture; 2], most: usize) {
    let size = variants[0].size();
    let pitch = size.x + BESIDE;
    let y = BEFORE + 0.5 * size.y;
    for count in (1..=most).rev() {
        let x = |k: usize| pitch * (k as f32 - 0.5 * (count - 1) as f32);
        let parts: Vec<Part> = (0..count).map(|k| Part::new(variants[k % 2], [x(k), y], 0.0).reached(0.6)).collect();
        let spots = f.floor.along_walls(pitch * count as f32);
        if f.once(spots, &parts, |floor, s| 0.4 * floor.to_window(s.origin) + 0.3 * floor.to_corner(s)).is_some() {
            return;
        }
    }
}

/// Mats on the floor that is left.
fn mats(f: &mut Furnisher) {
    let turn = [0.0, FRAC_PI_2][f.rng.below(2)];
    let center = f.room.center;
    for _ in 0..1 + f.rng.below(4) {
        let mat = ExerciseMat::random(&mut f.rng);
        let piece = Piece { flat: true, ..Piece::standing(mat.size(), 0.0).at(0.0, 0.0, 0.0) };
        let spots = f.floor.everywhere(0.15, &[turn]);
        if let Some((_, poses)) = f.floor.place(&[piece], spots, |_, s| s.origin.distance(center)) {
            f.build(&mat, poses[0]);
        }
    }
}
