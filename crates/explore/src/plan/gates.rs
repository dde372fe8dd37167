//! Which views are not worth taking: those from outside of a building, and those of next to nothing.

use super::PlanConfig;
use super::glance::{Glance, Glancer, SurfacePoint};
use super::report::Fault;
use crate::ViewStats;
use enfilade_math::{DVec3, warp};
use enfilade_scene::{Cx, Pose, StartCamera, Warning, WorldMesh};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// The back of a part counts only when at most this share of the rays that meet it from around the start meets its back: others are
/// thin things with two sides, or were modelled inside out.
const MOSTLY_FRONT: f64 = 0.25;

/// Places around the start from which the parts' sides are looked at, rays from each, and how far away the places are at most.
const PLACES: usize = 32;
const RAYS: usize = 1024;
const PLACE_DISTANCE_M: f64 = 4.0;

/// Level directions around a camera.
const LEVEL: usize = 72;

/// Directions all around it, of which those with a greater sine above the horizon than this are upward.
const UPWARD: usize = 128;
const UPWARD_SINE: f64 = 0.4;

/// The conditions of a view.
pub(super) struct Gates<'a> {
    pub glancer: &'a Glancer<'a>,
    config: &'a PlanConfig,
    /// By part: seeing its back is a sign of standing on the wrong side of it.
    has_front: Vec<bool>,
    /// Level and upward.
    max_open_shares: [f64; 2],
}

impl<'a> Gates<'a> {
    /// The conditions for views around a start camera, which is taken to be on the right side of things.
    pub fn new(glancer: &'a Glancer<'a>, config: &'a PlanConfig, world: &WorldMesh, start: &StartCamera, cx: &dyn Cx) -> Self {
        let has_front = fronts(glancer, world, start.position);
        let mut gates = Self { glancer, config, has_front, max_open_shares: [config.max_open_share; 2] };
        let open = gates.open_shares(start.position);
        for (limit, (share, what)) in gates.max_open_shares.iter_mut().zip(open.into_iter().zip(["level", "upward"])) {
            if share > *limit {
                let (found, allowed) = (100.0 * share, 100.0 * *limit);
                let message = format!(
                    "stands in the open: {found:.0} % of the {what} directions around it meet no surface, max_open_share allows {allowed:.0} %; \
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

    /// As [`Gates::fault`] for a first choice among many: what no surface shows counts by the coarse look.
    pub fn coarse_fault(&self, pose: &Pose) -> Option<Fault> {
        let glance = self.glancer.look(pose);
        let void = 1.0 - glance.points.len() as f64 / glance.rays as f64;
        self.fault(pose, None).max((void > self.config.max_void_share).then_some(Fault::Void))
    }

    /// Stands in the open, as outside of a building.
    pub fn is_open(&self, p: DVec3) -> bool {
        self.open_shares(p).iter().zip(self.max_open_shares).any(|(share, limit)| *share > limit)
    }

    /// Of the level and of the upward directions around a point, the share in which there is no surface, or only the back of one
    /// whose front is what one sees from around the start.
    pub fn open_shares(&self, p: DVec3) -> [f64; 2] {
        let leads_out =
            |direction: DVec3| self.glancer.meet(p, direction).is_none_or(|point| point.behind && self.has_front[point.part as usize]);
        let level = |k: usize| {
            let (sin, cos) = (TAU * (k as f64 + 0.5) / LEVEL as f64).sin_cos();
            leads_out(DVec3::new(cos, sin, 0.0))
        };
        let upward = || (0..UPWARD).map(|k| warp::fibonacci_sphere(k, UPWARD)).filter(|d| d.z > UPWARD_SINE);
        let level = (0..LEVEL).filter(|k| level(*k)).count() as f64 / LEVEL as f64;
        [level, upward().filter(|d| leads_out(*d)).count() as f64 / upward().count() as f64]
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
        glance.share(|point| point.behind && self.has_front[point.part as usize])
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

/// By part, whether the start and the places that it sees around it see (nearly) nothing but its front.
fn fronts(glancer: &Glancer, world: &WorldMesh, start: DVec3) -> Vec<bool> {
    let places = (0..PLACES).map(|k| {
        let direction = warp::fibonacci_sphere(k, PLACES);
        let free = glancer.meet(start, direction).map_or(PLACE_DISTANCE_M, |point| point.distance_m.min(PLACE_DISTANCE_M));
        // Spread over the way to the surface, the surface itself left out.
        start + direction * free * (0.1 + 0.8 * ((k * 5) % PLACES) as f64 / PLACES as f64)
    });
    let places: Vec<DVec3> = std::iter::once(start).chain(places).collect();
    let met: Vec<SurfacePoint> =
        places.par_iter().flat_map_iter(|p| (0..RAYS).filter_map(|k| glancer.meet(*p, warp::fibonacci_sphere(k, RAYS)))).collect();
    let parts = world.sources.iter().map(|source| source.part as usize + 1).max().unwrap_or(0);
    let (mut all, mut behind) = (vec![0u32; parts], vec![0u32; parts]);
    for point in met {
        all[point.part as usize] += 1;
        behind[point.part as usize] += u32::from(point.behind);
    }
    all.iter().zip(&behind).map(|(all, behind)| *all > 0 && f64::from(*behind) <= MOSTLY_FRONT * f64::from(*all)).collect()
}
