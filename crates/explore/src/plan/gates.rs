//! The gates: tests for views that are not worth taking, such as those from outside of a building, or of almost nothing.

use super::PlanConfig;
use super::glance::{Glance, Glancer};
use super::report::Fault;
use crate::{Surroundings, ViewStats};
use enfilade_math::DVec3;
use enfilade_scene::{Cx, Pose, StartCamera, Warning, WorldMesh};

/// The conditions of a view.
pub(super) struct Gates<'a> {
    pub glancer: &'a Glancer<'a>,
    config: &'a PlanConfig,
    around: Surroundings<'a>,
    /// Level and upward.
    max_open_shares: [f64; 2],
}

impl<'a> Gates<'a> {
    /// The conditions for views around a start camera, which is taken to be on the right side of things.
    pub fn new(glancer: &'a Glancer<'a>, config: &'a PlanConfig, world: &'a WorldMesh, start: &StartCamera, cx: &dyn Cx) -> Self {
        let around = Surroundings::new(world, glancer.bvh(), &[start.position]);
        let mut gates = Self { glancer, config, around, max_open_shares: [config.max_open_share; 2] };
        let open = gates.open_shares(start.position);
        for (limit, (share, what)) in gates.max_open_shares.iter_mut().zip(open.into_iter().zip(["level", "upward"])) {
            if share > *limit {
                let (found, allowed) = (100.0 * share, 100.0 * *limit);
                let message = format!(
                    "is in the open: {found:.0} % of the {what} directions around it meet no surface, max_open_share allows {allowed:.0} %; \
                     its trajectory may stand as open as that"
                );
                cx.warn(Warning { place: format!("camera {:?}", start.name), message });
                *limit = share;
            }
        }
        gates
    }

    /// The worst fault of a view, if any. `before` is the pose before it.
    pub fn fault(&self, pose: &Pose, before: Option<&Pose>) -> Option<Fault> {
        if self.is_open(pose.position) {
            return Some(Fault::Open);
        }
        let glance = self.glancer.look(pose);
        if self.back_face_share(&glance) > self.config.max_back_face_share {
            Some(Fault::BackFaces)
        } else if self.near_share(&glance) > self.config.max_near_share {
            Some(Fault::Near)
        } else {
            self.lacks_overlap(&glance, before).then_some(Fault::Overlap)
        }
    }

    /// Fault of a view by a coarse look, for a first choice among many; otherwise as [`Gates::fault`].
    pub fn coarse_fault(&self, pose: &Pose) -> Option<Fault> {
        let glance = self.glancer.look(pose);
        let void = 1.0 - glance.points.len() as f64 / glance.rays as f64;
        self.fault(pose, None).max((void > self.config.max_void_share).then_some(Fault::Void))
    }

    /// Whether a point is in the open, as outside of a building.
    pub fn is_open(&self, p: DVec3) -> bool {
        self.open_shares(p).iter().zip(self.max_open_shares).any(|(share, limit)| *share > limit)
    }

    /// See [`Surroundings::open_shares`].
    pub fn open_shares(&self, p: DVec3) -> [f64; 2] {
        self.around.open_shares(p)
    }

    /// Shows too little.
    pub fn is_void(&self, view: &ViewStats) -> bool {
        view.void_share() > self.config.max_void_share
    }

    /// Every fault of a view, the worst last.
    pub fn faults(&self, pose: &Pose, glance: &Glance, view: &ViewStats, before: Option<&Pose>) -> Vec<Fault> {
        let found = [
            (Fault::Overlap, self.lacks_overlap(glance, before)),
            (Fault::Void, self.is_void(view)),
            (Fault::Near, self.near_share(glance) > self.config.max_near_share),
            (Fault::BackFaces, self.back_face_share(glance) > self.config.max_back_face_share),
            (Fault::Open, self.is_open(pose.position)),
        ];
        found.into_iter().filter(|(_, found)| *found).map(|(fault, _)| fault).collect()
    }

    /// Share of the rays that end on the back of something whose front is what one sees from around the start.
    pub fn back_face_share(&self, glance: &Glance) -> f64 {
        glance.share(|point| self.around.is_wrong_side(point))
    }

    /// Share of the rays that end nearer than `min_depth_m`.
    pub fn near_share(&self, glance: &Glance) -> f64 {
        glance.share(|point| point.distance_m < self.config.min_depth_m)
    }

    fn lacks_overlap(&self, glance: &Glance, before: Option<&Pose>) -> bool {
        let (Some([min, max]), Some(before)) = (self.config.overlap, before) else { return false };
        !self.glancer.overlap(glance, before).is_some_and(|share| (min..=max).contains(&share))
    }
}
