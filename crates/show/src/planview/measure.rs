//! Numbers about every frame of a trajectory.

use super::look::Sight;
use super::planned::Planned;
use enfilade_geometry::Surfaces;
use enfilade_math::DVec3;
use enfilade_scene::{Camera, CameraView, Pose, Trajectory};
use serde::Serialize;

/// Measures of one frame.
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
    /// Angle turned since the frame before, about any axis, degrees.
    pub turn_deg: Option<f64>,
    /// To the nearest surface, metres, exactly.
    pub clearance_m: f64,
    /// Share of the visible surfaces that the frame before sees too.
    pub overlap: Option<f64>,
    /// Share of the pixels that see no surface.
    pub void_share: f64,
    /// Distinct triangles seen.
    pub triangles: usize,
    /// Distinct parts seen.
    pub parts: usize,
    /// The view's score in the plan; without one n·(1 − e)², Hypersim's view saliency, with n the number of triangles
    /// and e the void share.
    pub score: f64,
}

/// Measures the frames of a trajectory, some at a time.
pub(super) struct Measuring<'a> {
    camera: &'a Camera,
    poses: &'a [Pose],
    floor: f64,
    surfaces: Surfaces<'a>,
}

impl<'a> Measuring<'a> {
    pub fn new(planned: &'a Planned<'_>, camera: &'a Camera, trajectory: &'a Trajectory) -> Self {
        let surfaces = Surfaces::new(&planned.world.corners);
        Self { camera, poses: &trajectory.poses, floor: floor_z(planned, trajectory), surfaces }
    }

    /// Measures of the poses from index `first` on, which see `sights`; the pose before them sees `before`.
    pub fn measures(&self, first: usize, sights: &[Sight], before: Option<&Sight>) -> Vec<FrameMeasures> {
        let one = |k: usize| self.measure(first + k, &sights[k], if k == 0 { before } else { Some(&sights[k - 1]) });
        enfilade_parallel::map_up_to(sights.len(), one)
    }

    fn measure(&self, i: usize, sight: &Sight, before: Option<&Sight>) -> FrameMeasures {
        let (pose, last) = (&self.poses[i], i.checked_sub(1));
        let (triangles, parts) = sight.distinct();
        let void_share = sight.void_share();
        let overlap = |(last, before): (usize, &Sight)| {
            let view = CameraView::of_frame(self.camera, self.poses, last);
            sight.share_seen_by(&view, before)
        };
        FrameMeasures {
            frame: pose.frame,
            height_m: pose.position.z - self.floor,
            roll_deg: pose.roll_rad().to_degrees(),
            pitch_deg: (-pose.world_from_camera.z_axis.z).clamp(-1.0, 1.0).asin().to_degrees(),
            step_m: last.map(|last| pose.position.distance(self.poses[last].position)),
            turn_deg: last.map(|last| turn_deg(&self.poses[last], pose)),
            clearance_m: self.surfaces.distance_m(pose.position).unwrap_or(f64::INFINITY),
            overlap: last.zip(before).and_then(overlap),
            void_share,
            triangles,
            parts,
            score: triangles as f64 * (1.0 - void_share).powi(2),
        }
    }
}

/// Height of the floor of a trajectory: what most poses have below them, so the first decile of what is met straight below. The
/// lowest point of the scene when nothing is below.
pub(super) fn floor_z(planned: &Planned<'_>, trajectory: &Trajectory) -> f64 {
    let below = |p: DVec3| super::look::meet(planned.world, planned.bvh, p, DVec3::NEG_Z).map(|seen| seen.p_world.z);
    let mut found: Vec<f64> = trajectory.poses.iter().filter_map(|pose| below(pose.position)).collect();
    enfilade_math::quantile(&mut found, 0.1).unwrap_or(f64::from(planned.world.bounds.min.z))
}

fn turn_deg(before: &Pose, after: &Pose) -> f64 {
    let turn = before.world_from_camera.transpose() * after.world_from_camera;
    // Rodrigues: the trace of a rotation by a is 1 + 2 cos a.
    (0.5 * (turn.x_axis.x + turn.y_axis.y + turn.z_axis.z - 1.0)).clamp(-1.0, 1.0).acos().to_degrees()
}

#[cfg(test)]
mod tests {
    use super::super::look::look;
    use super::super::tests::with_planned;
    use super::*;
    use enfilade_math::Rng;
    use enfilade_testroom::box_room;

    #[test]
    fn measures_are_the_same_whatever_frames_are_measured_at_a_time() {
        with_planned(|planned| {
            let (camera, trajectory) = &planned.filmed[0];
            let sight = |i| look(planned.world, planned.bvh, &CameraView::of_frame(camera, &trajectory.poses, i));
            let sights: Vec<Sight> = (0..3).map(sight).collect();
            let measuring = Measuring::new(planned, camera, trajectory);
            let whole = measuring.measures(0, &sights, None);
            let mut pieces = measuring.measures(0, &sights[..1], None);
            pieces.extend(measuring.measures(1, &sights[1..], Some(&sights[0])));
            assert_eq!(pieces, whole);
            assert!(whole[0].overlap.is_none() && whole[1].overlap.is_some_and(|share| share > 0.6), "{whole:?}");
        });
    }

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
