//! Numbers about every frame of a trajectory.

use super::Planned;
use super::look::Sight;
use enfilade_geometry::Surfaces;
use enfilade_math::DVec3;
use enfilade_scene::{Camera, CameraView, Pose, Trajectory};
use rayon::prelude::*;
use serde::Serialize;

/// What is measured of one frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(super) struct FrameMeasures {
    /// Number of the frame.
    pub frame: u32,
    /// Camera centre over the floor, metres. The floor is [`floor_z`].
    pub height_m: f64,
    /// Rotation about the viewing axis, degrees.
    pub roll_deg: f64,
    /// Viewing axis over the horizon, degrees.
    pub pitch_deg: f64,
    /// From the camera centre of the frame before, metres.
    pub step_m: Option<f64>,
    /// Angle turned since the frame before, about whatever axis, degrees.
    pub turn_deg: Option<f64>,
    /// To the nearest surface, metres, exactly.
    pub clearance_m: f64,
    /// Share of what is seen that the frame before sees too.
    pub overlap: Option<f64>,
    /// Share of the pixels that see no surface.
    pub void_share: f64,
    /// Distinct triangles seen.
    pub triangles: usize,
    /// Distinct parts seen.
    pub parts: usize,
    /// What the plan says that the view is worth; without that n·(1 − e)², Hypersim's view saliency, with n the number of triangles
    /// and e the void share.
    pub score: f64,
}

/// Measures every frame. `sights` are what its poses see.
pub(super) fn measures(planned: &Planned<'_>, camera: &Camera, trajectory: &Trajectory, sights: &[Sight]) -> Vec<FrameMeasures> {
    let poses = &trajectory.poses;
    let floor = floor_z(planned, trajectory);
    let surfaces = Surfaces::new(&planned.world.corners);
    let view = |i| CameraView::of_frame(camera, poses, i);
    let one = |i: usize| {
        let (pose, sight) = (&poses[i], &sights[i]);
        let (triangles, parts) = sight.distinct();
        let void_share = sight.void_share();
        FrameMeasures {
            frame: pose.frame,
            height_m: pose.position.z - floor,
            roll_deg: pose.roll_rad().to_degrees(),
            pitch_deg: (-pose.world_from_camera.z_axis.z).clamp(-1.0, 1.0).asin().to_degrees(),
            step_m: i.checked_sub(1).map(|before| pose.position.distance(poses[before].position)),
            turn_deg: i.checked_sub(1).map(|before| turn_deg(&poses[before], pose)),
            clearance_m: surfaces.distance_m(pose.position).unwrap_or(f64::INFINITY),
            overlap: i.checked_sub(1).and_then(|before| sight.share_seen_by(&view(before), &sights[before])),
            void_share,
            triangles,
            parts,
            score: triangles as f64 * (1.0 - void_share).powi(2),
        }
    };
    (0..poses.len()).into_par_iter().map(one).collect()
}

/// Height of the floor of a trajectory: what most poses have below them, so the first decile of what is met straight below. The
/// lowest point of the scene when nothing is below.
pub(super) fn floor_z(planned: &Planned<'_>, trajectory: &Trajectory) -> f64 {
    let below = |p: DVec3| super::look::meet(planned.world, planned.bvh, p, DVec3::NEG_Z).map(|seen| seen.p_world.z);
    let mut found: Vec<f64> = trajectory.poses.iter().filter_map(|pose| below(pose.position)).collect();
    crate::statistics::quantile(&mut found, 0.1).unwrap_or(f64::from(planned.world.bounds.min.z))
}

fn turn_deg(before: &Pose, after: &Pose) -> f64 {
    let turn = before.world_from_camera.transpose() * after.world_from_camera;
    // Rodrigues: the trace of a rotation by a is 1 + 2 cos a.
    (0.5 * (turn.x_axis.x + turn.y_axis.y + turn.z_axis.z - 1.0)).clamp(-1.0, 1.0).acos().to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::box_room;
    use enfilade_math::Rng;

    #[test]
    fn clearance_in_a_box_is_the_distance_to_its_nearest_side() {
        let room = box_room(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5));
        let mut rng = Rng::new(3);
        for _ in 0..200 {
            let p = DVec3::new(4.0 * rng.next_f64(), 3.0 * rng.next_f64(), 2.5 * rng.next_f64());
            let expected = p.min(DVec3::new(4.0, 3.0, 2.5) - p).min_element();
            assert!((Surfaces::new(&room.corners).distance_m(p).unwrap() - expected).abs() < 1e-6, "{p}");
        }
        let outside = DVec3::new(-3.0, -4.0, 1.0);
        assert!((Surfaces::new(&room.corners).distance_m(outside).unwrap() - 5.0).abs() < 1e-6, "to an edge");
        assert!((Surfaces::new(&room.corners).distance_m(DVec3::new(-1.0, -2.0, 4.5)).unwrap() - 3.0).abs() < 1e-6, "to a corner");
    }
}
