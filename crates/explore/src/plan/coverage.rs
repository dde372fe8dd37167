//! Coverage: every surface seen a number of times from different angles, with as few pictures as a greedy choice needs.
//!
//! Surfaces are patches of even area. A view adds to a patch that it sees near enough, not too grazingly, and from a direction that
//! differs from those of the views chosen before. The next view is always the one that adds most area. What a view adds only ever
//! shrinks as others are chosen, so gains are computed again only for the view on top of the queue (lazy greedy: Minoux 1978).

use super::CoverageConfig;
use super::patches::{Patch, patches};
use super::places::Places;
use super::planner::{Draft, Planner};
use super::report::{CoverageReport, Fault, PartCoverage};
use super::stills::{candidates, reachable};
use crate::{ExploreError, ViewStats};
use enfilade_math::{DVec3, Rng};
use enfilade_parallel::{flat_map, flat_map_up_to, map};
use enfilade_scene::Pose;
use std::collections::BinaryHeap;

/// Places tried for a view of a patch that no pose drawn at random sees often enough.
const TRIES: usize = 64;

/// Views that see as much as can be seen as often as asked for. The first one is the start camera's.
///
/// It ends when no pose considered adds anything, or with `frames` poses.
pub(super) fn cover(planner: &Planner, first: Pose, config: &CoverageConfig, rng: &Rng) -> Result<Draft, ExploreError> {
    // Poses to choose from: the start camera's, random ones, and some aimed at patches that the random ones see too rarely.
    let frames = planner.config.frames as usize;
    let mut draft = Draft::default();
    let patches = patches(planner.world, config.samples as usize);
    let places = reachable(planner, first.position, |_, _| true)?;
    let mut poses = vec![first];
    poses.extend(drawn(planner, &places, config.poses as usize, &mut draft, rng));
    let mut seen: Vec<Vec<u32>> = seen_by_each(planner, &patches, &poses, config);
    let aimed = aimed(planner, &places, &patches, &seen, config, &mut draft, rng);
    seen.extend(seen_by_each(planner, &patches, &aimed, config));
    poses.extend(aimed);

    // The start camera's view comes first.
    let mut tally = Tally::new(&patches, config);
    let take = |i: usize, view: ViewStats, tally: &mut Tally, draft: &mut Draft| {
        tally.add(&poses[i], &seen[i]);
        draft.poses.push(Pose { frame: draft.poses.len() as u32, ..poses[i] });
        draft.views.push(view);
        planner.progress(draft.poses.len(), frames);
    };
    let look = |i: usize| planner.views(&poses[i..=i])[0];
    take(0, look(0), &mut tally, &mut draft);

    // Then always the view that adds most area, until none adds any or there are enough.
    let mut queue: BinaryHeap<Gain> = (1..poses.len()).map(|i| Gain { area_m2: tally.gain(&poses[i], &seen[i]), pose: i }).collect();
    while let Some(top) = queue.pop().filter(|top| draft.poses.len() < frames && top.area_m2 > 0.0) {
        let gain = Gain { area_m2: tally.gain(&poses[top.pose], &seen[top.pose]), pose: top.pose };
        if queue.peek().is_some_and(|next| gain < *next) {
            queue.push(gain);
            continue;
        }

        // Its gain is up to date and still the largest. A closer look may yet find a fault.
        let view = look(top.pose);
        let fault = match planner.gates.is_void(&view) {
            true => Some(Fault::Void),
            false => (!(planner.accepts)(&poses[top.pose])).then_some(Fault::Refused),
        };
        match fault {
            Some(fault) => draft.rejected.add(fault),
            None if gain.area_m2 > 0.0 => take(top.pose, view, &mut tally, &mut draft),
            None => break,
        }
    }
    planner.progress(frames, frames);

    // The report: surfaces by number of views, and those that no pose could have seen.
    let mut reachable = vec![false; patches.len()];
    seen.iter().flatten().for_each(|patch| reachable[*patch as usize] = true);
    draft.coverage = Some(tally.report(&reachable));
    Ok(draft)
}

/// The gain of a pose. Of equal gains the pose with the lower index is greater.
#[derive(PartialEq)]
struct Gain {
    area_m2: f64,
    pose: usize,
}

impl Eq for Gain {}

impl Ord for Gain {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.area_m2.total_cmp(&other.area_m2).then(other.pose.cmp(&self.pose))
    }
}

impl PartialOrd for Gain {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// Poses without a fault at random places within reach.
fn drawn(planner: &Planner, places: &Places, n: usize, draft: &mut Draft, rng: &Rng) -> Vec<Pose> {
    let one = |i: usize| {
        let mut rng = rng.fork(i as u64 + 1);
        let place = places.points[rng.below(places.points.len())];
        candidates(planner, 0, place, &mut rng).into_iter().next()
    };
    let poses: Vec<Pose> = flat_map_up_to(n, one);
    without_faults(planner, poses, draft)
}

/// The poses that have no fault by a coarse look.
fn without_faults(planner: &Planner, poses: Vec<Pose>, draft: &mut Draft) -> Vec<Pose> {
    let faults = map(&poses, |pose| planner.gates.coarse_fault(pose));
    faults.iter().flatten().for_each(|fault| draft.rejected.add(*fault));
    poses.into_iter().zip(faults).filter(|(_, fault)| fault.is_none()).map(|(pose, _)| pose).collect()
}

/// Poses aimed at patches that fewer poses see than asked for.
fn aimed(
    planner: &Planner,
    places: &Places,
    patches: &[Patch],
    seen: &[Vec<u32>],
    config: &CoverageConfig,
    draft: &mut Draft,
    rng: &Rng,
) -> Vec<Pose> {
    let mut times = vec![0u32; patches.len()];
    seen.iter().flatten().for_each(|patch| times[*patch as usize] += 1);
    let wanting: Vec<usize> = (0..patches.len()).filter(|i| times[*i] < config.views).collect();
    // Evenly over the patches that lack views, so that no part is forgotten.
    let n = (config.poses as usize / 2).max(1);
    let chosen: Vec<usize> = wanting.iter().step_by(wanting.len().div_ceil(n).max(1)).copied().collect();
    let one = |i: &usize| {
        let mut rng = rng.fork((1 << 32) + *i as u64);
        let near = (0..TRIES).map(|_| places.points[rng.below(places.points.len())]).collect::<Vec<DVec3>>();
        near.into_iter().find_map(|place| {
            let (patch, roll) = (&patches[*i], planner.rules.draw_roll_rad(&mut rng));
            let direction = planner.rules.tilted((patch.p_world - place).try_normalize()?);
            if !is_near(patch, place, config) || !planner.gates.glancer.reaches(place, patch.p_world) {
                return None;
            }
            planner.rules.toward(0, place, direction, roll)
        })
    };
    let poses: Vec<Pose> = flat_map(&chosen, one);
    without_faults(planner, poses, draft)
}

/// For each pose the patches that it sees, ascending.
pub(super) fn seen_by_each(planner: &Planner, patches: &[Patch], poses: &[Pose], config: &CoverageConfig) -> Vec<Vec<u32>> {
    let glancer = planner.gates.glancer;
    let sees = |pose: &Pose, patch: &Patch| {
        is_near(patch, pose.position, config) && glancer.frames(pose, patch.p_world) && glancer.reaches(pose.position, patch.p_world)
    };
    map(poses, |pose| (0..patches.len() as u32).filter(|i| sees(pose, &patches[*i as usize])).collect())
}

/// Whether a patch, if it is visible, counts as seen from a position: near enough, and not too grazingly. Both sides count.
fn is_near(patch: &Patch, position: DVec3, config: &CoverageConfig) -> bool {
    let way = position - patch.p_world;
    let distance = way.length();
    distance <= config.max_distance_m && way.dot(patch.normal).abs() >= distance * config.max_incidence_deg.to_radians().cos()
}

/// From which directions each patch was seen so far.
pub(super) struct Tally<'a> {
    patches: &'a [Patch],
    views: usize,
    /// Cosine of the minimum angle between two views that count.
    cos_apart: f64,
    directions: Vec<Vec<DVec3>>,
}

impl<'a> Tally<'a> {
    pub fn new(patches: &'a [Patch], config: &CoverageConfig) -> Self {
        let cos_apart = config.min_angle_deg.to_radians().cos();
        Self { patches, views: config.views as usize, cos_apart, directions: vec![Vec::new(); patches.len()] }
    }

    /// The direction from a patch to a pose, where a view from there counts.
    fn new_direction(&self, pose: &Pose, patch: u32) -> Option<DVec3> {
        let seen = &self.directions[patch as usize];
        let direction = (pose.position - self.patches[patch as usize].p_world).normalize_or_zero();
        // With an angle of 0 every view counts.
        let is_new = seen.len() < self.views && (self.cos_apart == 1.0 || seen.iter().all(|other| other.dot(direction) <= self.cos_apart));
        is_new.then_some(direction)
    }

    /// The area that a view would add, square metres, counted once for each time that it is wanted.
    pub fn gain(&self, pose: &Pose, seen: &[u32]) -> f64 {
        seen.iter().filter(|patch| self.new_direction(pose, **patch).is_some()).map(|patch| self.patches[*patch as usize].area_m2).sum()
    }

    pub fn add(&mut self, pose: &Pose, seen: &[u32]) {
        for patch in seen {
            let direction = self.new_direction(pose, *patch);
            self.directions[*patch as usize].extend(direction);
        }
    }

    /// Number of views of each patch, up to the number wanted.
    #[cfg(test)]
    pub fn times(&self) -> impl Iterator<Item = usize> {
        self.directions.iter().map(Vec::len)
    }

    fn report(&self, reachable: &[bool]) -> CoverageReport {
        let mut parts: Vec<PartCoverage> = Vec::new();
        for (patch, directions) in self.patches.iter().zip(&self.directions) {
            if parts.last().is_none_or(|last| last.part != patch.part) {
                parts.push(PartCoverage { part: patch.part, area_m2: 0.0, seen_share: vec![0.0; self.views + 1] });
            }
            if let Some(part) = parts.last_mut() {
                part.area_m2 += patch.area_m2;
                part.seen_share[directions.len()] += patch.area_m2;
            }
        }
        let area_m2: f64 = parts.iter().map(|part| part.area_m2).sum();
        let share = |area: f64| if area_m2 > 0.0 { area / area_m2 } else { 0.0 };
        let seen_share = (0..=self.views).map(|k| share(parts.iter().map(|part| part.seen_share[k]).sum())).collect();
        let reached = self.patches.iter().zip(reachable).filter(|(_, reachable)| **reachable).map(|(patch, _)| patch.area_m2).sum();
        for part in &mut parts {
            part.seen_share.iter_mut().for_each(|area| *area /= part.area_m2);
        }
        CoverageReport {
            views: self.views as u32,
            area_m2,
            seen_share,
            reachable_share: share(reached),
            never_seen: parts.iter().filter(|part| part.seen_share[0] == 1.0).map(|part| part.part).collect(),
            parts,
        }
    }
}
