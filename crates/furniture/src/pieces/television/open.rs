//! Cabinets for televisions with drawers, with an open shelf, and of glass.

use super::bench::TelevisionBench;
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, corners, cylinder};
use crate::pieces::joinery::{Carcass, Feet, front, pull};
use crate::pieces::{CONTACT, board, grained, on};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// Thickness of boards, metres.
const BOARD: f32 = 0.02;

/// A box with a light, as receivers and players have.
fn player(b: &mut Builder, pose: DAffine3, at: Vec3, size: Vec3) {
    let player = b.object("player", Class::OtherProp, on(pose, at + Vec3::Z * CONTACT, 0.01));
    b.part(&player, "housing", rounded_box(size, 0.004, 2).moved(Vec3::Z * 0.5 * size.z), Finish::BlackPlastic);
    let face = 0.5 * size.y;
    let window = board([-0.3 * size.x, face - 0.002, 0.3 * size.z], [0.1 * size.x, face + 0.001, 0.7 * size.z], 0.0005);
    b.part(&player, "window", window, Finish::GlossBlack);
}

/// Two or three drawers side by side below an open compartment.
pub fn drawers(bench: &TelevisionBench, finish: Finish, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
    let cabinet = b.object("tv_bench", Class::Cabinet, pose);
    let (half, back, face) = (0.5 * bench.width, -0.5 * bench.depth, 0.5 * bench.depth);
    let leg = 0.07;
    let feet = [Feet::Plinth, Feet::Round(Finish::BlackMetal), Feet::Runners(Finish::BlackMetal)][rng.below(3)];
    feet.add(b, &cabinet, Vec2::new(half, face), leg, finish);
    let carcass = Carcass { x: [-half, half], y: [back, face - 0.018], z: [leg, bench.top], thick: BOARD, finish };
    carcass.add(b, &cabinet, rng);
    let [x0, x1, low, high] = carcass.inside();
    // The lower part is for drawers, the upper one is open.
    let split = low + 0.56 * (high - low);
    let shelf = board([x0 + 0.0003, back + 0.0105, split], [x1 - 0.0003, face - 0.03, split + 0.016], 0.001);
    b.part(&cabinet, "shelf", grained(shelf, rng), finish);
    let count = if bench.width > 1.5 { 3 } else { 2 };
    let wide = (x1 - x0) / count as f32;
    for k in 0..count {
        let from = b.part_count();
        let left = x0 + wide * k as f32;
        let rect = [left + 0.0015, left + wide - 0.0015, low + 0.002, split - 0.002];
        let y = face - 0.0178;
        b.part(&cabinet, &format!("drawer_{}", k + 1), front(rect, y, 0.0175, false, rng), finish);
        pull(b, &cabinet, &format!("drawer_{}", k + 1), from, rect, y, bench.depth - 0.05, Finish::Wood);
    }
    let walls = (1..count).map(|k| {
        let x = x0 + wide * k as f32;
        board([x - 0.008, back + 0.0105, split + 0.0162], [x + 0.008, face - 0.03, high - 0.0002], 0.001)
    });
    b.part(&cabinet, "walls", grained(all(walls), rng), finish);
    let tall = (high - split - 0.016 - 0.02).min(0.06);
    if tall > 0.03 {
        player(b, pose, Vec3::new(x0 + 0.5 * wide, 0.0, split + 0.016), Vec3::new(0.34f32.min(wide - 0.05), 0.22, tall));
    }
}

/// A board on runners of metal with a shelf below.
pub fn open(bench: &TelevisionBench, finish: Finish, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
    let cabinet = b.object("tv_bench", Class::Cabinet, pose);
    let (half, deep) = (0.5 * bench.width, 0.5 * bench.depth);
    let top = board([-half, -deep, bench.top - 0.03], [half, deep, bench.top], 0.003);
    b.part(&cabinet, "top", grained(top, rng), finish);
    Feet::Runners(Finish::BlackMetal).add(b, &cabinet, Vec2::new(half, deep), bench.top - 0.0302, finish);
    let low = 0.14;
    let shelf = board([0.045 - half, 0.04 - deep, low], [half - 0.045, deep - 0.04, low + BOARD], 0.002);
    b.part(&cabinet, "shelf", grained(shelf, rng), finish);
    // Two bars carry it from runner to runner.
    let bar = |y: f32| board([0.03 - half, y - 0.01, low - 0.0202], [half - 0.03, y + 0.01, low - 0.0002], 0.001);
    let posts = corners(Vec2::new(half - 0.03, deep - 0.034))
        .map(|at| board([at.x - 0.0123, at.y - 0.0122, low - 0.02], [at.x + 0.0123, at.y + 0.0122, low - 0.0003], 0.001));
    b.part(&cabinet, "bars", all([bar(0.034 - deep), bar(deep - 0.034)].into_iter().chain(posts)), Finish::BlackMetal);
    player(b, pose, Vec3::new(-0.22 * bench.width, 0.0, low + BOARD), Vec3::new(0.4, 0.26, 0.07));
    box_of_games(b, pose, Vec3::new(0.25 * bench.width, 0.0, low + BOARD), rng);
}

/// Three panes on metal posts.
pub fn glass(bench: &TelevisionBench, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
    let cabinet = b.object("tv_bench", Class::Cabinet, pose);
    let (half, deep) = (0.5 * bench.width, 0.5 * bench.depth);
    let metal = [Finish::Chrome, Finish::BlackMetal, Finish::Aluminium][rng.below(3)];
    let pane = |z: f32, inset: f32| board([inset - half, inset - deep, z - 0.008], [half - inset, deep - inset, z], 0.001);
    // The panes have holes for the posts: each piece of a post ends at a pane.
    let levels = [0.1, 0.5 * (bench.top + 0.1), bench.top];
    let finish = [Finish::DrinkingGlass, Finish::GlossBlack][rng.below(2)];
    for (k, z) in levels.into_iter().enumerate() {
        b.part(&cabinet, &format!("pane_{}", k + 1), pane(z, if k == 2 { 0.0 } else { 0.01 }), finish);
    }
    for (i, at) in corners(Vec2::new(half - 0.06, deep - 0.06)).into_iter().enumerate() {
        let piece = |low: f32, high: f32| cylinder(0.019, high - low, 20).moved(at.extend(low));
        let post = all([
            piece(0.0, levels[0] - 0.0082),
            piece(levels[0] + 0.0002, levels[1] - 0.0082),
            piece(levels[1] + 0.0002, levels[2] - 0.0082),
        ]);
        b.part(&cabinet, &format!("post_{}", i + 1), post, metal);
    }
    player(b, pose, Vec3::new(-0.1, 0.0, levels[1]), Vec3::new(0.42, 0.27, 0.06));
    player(b, pose, Vec3::new(0.12, 0.0, levels[0]), Vec3::new(0.38, 0.24, 0.09));
}

/// A row of cases of films or games that stand.
fn box_of_games(b: &mut Builder, pose: DAffine3, at: Vec3, rng: &mut Rng) {
    let object: Object = b.object("game_cases", Class::OtherProp, on(pose, at + Vec3::Z * CONTACT, 0.0));
    let count = 6 + rng.below(6);
    for k in 0..count {
        // Cases are 135 × 190 × 14 mm.
        let x = 0.0145 * (k as f32 - 0.5 * (count - 1) as f32);
        let case = board([x - 0.007, -0.0675, 0.0], [x + 0.007, 0.0675, 0.19], 0.001);
        b.part(&object, &format!("case_{}", k + 1), case, [Finish::BlackPlastic, Finish::Plastic(rng.below(5) as u8)][rng.below(2)]);
    }
}
