//! Objects: cameras above and around groups of objects, as the training images of BOP have them (Hodaň et al. 2020, section 3.2).
//!
//! Every frame has a number of candidates. Each looks at a point near the middle of a group of neighbouring objects, from a random direction
//! of the upper hemisphere and a random distance. The one taken is the best by the objects that it shows, of which those count most that have
//! so far been visible in less than their share of the frames.

use super::ObjectsConfig;
use super::planner::{Draft, Planner};
use super::report::{Fault, ObjectVisibility};
use super::targets::Targets;
use crate::{ExploreError, ViewStats};
use enfilade_geometry::VisibilityBuffer;
use enfilade_math::{DVec3, Rng};
use enfilade_scene::Pose;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Placements drawn per candidate wanted, before the rules of a pose sort them out.
const DRAWS_PER_CANDIDATE: usize = 30;

/// Weight of an object that has its share already, in frames that it lags behind.
const CONTENT: f64 = 0.05;

/// A camera looks at a point within this many radii of an object from the middle of its group.
const ASIDE_RADII: f64 = 0.5;

/// Most objects that a warning names.
const NAMED: usize = 12;

/// What a candidate shows.
struct Look {
    view: ViewStats,
    /// For each target, whether enough of it is visible.
    shows: Vec<bool>,
}

/// Views of the targets. None of them is the start camera's.
pub(super) fn objects(planner: &Planner, config: &ObjectsConfig, targets: &Targets, rng: &Rng) -> Result<Draft, ExploreError> {
    let frames = planner.config.frames as usize;
    let mut draft = Draft::default();
    let mut seen = vec![0u32; targets.list.len()];
    for frame in 0..frames {
        planner.progress(frame, frames);
        let weights = weights(targets, &seen, draft.poses.len());
        let candidates = candidates(planner, config, targets, &weights, draft.poses.len() as u32, &mut rng.fork(frame as u64));
        let looks = looks(planner, targets, &candidates);
        if let Some(best) = best(planner, &candidates, &looks, &weights, &mut draft) {
            draft.poses.push(candidates[best]);
            draft.views.push(looks[best].view);
            seen.iter_mut().zip(&looks[best].shows).for_each(|(seen, shows)| *seen += u32::from(*shows));
        }
    }
    planner.progress(frames, frames);
    let found = draft.poses.len();
    if found == 0 {
        let [nearest_m, farthest_m] = config.radius_m;
        return Err(ExploreError::NoViewOfObjects { trajectory: planner.name.to_string(), nearest_m, farthest_m });
    }
    if found < frames {
        planner.warn(format!(
            "{found} of {frames} views of objects were found: for the others no drawn camera is in free space; widen radius_m or elevation_deg, \
             or lower clearance_m"
        ));
    }
    draft.objects = visibility(targets, &seen, found);
    warn_of_lagging(planner, &draft.objects);
    Ok(draft)
}

/// The weight of each target: the frames by which it would lag behind its share after the next one.
fn weights(targets: &Targets, seen: &[u32], frames: usize) -> Vec<f64> {
    let lag = |(target, seen): (&super::targets::Target, &u32)| target.visible_share * (frames as f64 + 1.0) - f64::from(*seen);
    targets.list.iter().zip(seen).map(lag).map(|lag| lag.max(0.0) + CONTENT).collect()
}

/// Up to `candidates` poses that keep the rules.
fn candidates(planner: &Planner, config: &ObjectsConfig, targets: &Targets, weights: &[f64], frame: u32, rng: &mut Rng) -> Vec<Pose> {
    let wanted = planner.config.candidates as usize;
    let draw = |_| {
        let look_at = middle(config, targets, weights, rng);
        let position = look_at + between(config.radius_m, rng.next_f64()) * direction(config.elevation_deg, rng);
        (position, look_at, planner.rules.draw_roll_rad(rng))
    };
    let draws: Vec<(DVec3, DVec3, f64)> = (0..wanted * DRAWS_PER_CANDIDATE).map(draw).collect();
    let pose = |(position, look_at, roll): (DVec3, DVec3, f64)| {
        let direction = planner.rules.tilted((look_at - position).try_normalize()?);
        planner.rules.is_position(position).then(|| planner.rules.toward(frame, position, direction, roll))?
    };
    draws.into_iter().filter_map(pose).take(wanted).collect()
}

/// A point near the middle of a group: an object drawn by the weights, and some of those that are near it.
fn middle(config: &ObjectsConfig, targets: &Targets, weights: &[f64], rng: &mut Rng) -> DVec3 {
    let mut place = rng.next_f64() * weights.iter().sum::<f64>();
    let first = weights.iter().position(|weight| {
        place -= weight;
        place < 0.0
    });
    let first = &targets.list[first.unwrap_or(weights.len() - 1)];
    let (mut sum, mut count) = (first.center, 1.0);
    for other in &targets.list {
        let is_near = other.name != first.name && other.center.distance(first.center) <= config.radius_m[0];
        // Drawn for all of them, so that a draw does not depend on what is near.
        if rng.next_f64() < 0.5 && is_near {
            (sum, count) = (sum + other.center, count + 1.0);
        }
    }
    let aside = DVec3::from([0; 3].map(|_| 2.0 * rng.next_f64() - 1.0));
    sum / count + ASIDE_RADII * first.radius_m * aside.clamp_length_max(1.0)
}

/// From a point to a camera, uniform over the part of the sphere between two elevations.
fn direction(elevation_deg: [f64; 2], rng: &mut Rng) -> DVec3 {
    let z = between(elevation_deg.map(|angle| angle.to_radians().sin()), rng.next_f64());
    let (sin, cos) = (TAU * rng.next_f64()).sin_cos();
    let r = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(r * cos, r * sin, z)
}

fn between([low, high]: [f64; 2], t: f64) -> f64 {
    low + (high - low) * t
}

fn looks(planner: &Planner, targets: &Targets, poses: &[Pose]) -> Vec<Look> {
    let (width, height) = (planner.config.test_width, planner.config.test_height);
    let room = || (planner.image.sight(planner.world), VisibilityBuffer::new(width, height));
    let look = |(sight, alone): &mut (crate::view::Sight, VisibilityBuffer), pose: &Pose| {
        sight.look(planner.rules.bvh, &planner.image, pose);
        let shows = targets.shown(planner, pose, &sight.buffer, alone);
        Look { view: sight.judge(planner.world, &planner.config.saliency), shows }
    };
    poses.par_iter().map_init(room, look).collect()
}

/// The best candidate without a fault; where all have one, the best of those with the least.
fn best(planner: &Planner, candidates: &[Pose], looks: &[Look], weights: &[f64], draft: &mut Draft) -> Option<usize> {
    let score = |look: &Look| look.shows.iter().zip(weights).filter(|(shows, _)| **shows).map(|(_, weight)| weight).sum::<f64>();
    let scores: Vec<f64> = looks.iter().map(score).collect();
    let mut order: Vec<usize> = (0..candidates.len()).collect();
    order.sort_by(|a, b| scores[*b].total_cmp(&scores[*a]));
    let mut least: Option<(Fault, usize)> = None;
    for index in order {
        let pose = &candidates[index];
        let void = planner.gates.is_void(&looks[index].view).then_some(Fault::Void);
        let fault = planner.gates.fault(pose, None).max(void).or_else(|| (!(planner.accepts)(pose)).then_some(Fault::Refused));
        let Some(fault) = fault else { return Some(index) };
        draft.rejected.add(fault);
        if least.is_none_or(|(known, _)| fault < known) {
            least = Some((fault, index));
        }
    }
    least.map(|(_, index)| index)
}

fn visibility(targets: &Targets, seen: &[u32], frames: usize) -> Vec<ObjectVisibility> {
    let one = |(target, seen): (&super::targets::Target, &u32)| ObjectVisibility {
        name: target.name.clone(),
        wanted_share: target.visible_share,
        visible_share: f64::from(*seen) / frames.max(1) as f64,
    };
    targets.list.iter().zip(seen).map(one).collect()
}

/// Warns of objects that are visible in less than their share, to within half a frame of rounding.
fn warn_of_lagging(planner: &Planner, objects: &[ObjectVisibility]) {
    let slack = 0.5 / f64::from(planner.config.frames);
    let percent = |share: f64| 100.0 * share;
    let lagging: Vec<&ObjectVisibility> = objects.iter().filter(|one| one.visible_share < one.wanted_share - slack).collect();
    if lagging.is_empty() {
        return;
    }
    let said = |one: &&ObjectVisibility| {
        format!("{:?} in {:.0} % instead of {:.0} %", one.name, percent(one.visible_share), percent(one.wanted_share))
    };
    let named: Vec<String> = lagging.iter().take(NAMED).map(said).collect();
    let more = if lagging.len() > NAMED { format!(" and {} more", lagging.len() - NAMED) } else { String::new() };
    planner.warn(format!(
        "{} of {} objects are visible in fewer frames than wanted: {}{more}; they are hidden, far apart or out of reach: widen radius_m, raise \
         candidates, or ask for less",
        lagging.len(),
        objects.len(),
        named.join(", ")
    ));
}
