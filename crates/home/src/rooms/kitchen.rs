//! The kitchen: fitted units along one wall or around a corner, and a table where there is room.

use super::Furnisher;
use super::wishes::cornered;
use crate::place::{Piece, Spot};
use crate::room::{Opening, Wall};
use enfilade_furniture::kitchen::{self, FittedKitchen, Run};
use enfilade_furniture::{Furniture, RoomKind};
use enfilade_math::{Vec2, Vec3};

/// Units keep this distance from walls.
const GAP: f32 = 0.001;
/// Longest main run and longest wing.
const LONGEST: [f32; 2] = [4.0, 2.5];
/// Room for a door's casing and a switch.
const BESIDE_DOOR: f32 = 0.22;
/// A window's sill reaches this far beyond it.
const SILL: f32 = 0.08;
/// Air between units and a sloping ceiling, metres.
const UNDER_SLOPE: f32 = 0.05;
/// Cost of a kitchen without a refrigerator: it is taken where its length is this much nearer to the usual one, metres.
const NO_REFRIGERATOR: f32 = 1.5;
/// Shortest main run: sink, hob and a little worktop.
const SHORTEST: f32 = 1.7;
/// Corners with a smaller angle are acute, radians.
const SQUARE: f32 = 1.56;
/// Doors beyond corners with a larger angle do not swing over units, radians.
const OBTUSE: f32 = 1.9;

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    if !units(f).is_some_and(|kitchen| kitchen.has_refrigerator()) {
        f.furnish("refrigerator", cornered);
    }
    if !f.home_has(RoomKind::Dining) {
        f.dine([2, 4], |floor, s| floor.to_window(s.origin));
    }
    f.perhaps(0.6, "waste_bin", cornered);
    f.art(1, |_, s| s.x.abs());
    f.hang_plant(0.3);
    f.ceiling_lamp();
}

/// A piece of wall without doors, and whether it ends at the room's corners.
struct Stretch {
    wall: Wall,
    x: [f32; 2],
    corners: [bool; 2],
}

/// The longest stretches of each wall, the best first.
fn stretches(f: &Furnisher) -> Vec<Stretch> {
    let mut all: Vec<Stretch> = Vec::new();
    for wall in f.room.walls() {
        let half = 0.5 * f.room.length(wall);
        // Units do not reach into acute corners.
        let angles = f.room.angles(wall);
        let [low_end, high_end] = [0, 1].map(|k| if angles[k] < SQUARE { kitchen::DEPTH / angles[k].tan() } else { 0.0 });
        let (low_end, high_end) = (-half + low_end, half - high_end);
        let mut ways: Vec<[f32; 2]> =
            f.room.ways().filter(|o| o.wall == wall).map(|o| [o.x[0] - BESIDE_DOOR, o.x[1] + BESIDE_DOOR]).collect();
        // Doors in the walls beside it swing over its ends.
        for (k, end) in [(0, -1.0), (1, 1.0)] {
            let side = f.room.beside(wall)[k];
            let near = angles[k] < OBTUSE
                && f.room.ways().filter(|o| o.wall == side).any(|o| {
                    let along = 0.5 * f.room.length(side);
                    let gap = if end < 0.0 { along - o.x[1] } else { along + o.x[0] };
                    gap < kitchen::DEPTH + 0.06
                });
            if near {
                ways.push(if end < 0.0 { [-half, 0.95 - half] } else { [half - 0.95, half] });
            }
        }
        ways.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut from = low_end;
        for [low, high] in ways.into_iter().chain([[high_end, high_end]]) {
            if low - from >= SHORTEST {
                all.push(Stretch {
                    wall,
                    x: [from + GAP, low - GAP],
                    corners: [from == low_end && f.room.is_square(wall, 0), low == high_end && f.room.is_square(wall, 1)],
                });
            }
            from = from.max(high);
        }
    }
    all
}

/// Places the fitted units; `None` where no wall has room.
fn units(f: &mut Furnisher) -> Option<FittedKitchen> {
    let mut tried: Vec<(f32, FittedKitchen, Stretch)> = Vec::new();
    for mut stretch in stretches(f) {
        let along = stretch.x[1] - stretch.x[0];
        let width = along.min(f.rng.range(2.7, LONGEST[0]));
        // A run begins at a corner if there is one.
        if stretch.corners[0] || !stretch.corners[1] {
            stretch.x[1] = stretch.x[0] + width;
            stretch.corners[1] &= width >= along;
        } else {
            stretch.x[0] = stretch.x[1] - width;
            stretch.corners[0] = false;
        }
        let wings = [0, 1].map(|k| if stretch.corners[k] { wing(f, stretch.wall, k) } else { 0.0 });
        let middle = 0.5 * (stretch.x[0] + stretch.x[1]);
        let windows = windows(f, &stretch, middle);
        for wings in [wings, [wings[0], 0.0], [0.0, wings[1]], [0.0; 2]] {
            let variants: Vec<FittedKitchen> =
                (0..6).map(|_| FittedKitchen::fitted(width, wings, &windows, &mut f.rng)).filter(|k| !shuts(k, &windows)).collect();
            let low_sill = f.room.windows().any(|o| o.wall == stretch.wall && o.z[0] < kitchen::WORKTOP + 0.05);
            for kitchen in variants {
                let length = width + kitchen.wings.iter().flatten().map(Run::length).sum::<f32>();
                let cold = if kitchen.has_refrigerator() { 0.0 } else { NO_REFRIGERATOR };
                let cost = (length - 4.2).abs() + if low_sill { 5.0 } else { 0.0 } + cold + f.rng.range(0.0, 0.8);
                tried.push((cost, kitchen, Stretch { ..stretch }));
            }
        }
    }
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    tried.into_iter().find_map(|(_, kitchen, stretch)| place(f, &kitchen, &stretch).then_some(kitchen))
}

/// Extents of the windows above the main run, measured from its middle: those in its wall, and, as a narrow one at its end, those in the
/// walls beside it that begin within its depth.
fn windows(f: &Furnisher, stretch: &Stretch, middle: f32) -> Vec<[f32; 2]> {
    let half = 0.5 * (stretch.x[1] - stretch.x[0]);
    let behind = f.room.windows().filter(|o| o.wall == stretch.wall).map(|o| o.x.map(|x| x - middle));
    let beside = [0, 1].into_iter().filter(|&k| stretch.corners[k]).filter_map(|k| {
        let side = f.room.beside(stretch.wall)[k];
        let along = 0.5 * f.room.length(side);
        let gap = |o: &Opening| if k == 0 { along - o.x[1] } else { along + o.x[0] };
        let near = f.room.windows().filter(|o| o.wall == side).any(|o| gap(o) < kitchen::DEPTH + SILL);
        near.then_some(if k == 0 { [-half, SILL - half] } else { [half - SILL, half] })
    });
    // Nothing hangs where the ceiling slopes down either.
    let low = f.room.low_spans(stretch.wall, [0.0, kitchen::DEPTH], kitchen::TALL + UNDER_SLOPE);
    let low = low.into_iter().map(|x| x.map(|x| (x - middle).clamp(-half, half))).filter(|x| x[1] > x[0]);
    let mut all: Vec<[f32; 2]> = behind.chain(beside).chain(low).collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    all
}

/// True when a tall unit is in front of a window.
fn shuts(kitchen: &FittedKitchen, windows: &[[f32; 2]]) -> bool {
    let mut x = -0.5 * kitchen.main.length();
    kitchen.main.units.iter().any(|(unit, _)| {
        let span = [x, x + unit.width()];
        x = span[1];
        unit.is_tall() && windows.iter().any(|w| span[1] > w[0] - 0.06 && span[0] < w[1] + 0.06)
    })
}

/// Greatest length of a wing in the corner at an end of a wall, metres.
fn wing(f: &mut Furnisher, wall: Wall, end: usize) -> f32 {
    let side = f.room.beside(wall)[end];
    let along = f.room.length(side);
    let beside = |o: &Opening| if o.is_way() { BESIDE_DOOR } else { 0.1 };
    let gap = |o: &Opening| if end == 0 { 0.5 * along - o.x[1] } else { o.x[0] + 0.5 * along };
    let free = f.room.openings.iter().filter(|o| o.wall == side).map(|o| gap(o) - beside(o)).fold(along, f32::min);
    let wished = if f.chance(0.6) { f.rng.range(1.5, LONGEST[1]) } else { 0.0 };
    let length = wished.min(free);
    if length < 1.3 { 0.0 } else { length }
}

fn place(f: &mut Furnisher, kitchen: &FittedKitchen, stretch: &Stretch) -> bool {
    let size = kitchen.size();
    let middle = 0.5 * (stretch.x[0] + stretch.x[1]);
    let run = |size: Vec3, at: Vec2, yaw: f32, reach: f32| Piece::standing(size, reach).at(at.x, at.y, yaw);
    let base = Vec3::new(size.x, kitchen::DEPTH, kitchen::WORKTOP);
    let mut group = vec![run(base, Vec2::new(0.0, GAP + 0.5 * kitchen::DEPTH), 0.0, 0.9)];
    for (k, wing) in kitchen.wings.iter().enumerate() {
        if let Some(wing) = wing {
            let s = [-1.0, 1.0][k];
            let at = Vec2::new(s * 0.5 * (size.x - kitchen::DEPTH), GAP + kitchen::DEPTH + 0.5 * wing.length());
            group.push(run(Vec3::new(wing.length(), kitchen::DEPTH, kitchen::WORKTOP), at, s * std::f32::consts::FRAC_PI_2, 0.8));
        }
    }
    // What reaches above the worktop stays clear of windows, switches and what else is on the walls.
    let back = Vec2::new(0.0, GAP + 0.5 * size.y);
    for [min, max] in kitchen.uppers() {
        let at = back + 0.5 * (min + max).truncate();
        group.push(Piece { z: min.z, ..run(max - min, at, 0.0, 0.0) });
    }
    let spot =
        Spot { origin: f.room.before(stretch.wall, middle, 0.0), yaw: f.room.yaw(stretch.wall), wall: Some(stretch.wall), x: middle };
    let (wall, corners) = (stretch.wall, stretch.corners);
    let Some(_) = f.floor.place(&group, vec![spot], |_, _| 0.0) else { return false };
    let at = spot.point(back);
    let z = f64::from(enfilade_furniture::CONTACT);
    let pose = enfilade_furniture::pose(f64::from(at.x), f64::from(at.y), z, f64::from(spot.yaw));
    f.build(kitchen, pose);
    // The space of the wall units and tall units is taken.
    let above = f.floor.strip(wall, stretch.x, 0.4);
    f.floor.take(above, [kitchen::WORKTOP, f.room.size.z - 0.05]);
    f.built_in.push((wall, stretch.x));
    for (k, corner) in corners.into_iter().enumerate() {
        if let Some(wing) = &kitchen.wings[k] {
            let side = f.room.beside(wall)[k];
            let half = 0.5 * f.room.length(side);
            let length = wing.length() + kitchen::DEPTH + GAP;
            let x = if k == 0 { [half - length, half] } else { [-half, length - half] };
            f.floor.take(f.floor.strip(side, x, 0.4), [kitchen::WORKTOP, f.room.size.z - 0.05]);
            f.built_in.push((side, x));
        } else if corner {
            // The end of the run is against the side wall.
            let side = f.room.beside(wall)[k];
            let half = 0.5 * f.room.length(side);
            f.built_in.push((side, if k == 0 { [half - kitchen::DEPTH, half] } else { [-half, kitchen::DEPTH - half] }));
        }
    }
    f.litter(&kitchen.surfaces(), pose, 0.6);
    true
}
