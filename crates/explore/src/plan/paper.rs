//! Hypersim's random walk as the supplement of its paper states it, and nothing else.
//!
//! A pose is a position p and a target t. The next one is drawn from the set of those whose p is in the box around the last p and in the
//! box around the first (equation 2), whose t is in the boxes around the last and the first t (equation 3), with p and t in free space, p
//! seen from the last p, t from the last t, and a roll of at most 5 degrees; in proportion to how salient the view is (equation 1 of the
//! paper).

use super::planner::{Draft, Planner, by_score};
use super::rules::rolled;
use super::walk::{points, steps};
use crate::{ExploreError, ViewStats};
use enfilade_math::{DVec3, Rng};
use enfilade_scene::Pose;

/// Rounds of drawing points for one step before the set counts as empty: it is sampled by rejection, and may be small.
const ROUNDS: u32 = 32;

/// A walk from `first`.
pub(super) fn walk(planner: &Planner, first: Pose, rng: &Rng) -> Result<Draft, ExploreError> {
    steps(planner, first, |last, frame| step(planner, &first, last, frame, rng.fork(u64::from(frame))))
}

/// The pose after `last`, and what it shows.
fn step(planner: &Planner, first: &Pose, last: &Pose, frame: u32, mut rng: Rng) -> Result<(Pose, ViewStats), ExploreError> {
    let (rules, config) = (planner.rules, planner.config);
    let (mut positions, mut targets): (Vec<DVec3>, Vec<DVec3>) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        // Points of both boxes that are free and seen from the last ones.
        let near = |first, last, rng: &mut Rng| rules.targets_seen_from(last, points(config, first, last, 1.0, config.queries, rng));
        positions.extend(near(first.position, last.position, &mut rng));
        targets.extend(near(first.look_at, last.look_at, &mut rng));
        if positions.is_empty() || targets.is_empty() {
            continue;
        }

        // Candidates uniform in the set, and a choice in proportion to their saliency.
        let candidates = candidates(planner, &positions, &targets, frame, &mut rng);
        if let Some(chosen) = choose(planner, &candidates, &mut rng) {
            return Ok(chosen);
        }
    }
    Err(ExploreError::Stuck {
        trajectory: planner.name.to_string(),
        frame,
        position: last.position,
        queries: config.queries.saturating_mul(ROUNDS),
        look_from: positions.len(),
        look_at: targets.len(),
    })
}

/// Random pairs of a position and a target, each with a roll of its own.
pub(super) fn candidates(planner: &Planner, positions: &[DVec3], targets: &[DVec3], frame: u32, rng: &mut Rng) -> Vec<Pose> {
    let rules = planner.rules;
    let pair = |_| {
        let (position, look_at) = (positions[rng.below(positions.len())], targets[rng.below(targets.len())]);
        rolled(frame, position, look_at, rules.draw_roll_rad(rng)).filter(|pose| rules.has_room_beside(pose))
    };
    (0..planner.config.candidates).filter_map(pair).collect()
}

/// One of the candidates, drawn in proportion to its saliency, and what it shows; `None` when none shows anything.
pub(super) fn choose(planner: &Planner, candidates: &[Pose], rng: &mut Rng) -> Option<(Pose, ViewStats)> {
    let views = planner.views(candidates);
    let scores: Vec<f64> = views.iter().map(|view| planner.score(view)).collect();
    let chosen = by_score(&scores)?.sample(rng.next_f32()).0;
    Some((candidates[chosen], views[chosen]))
}
