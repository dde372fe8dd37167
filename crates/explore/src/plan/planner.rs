//! The common base of all modes: the scene, the rules and the gates, and the choice among candidates in proportion to their scores.

use super::PlanConfig;
use super::gates::Gates;
use super::report::{CoverageReport, Fault, ObjectVisibility, RejectedCounts};
use super::rules::Rules;
use crate::ViewStats;
use crate::view::{Sight, TestImage};
use enfilade_math::{Distribution1, Rng};
use enfilade_scene::{Cx, Intrinsics, Pose, StartCamera, WorldMesh};
use rayon::prelude::*;

/// Scores whose greatest is not between these are scaled together, because choices are made in single precision.
const SCORES: [f64; 2] = [1e-30, 1e30];

/// The common inputs of all modes.
pub(super) struct Planner<'a> {
    pub rules: &'a Rules<'a>,
    pub gates: &'a Gates<'a>,
    pub world: &'a WorldMesh,
    pub config: &'a PlanConfig,
    pub image: TestImage,
    pub name: &'a str,
    /// The camera that the trajectory begins with; none for poses made by hand.
    pub start: Option<&'a StartCamera>,
    /// The caller's acceptance test of a pose.
    pub accepts: &'a (dyn Fn(&Pose) -> bool + Sync),
    pub cx: &'a dyn Cx,
}

/// The result of a mode.
#[derive(Default)]
pub(super) struct Draft {
    pub poses: Vec<Pose>,
    /// Measurements of the poses' views, if the mode already has them; else empty.
    pub views: Vec<ViewStats>,
    pub rejected: RejectedCounts,
    pub coverage: Option<CoverageReport>,
    /// Visibility of the objects, if the mode looks at some.
    pub objects: Vec<ObjectVisibility>,
}

impl<'a> Planner<'a> {
    pub fn new(rules: &'a Rules<'a>, gates: &'a Gates<'a>, world: &'a WorldMesh, name: &'a str, cx: &'a dyn Cx) -> Self {
        let config = rules.config;
        let image = TestImage::new(&Intrinsics::from_fov_x(config.test_width, config.test_height, config.fov_x_rad));
        Self { rules, gates, world, config, image, name, start: None, accepts: &|_| true, cx }
    }

    /// Measurements of the view of each pose.
    pub fn views(&self, poses: &[Pose]) -> Vec<ViewStats> {
        let look = |sight: &mut Sight, pose: &Pose| {
            sight.look(self.rules.bvh, &self.image, pose);
            sight.judge(self.world, &self.config.saliency)
        };
        poses.par_iter().map_init(|| self.image.sight(self.world), look).collect()
    }

    /// The score of a view.
    pub fn score(&self, view: &ViewStats) -> f64 {
        self.config.saliency.score(view)
    }

    /// The index of a candidate without a fault, drawn in proportion to the scores. Looking for faults is expensive, so only candidates
    /// that are drawn are looked at, and one with a fault is not drawn again. `before` is the pose before them.
    pub fn choose(
        &self,
        candidates: &[Pose],
        views: &[ViewStats],
        before: Option<&Pose>,
        rejected: &mut RejectedCounts,
        rng: &mut Rng,
    ) -> Option<usize> {
        // Views of too little have no score.
        let score = |view: &ViewStats| if self.gates.is_void(view) { 0.0 } else { self.score(view) };
        let scores: Vec<f64> = views.iter().map(score).collect();
        views.iter().filter(|view| self.gates.is_void(view)).for_each(|_| rejected.add(Fault::Void));

        let fault = |pose: &Pose| self.gates.fault(pose, before);
        self.draw(candidates, scores, fault, rejected, rng)
    }

    /// The index of a candidate that has no `fault` and is accepted, drawn in proportion to the scores; one that fails is not drawn again.
    pub fn draw(
        &self,
        candidates: &[Pose],
        mut scores: Vec<f64>,
        fault: impl Fn(&Pose) -> Option<Fault>,
        rejected: &mut RejectedCounts,
        rng: &mut Rng,
    ) -> Option<usize> {
        while let Some(distribution) = by_score(&scores) {
            let chosen = distribution.sample(rng.next_f32()).0;
            let pose = &candidates[chosen];
            let fault = fault(pose).or_else(|| (!(self.accepts)(pose)).then_some(Fault::Refused));
            let Some(fault) = fault else { return Some(chosen) };
            rejected.add(fault);
            scores[chosen] = 0.0;
        }
        None
    }

    pub fn progress(&self, done: usize, total: usize) {
        self.cx.progress(&format!("plan {}", self.name), done as u64, total as u64);
    }

    pub fn warn(&self, message: String) {
        self.cx.warn(enfilade_scene::Warning { place: self.name.to_string(), message });
    }
}

/// Draws indices in proportion to scores, however large or small those are; `None` when all are 0.
pub(super) fn by_score(scores: &[f64]) -> Option<Distribution1> {
    let greatest = scores.iter().fold(0.0, |max: f64, score| max.max(*score));
    let unit = if (SCORES[0]..=SCORES[1]).contains(&greatest) || greatest == 0.0 { 1.0 } else { greatest };
    let weights: Vec<f32> = scores.iter().map(|score| (score / unit) as f32).collect();
    Distribution1::new(&weights)
}
