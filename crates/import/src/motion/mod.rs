//! Motion of nodes over time: what the animations of all formats share.
//!
//! A format says where a node is at any moment, and at which moments straight pieces end. [`states`] makes states of a body from poses,
//! [`Changing`] a body from any placements. Between states, bodies move as scenes do: translations linearly, rotations the shortest way.

mod changing;
mod rigid;
mod shapes;

pub(crate) use changing::{Changing, Moved};
pub(crate) use rigid::between_placements;
pub(crate) use shapes::{Shapes, place, shapes};

use crate::assembly::TimedPoses;
use enfilade_math::DAffine3;
use enfilade_scene::RigidPose;

/// Greatest distance by which straight pieces depart from the file's motion, metres.
const LENGTH_M: f64 = 1e-4;
/// States a second of what does not move evenly.
pub(crate) const RATE_HZ: f64 = 60.0;
/// Length of the pieces that curves are cut into, seconds.
const PIECE_S: f64 = 1.0 / RATE_HZ;
/// Most states of one node.
pub(crate) const MOST_STATES: usize = 200_000;

/// From which side a moment is approached: at a step, values differ.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Side {
    Before,
    After,
}

/// The moments within a curve from one moment to another at which its pieces end.
pub(crate) fn pieces(from_s: f64, to_s: f64) -> impl Iterator<Item = f64> {
    cuts(from_s, to_s, (to_s - from_s) / PIECE_S, MOST_STATES as f64)
}

/// The moments, in any unit, that cut the time from one moment to another into `pieces` of equal length, rounded up, and at most `most`.
pub(crate) fn cuts(from: f64, to: f64, pieces: f64, most: f64) -> impl Iterator<Item = f64> {
    let pieces = pieces.ceil().clamp(1.0, most) as usize;
    (1..pieces).map(move |piece| from + (to - from) * piece as f64 / pieces as f64)
}

/// Greatest distance by which straight pieces depart from the file's motion, in the units of a space that this map places in the file.
pub(crate) fn length_in(file_from_space: &DAffine3, meters_per_unit: f64) -> f64 {
    LENGTH_M / (meters_per_unit * file_from_space.matrix3.determinant().abs().cbrt())
}

/// Greatest turn between two moments of which the shortest way is taken, degrees.
const TURN_DEG: f64 = 60.0;
/// Most moments that a turn is cut into.
const MOST_TURNS: f64 = 10_000.0;

/// The moments, in any unit, within an even turn by an angle, degrees, that cut it into pieces whose shortest way is theirs.
pub(crate) fn turns(from: f64, to: f64, angle_deg: f64) -> impl Iterator<Item = f64> {
    cuts(from, to, angle_deg / TURN_DEG, MOST_TURNS)
}

/// The states of a node whose pose is known at all times, at moments in any order. `None` without any moment.
///
/// # Errors
/// When there are more states than a scene may have, or one is not finite; a clause that begins with "it".
pub(crate) fn states(mut moments: Vec<f64>, pose: impl Fn(f64, Side) -> RigidPose) -> Result<Option<TimedPoses>, String> {
    moments.sort_by(f64::total_cmp);
    moments.dedup();
    if moments.len() > MOST_STATES {
        return Err(format!("it has {} states, more than {MOST_STATES}", moments.len()));
    }
    let (mut times_s, mut poses) = (Vec::new(), Vec::new());
    for time_s in moments {
        let [before, after] = [pose(time_s, Side::Before), pose(time_s, Side::After)];
        let here = if before == after { &[before][..] } else { &[before, after] };
        if !here.iter().all(|pose| pose.rotation.is_finite() && pose.translation.is_finite()) {
            return Err(format!("its state at {time_s} s is not finite"));
        }
        times_s.extend(here.iter().map(|_| time_s));
        poses.extend(here);
    }
    Ok((!times_s.is_empty()).then_some((times_s, poses)))
}
