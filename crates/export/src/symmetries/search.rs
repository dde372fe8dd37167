//! The search for axes of symmetry.

use super::deviation::Shape;
use super::moments::{Likeness, Moments};
use enfilade_math::{DMat3, DVec3};
use enfilade_parallel::flat_map;
use std::f64::consts::{PI, TAU};

/// Most turns of an axis that are told from a continuous one.
const MOST_FOLDS: u32 = 36;

/// Turns about an axis that all have to be symmetries where it is continuous: no multiple of these is a small share of a full turn.
const CONTINUOUS_TURNS: [f64; 8] = [0.61, 1.17, 1.62, 2.07, 2.49, 2.83, 0.37, 0.89];

/// Directions are tried this far apart, radians, and those of one axis are within twice of that.
const SPACING: f64 = 0.04;

/// Directions nearer to a better one than this (cosine) are that one's.
const SAME_AXIS: f64 = 0.985;

/// Folds by which directions are first judged.
const FIRST_FOLDS: [u32; 3] = [2, 3, 5];

/// Steps of the refinement of a direction, radians: the first, and the last.
const STEPS: [f64; 2] = [0.02, 1e-6];

/// A direction within this of one of the model's own axes (cosine) is that axis, where it fits as well.
const ALONG_AXIS: f64 = 0.9998;

/// Deviation that rounding makes, over the diameter.
const ROUNDING: f64 = 1e-4;

/// The discrete rotations but the identity, and the continuous axes, of a surface.
pub(super) fn search(shape: &Shape, moments: &Moments, tolerance_m: f64) -> (Vec<DMat3>, Vec<DVec3>) {
    let search = Search { shape, tolerance_m };
    let directions = match moments.likeness(tolerance_m / shape.diameter_m) {
        Likeness::None => moments.axes.to_cols_array_2d().map(DVec3::from).to_vec(),
        Likeness::Two(axis) => std::iter::once(axis).chain(across(axis)).collect(),
        Likeness::All if search.is_ball() => return (Vec::new(), vec![DVec3::X, DVec3::Y, DVec3::Z]),
        Likeness::All => everywhere(),
    };
    // A continuous axis makes all others superfluous.
    let (round, others): (Vec<_>, Vec<_>) = search.likely(directions).into_iter().partition(|(axis, _)| search.may_be_continuous(*axis));
    let mut axes: Vec<(DVec3, Fold)> = Vec::new();
    for (axis, fold) in round {
        match search.judged(axis, fold) {
            Some((axis, Fold::Continuous)) => return (search.flip(axis).into_iter().collect(), vec![axis]),
            judged => axes.extend(judged),
        }
    }
    axes.extend(flat_map(&others, |(axis, fold)| search.judged(*axis, *fold)));
    // Directions that were apart may have been refined to the same axis.
    for i in (0..axes.len()).rev() {
        if axes[..i].iter().any(|(other, _)| other.dot(axes[i].0).abs() > SAME_AXIS) {
            axes.remove(i);
        }
    }
    match axes.iter().find(|(_, fold)| *fold == Fold::Continuous) {
        Some((axis, _)) => (search.flip(*axis).into_iter().collect(), vec![*axis]),
        None => (rotations(&axes), Vec::new()),
    }
}

/// The symmetry about an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fold {
    Continuous,
    /// Turns by this part of a full turn, and its multiples.
    Turns(u32),
}

struct Search<'a> {
    shape: &'a Shape,
    tolerance_m: f64,
}

impl Search<'_> {
    fn holds(&self, turn: DMat3) -> bool {
        self.shape.deviates_less(turn, self.tolerance_m)
    }

    fn is_ball(&self) -> bool {
        let axes = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-2.0, 1.0, 1.0), DVec3::new(1.0, -3.0, 2.0)].map(DVec3::normalize);
        axes.into_iter().all(|axis| CONTINUOUS_TURNS.into_iter().all(|angle| self.holds(DMat3::from_axis_angle(axis, angle))))
    }

    /// Tolerance for directions that are not yet refined: one that is off by the spacing turns points aside by up to twice as much.
    fn loose_m(&self) -> f64 {
        self.tolerance_m + SPACING * self.shape.diameter_m
    }

    fn may_be_continuous(&self, axis: DVec3) -> bool {
        let turns = CONTINUOUS_TURNS.into_iter().map(|angle| DMat3::from_axis_angle(axis, angle));
        turns.into_iter().all(|turn| self.shape.may_deviate_less(turn, self.loose_m()))
    }

    /// The directions about which a turn may be a symmetry, with the fold that fits best, and the best of those that are near each other.
    fn likely(&self, directions: Vec<DVec3>) -> Vec<(DVec3, u32)> {
        let tolerance_m = self.loose_m();
        let mut found: Vec<(f64, DVec3, u32)> = flat_map(&directions, |&axis| {
            let turn = |fold: u32| DMat3::from_axis_angle(axis, TAU / f64::from(fold));
            let good = FIRST_FOLDS.into_iter().filter(|fold| self.shape.may_deviate_less(turn(*fold), tolerance_m));
            good.map(|fold| (self.shape.mean_square(turn(fold)), axis, fold)).min_by(|a, b| a.0.total_cmp(&b.0))
        });
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut likely: Vec<(DVec3, u32)> = Vec::new();
        for (_, axis, fold) in found {
            if likely.iter().all(|(other, _)| other.dot(axis).abs() < SAME_AXIS) {
                likely.push((axis, fold));
            }
        }
        likely
    }

    /// A direction moved to where it fits best, and its symmetry; `None` where it has none.
    fn judged(&self, axis: DVec3, fold: u32) -> Option<(DVec3, Fold)> {
        let axis = self.refined(axis, fold);
        Some((axis, self.fold(axis)?))
    }

    /// The direction near `axis` about which one of `fold` turns fits best: a compass search, whose step is halved where no side is better.
    fn refined(&self, axis: DVec3, fold: u32) -> DVec3 {
        let square = |axis: DVec3| self.shape.mean_square(DMat3::from_axis_angle(axis, TAU / f64::from(fold)));
        let (mut best, mut least, mut step) = (axis, square(axis), STEPS[0]);
        while step > STEPS[1] {
            let (u, v) = best.any_orthonormal_pair();
            let sides = [u, -u, v, -v].map(|side| (best + step * side).normalize());
            let (found, side) =
                sides.into_iter().map(|side| (square(side), side)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((least, best));
            if found < least {
                (best, least) = (side, found);
            } else {
                step *= 0.5;
            }
        }
        let limit = least + (ROUNDING * self.shape.diameter_m).powi(2);
        let own = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().find(|own| own.dot(best).abs() > ALONG_AXIS && square(*own) <= limit);
        own.unwrap_or_else(|| if best[largest(best)] < 0.0 { -best } else { best })
    }

    /// The symmetry about exactly this axis.
    fn fold(&self, axis: DVec3) -> Option<Fold> {
        let turn = |angle: f64| DMat3::from_axis_angle(axis, angle);
        if CONTINUOUS_TURNS.into_iter().all(|angle| self.holds(turn(angle))) {
            return Some(Fold::Continuous);
        }
        // Small turns of anything nearly round fit, so all multiples have to; those of a divisor are known by then. The largest move most.
        let own_turns_hold = |n: u32| {
            let own = (1..=n / 2).rev().filter(|k| greatest_divisor(*k, n) == 1);
            own.map(|k| turn(TAU * f64::from(k) / f64::from(n))).all(|turn| self.holds(turn))
        };
        let mut holding: Vec<u32> = Vec::new();
        for n in 2..=MOST_FOLDS {
            if (2..n).filter(|divisor| n % divisor == 0).all(|divisor| holding.contains(&divisor)) && own_turns_hold(n) {
                holding.push(n);
            }
        }
        holding.pop().map(Fold::Turns)
    }

    /// The half turn that exchanges the ends of a continuous axis, if it is a symmetry.
    fn flip(&self, axis: DVec3) -> Option<DMat3> {
        let across = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().find(|own| own.dot(axis).abs() < 1e-9);
        let half = DMat3::from_axis_angle(across.unwrap_or_else(|| axis.any_orthonormal_vector()), PI);
        self.holds(half).then_some(half)
    }
}

fn greatest_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_divisor(b, a % b) }
}

fn largest(v: DVec3) -> usize {
    (0..3).max_by(|a, b| v[*a].abs().total_cmp(&v[*b].abs()).then(b.cmp(a))).unwrap_or(0)
}

/// Directions across an axis, each for both of its ends.
fn across(axis: DVec3) -> Vec<DVec3> {
    let (u, v) = axis.any_orthonormal_pair();
    let n = (PI / SPACING).ceil() as u32;
    (0..n).map(|k| PI * f64::from(k) / f64::from(n)).map(|angle| u * angle.cos() + v * angle.sin()).collect()
}

/// Directions over half a sphere, on a spiral of even spacing (Saff and Kuijlaars 1997).
fn everywhere() -> Vec<DVec3> {
    let n = (TAU / (SPACING * SPACING)).ceil();
    let golden = PI * (3.0 - 5f64.sqrt());
    let direction = |k: u32| {
        let z = (f64::from(k) + 0.5) / n;
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * cos, r * sin, z)
    };
    (0..n as u32).map(direction).collect()
}

/// The turns about all axes but none twice, by axis and angle.
fn rotations(axes: &[(DVec3, Fold)]) -> Vec<DMat3> {
    let mut turns: Vec<DMat3> = Vec::new();
    for (axis, fold) in axes {
        let Fold::Turns(n) = *fold else { continue };
        for turn in (1..n).map(|k| DMat3::from_axis_angle(*axis, TAU * f64::from(k) / f64::from(n))) {
            let apart = |other: &DMat3| (*other - turn).to_cols_array().iter().any(|v| v.abs() > 0.05);
            if turns.iter().all(apart) {
                turns.push(turn);
            }
        }
    }
    turns
}
