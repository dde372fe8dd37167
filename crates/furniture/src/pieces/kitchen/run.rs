//! A run of kitchen units in a line along a wall: which unit is where, the pieces of worktop (class counter) with their cut-outs, what
//! covers the wall behind them, and what hangs above. The run's space has x from its left end, y from the wall and z from the floor.

use super::front::KitchenStyle;
use super::unit::Unit;
use super::{DEPTH, HANDLES, TALL, THICKNESS, WALL_DEPTH, WALL_UNIT, WORKTOP, appliance, sink, unit};
use crate::builder::{Builder, Class};
use crate::pieces::form::plate_with_holes;
use crate::pieces::{CONTACT, Surface, board, grained, on};
use crate::shape::Reshape;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// The things above a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Above {
    Nothing,
    Doors,
    Glazed,
    /// Two open boards.
    Boards,
    Hood,
}

/// Height above the worktop of what covers the wall below a window, metres.
const UPSTAND: f32 = 0.1;
/// Length of a window's sill beyond the window at each side, metres.
pub(super) const SILL_END: f32 = 0.06;

/// Units in a line along a wall, in the run's own space: x from its left end, y from the wall, z from the floor.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// From left to right, each with what hangs above it.
    pub units: Vec<(Unit, Above)>,
    /// The windows that begin not far above the worktop, from and to along x, in ascending order.
    pub windows: Vec<[f32; 2]>,
}

impl Run {
    /// Sum of the widths.
    pub fn length(&self) -> f32 {
        self.units.iter().map(|(unit, _)| unit.width()).sum()
    }

    /// Each unit with the x of its left edge.
    fn placed(&self) -> impl Iterator<Item = (f32, Unit, Above)> {
        self.units.iter().scan(0.0, |x, &(unit, above)| {
            let left = *x;
            *x += unit.width();
            Some((left, unit, above))
        })
    }

    /// Ends of the pieces of worktop, between tall units.
    fn worktops(&self) -> Vec<[f32; 2]> {
        let mut pieces: Vec<[f32; 2]> = Vec::new();
        for (x, unit, _) in self.placed().filter(|(_, unit, _)| !unit.is_tall()) {
            match pieces.last_mut() {
                Some(piece) if (piece[1] - x).abs() < 1e-4 => piece[1] = x + unit.width(),
                _ => pieces.push([x, x + unit.width()]),
            }
        }
        pieces
    }

    /// Surfaces for small things: the worktop except for sink and hob, in the run's space.
    pub fn surfaces(&self) -> Vec<Surface> {
        /// Distance that things keep from the end of a strip, metres.
        const MARGIN: f32 = 0.02;
        /// Narrower strips stay empty, metres.
        const NARROWEST: f32 = 0.12;
        let mut free: Vec<Surface> = Vec::new();
        for (x, unit, above) in self.placed() {
            if unit.is_tall() || matches!(unit, Unit::Sink(_) | Unit::Oven(_)) {
                continue;
            }
            let headroom = if above == Above::Nothing { f32::INFINITY } else { WALL_UNIT[0] - WORKTOP };
            match free.last_mut() {
                Some(last) if (last.max.x + MARGIN - x).abs() < 1e-4 && last.headroom == headroom => last.max.x = x + unit.width() - MARGIN,
                _ => free.push(Surface {
                    min: Vec2::new(x + MARGIN, 0.05),
                    max: Vec2::new(x + unit.width() - MARGIN, DEPTH - 0.04),
                    z: WORKTOP,
                    headroom,
                }),
            }
        }
        free.retain(|s| s.max.x - s.min.x > NARROWEST);
        free
    }

    /// The pieces of what covers the wall behind a worktop over `[x0, x1]`, each with its upper edge: below windows it is an upstand.
    fn covered(&self, [x0, x1]: [f32; 2]) -> Vec<([f32; 2], f32)> {
        let mut pieces = Vec::new();
        let mut from = x0;
        for [low, high] in self.windows.iter().map(|w| [(w[0] - SILL_END).clamp(x0, x1), (w[1] + SILL_END).clamp(x0, x1)]) {
            pieces.push(([from, low], WALL_UNIT[0] - 0.001));
            pieces.push(([low.max(from), high], WORKTOP + UPSTAND));
            from = from.max(high);
        }
        pieces.push(([from, x1], WALL_UNIT[0] - 0.001));
        pieces.retain(|([a, b], _)| b - a > 0.01);
        pieces
    }

    /// The boxes of what reaches above the worktop, from and to, in the run's space.
    pub fn uppers(&self) -> Vec<[Vec3; 2]> {
        let mut all = Vec::new();
        for (x, unit, above) in self.placed() {
            let (end, hood) = (x + unit.width(), Vec3::new(0.0, 0.47, WORKTOP + 0.6));
            if unit.is_tall() {
                all.push([Vec3::new(x, 0.0, WORKTOP), Vec3::new(end, DEPTH + HANDLES, TALL)]);
            } else if above != Above::Nothing {
                let (depth, low) = if above == Above::Hood { (hood.y, hood.z) } else { (WALL_DEPTH + HANDLES, WALL_UNIT[0] - 0.12) };
                all.push([Vec3::new(x, 0.0, low), Vec3::new(end, depth, TALL)]);
            }
        }
        for ([x0, x1], top) in self.worktops().into_iter().flat_map(|piece| self.covered(piece)) {
            all.push([Vec3::new(x0, 0.0, WORKTOP), Vec3::new(x1, 0.0085, top)]);
        }
        all
    }

    /// Adds units, what hangs above them, worktops and what covers the wall.
    pub fn build(&self, b: &mut Builder, pose: DAffine3, style: &KitchenStyle, rng: &mut Rng) {
        // A built-in refrigerator is of another class, and comes last: the run begins with its cabinets.
        let mut placed: Vec<(f32, Unit, Above)> = self.placed().collect();
        placed.sort_by_key(|(_, unit, _)| *unit == Unit::BuiltInRefrigerator);
        for (x, unit, above) in placed {
            let w = unit.width();
            let at = on(pose, Vec3::new(x, 0.0, 0.0), 0.0);
            unit::base(b, at, unit, style, rng);
            let middle = |z: f32| on(pose, Vec3::new(x + 0.5 * w, 0.0, z), 0.0);
            match unit {
                Unit::Sink(_) => sink::build(b, middle(WORKTOP), w, style, rng),
                Unit::Oven(_) => appliance::hob(b, middle(WORKTOP), w.min(0.8), style, rng),
                _ => {}
            }
            match above {
                Above::Nothing => {}
                Above::Doors | Above::Glazed => unit::wall_cabinet(b, at, w, WALL_UNIT, above == Above::Glazed, style, rng),
                Above::Hood => appliance::hood(b, middle(0.0), w, style, rng),
                Above::Boards => self.boards(b, at, w, style, rng),
            }
        }
        for piece in self.worktops() {
            self.worktop(b, pose, piece, style, rng);
        }
    }

    fn boards(&self, b: &mut Builder, pose: DAffine3, w: f32, style: &KitchenStyle, rng: &mut Rng) {
        for z in [1.50, 1.83] {
            let object = b.object("wall_shelf", Class::Shelves, pose);
            // The shelf touches the wall or, where its brackets reach down to it, what covers the wall.
            let back = if z - 0.12 < WALL_UNIT[0] { 0.009 } else { 0.001 };
            b.part(
                &object,
                "board",
                grained(board([0.01, back, z], [w - 0.01, 0.24, z + 0.028], 0.002), rng),
                crate::materials::Finish::Wood,
            );
            let bracket = |x: f32| {
                board([x - 0.008, back + 0.0002, z - 0.12], [x + 0.008, back + 0.005, z - CONTACT], 0.001).with(board(
                    [x - 0.008, back + 0.0052, z - 0.006],
                    [x + 0.008, 0.2, z - CONTACT],
                    0.001,
                ))
            };
            b.part(&object, "brackets", bracket(0.08).with(bracket(w - 0.08)), style.metal);
            crate::pieces::tableware::shelf_of_crockery(b, on(pose, Vec3::new(0.5 * w, 0.13, z + 0.028), 0.0), w - 0.14, rng);
        }
    }

    /// One piece of worktop over `[x0, x1]` with its cut-outs, and what covers the wall behind it.
    fn worktop(&self, b: &mut Builder, pose: DAffine3, [x0, x1]: [f32; 2], style: &KitchenStyle, rng: &mut Rng) {
        let holes: Vec<[f32; 4]> = self
            .placed()
            .filter(|(x, unit, _)| matches!(unit, Unit::Sink(_)) && *x >= x0 && *x < x1)
            .map(|(x, unit, _)| {
                let [half, back, front] = sink::cut_out(unit.width());
                let middle = x + 0.5 * unit.width();
                [middle - half, middle + half, back, front]
            })
            .collect();
        let counter = b.object("worktop", Class::Counter, pose);
        let ends = [Vec2::new(x0 + 0.0003, 0.002), Vec2::new(x1 - 0.0003, DEPTH)];
        let top = plate_with_holes(ends[0], ends[1], THICKNESS, 0.002, &holes);
        b.part(&counter, "top", grained(top.moved(Vec3::new(0.0, 0.0, WORKTOP)), rng), style.worktop);
        // The covering ends just below the wall units, where its upper edge is not seen.
        let cover = b.object("splashback", Class::OtherStructure, pose);
        for (i, ([x0, x1], top)) in self.covered([x0, x1]).into_iter().enumerate() {
            let mesh = board([x0 + 0.001, 0.0008, WORKTOP + CONTACT], [x1 - 0.001, 0.0085, top], 0.0008);
            b.part(&cover, &format!("panel_{}", i + 1), mesh, style.splashback);
        }
    }

    /// Depth of wall units with their fronts, metres.
    pub const WALL_DEPTH: f32 = WALL_DEPTH;
}
