//! Trajectories: where the pictures of a scene are taken from. One file per mode, all of them under the same rules.

mod config;
mod coverage;
mod first;
mod gates;
mod glance;
mod headings;
mod hypersim;
mod keyframes;
mod measure;
mod patches;
mod places;
mod report;
mod rules;
mod spline;
mod stills;
mod timing;
mod tour;
mod video;
mod walk;

use crate::view::{Sight, TestImage, ViewStats};
use crate::{ExploreError, FreeSpace, Preset};
use enfilade_geometry::Bvh;
use enfilade_math::{Distribution1, Rng};
use enfilade_scene::{Cx, Intrinsics, Pose, StartCamera, Trajectory, WorldMesh};
use gates::Gates;
use glance::Glancer;
use rayon::prelude::*;
use rules::Rules;

pub use config::{CoverageConfig, KeyframesConfig, Mode, PlanConfig, StillsConfig, VideoConfig, WalkConfig};
pub use coverage::{CoverageReport, PartCoverage};
pub use keyframes::{Keyframe, parse_keyframes};
pub use report::{Fault, FrameValues, PlanReport, PlanStatistics, RejectedCounts, RelaxedFrame, Spread};

/// Scores above this are scaled down together.
const MOST_SCORE: f64 = 1e30;

/// A trajectory and how it came out.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// Poses numbered from 0 without a gap.
    pub trajectory: Trajectory,
    /// Its measurements.
    pub report: PlanReport,
}

/// Finds trajectory `trajectory_index` (`cam_00`, `cam_01`, …), which begins at `start`, by the configured [`Mode`].
///
/// Every pose keeps these rules, whatever the mode: the camera is in free space, `clearance_m` from every surface and at the height
/// above the floor that is asked for; its target is in free space, at least `min_look_distance_m` away, and seen; roll and pitch are
/// within their limits; a second camera of a stereo rig has room too. Views with a [`Fault`] are taken only when nothing better is
/// found, with a warning, and stand in the report.
///
/// A start camera that breaks a rule is mended with a warning: moved to the nearest position that is clear, its roll and pitch
/// brought within the limits, its view turned when there is nothing before it.
///
/// # Errors
/// A configuration out of its domain, a start camera with no clear position near it or nothing to look at, or a mode that finds no
/// way to go on. Poses made by hand are not planned: [`follow`] is for them.
pub fn plan(
    world: &WorldMesh,
    bvh: &Bvh,
    space: &FreeSpace,
    start: &StartCamera,
    trajectory_index: u32,
    config: &PlanConfig,
    cx: &dyn Cx,
) -> Result<Planned, ExploreError> {
    plan_accepted(world, bvh, space, start, &format!("cam_{trajectory_index:02}"), trajectory_index, config, &|_| true, cx)
}

/// As [`plan`], for a trajectory of any `name`, whose random numbers `trajectory_index` chooses, and with a last word by the caller: a
/// view for which `accepts` is false has [`Fault::Refused`]. It is asked about views that have no other fault, from any thread, and
/// never about the first pose; the preset of Hypersim does not ask.
///
/// # Errors
/// As [`plan`].
pub fn plan_accepted(
    world: &WorldMesh,
    bvh: &Bvh,
    space: &FreeSpace,
    start: &StartCamera,
    name: &str,
    trajectory_index: u32,
    config: &PlanConfig,
    accepts: &(dyn Fn(&Pose) -> bool + Sync),
    cx: &dyn Cx,
) -> Result<Planned, ExploreError> {
    config.validate()?;
    let rules = Rules::new(bvh, space, config);
    let glancer = Glancer::new(&rules, world);
    let gates = Gates::new(&glancer, config, world, start, cx);
    let planner = Planner { accepts, ..Planner::new(&rules, &gates, world, name, cx) };
    if config.preset == Preset::Hypersim {
        let (poses, views) =
            hypersim::walk(world, bvh, space, start, name, config, &|frame| planner.progress(frame as usize, config.frames as usize))?
                .into_iter()
                .unzip();
        return Ok(measure::finish(&planner, Draft { poses, views, ..Draft::default() }));
    }
    let rng = Rng::new(config.seed).fork(u64::from(trajectory_index));
    let first = first::pose(&rules, start, &planner.image, cx)?;
    let draft = match &config.mode {
        Mode::Walk(_) => walk::walk(&planner, first, &rng),
        Mode::Video(video) => video::video(&planner, first, video, &rng),
        Mode::Stills(stills) => stills::stills(&planner, first, stills, &rng),
        Mode::Coverage(coverage) => coverage::cover(&planner, first, coverage, &rng),
        Mode::Keyframes(_) => Err(ExploreError::Config {
            field: "mode",
            found: "keyframes".into(),
            expected: "a mode that finds poses; poses that are given go to `follow`",
        }),
    }?;
    Ok(measure::finish(&planner, draft))
}

/// The trajectory `name` through poses made by hand, with every frame between two of them interpolated: positions and targets on
/// splines of continuous curvature, roll evenly. Nothing is mended: frames that break a rule are named in a warning and in the report.
///
/// The first position is taken to be on the right side of things, as the start camera is in [`plan`].
///
/// # Errors
/// A configuration out of its domain, or a frame that has no view: looking straight up or down, or at its own position.
pub fn follow(
    world: &WorldMesh,
    bvh: &Bvh,
    space: &FreeSpace,
    keyframes: &[Keyframe],
    name: &str,
    config: &PlanConfig,
    cx: &dyn Cx,
) -> Result<Planned, ExploreError> {
    config.validate()?;
    let poses = keyframes::interpolate(keyframes, name)?;
    let first = &poses[0];
    let start = StartCamera {
        name: name.to_string(),
        position: first.position,
        world_from_camera: first.world_from_camera,
        fov_x_rad: config.fov_x_rad,
        aspect: f64::from(config.test_width) / f64::from(config.test_height),
    };
    let rules = Rules::new(bvh, space, config);
    let glancer = Glancer::new(&rules, world);
    let gates = Gates::new(&glancer, config, world, &start, cx);
    let planner = Planner::new(&rules, &gates, world, name, cx);
    keyframes::warn_of_crossings(&planner, &poses);
    Ok(measure::finish(&planner, Draft { poses, ..Draft::default() }))
}

/// What every mode works with.
struct Planner<'a> {
    rules: &'a Rules<'a>,
    gates: &'a Gates<'a>,
    world: &'a WorldMesh,
    config: &'a PlanConfig,
    image: TestImage,
    name: &'a str,
    /// The caller's last word.
    accepts: &'a (dyn Fn(&Pose) -> bool + Sync),
    cx: &'a dyn Cx,
}

/// What a mode found.
#[derive(Default)]
struct Draft {
    poses: Vec<Pose>,
    /// What the poses show, where the mode knows already; else empty.
    views: Vec<ViewStats>,
    rejected: RejectedCounts,
    coverage: Option<CoverageReport>,
}

impl<'a> Planner<'a> {
    fn new(rules: &'a Rules<'a>, gates: &'a Gates<'a>, world: &'a WorldMesh, name: &'a str, cx: &'a dyn Cx) -> Self {
        let config = rules.config;
        let image = TestImage::new(&Intrinsics::from_fov_x(config.test_width, config.test_height, config.fov_x_rad));
        Self { rules, gates, world, config, image, name, accepts: &|_| true, cx }
    }

    /// What each pose shows.
    fn views(&self, poses: &[Pose]) -> Vec<ViewStats> {
        let look = |sight: &mut Sight, pose: &Pose| {
            sight.look(self.rules.bvh, &self.image, pose);
            sight.judge(self.world, &self.config.saliency)
        };
        poses.par_iter().map_init(|| self.image.sight(self.world), look).collect()
    }

    /// What a view is worth.
    fn score(&self, view: &ViewStats) -> f64 {
        self.config.saliency.score(view)
    }

    /// The index of a candidate without a fault, drawn in proportion to the scores. Coarse looks are dear, so only what is drawn is
    /// looked at; one with a fault is drawn no more. `before` is the pose before them.
    fn choose(
        &self,
        candidates: &[Pose],
        views: &[ViewStats],
        before: Option<&Pose>,
        rejected: &mut RejectedCounts,
        rng: &mut Rng,
    ) -> Option<usize> {
        let score = |view: &ViewStats| if self.gates.is_void(view) { 0.0 } else { self.score(view) };
        let scores: Vec<f64> = views.iter().map(score).collect();
        let greatest = scores.iter().fold(0.0, |most: f64, score| most.max(*score));
        // Beyond what a sum of single precision can hold, only ratios count.
        let unit = if greatest > MOST_SCORE { greatest } else { 1.0 };
        let mut weights: Vec<f32> = scores.into_iter().map(|score| (score / unit) as f32).collect();
        views.iter().filter(|view| self.gates.is_void(view)).for_each(|_| rejected.add(Fault::Void));
        while let Some(distribution) = Distribution1::new(&weights) {
            let chosen = distribution.sample(rng.next_f32()).0;
            let pose = &candidates[chosen];
            let fault = self.gates.fault(pose, before).or_else(|| (!(self.accepts)(pose)).then_some(Fault::Refused));
            let Some(fault) = fault else { return Some(chosen) };
            rejected.add(fault);
            weights[chosen] = 0.0;
        }
        None
    }

    fn progress(&self, done: usize, total: usize) {
        self.cx.progress(&format!("plan {}", self.name), done as u64, total as u64);
    }

    fn warn(&self, message: String) {
        self.cx.warn(enfilade_scene::Warning { place: self.name.to_string(), message });
    }
}

#[cfg(test)]
mod tests;
