//! What a pose must satisfy, whatever it shows.

use super::PlanConfig;
use crate::FreeSpace;
use enfilade_geometry::{Bvh, Voxel};
use enfilade_math::{DVec3, Ray};
use enfilade_scene::Pose;
use rayon::prelude::*;

/// A point is seen when no surface is nearer than this much beyond it, as a share of its distance: the original's margin.
const SIGHT_MARGIN: f64 = 0.01;

/// Views closer to the vertical than this (sine of the angle) have no meaningful roll and are not taken.
pub(super) const MIN_SLANT: f64 = 0.1;

pub(super) struct Rules<'a> {
    pub bvh: &'a Bvh,
    pub space: &'a FreeSpace,
    pub config: &'a PlanConfig,
}

impl<'a> Rules<'a> {
    pub fn new(bvh: &'a Bvh, space: &'a FreeSpace, config: &'a PlanConfig) -> Self {
        Self { bvh, space, config }
    }

    /// Those of `points` where a camera may be that is seen from `last`.
    pub fn positions_seen_from(&self, last: DVec3, points: Vec<DVec3>) -> Vec<DVec3> {
        points.into_par_iter().with_min_len(64).filter(|p| self.is_position(*p) && self.sees(last, *p)).collect()
    }

    /// Those of `points` where a target may be that is seen from `last`.
    pub fn targets_seen_from(&self, last: DVec3, points: Vec<DVec3>) -> Vec<DVec3> {
        points.into_par_iter().with_min_len(64).filter(|p| self.is_free(*p) && self.sees(last, *p)).collect()
    }

    /// In a free voxel.
    pub fn is_free(&self, p: DVec3) -> bool {
        self.space.tree.state(p) == Voxel::Free
    }

    /// In a free voxel, with no occupied voxel within the clearance.
    pub fn is_position(&self, p: DVec3) -> bool {
        self.is_free(p) && !self.space.tree.any_within(p, self.config.clearance_m, Voxel::Occupied)
    }

    /// Whether the second camera of a stereo rig may be beside this pose; true without one.
    pub fn has_room_beside(&self, pose: &Pose) -> bool {
        let baseline = self.config.stereo_baseline_m;
        let partner = pose.position + baseline * pose.world_from_camera.x_axis;
        baseline == 0.0 || (self.is_position(partner) && self.sees(pose.position, partner))
    }

    /// No surface between `from` and `to`, nor close behind `to`.
    pub fn sees(&self, from: DVec3, to: DVec3) -> bool {
        let distance = from.distance(to);
        let Some(direction) = (to - from).try_normalize() else { return true };
        let mut ray = Ray::new(from.as_vec3(), direction.as_vec3());
        ray.t_max = (distance / (1.0 - SIGHT_MARGIN)) as f32;
        !self.bvh.occluded(&ray)
    }

    /// Distance to the first surface, metres; infinite when there is none.
    pub fn distance_m(&self, from: DVec3, direction: DVec3) -> f64 {
        self.bvh.closest(&Ray::new(from.as_vec3(), direction.as_vec3())).map_or(f64::INFINITY, |hit| f64::from(hit.t))
    }
}

/// The pose that looks from `position` to `look_at` with exactly this roll; `None` when the view is nearly vertical.
pub(super) fn posed(frame: u32, position: DVec3, look_at: DVec3, roll_rad: f64) -> Option<Pose> {
    let z = (position - look_at).try_normalize()?;
    if z.truncate().length() < MIN_SLANT {
        return None;
    }
    let level_x = DVec3::Z.cross(z).normalize();
    let up = z.cross(level_x) * roll_rad.cos() - level_x * roll_rad.sin();
    Pose::look_at(frame, position, look_at, up)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_has_the_roll_asked_for() {
        for target in [DVec3::new(3.0, 1.0, 0.2), DVec3::new(-1.0, 0.3, 2.0), DVec3::new(0.0, -2.0, -1.5)] {
            for roll in [-5.0f64, 0.0, 3.0, 5.0].map(f64::to_radians) {
                let pose = posed(3, DVec3::ZERO, target, roll).unwrap();
                assert!((pose.roll_rad() - roll).abs() < 1e-14, "{} {roll}", pose.roll_rad());
            }
        }
        assert_eq!(posed(0, DVec3::ZERO, DVec3::new(0.01, 0.0, -1.0), 0.0), None);
    }
}
