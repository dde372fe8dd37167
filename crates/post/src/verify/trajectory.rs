//! Laws of the poses.

use super::card::Card;
use super::law::Law;
use enfilade_math::DMat3;
use enfilade_scene::{Pose, Trajectory};

/// Checks every law about the poses of a trajectory. `place` names the camera.
pub fn check_trajectory(trajectory: &Trajectory, place: &str) -> Card {
    let mut card = Card::default();
    for (index, pose) in trajectory.poses.iter().enumerate() {
        let at = || format!("{place}/frame.{:04}", pose.frame);
        card.observe(Law::FrameNumbers, if pose.frame as usize == index { 0.0 } else { 1.0 }, || {
            format!("{place}: pose {index} is of frame {}", pose.frame)
        });
        let finite = pose.position.is_finite() && pose.look_at.is_finite() && pose.world_from_camera.is_finite();
        card.observe(Law::PosesFinite, if finite { 0.0 } else { 1.0 }, at);
        if finite {
            check_pose(&mut card, pose, at);
        }
    }
    card
}

fn check_pose(card: &mut Card, pose: &Pose, at: impl Fn() -> String) {
    let r = pose.world_from_camera;
    let off_identity = (r * r.transpose() - DMat3::IDENTITY).to_cols_array();
    card.observe(Law::Orthonormal, off_identity.iter().fold(0.0, |worst: f64, v| worst.max(v.abs())), &at);
    card.observe(Law::RightHanded, (r.determinant() - 1.0).abs(), &at);
    let ahead = (pose.look_at - pose.position).try_normalize();
    card.observe(Law::LookAt, ahead.map_or(f64::INFINITY, |ahead| (ahead + r.z_axis).abs().max_element()), &at);
    card.observe(Law::Roll, pose.roll_rad().abs().to_degrees(), &at);
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DVec3;

    fn trajectory() -> Trajectory {
        let pose = |frame: u32| {
            let position = DVec3::new(f64::from(frame), 0.2, 1.4);
            Pose::look_at(frame, position, position + DVec3::new(1.0, 2.0, -0.3), DVec3::new(0.03, 0.0, 1.0)).unwrap()
        };
        Trajectory { name: "cam_00".into(), poses: (0..5).map(pose).collect() }
    }

    fn failures(change: impl Fn(&mut Trajectory)) -> Vec<Law> {
        let mut t = trajectory();
        change(&mut t);
        check_trajectory(&t, "s/cam_00").failures()
    }

    #[test]
    fn good_poses_pass() {
        assert_eq!(failures(|_| ()), []);
    }

    #[test]
    fn each_broken_pose_fails_its_law_alone() {
        assert_eq!(failures(|t| t.poses[3].position.y = f64::NAN), [Law::PosesFinite]);
        assert_eq!(failures(|t| t.poses[4].frame = 7), [Law::FrameNumbers]);
        assert_eq!(failures(|t| t.poses[1].look_at.z += 0.01), [Law::LookAt]);
        assert_eq!(failures(|t| t.poses[1].look_at = t.poses[1].position), [Law::LookAt]);
        assert_eq!(failures(|t| t.poses[2].world_from_camera.x_axis *= -1.0), [Law::RightHanded]);
        let shear = |t: &mut Trajectory| {
            let r = &mut t.poses[2].world_from_camera;
            r.x_axis += 1e-6 * r.z_axis; // keeps the determinant
        };
        assert_eq!(failures(shear), [Law::Orthonormal]);
        let roll = |t: &mut Trajectory| {
            let r = &mut t.poses[0].world_from_camera;
            *r *= DMat3::from_rotation_z(8f64.to_radians());
        };
        assert_eq!(failures(roll), [Law::Roll]);
    }
}
