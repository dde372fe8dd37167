//! Televisions: on a cabinet opposite the sofa or on the wall above it, and opposite beds.

use super::Furnisher;
use crate::place::{Floor, Spot};
use crate::room::Wall;
use enfilade_furniture::office::WallDisplay;
use enfilade_furniture::{BookStack, Furniture, TelevisionBench, TelevisionSet, Vase, on};
use enfilade_math::{DAffine3, Vec3};

/// Builds the cabinet with its television opposite the sofa: one in four is on the wall above it, where that is free.
pub fn opposite(f: &mut Furnisher, bench: &TelevisionBench, wall: Wall, pose: DAffine3) {
    let width = f.rng.range(0.9, 1.35).min(bench.width);
    let display = WallDisplay { width, shows: TelevisionSet::shown(&mut f.rng) };
    let at = pose.translation.truncate().as_vec2();
    let above = |_: &Floor, s: &Spot| {
        let aside = (s.origin - at).dot(s.front().perp()).abs();
        if aside > 0.12 { f32::INFINITY } else { aside }
    };
    let bare = TelevisionBench { set: None, ..*bench };
    if f.chance(0.25) && f.hang(&display, bench.top + 0.25 + 0.5 * display.size().z, &[wall], above).is_some() {
        f.build(&bare, pose);
        return on_bench(f, bench, None, pose);
    }
    f.build(bench, pose);
    on_bench(f, bench, bench.set, pose);
}

/// In three of ten bedrooms a television hangs opposite the bed.
pub fn before_bed(f: &mut Furnisher) {
    let display = WallDisplay { width: f.rng.range(0.7, 1.15), shows: TelevisionSet::shown(&mut f.rng) };
    let Some(wall) = f.accent.filter(|_| f.chance(0.3)) else { return };
    let opposite = f.room.face(wall).opposite;
    f.hang(&display, 1.35, &[opposite], |_, s| s.x.abs());
}

/// A vase and books beside the television, or below it where it is on the wall, as far as there is room.
fn on_bench(f: &mut Furnisher, bench: &TelevisionBench, set: Option<TelevisionSet>, pose: DAffine3) {
    /// Width that a vase or a pile of books takes, metres.
    const THING: f32 = 0.2;
    let top = |x: f32, y: f32| on(pose, Vec3::new(x, y, bench.top), 0.0);
    let screen = set.map_or(0.0, |set| set.width);
    let beside = 0.25 * (bench.width + screen);
    if bench.width - screen < 2.0 * THING {
        return;
    }
    let side = if f.rng.below(2) == 0 { 1.0 } else { -1.0 };
    // Branches would hide a screen on the wall.
    let vase = Vase { height: 0.24, belly: 0.075, branches: if set.is_some() { 5 } else { 0 } };
    if f.is_below_slopes(vase.size(), top(side * beside, 0.0)) {
        f.build_small(&vase, top(side * beside, 0.0));
    }
    let turn = f.rng.range(-0.15, 0.15);
    f.build_small(&BookStack { count: 2 }, on(top(-side * beside, -0.02), Vec3::ZERO, turn));
}
