//! Numbers about every frame of a trajectory.

use super::Planned;
use super::look::Sight;
use enfilade_math::{DVec3, Vec3};
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
            clearance_m: distance_to_surfaces(&planned.world.corners, pose.position),
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

/// Distance from `p` to the nearest point of any triangle; infinite without triangles.
fn distance_to_surfaces(triangles: &[[Vec3; 3]], p: DVec3) -> f64 {
    let mut nearest2 = f64::INFINITY;
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        // The box around the triangle is farther than what was found: so is the triangle.
        if p.clamp(a.min(b).min(c), a.max(b).max(c)).distance_squared(p) < nearest2 {
            nearest2 = nearest2.min(nearest_on_triangle([a, b, c], p).distance_squared(p));
        }
    }
    nearest2.sqrt()
}

/// The point of a triangle nearest to `p`. Ericson 2005, "Real-Time Collision Detection", section 5.1.5.
fn nearest_on_triangle([a, b, c]: [DVec3; 3], p: DVec3) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if d1 <= 0.0 && d2 <= 0.0 {
        a
    } else if d3 >= 0.0 && d4 <= d3 {
        b
    } else if d6 >= 0.0 && d5 <= d6 {
        c
    } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        a + d1 / (d1 - d3) * ab
    } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        a + d2 / (d2 - d6) * ac
    } else if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)
    } else {
        let sum = va + vb + vc;
        a + vb / sum * ab + vc / sum * ac
    }
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
            assert!((distance_to_surfaces(&room.corners, p) - expected).abs() < 1e-6, "{p}");
        }
        let outside = DVec3::new(-3.0, -4.0, 1.0);
        assert!((distance_to_surfaces(&room.corners, outside) - 5.0).abs() < 1e-6, "to an edge");
        assert!((distance_to_surfaces(&room.corners, DVec3::new(-1.0, -2.0, 4.5)) - 3.0).abs() < 1e-6, "to a corner");
    }
}
