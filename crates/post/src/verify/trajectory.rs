//! Laws of the poses.

use super::card::Card;
use super::law::Law;
use enfilade_math::DMat3;
use enfilade_scene::{Pose, Trajectory};
use serde::Deserialize;
use std::path::Path;

/// The roll that was the limit of every plan before plans said what theirs is, degrees.
const USUAL_ROLL_LIMIT_DEG: f64 = 5.0;

/// The greatest roll that the plan whose report is at `path` allows, degrees; `None` where it has no limit, or nothing was planned here.
pub(super) fn roll_limit_deg(path: &Path) -> Option<f64> {
    #[derive(Deserialize)]
    struct Plan {
        #[serde(default = "usual")]
        roll_limit_deg: Option<f64>,
    }
    fn usual() -> Option<f64> {
        Some(USUAL_ROLL_LIMIT_DEG)
    }
    serde_json::from_slice::<Plan>(&std::fs::read(path).ok()?).ok()?.roll_limit_deg
}

/// Checks every law about the poses of a trajectory. `roll_limit_deg` is the roll that its plan allows, if it has a limit; `place` names
/// the camera.
pub fn check_trajectory(trajectory: &Trajectory, roll_limit_deg: Option<f64>, place: &str) -> Card {
    let mut card = Card::default();
    for (index, pose) in trajectory.poses.iter().enumerate() {
        let at = || format!("{place}/frame.{:04}", pose.frame);
        card.observe(Law::FrameNumbers, if pose.frame as usize == index { 0.0 } else { 1.0 }, || {
            format!("{place}: pose {index} is of frame {}", pose.frame)
        });
        let finite = pose.position.is_finite() && pose.look_at.is_finite() && pose.world_from_camera.is_finite();
        card.observe(Law::PosesFinite, if finite { 0.0 } else { 1.0 }, at);
        if finite {
            check_pose(&mut card, pose, roll_limit_deg, at);
        }
    }
    card
}

fn check_pose(card: &mut Card, pose: &Pose, roll_limit_deg: Option<f64>, at: impl Fn() -> String) {
    let r = pose.world_from_camera;
    let off_identity = (r * r.transpose() - DMat3::IDENTITY).to_cols_array();
    card.observe(Law::Orthonormal, off_identity.iter().fold(0.0, |worst: f64, v| worst.max(v.abs())), &at);
    card.observe(Law::RightHanded, (r.determinant() - 1.0).abs(), &at);
    let ahead = (pose.look_at - pose.position).try_normalize();
    card.observe(Law::LookAt, ahead.map_or(f64::INFINITY, |ahead| (ahead + r.z_axis).abs().max_element()), &at);
    if let Some(limit) = roll_limit_deg {
        card.observe(Law::Roll, (pose.roll_rad().abs().to_degrees() - limit).max(0.0), &at);
    }
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
        check_trajectory(&t, Some(5.0), "s/cam_00").failures()
    }

    #[test]
    fn good_poses_pass() {
        assert_eq!(failures(|_| ()), []);
    }

    #[test]
    fn the_limit_of_roll_is_that_of_the_plan() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan_report.json");
        assert_eq!(roll_limit_deg(&path), None, "nothing was planned here");
        for (text, limit) in [("{}", Some(5.0)), (r#"{"roll_limit_deg": 12.5}"#, Some(12.5)), (r#"{"roll_limit_deg": null}"#, None)] {
            std::fs::write(&path, text).unwrap();
            assert_eq!(roll_limit_deg(&path), limit, "{text}");
        }
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
        let mut rolled = trajectory();
        roll(&mut rolled);
        for limit in [Some(15.0), None] {
            assert_eq!(check_trajectory(&rolled, limit, "s/cam_00").failures(), [], "{limit:?}");
        }
    }
}
