//! Rules that a pose must satisfy, whatever it shows.

use super::PlanConfig;
use crate::FreeSpace;
use enfilade_geometry::{Bvh, Voxel};
use enfilade_math::{DQuat, DVec3, Ray, Rng};
use enfilade_parallel::flat_map;
use enfilade_scene::Pose;
use std::f64::consts::TAU;

/// A point is seen when no surface is nearer than this much beyond it, as a share of its distance: the original's margin.
const SIGHT_MARGIN: f64 = 0.01;

/// Views closer to the vertical than this (sine of the angle) have no meaningful roll and are not taken.
pub(super) const MIN_SLANT: f64 = 0.1;

/// Views closer than this have no roll at all in double precision.
const VERTICAL: f64 = 1e-6;

/// Limits of angles and heights are kept to within this, so that rounding breaks none.
const ROUNDING: f64 = 1e-9;

/// A floor is looked for below the camera and this far around it, so that no table and no edge of a bed is taken for one.
const STANDING_RADIUS_M: f64 = 0.5;
const STANDING_PLACES: usize = 8;

/// Targets keep this many voxels away from the surface behind them; the original's number.
const TARGET_MARGIN_VOXELS: f64 = 1.75;

/// A way is looked at in steps of this many voxels.
const WAY_STEP_VOXELS: f64 = 0.25;

pub(super) struct Rules<'a> {
    pub bvh: &'a Bvh,
    pub space: &'a FreeSpace,
    pub config: &'a PlanConfig,
}

impl<'a> Rules<'a> {
    pub fn new(bvh: &'a Bvh, space: &'a FreeSpace, config: &'a PlanConfig) -> Self {
        Self { bvh, space, config }
    }

    /// The `points` seen from `last` where a camera may be.
    pub fn positions_seen_from(&self, last: DVec3, points: Vec<DVec3>) -> Vec<DVec3> {
        flat_map(&points, |&p| (self.is_position(p) && self.sees(last, p)).then_some(p))
    }

    /// The `points` seen from `last` where a target may be.
    pub fn targets_seen_from(&self, last: DVec3, points: Vec<DVec3>) -> Vec<DVec3> {
        flat_map(&points, |&p| (self.is_free(p) && self.sees(last, p)).then_some(p))
    }

    /// In a free voxel.
    pub fn is_free(&self, p: DVec3) -> bool {
        self.space.tree.state(p) == Voxel::Free
    }

    /// In a voxel that a surface touches.
    pub fn is_occupied(&self, p: DVec3) -> bool {
        self.space.tree.state(p) == Voxel::Occupied
    }

    /// In a free voxel, with no occupied voxel within the clearance.
    pub fn has_room(&self, p: DVec3) -> bool {
        self.is_free(p) && !self.space.tree.any_within(p, self.config.clearance_m, Voxel::Occupied)
    }

    /// Whether a camera may be here: enough room, and the height asked for.
    pub fn is_position(&self, p: DVec3) -> bool {
        self.has_room(p) && self.is_at_height(p)
    }

    /// At the height above the floor that is asked for; true where none is.
    pub fn is_at_height(&self, p: DVec3) -> bool {
        let Some([min, max]) = self.config.camera_height_m else { return true };
        self.height_m(p).is_some_and(|h| h >= min - ROUNDING && h <= max + ROUNDING)
    }

    /// Height above the floor: the lowest surface below the point and the places around it that it sees. `None` above nothing.
    pub fn height_m(&self, p: DVec3) -> Option<f64> {
        let below = |p: DVec3| self.distance_m(p, -DVec3::Z);
        let around = (0..STANDING_PLACES).filter_map(|k| {
            let (sin, cos) = (TAU * k as f64 / STANDING_PLACES as f64).sin_cos();
            let beside = p + STANDING_RADIUS_M * DVec3::new(cos, sin, 0.0);
            self.sees(p, beside).then(|| below(beside))
        });
        let lowest = around.filter(|h| h.is_finite()).fold(below(p), f64::max);
        lowest.is_finite().then_some(lowest)
    }

    /// Whether the second camera of a stereo rig may be beside this pose; true without one.
    pub fn has_room_beside(&self, pose: &Pose) -> bool {
        let baseline = self.config.stereo_baseline_m;
        let partner = pose.position + baseline * pose.world_from_camera.x_axis;
        baseline == 0.0 || (self.has_room(partner) && self.sees(pose.position, partner))
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

    /// Whether the straight way between two points is in free voxels, with no occupied one within the clearance of any point of it.
    pub fn is_clear_way(&self, from: DVec3, to: DVec3) -> bool {
        let step_m = WAY_STEP_VOXELS * self.space.tree.resolution_m();
        let steps = (from.distance(to) / step_m).ceil().max(1.0);
        // Every point of the way is within half a step of one that is tested, so each is tested with that much more clearance.
        let clearance = self.config.clearance_m + 0.5 * from.distance(to) / steps;
        (0..=steps as usize).all(|i| {
            let p = from.lerp(to, i as f64 / steps);
            self.is_free(p) && !self.space.tree.any_within(p, clearance, Voxel::Occupied)
        })
    }

    /// Roll is uniform within plus and minus this.
    pub fn roll_limit_rad(&self) -> f64 {
        if self.config.level { 0.0 } else { self.config.roll_limit_deg.to_radians() }
    }

    /// A roll within the limit.
    pub fn draw_roll_rad(&self, rng: &mut Rng) -> f64 {
        self.roll_limit_rad() * (2.0 * rng.next_f64() - 1.0)
    }

    /// The lowest and the highest angle of the viewing axis above the horizon.
    pub fn pitch_limits_rad(&self) -> [f64; 2] {
        if self.config.level { [0.0; 2] } else { self.config.pitch_limits_deg.map(f64::to_radians) }
    }

    /// A unit direction with its pitch brought within the limits.
    pub fn tilted(&self, direction: DVec3) -> DVec3 {
        let [low, high] = self.pitch_limits_rad();
        let pitch = pitch_rad(direction);
        let flat = DVec3::new(direction.x, direction.y, 0.0);
        match flat.try_normalize() {
            Some(flat) if pitch < low - ROUNDING || pitch > high + ROUNDING => {
                let (sin, cos) = pitch.clamp(low, high).sin_cos();
                cos * flat + sin * DVec3::Z
            }
            _ => direction,
        }
    }

    /// The target of a camera at `position` that is aimed at `look_at`: the point itself, or the one level with the camera where
    /// views are level. `None` when it is too near, hidden, not free, or too high or low.
    pub fn sight(&self, position: DVec3, look_at: DVec3) -> Option<DVec3> {
        let target = if self.config.level { DVec3::new(look_at.x, look_at.y, position.z) } else { look_at };
        let [low, high] = self.pitch_limits_rad();
        if position.distance(target) < self.config.min_look_distance_m || !self.sees(position, target) {
            return None;
        }
        let pitch = pitch_rad(target - position);
        let within = pitch >= low - ROUNDING && pitch <= high + ROUNDING;
        (within && (target == look_at || self.is_free(target))).then_some(target)
    }

    /// The pose that looks along a direction, at the farthest point that is in free space and well before the first surface. `None`
    /// when there is none, the view is nearly vertical, or the second camera has no room.
    pub fn toward(&self, frame: u32, position: DVec3, direction: DVec3, roll_rad: f64) -> Option<Pose> {
        let look_at = self.target(position, direction)?;
        posed(frame, position, look_at, roll_rad).filter(|pose| self.has_room_beside(pose))
    }

    /// The farthest point along a direction that is in free space and well before the first surface.
    pub fn target(&self, position: DVec3, direction: DVec3) -> Option<DVec3> {
        if direction.truncate().length() < MIN_SLANT {
            return None;
        }
        self.farthest(position, direction, self.config.min_look_distance_m)
    }

    /// The farthest target, as [`Rules::target`], but in any direction, however steep, and at least `nearest_m` away.
    pub fn farthest(&self, position: DVec3, direction: DVec3, nearest_m: f64) -> Option<DVec3> {
        let voxel_m = self.space.tree.resolution_m();
        let reach = self.distance_m(position, direction).min(self.exit_m(position, direction)) - TARGET_MARGIN_VOXELS * voxel_m;
        let mut distance = reach;
        while distance >= nearest_m {
            let p = position + distance * direction;
            if self.is_free(p) && self.sees(position, p) {
                return Some(p);
            }
            distance -= 0.25 * voxel_m;
        }
        None
    }

    /// Distance at which a ray from inside leaves the box of free space, metres.
    fn exit_m(&self, position: DVec3, direction: DVec3) -> f64 {
        let border = DVec3::select(direction.cmpgt(DVec3::ZERO), self.space.free_max, self.space.free_min);
        let t = (border - position) / direction;
        (0..3).filter(|a| direction[*a] != 0.0).map(|a| t[a]).fold(f64::INFINITY, f64::min)
    }
}

/// Angle of a direction above the horizon.
pub(super) fn pitch_rad(direction: DVec3) -> f64 {
    direction.z.atan2(direction.truncate().length())
}

/// Angle turned between two poses, about whatever axis.
pub(super) fn turned_rad(from: &Pose, to: &Pose) -> f64 {
    let turn = DQuat::from_mat3(&(from.world_from_camera.transpose() * to.world_from_camera));
    2.0 * turn.xyz().length().atan2(turn.w.abs())
}

/// The pose that looks from `position` to `look_at` with exactly this roll; `None` when the view is nearly vertical.
pub(super) fn posed(frame: u32, position: DVec3, look_at: DVec3, roll_rad: f64) -> Option<Pose> {
    let z = (position - look_at).try_normalize()?;
    if z.truncate().length() < MIN_SLANT {
        return None;
    }
    rolled(frame, position, look_at, roll_rad)
}

/// The pose that looks from `position` to `look_at` with this roll, as [`posed`], however steep the view is; `None` when it is vertical.
pub(super) fn rolled(frame: u32, position: DVec3, look_at: DVec3, roll_rad: f64) -> Option<Pose> {
    let z = (position - look_at).try_normalize()?;
    if z.truncate().length() < VERTICAL {
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
