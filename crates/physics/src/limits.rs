//! How far joints go: a scene's limits, or less where the pieces of a body would run into those of another.
//!
//! Surfaces of a scene may pass where convex pieces do not, as between the leaves of a plant, or go a little way into each other, as a
//! soft thing before a door does.

use crate::bodies::{Group, Hold};
use crate::model::Piece;
use crate::rest::{solids, told};
use enfilade_compose::{Passage, Solid};
use enfilade_math::{DAffine3, DVec3, free_way};
use enfilade_scene::BodyStates;
use std::collections::BTreeSet;

/// Way of the farthest corner from one state that is tried to the next, metres.
const STEP_M: f64 = 0.005;
/// Times that the last step before something is halved.
const HALVINGS: usize = 6;
/// A joint is fixed where its farthest corner could go no farther, metres.
const LEAST_M: f64 = 0.002;
/// Share of its range by which a joint may end earlier without a word.
const UNTOLD: f64 = 0.02;

/// How far a joint goes.
struct Range {
    limits: [f64; 2],
    /// Metres that the farthest corner goes per unit of the state.
    reach_m: f64,
    /// The group that ends the range.
    by: Option<usize>,
}

/// Ends the ranges of joints where something is in the way. What touches at rest does not count: it goes along or bears the joint.
pub(crate) fn shorten(groups: &mut [Group], parts: &[Vec<Piece>], touching: &[[usize; 2]], notes: &mut Vec<String>) {
    let all: Vec<Vec<Solid>> = groups.iter().map(|group| solids(group, parts)).collect();
    let touching: BTreeSet<[usize; 2]> = touching.iter().copied().collect();
    let ranges = enfilade_parallel::map_up_to(groups.len(), |number| range(groups, &all, &touching, number));
    let mut shorter = BTreeSet::new();
    for (number, range) in ranges.into_iter().enumerate() {
        let Some(Range { limits, reach_m, by }) = range else { continue };
        let Some(before) = groups[number].joint.limits() else { continue };
        let (had, has) = (before[1] - before[0], limits[1] - limits[0]);
        if let Some(other) = by.filter(|_| had - has > UNTOLD * had) {
            shorter.insert(format!("{} ({})", groups[number].name, groups[other].name));
        }
        groups[number].joint = if has * reach_m < LEAST_M { Hold::Fixed } else { groups[number].joint.within(limits) };
    }
    if !shorter.is_empty() {
        notes.push(format!("{} joints end earlier, before the pieces of what is in the way: {}", shorter.len(), told(&shorter)));
    }
}

/// The free range of a group's joint; `None` where it has no joint with limits.
fn range(groups: &[Group], all: &[Vec<Solid>], touching: &BTreeSet<[usize; 2]>, number: usize) -> Option<Range> {
    let joint = groups[number].joint;
    let limits = joint.limits()?;
    let tree: Vec<usize> = (0..groups.len()).filter(|&one| hangs_on(groups, one, number)).collect();
    let moving: Vec<Solid> = tree.iter().flat_map(|one| all[*one].iter().cloned()).collect();
    let touches = |other: usize| tree.iter().any(|&one| touching.contains(&[one.min(other), one.max(other)]));
    let bears = |other: usize| tree.iter().any(|&one| groups[one].parent == Some(other));
    let others = (0..groups.len()).filter(|&other| !tree.contains(&other) && !touches(other) && !bears(other));
    let passage = Passage::new(&moving, others.map(|other| (other, all[other].as_slice())));
    let reach_m = joint.reach_m(moving.iter().flat_map(|solid| &solid.corners));
    let end = |limit: f64| free_way(limit, STEP_M / reach_m.max(STEP_M), HALVINGS, |state| passage.hit(joint.way_to(state)));
    // Rest is where it is.
    let ends = limits.map(|limit| if limit == 0.0 { (limit, None) } else { end(limit) });
    Some(Range { limits: ends.map(|(state, _)| state), reach_m, by: ends[1].1.or(ends[0].1) })
}

/// Whether a group is another one or is joined to it, over however many.
fn hangs_on(groups: &[Group], mut one: usize, number: usize) -> bool {
    while one != number {
        let Some(parent) = groups[one].parent else { return false };
        one = parent;
    }
    true
}

impl Hold {
    /// The limits of a hinge or slide that has some.
    fn limits(self) -> Option<[f64; 2]> {
        match self {
            Self::Hinge { limits, .. } | Self::Slide { limits, .. } => limits,
            Self::Fixed | Self::Free => None,
        }
    }

    /// This joint with these limits.
    fn within(self, limits: [f64; 2]) -> Self {
        match self {
            Self::Hinge { point, axis, .. } => Self::Hinge { point, axis, limits: Some(limits) },
            Self::Slide { axis, .. } => Self::Slide { axis, limits: Some(limits) },
            Self::Fixed | Self::Free => self,
        }
    }

    /// What takes its body from rest to a state.
    fn way_to(self, state: f64) -> DAffine3 {
        match self {
            Self::Hinge { point, axis, .. } => BodyStates::Hinge { point, axis, angles_rad: Vec::new() }.map_to(state),
            Self::Slide { axis, .. } => BodyStates::Slide { axis, distances_m: Vec::new() }.map_to(state),
            Self::Fixed | Self::Free => DAffine3::IDENTITY,
        }
    }

    /// Metres that the farthest of some corners goes per unit of the state.
    fn reach_m<'c>(self, corners: impl Iterator<Item = &'c DVec3>) -> f64 {
        match self {
            Self::Hinge { point, axis, .. } => corners.map(|corner| axis.cross(*corner - point).length()).fold(0.0, f64::max),
            _ => 1.0,
        }
    }
}
