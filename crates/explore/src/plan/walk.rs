//! Hypersim's random walk: every step draws poses near the last one and chooses among them in proportion to what they show.

use super::PlanConfig;
use super::planner::{Draft, Planner};
use super::report::{Fault, RejectedCounts};
use super::rules::posed;
use crate::{ExploreError, ViewStats};
use enfilade_math::{DVec3, Rng};
use enfilade_scene::Pose;
use std::cmp::Reverse;

/// Attempts of one step, until a pose is found: a factor on the number of random points, and one on how far they may be.
const ATTEMPTS: [(u32, f64); 5] = [(1, 1.0), (4, 1.0), (4, 0.5), (4, 0.25), (4, 0.1)];

/// Pairs drawn per candidate wanted, before an attempt makes do with fewer.
const DRAWS_PER_CANDIDATE: usize = 50;

/// A walk from `first`: positions and targets move at most `step_m` a step and stay within `height_range_m` of their height in frame
/// 0; the last position sees the new one, and the last target the new one. Where a height above the floor is asked for, positions have
/// that instead, and targets go up and down with them. Among the poses that keep the rules, one is chosen in proportion to its score.
pub(super) fn walk(planner: &Planner, first: Pose, rng: &Rng) -> Result<Draft, ExploreError> {
    let mut rejected = RejectedCounts::default();
    let draft = steps(planner, first, |last, frame| {
        Step { planner, first: &first, last: *last }.take(frame, &mut rejected, rng.fork(u64::from(frame)))
    })?;
    Ok(Draft { rejected, ..draft })
}

/// All poses of a walk from `first`, each by `next` from the last one and its frame number, and what they show.
pub(super) fn steps(
    planner: &Planner,
    first: Pose,
    mut next: impl FnMut(&Pose, u32) -> Result<(Pose, ViewStats), ExploreError>,
) -> Result<Draft, ExploreError> {
    let frames = planner.config.frames as usize;
    let mut draft = Draft { poses: vec![first], views: planner.views(&[first]), ..Draft::default() };
    for frame in 1..frames {
        planner.progress(frame, frames);
        let (pose, view) = next(&draft.poses[frame - 1], frame as u32)?;
        draft.poses.push(pose);
        draft.views.push(view);
    }
    planner.progress(frames, frames);
    Ok(draft)
}

struct Step<'a> {
    planner: &'a Planner<'a>,
    first: &'a Pose,
    last: Pose,
}

impl Step<'_> {
    /// The next pose, and what it shows.
    fn take(&self, frame: u32, rejected: &mut RejectedCounts, mut rng: Rng) -> Result<(Pose, ViewStats), ExploreError> {
        let (planner, rules, first, last) = (self.planner, self.planner.rules, self.first, self.last);
        let (mut look_from, mut look_at, mut queries) = (0, 0, 0);
        let mut spare = Vec::new();
        for (sampling, scale) in ATTEMPTS {
            // Random points around the last pose where the camera may be, and where its target may be.
            queries = planner.config.queries.saturating_mul(sampling);
            let mut positions = points(planner.config, first.position, last.position, scale, queries, &mut rng);
            if planner.config.camera_height_m.is_some() {
                positions = positions.into_iter().filter_map(|p| self.at_height(p, scale, &mut rng)).collect();
            }
            let positions = rules.positions_seen_from(last.position, positions);
            let targets = points(planner.config, self.first_target(), last.look_at, scale, queries, &mut rng);
            let targets = rules.targets_seen_from(last.look_at, targets);
            (look_from, look_at) = (positions.len(), targets.len());

            // Pairs of them that see each other are candidate poses; one is chosen in proportion to its score.
            let candidates = self.pair(&positions, &targets, frame, &mut rng);
            let views = planner.views(&candidates);
            if let Some(chosen) = planner.choose(&candidates, &views, Some(&last), rejected, &mut rng) {
                return Ok((candidates[chosen], views[chosen]));
            }
            spare.extend(candidates.into_iter().zip(views));
        }

        // No attempt found a view without a fault.
        let worst = |(pose, view): &(Pose, ViewStats)| worst_fault(planner, pose, view, &last);
        // Of the candidates with a fault, the first among those whose fault is least bad and that show most surface.
        let best = spare.into_iter().min_by_key(|found| (worst(found), Reverse(found.1.hits)));
        best.ok_or_else(|| ExploreError::Stuck {
            trajectory: planner.name.to_string(),
            frame,
            position: last.position,
            queries,
            look_from,
            look_at,
        })
    }

    /// The target of frame 0; where the camera goes up and down with the floor, it goes with it.
    fn first_target(&self) -> DVec3 {
        let risen_m = self.planner.config.camera_height_m.map_or(0.0, |_| self.last.position.z - self.first.position.z);
        self.first.look_at + risen_m * DVec3::Z
    }

    /// The point above or below `p` at a height uniform in the range asked for, no further up or down than a step.
    fn at_height(&self, p: DVec3, scale: f64, rng: &mut Rng) -> Option<DVec3> {
        let config = self.planner.config;
        let [min, max] = config.camera_height_m?;
        let wanted = min + (max - min) * rng.next_f64();
        let from = DVec3::new(p.x, p.y, self.last.position.z);
        let moved = wanted - self.planner.rules.height_m(from)?;
        // No further up or down than the walk's step, or than the range asked for where that is larger: a step of a stair.
        let limit = (scale * config.step_m[2]).max(max - min);
        (moved.abs() <= limit).then(|| from + moved * DVec3::Z)
    }

    /// Poses from random pairs of a position and a target that it sees, each with a roll of its own.
    fn pair(&self, positions: &[DVec3], targets: &[DVec3], frame: u32, rng: &mut Rng) -> Vec<Pose> {
        let rules = self.planner.rules;
        let wanted = self.planner.config.candidates as usize;
        let mut poses = Vec::with_capacity(wanted);
        if positions.is_empty() || targets.is_empty() {
            return poses;
        }
        for _ in 0..wanted * DRAWS_PER_CANDIDATE {
            let (position, look_at) = (positions[rng.below(positions.len())], targets[rng.below(targets.len())]);
            let Some(target) = rules.sight(position, look_at) else { continue };
            if target != look_at && !rules.sees(self.last.look_at, target) {
                continue; // brought level with the camera, it is hidden from the last one
            }
            poses.extend(posed(frame, position, target, rules.draw_roll_rad(rng)).filter(|pose| rules.has_room_beside(pose)));
            if poses.len() == wanted {
                break;
            }
        }
        poses
    }
}

/// Points uniform in the box around `last`, within the heights allowed around `first`, or as near to them as the box is.
pub(super) fn points(config: &PlanConfig, first: DVec3, last: DVec3, scale: f64, n: u32, rng: &mut Rng) -> Vec<DVec3> {
    let half = scale * DVec3::from(config.step_m);
    let (mut low, mut high) = (last - half, last + half);
    [low.z, high.z] = [first.z - config.height_range_m, first.z + config.height_range_m].map(|z| z.clamp(low.z, high.z));
    (0..n).map(|_| low + (high - low) * DVec3::new(rng.next_f64(), rng.next_f64(), rng.next_f64())).collect()
}

fn worst_fault(planner: &Planner, pose: &Pose, view: &ViewStats, before: &Pose) -> Option<Fault> {
    let gates = planner.gates;
    let fault = gates.fault(pose, Some(before)).max(gates.is_void(view).then_some(Fault::Void));
    let refused = || fault < Some(Fault::Refused) && !(planner.accepts)(pose);
    if refused() { Some(Fault::Refused) } else { fault }
}
