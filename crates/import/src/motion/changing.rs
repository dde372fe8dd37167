//! Nodes whose placement in their parent changes with time.

use super::rigid::rigid;
use super::{Side, length_in};
use crate::assembly::{Assembly, STRETCHED};
use enfilade_math::DAffine3;
use enfilade_scene::BodyId;

/// A node whose placement changes.
pub(crate) struct Changing<'c> {
    /// Place of the node in messages.
    pub place: &'c str,
    /// The name of its body.
    pub name: &'c str,
    /// Placement in the node's parent at rest.
    pub rest: DAffine3,
    /// The moments between which it moves evenly, or smoothly: seconds.
    pub moments: Vec<f64>,
    /// Placement in the node's parent at a moment.
    pub local: &'c dyn Fn(f64, Side) -> DAffine3,
    /// A moment in messages.
    pub told: &'c dyn Fn(f64) -> String,
}

/// How a node moves.
pub(crate) struct Moved {
    /// The body that it is; `None` where it stays.
    pub body: Option<BodyId>,
    /// Why the body is not all of its motion, as what is said of the node.
    pub problem: Option<String>,
}

impl Changing<'_> {
    /// The body that the node is, and what is missing of its motion then.
    pub(crate) fn moved(self, (file_from_parent, bearer): (DAffine3, Option<BodyId>), a: &mut Assembly) -> Moved {
        let length = length_in(&file_from_parent, a.meters_per_unit());
        let motion = match rigid(self.rest, self.moments, length, self.local) {
            Ok(motion) => motion,
            Err(problem) => {
                a.warn(self.place, format!("it is animated, but {problem}; it stays"));
                return Moved { body: None, problem: None };
            }
        };
        let what = "it changes its scale or shear, which no rigid motion does, and keeps those of rest; for the first time at";
        let distorted = motion.distorted_at_s.map(|time_s| format!("{what} {}", (self.told)(time_s)));
        if motion.is_rest() {
            return Moved { body: None, problem: distorted };
        }
        let body = a.push_body(self.name, bearer, file_from_parent * motion.parent_from_frame, motion.states);
        Moved { body, problem: if body.is_none() { Some(STRETCHED.into()) } else { distorted } }
    }
}
