//! A low cabinet with two doors and an open compartment between them for a player, on slanted legs.

use super::bench::TelevisionBench;
use crate::builder::{Builder, Class};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::{CONTACT, board, grained, leg, on};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// Height of the legs, metres.
const LEG: f32 = 0.14;
/// Height of the cabinet's top, metres: television cabinets are 40 to 60 cm high.
pub const TOP: f32 = 0.50;
/// Thickness of the boards, metres.
const BOARD: f32 = 0.022;
/// Position at which uprights meet the boards below and above them, metres from the outer face: the board and air that keeps faces out of
/// one plane.
const INNER: f32 = 0.0222;

/// Adds a cabinet with two doors; its fronts are white or of wood.
pub fn doors(bench: &TelevisionBench, white: bool, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
    let cabinet = b.object("tv_bench", Class::Cabinet, pose);
    let (half, wood) = (0.5 * bench.width, Finish::Wood);
    let (back, front) = (-0.5 * bench.depth, 0.5 * bench.depth);
    b.part(&cabinet, "top", grained(board([-half, back, TOP - BOARD], [half, front, TOP], 0.002), rng), wood);
    b.part(&cabinet, "bottom", grained(board([-half, back, LEG], [half, front, LEG + BOARD], 0.002), rng), wood);
    let side = |x: f32| board([x - 0.5 * BOARD, back, LEG + INNER], [x + 0.5 * BOARD, front, TOP - INNER], 0.002);
    b.part(&cabinet, "side_left", grained(side(-half + 0.5 * BOARD), rng), wood);
    b.part(&cabinet, "side_right", grained(side(half - 0.5 * BOARD), rng), wood);
    let inner = bench.width - 2.0 * BOARD;
    let rear = board([-0.5 * inner, back + 0.002, LEG + INNER], [0.5 * inner, back + 0.012, TOP - INNER], 0.001);
    b.part(&cabinet, "rear", rear, wood);
    let fronts = if white { Finish::WhiteLacquer } else { wood };
    // Two doors, and an open compartment between them for the player.
    let third = inner / 3.0;
    for (i, x) in [(1, -third), (2, third)] {
        let door =
            board([x - 0.5 * third + 0.003, front - 0.019, LEG + 0.0255], [x + 0.5 * third - 0.003, front - 0.001, TOP - 0.0255], 0.0015);
        let from = b.part_count();
        b.part(&cabinet, &format!("door_{i}"), grained(door, rng), fronts);
        let knob = leg(0.022, [0.011, 0.007], Vec2::ZERO).moved(Vec3::new(0.0, 0.0, -0.022)).turned(Vec3::X, std::f32::consts::FRAC_PI_2);
        let at = Vec3::new(x - x.signum() * (0.5 * third - 0.045), front - 0.0012, TOP - 0.075);
        b.part(&cabinet, &format!("knob_{i}"), knob.moved(at), Finish::Brass);
        // The knob is towards the middle, the hinges are at the outer edge.
        let edge = x + x.signum() * (0.5 * third - 0.003);
        b.joint(&cabinet, &format!("door_{i}"), &Joint::cupboard(edge, front - 0.001, x.signum()), from..b.part_count());
        let wall = 0.5 * third * x.signum();
        let divider = board([wall - 0.009, back + 0.0125, LEG + INNER], [wall + 0.009, front - 0.002, TOP - INNER], 0.0015);
        b.part(&cabinet, &format!("divider_{i}"), grained(divider, rng), wood);
    }
    let shelf = board([-0.5 * third + 0.0092, back + 0.0125, 0.31], [0.5 * third - 0.0092, front - 0.02, 0.326], 0.0015);
    b.part(&cabinet, "shelf", grained(shelf, rng), wood);
    for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
        let at = on(DAffine3::IDENTITY, Vec3::new(s.x * (half - 0.12), s.y * (front - 0.07), 0.0), 0.0);
        b.part_at(&cabinet, &format!("leg_{}", i + 1), leg(LEG - 0.0002, [0.013, 0.02], s * 0.03), at, wood);
    }
    let player = b.object("player", Class::OtherProp, on(pose, Vec3::new(0.02, 0.02, 0.326 + CONTACT), 0.01));
    b.part(
        &player,
        "housing",
        rounded_box(Vec3::new(0.36, 0.26, 0.055), 0.004, 2).moved(Vec3::new(0.0, 0.0, 0.0275)),
        Finish::BlackPlastic,
    );
}
