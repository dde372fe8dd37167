//! Plans a fitted kitchen over the walls that it is given: the units along the main wall and along up to two wings, and the wall units
//! above them. The kitchen's space has its origin on the floor in the middle of its footprint, with the main run at the back. A random
//! kitchen is 2.7 to 4.2 m wide, and its wings reach 1.5 to 2.6 m from the back wall.

use super::front::KitchenStyle;
use super::run::{Above, Run, SILL_END};
use super::unit::Unit;
use super::{DEPTH, HANDLES, TALL};
use crate::builder::Builder;
use crate::pieces::{Furniture, Surface, on};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A fitted kitchen along one wall, around a corner, or on three sides.
#[derive(Clone, Debug)]
pub struct FittedKitchen {
    /// Along the back wall.
    pub main: Run,
    /// Along the walls at −x and +x. The units of the one at +x are listed from the corner to the front, those at −x from the front to the
    /// corner.
    pub wings: [Option<Run>; 2],
    /// Fronts, handles and finishes of all units.
    pub style: KitchenStyle,
}

/// The units that a run must contain; other units fill the rest.
#[derive(Clone, Copy)]
struct Needs {
    sink: bool,
    hob: bool,
    tall: usize,
    corners: [bool; 2],
}

/// Length of the blind corner at the end of the main run, where a wing meets it, metres.
const CORNER: f32 = DEPTH + 0.05;
/// Air between the main run and a wing, metres.
const JOINT: f32 = 0.001;

impl FittedKitchen {
    /// A kitchen over `width` of the back wall with wings that reach `wings` metres from the back wall on either side (0 for none);
    /// over `windows`, from and to along x, nothing hangs.
    pub fn fitted(width: f32, wings: [f32; 2], windows: &[[f32; 2]], rng: &mut Rng) -> Self {
        let corners = wings.map(|length| length >= DEPTH + 0.6);
        let room = width - CORNER * corners.iter().filter(|&&c| c).count() as f32;
        let elsewhere = corners[0] || corners[1];
        let hob_here = !elsewhere || room > 2.6;
        let needs =
            Needs { sink: true, hob: hob_here, tall: if elsewhere { 0 } else { ((room - 2.2) / 0.6).clamp(0.0, 2.0) as usize }, corners };
        let main = plan(width, needs, windows.iter().map(|w| w.map(|x| x + 0.5 * width)).collect(), rng);
        let mut hob_left = !hob_here;
        let wings = [0, 1].map(|k| {
            corners[k].then(|| {
                let length = wings[k] - DEPTH - JOINT;
                let tall = ((length - 0.9) / 0.6).clamp(0.0, 2.0) as usize;
                let needs = Needs { sink: false, hob: std::mem::take(&mut hob_left), tall, corners: [false; 2] };
                let mut run = plan(length, needs, Vec::new(), rng);
                // Tall units stand at the end away from the corner.
                let first_is_tall = run.units.first().is_some_and(|(unit, _)| unit.is_tall());
                if first_is_tall == (k == 1) {
                    run.units.reverse();
                }
                run
            })
        });
        Self { main, wings, style: KitchenStyle::random(rng) }
    }

    /// True when a refrigerator is built in.
    pub fn has_refrigerator(&self) -> bool {
        self.runs().iter().any(|(run, _, _)| run.units.iter().any(|(unit, _)| *unit == Unit::BuiltInRefrigerator))
    }

    /// The boxes, as [min, max] in the kitchen's space, of what rises above the worktop: tall units, wall units, and what covers the wall.
    pub fn uppers(&self) -> Vec<[Vec3; 2]> {
        let mut all = Vec::new();
        for (run, at, yaw) in self.runs() {
            let turn = |p: Vec3| Vec2::from_angle(yaw).rotate(p.truncate()).extend(p.z) + at;
            all.extend(run.uppers().into_iter().map(|[min, max]| [turn(min).min(turn(max)), turn(min).max(turn(max))]));
        }
        all
    }

    fn depth(&self) -> f32 {
        let reach = |run: &Option<Run>| run.as_ref().map_or(0.0, |run| run.length() + DEPTH + JOINT);
        reach(&self.wings[0]).max(reach(&self.wings[1])).max(DEPTH + HANDLES)
    }

    /// The runs, each with its place in the kitchen's space.
    fn runs(&self) -> Vec<(&Run, Vec3, f32)> {
        let (half, back) = (0.5 * self.main.length(), -0.5 * self.depth());
        let mut runs = vec![(&self.main, Vec3::new(-half, back, 0.0), 0.0)];
        if let Some(left) = &self.wings[0] {
            runs.push((left, Vec3::new(-half, back + DEPTH + JOINT + left.length(), 0.0), -FRAC_PI_2));
        }
        if let Some(right) = &self.wings[1] {
            runs.push((right, Vec3::new(half, back + DEPTH + JOINT, 0.0), FRAC_PI_2));
        }
        runs
    }
}

/// Fills `length` with units: tall ones first, then drawers, hob, drawers, sink, dishwasher.
fn plan(length: f32, needs: Needs, windows: Vec<[f32; 2]>, rng: &mut Rng) -> Run {
    let corner = CORNER * needs.corners.iter().filter(|&&c| c).count() as f32;
    let mut free = length - corner;
    let mut take = |w: f32| {
        let fits = free >= w - 1e-4;
        free -= if fits { w } else { 0.0 };
        fits
    };
    let wide_sink = length > 3.4 && rng.below(2) == 0;
    let sink = needs.sink.then_some(Unit::Sink(if wide_sink { 0.8 } else { 0.6 })).filter(|unit| take(unit.width()));
    let hob = needs.hob.then_some(Unit::Oven(if length > 3.6 && rng.below(3) == 0 { 0.9 } else { 0.6 })).filter(|unit| take(unit.width()));
    let dishwasher = (needs.sink).then_some(Unit::Dishwasher).filter(|unit| take(unit.width()));
    let tall: Vec<Unit> = [Unit::BuiltInRefrigerator, if rng.below(2) == 0 { Unit::Tower } else { Unit::Larder(0.6) }]
        .into_iter()
        .take(needs.tall)
        .filter(|unit| take(unit.width()))
        .collect();
    let mut fill: Vec<Unit> = Vec::new();
    for width in [0.8, 0.6, 0.6, 0.9, 0.6, 0.5, 0.45, 0.4, 0.3] {
        if take(width) {
            fill.push(if rng.below(2) == 0 && width > 0.35 { Unit::Drawers(width) } else { Unit::Doors(width) });
        }
    }
    let between = fill.len().div_ceil(2);
    let mut units: Vec<Unit> = tall;
    units.extend(fill.drain(..between.min(1)));
    units.extend(hob);
    let before_sink = between.saturating_sub(1).max(usize::from(!fill.is_empty()));
    units.extend(fill.drain(..before_sink.min(fill.len())));
    units.extend(sink);
    units.extend(dishwasher);
    units.extend(fill);
    if free > 0.004 {
        units.push(Unit::Filler(free));
    }
    // Either end will do: only the tall units have to be at one.
    if rng.below(2) == 0 {
        units.reverse();
    }
    if needs.corners[0] {
        units.insert(0, Unit::Corner(CORNER));
    }
    if needs.corners[1] {
        units.push(Unit::Corner(CORNER));
    }
    hang(units, windows, rng)
}

/// Decides what hangs above the units.
fn hang(units: Vec<Unit>, windows: Vec<[f32; 2]>, rng: &mut Rng) -> Run {
    let style = rng.below(5);
    let mut x = 0.0;
    let units = units.into_iter().map(|unit| {
        let span = [x, x + unit.width()];
        x = span[1];
        let open = windows.iter().any(|w| span[1] > w[0] - SILL_END && span[0] < w[1] + SILL_END);
        let above = match unit {
            _ if unit.is_tall() || open => Above::Nothing,
            Unit::Oven(_) => Above::Hood,
            Unit::Corner(_) | Unit::Filler(_) => Above::Nothing,
            Unit::Sink(_) if style == 1 => Above::Nothing,
            Unit::Drawers(_) if style == 2 => Above::Glazed,
            _ if style == 3 => Above::Boards,
            Unit::Doors(_) if style == 4 => Above::Boards,
            _ => Above::Doors,
        };
        (unit, above)
    });
    Run { units: units.collect(), windows }
}

impl Furniture for FittedKitchen {
    fn random(rng: &mut Rng) -> Self {
        let width = rng.range(2.7, 4.2);
        let wings = match rng.below(4) {
            0 => [rng.range(1.6, 2.6), 0.0],
            1 => [0.0, rng.range(1.6, 2.6)],
            2 if width > 2.9 => [rng.range(1.5, 2.2), rng.range(1.5, 2.2)],
            _ => [0.0; 2],
        };
        Self::fitted(width, wings, &[], rng)
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.main.length(), self.depth(), TALL)
    }

    /// A cook needs 1.1 m in front of the units (NKBA planning guideline 6: 1.07 m); between wings most of it is within the kitchen's
    /// depth.
    fn reach(&self) -> f32 {
        if self.wings.iter().all(Option::is_none) { 1.1 } else { 0.3 }
    }

    fn surfaces(&self) -> Vec<Surface> {
        let mut all = Vec::new();
        for (run, at, yaw) in self.runs() {
            let turn = Vec2::from_angle(yaw);
            all.extend(run.surfaces().into_iter().map(|s| {
                let [p, q] = [s.min, s.max].map(|p| turn.rotate(p) + at.truncate());
                Surface { min: p.min(q), max: p.max(q), ..s }
            }));
        }
        all
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        for (run, at, yaw) in self.runs() {
            run.build(b, on(pose, at, yaw), &self.style, rng);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fitted_kitchen_fills_its_walls_and_has_what_cooking_needs() {
        for seed in 0..200 {
            let mut rng = Rng::new(seed);
            let width = rng.range(2.4, 5.0);
            let wings = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.7], [2.2, 2.4]][seed as usize % 4];
            let kitchen = FittedKitchen::fitted(width, wings, &[], &mut rng);
            assert!((kitchen.main.length() - width).abs() < 0.005, "seed {seed}: {} of {width}", kitchen.main.length());
            let units: Vec<Unit> = kitchen.runs().iter().flat_map(|(run, ..)| run.units.iter().map(|u| u.0)).collect();
            assert!(units.iter().any(|u| matches!(u, Unit::Sink(_))), "seed {seed}: {units:?}");
            assert!(units.iter().any(|u| matches!(u, Unit::Oven(_))), "seed {seed}: {units:?}");
            let half = 0.5 * kitchen.size().truncate();
            for s in kitchen.surfaces() {
                assert!(s.min.cmpge(-half).all() && s.max.cmple(half).all() && s.min.cmplt(s.max).all(), "seed {seed}: {s:?} in {half}");
            }
        }
    }
}
