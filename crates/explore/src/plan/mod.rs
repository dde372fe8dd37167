//! Trajectories: random walks through the free space, drawn to what is worth seeing.

mod coverage;
mod first;
mod report;
mod rules;

use crate::error::require;
use crate::view::{SeenSet, TestImage, ViewStats};
use crate::{ExploreError, FreeSpace, Saliency};
use enfilade_geometry::Bvh;
use enfilade_math::{DVec3, Distribution1, Rng};
use enfilade_scene::{Cx, Intrinsics, Pose, StartCamera, Trajectory, Warning, WorldMesh};
use rayon::prelude::*;
use rules::{Rules, posed};
use serde::{Deserialize, Serialize};

pub use coverage::{CoverageReport, PartCoverage};
pub use report::{Fault, FrameValues, PlanReport, PlanStatistics, RejectedCounts, RelaxedFrame, Spread};

/// What one step tries, one after the other, until a pose is found: factor on the number of samples, factor on the step.
const ATTEMPTS: [(u32, f64); 5] = [(1, 1.0), (4, 1.0), (4, 0.5), (4, 0.25), (4, 0.1)];

/// Pairs drawn per candidate wanted, before an attempt makes do with fewer.
const DRAWS_PER_CANDIDATE: usize = 50;

/// How a trajectory is found. The defaults are Hypersim's, as its paper states them, with a clearance and limits added.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PlanConfig {
    /// Poses in the trajectory, the start camera's among them.
    pub frames: u32,
    /// Poses compared at each step.
    pub candidates: u32,
    /// Random points drawn at each step for the camera, and as many for its target, before the rules sort them out.
    pub queries: u32,
    /// How far the camera and its target may each move in one step along x, y and z, metres.
    pub step_m: [f64; 3],
    /// How far above or below those of frame 0 the camera and its target may each be, metres.
    pub height_range_m: f64,
    /// The camera keeps at least this far from every surface, metres. Measured by occupied voxels, so up to a voxel's diagonal more.
    pub clearance_m: f64,
    /// The target is at least this far from the camera, metres.
    pub min_look_distance_m: f64,
    /// Roll is uniform within plus and minus this, degrees (less than 90).
    pub roll_limit_deg: f64,
    /// Views that show no surface in more than this share of the pixels are taken only when nothing better is found.
    pub max_void_share: f64,
    /// Horizontal field of view of the test images, radians.
    pub fov_x_rad: f64,
    /// Width of the test images, pixels. Planning time is in proportion to width times height.
    pub test_width: u32,
    /// Height of the test images, pixels.
    pub test_height: u32,
    /// A second camera stands this far to the right of the first, metres, and keeps the same rules; 0 for none.
    #[serde(skip_serializing_if = "is_zero")]
    pub stereo_baseline_m: f64,
    /// What makes a view worth taking.
    pub saliency: Saliency,
    /// Seed; each trajectory has its own stream of random numbers.
    pub seed: u64,
}

fn is_zero(v: &f64) -> bool {
    *v == 0.0
}

impl Default for PlanConfig {
    fn default() -> Self {
        Self {
            frames: 100,
            candidates: 20,
            queries: 1000,
            step_m: [1.5, 1.5, 0.25],
            height_range_m: 0.25,
            clearance_m: 0.2,
            min_look_distance_m: 0.5,
            roll_limit_deg: 5.0,
            max_void_share: 0.2,
            fov_x_rad: std::f64::consts::FRAC_PI_3,
            test_width: 256,
            test_height: 192,
            stereo_baseline_m: 0.0,
            saliency: Saliency::default(),
            seed: 0,
        }
    }
}

impl PlanConfig {
    fn validate(&self) -> Result<(), ExploreError> {
        let length = |v: f64| v >= 0.0 && v.is_finite();
        let counts = [("frames", self.frames), ("candidates", self.candidates), ("queries", self.queries)];
        for (field, n) in counts.into_iter().chain([("test_width", self.test_width), ("test_height", self.test_height)]) {
            require(n >= 1, field, n, "1 or more")?;
        }
        let step_ok = self.step_m.iter().all(|s| length(*s)) && self.step_m[0] + self.step_m[1] > 0.0;
        require(step_ok, "step_m", format!("{:?}", self.step_m), "three lengths in metres, the first two not both 0")?;
        require(length(self.height_range_m), "height_range_m", self.height_range_m, "a length of 0 or more")?;
        require(length(self.clearance_m), "clearance_m", self.clearance_m, "a length of 0 or more")?;
        require(length(self.stereo_baseline_m), "stereo_baseline_m", self.stereo_baseline_m, "a length of 0 or more")?;
        let distance = self.min_look_distance_m;
        require(distance > 0.0 && length(distance), "min_look_distance_m", distance, "a length above 0")?;
        require((0.0..90.0).contains(&self.roll_limit_deg), "roll_limit_deg", self.roll_limit_deg, "0 up to but not 90 degrees")?;
        require((0.0..=1.0).contains(&self.max_void_share), "max_void_share", self.max_void_share, "a share from 0 to 1")?;
        let fov_ok = self.fov_x_rad > 0.0 && self.fov_x_rad < std::f64::consts::PI;
        require(fov_ok, "fov_x_rad", self.fov_x_rad, "an angle between 0 and pi")
    }
}

/// Finds trajectory `trajectory_index` (`cam_00`, `cam_01`, …), which begins at `start` and looks where it looks.
///
/// Every pose keeps these rules: the camera is in free space and `clearance_m` from every surface; its target is in free space; both
/// move at most `step_m` and stay within `height_range_m` of their height in frame 0; the last position sees the new one, the last
/// target the new one, and the camera its target; roll is within `roll_limit_deg`. Among the poses that do, one is chosen in
/// proportion to its [`Saliency`].
///
/// A start camera that breaks a rule is mended with a warning: moved to the nearest position that is clear, its roll brought within
/// the limit, its view turned when there is nothing before it.
///
/// # Errors
/// A configuration out of its domain, a start camera with no clear position near it or nothing to look at, or a walk that is stuck
/// even with more samples and smaller steps.
pub fn plan(
    world: &WorldMesh,
    bvh: &Bvh,
    space: &FreeSpace,
    start: &StartCamera,
    trajectory_index: u32,
    config: &PlanConfig,
    cx: &dyn Cx,
) -> Result<Trajectory, ExploreError> {
    config.validate()?;
    let name = format!("cam_{trajectory_index:02}");
    let image = TestImage::new(&Intrinsics::from_fov_x(config.test_width, config.test_height, config.fov_x_rad));
    let walk = Walk { rules: Rules::new(bvh, space, config), bvh, config, image, triangles: world.corners.len(), name: &name };
    let what = format!("plan {name}");
    let rng = Rng::new(config.seed).fork(u64::from(trajectory_index));

    let first = first::pose(&walk.rules, start, &walk.image, cx)?;
    let mut empty_frames = Vec::new();
    if walk.look(&first).void_share() > config.max_void_share {
        empty_frames.push(0);
    }
    let mut poses = vec![first];
    for frame in 1..config.frames {
        cx.progress(&what, u64::from(frame), u64::from(config.frames));
        let (pose, view) = walk.step(&first, &poses[poses.len() - 1], frame, rng.fork(u64::from(frame)))?;
        if view.void_share() > config.max_void_share {
            empty_frames.push(frame);
        }
        poses.push(pose);
    }
    cx.progress(&what, u64::from(config.frames), u64::from(config.frames));
    warn_of_void(&name, &empty_frames, config, cx);
    Ok(Trajectory { name, poses })
}

fn warn_of_void(name: &str, frames: &[u32], config: &PlanConfig, cx: &dyn Cx) {
    let Some(first) = frames.first() else { return };
    let (n, all, percent) = (frames.len(), config.frames, 100.0 * config.max_void_share);
    let message = format!(
        "{n} of {all} views (the first is frame {first}) show no surface in more than {percent:.0} % of their pixels, and no better view \
         was found: the scene is open or lacks walls there"
    );
    cx.warn(Warning { place: name.to_string(), message });
}

struct Walk<'a> {
    rules: Rules<'a>,
    bvh: &'a Bvh,
    config: &'a PlanConfig,
    image: TestImage,
    triangles: usize,
    name: &'a str,
}

impl Walk<'_> {
    fn look(&self, pose: &Pose) -> ViewStats {
        self.image.look(self.bvh, pose, &mut SeenSet::new(self.triangles))
    }

    /// The pose after `last`, and what it shows.
    fn step(&self, first: &Pose, last: &Pose, frame: u32, mut rng: Rng) -> Result<(Pose, ViewStats), ExploreError> {
        let mut fullest: Option<(Pose, ViewStats)> = None;
        let (mut look_from, mut look_at, mut queries) = (0, 0, 0);
        for (sampling, scale) in ATTEMPTS {
            // Where the camera and its target may go.
            queries = self.config.queries.saturating_mul(sampling);
            let positions = self.points(first.position, last.position, scale, queries, &mut rng);
            let positions = self.rules.positions_seen_from(last.position, positions);
            let targets = self.points(first.look_at, last.look_at, scale, queries, &mut rng);
            let targets = self.rules.targets_seen_from(last.look_at, targets);
            (look_from, look_at) = (positions.len(), targets.len());

            // Candidate poses, and what each is worth.
            let candidates = self.pair(&positions, &targets, frame, &mut rng);
            let views = self.views(&candidates);
            let score = |view: &ViewStats| {
                if view.void_share() > self.config.max_void_share { 0.0 } else { self.config.saliency.score(view) as f32 }
            };
            let weights: Vec<f32> = views.iter().map(score).collect();
            if let Some(distribution) = Distribution1::new(&weights) {
                let chosen = distribution.sample(rng.next_f32()).0;
                return Ok((candidates[chosen], views[chosen]));
            }
            for found in candidates.into_iter().zip(views) {
                if fullest.is_none_or(|best| found.1.hits > best.1.hits) {
                    fullest = Some(found);
                }
            }
        }
        fullest.ok_or_else(|| ExploreError::Stuck {
            trajectory: self.name.to_string(),
            frame,
            position: last.position,
            queries,
            look_from,
            look_at,
        })
    }

    /// Points uniform in the box around `last`, within the heights allowed around `first`.
    fn points(&self, first: DVec3, last: DVec3, scale: f64, n: u32, rng: &mut Rng) -> Vec<DVec3> {
        let half = scale * DVec3::from(self.config.step_m);
        let (mut low, mut high) = (last - half, last + half);
        low.z = low.z.max(first.z - self.config.height_range_m);
        high.z = high.z.min(first.z + self.config.height_range_m);
        (0..n).map(|_| low + (high - low) * DVec3::new(rng.next_f64(), rng.next_f64(), rng.next_f64())).collect()
    }

    /// Poses from random pairs of a position and a target that it sees. All of one step share one roll.
    fn pair(&self, positions: &[DVec3], targets: &[DVec3], frame: u32, rng: &mut Rng) -> Vec<Pose> {
        let limit = self.config.roll_limit_deg.to_radians();
        let roll_rad = limit * (2.0 * rng.next_f64() - 1.0);
        let wanted = self.config.candidates as usize;
        let mut poses = Vec::with_capacity(wanted);
        if positions.is_empty() || targets.is_empty() {
            return poses;
        }
        for _ in 0..wanted * DRAWS_PER_CANDIDATE {
            let (position, look_at) = (positions[rng.below(positions.len())], targets[rng.below(targets.len())]);
            if position.distance(look_at) < self.config.min_look_distance_m || !self.rules.sees(position, look_at) {
                continue;
            }
            poses.extend(posed(frame, position, look_at, roll_rad).filter(|pose| self.rules.has_room_beside(pose)));
            if poses.len() == wanted {
                break;
            }
        }
        poses
    }

    fn views(&self, poses: &[Pose]) -> Vec<ViewStats> {
        let seen = || SeenSet::new(self.triangles);
        poses.par_iter().map_init(seen, |seen, pose| self.image.look(self.bvh, pose, seen)).collect()
    }
}

#[cfg(test)]
mod tests;
