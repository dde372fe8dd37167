//! Stills: pictures that keep a distance from each other, over all the space within reach.

use super::StillsConfig;
use super::places::Places;
use super::planner::{Draft, Planner};
use super::report::Fault;
use super::rules::Rules;
use crate::ExploreError;
use enfilade_math::{DVec3, Rng};
use enfilade_scene::Pose;
use std::f64::consts::TAU;

/// Directions are drawn up to this far above and below the horizon, where the limits of pitch allow more.
const STEEPEST_DRAWN_DEG: f64 = 45.0;

/// Directions drawn per candidate wanted at a place.
const DRAWS_PER_CANDIDATE: usize = 3;

/// Stills at random places that are `min_distance_m` from each other (dart throwing, so they are spaced like blue noise). Each is chosen
/// among the candidates at its place in proportion to their scores. The first one is the start camera's.
///
/// There are fewer than `frames` when no more places are left, with a warning.
pub(super) fn stills(planner: &Planner, first: Pose, stills: &StillsConfig, rng: &Rng) -> Result<Draft, ExploreError> {
    let frames = planner.config.frames as usize;
    let places = reachable(planner, first.position, |_, _| true)?;
    let mut draft = Draft { poses: vec![first], views: planner.views(&[first]), ..Draft::default() };
    for place in places.shuffled(&mut rng.fork(0)) {
        if draft.poses.len() >= frames {
            break;
        }
        planner.progress(draft.poses.len(), frames);

        // A position in the voxel, far enough from the other stills or at least free to look elsewhere, and not in the open.
        let mut rng = rng.fork(place as u64 + 1);
        let position = jittered(planner.rules, places.points[place], &mut rng);
        let near: Vec<Pose> = draft.poses.iter().filter(|pose| pose.position.distance(position) < stills.min_distance_m).copied().collect();
        if !near.is_empty() && stills.min_angle_deg == 0.0 {
            continue;
        }
        if planner.gates.is_open(position) {
            draft.rejected.add(Fault::Open);
            continue;
        }

        // Random directions there, and a choice among them.
        let frame = draft.poses.len() as u32;
        let mut candidates = candidates(planner, frame, position, &mut rng);
        let apart = |a: &Pose, b: &Pose| {
            (a.world_from_camera.z_axis).angle_between(b.world_from_camera.z_axis) >= stills.min_angle_deg.to_radians()
        };
        candidates.retain(|pose| near.iter().all(|other| apart(pose, other)));
        let views = planner.views(&candidates);
        if let Some(chosen) = planner.choose(&candidates, &views, None, &mut draft.rejected, &mut rng) {
            draft.poses.push(candidates[chosen]);
            draft.views.push(views[chosen]);
        }
    }
    planner.progress(frames, frames);
    if draft.poses.len() < frames {
        let (found, distance) = (draft.poses.len(), stills.min_distance_m);
        planner
            .warn(format!("{found} of {frames} stills were found: no more places keep {distance} m from the others; lower min_distance_m"));
    }
    Ok(draft)
}

/// The places within reach of a position for which `allowed(first, place)`, where the first is the one nearest to it.
pub(super) fn reachable(planner: &Planner, position: DVec3, allowed: impl Fn(DVec3, DVec3) -> bool) -> Result<Places, ExploreError> {
    let places = Places::around(planner.rules, position, allowed);
    if places.points.is_empty() {
        return Err(ExploreError::NoPlaces { trajectory: planner.name.to_string(), position, clearance_m: planner.config.clearance_m });
    }
    if places.is_cut {
        let n = places.points.len();
        planner.warn(format!("only the {n} places nearest to the start are considered: the free space is very large, or leaks"));
    }
    Ok(places)
}

/// A random point in the voxel around a place, or the place itself where that point has no room.
fn jittered(rules: &Rules, place: DVec3, rng: &mut Rng) -> DVec3 {
    let shift = DVec3::from([0; 3].map(|_| rng.next_f64() - 0.5));
    let p = place + 0.98 * rules.space.tree.resolution_m() * shift;
    if rules.is_position(p) { p } else { place }
}

/// Up to `candidates` poses at a position that keep the rules, in random directions.
pub(super) fn candidates(planner: &Planner, frame: u32, position: DVec3, rng: &mut Rng) -> Vec<Pose> {
    let wanted = planner.config.candidates as usize;
    let draws = (0..wanted * DRAWS_PER_CANDIDATE).map(|_| (direction(planner.rules, rng), planner.rules.draw_roll_rad(rng)));
    let draws: Vec<(DVec3, f64)> = draws.collect();
    draws.into_iter().filter_map(|(direction, roll)| planner.rules.toward(frame, position, direction, roll)).take(wanted).collect()
}

/// A direction uniform over the part of the sphere that the limits of pitch leave.
fn direction(rules: &Rules, rng: &mut Rng) -> DVec3 {
    let steepest = STEEPEST_DRAWN_DEG.to_radians();
    let [low, high] = rules.pitch_limits_rad();
    let drawn = [low.max(-steepest), high.min(steepest)];
    let [low, high] = if drawn[0] <= drawn[1] { drawn } else { [low, high] };
    let z = low.sin() + (high.sin() - low.sin()) * rng.next_f64();
    let (sin, cos) = (TAU * rng.next_f64()).sin_cos();
    let r = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(r * cos, r * sin, z)
}
