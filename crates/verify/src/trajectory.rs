//! Laws of the poses.

use super::card::Card;
use super::law::Law;
use enfilade_explore::{PlannedStart, WalkBoxes};
use enfilade_geometry::Voxel;
use enfilade_math::DMat3;
use enfilade_scene::{Pose, Trajectory};
use serde::Deserialize;
use std::path::Path;

/// The limit of roll of all plans before plans recorded their own, degrees.
const USUAL_ROLL_LIMIT_DEG: f64 = 5.0;

/// The rules of a plan, from its report; the default is for poses that were not planned here.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct PlanRules {
    /// Name of the mode; empty where it is not known.
    #[serde(default)]
    pub mode: String,
    /// The greatest roll, degrees; `None` where it has no limit.
    #[serde(default = "usual")]
    pub roll_limit_deg: Option<f64>,
    /// The boxes of a walk; `None` for other modes, and if the plan does not record them.
    #[serde(default)]
    pub walk: Option<WalkBoxes>,
    /// The camera that it begins with; `None` if the plan does not record it.
    #[serde(default)]
    pub start: Option<PlannedStart>,
    /// True for the second camera of a rig, which is beside the planned one.
    #[serde(skip)]
    pub is_second: bool,
}

fn usual() -> Option<f64> {
    Some(USUAL_ROLL_LIMIT_DEG)
}

impl PlanRules {
    /// Rules of the plan whose report is at `path`.
    pub(super) fn of(path: &Path) -> Self {
        std::fs::read(path).ok().and_then(|text| serde_json::from_slice(&text).ok()).unwrap_or_default()
    }

    /// Whether the camera of this frame may be in such a voxel: in a free one, or, for the artist's own camera, also in one that a surface
    /// touches, which carving treats as free because of the camera. Poses that are given are kept at any place, and so is the artist's by
    /// Hypersim's preset, which does not check the space for the second camera of a rig either.
    pub(super) fn may_stand_in(&self, voxel: Voxel, frame: u32) -> bool {
        let anywhere = ["keyframes", "cameras"].contains(&self.mode.as_str()) || (self.is_preset() && (self.is_second || frame == 0));
        // The second camera of a rig beside the artist's camera may be in any voxel.
        anywhere || voxel == Voxel::Free || (self.is_given(frame) && (self.is_second || voxel == Voxel::Occupied))
    }

    /// Whether this frame looks at its look-at point, which a walk takes beside the axis where nothing on the artist's is free.
    fn looks_at_target(&self, frame: u32) -> bool {
        !self.is_given(frame) || self.start.as_ref().is_some_and(|start| start.looks_along_axis)
    }

    /// Whether this frame is the artist's pose. Before plans recorded this, it was so in Hypersim's preset.
    fn is_given(&self, frame: u32) -> bool {
        frame == 0 && self.start.as_ref().map_or(self.is_preset(), |start| start.is_kept)
    }

    /// Only Hypersim's preset walks without a limit of roll.
    fn is_preset(&self) -> bool {
        self.mode == "walk" && self.roll_limit_deg.is_none()
    }
}

/// Checks every law about the poses of a trajectory, as far as its plan keeps to it. `place` names the camera.
pub fn check_trajectory(trajectory: &Trajectory, rules: &PlanRules, place: &str) -> Card {
    let mut card = Card::default();
    for (index, pose) in trajectory.poses.iter().enumerate() {
        let at = || format!("{place}/frame.{:04}", pose.frame);
        card.observe(Law::FrameNumbers, if pose.frame as usize == index { 0.0 } else { 1.0 }, || {
            format!("{place}: pose {index} is of frame {}", pose.frame)
        });
        let finite = pose.position.is_finite() && pose.look_at.is_finite() && pose.world_from_camera.is_finite();
        card.observe(Law::PosesFinite, if finite { 0.0 } else { 1.0 }, at);
        if finite {
            check_pose(&mut card, pose, rules, at);
        }
    }
    card
}

fn check_pose(card: &mut Card, pose: &Pose, rules: &PlanRules, at: impl Fn() -> String) {
    let r = pose.world_from_camera;
    let off_identity = (r * r.transpose() - DMat3::IDENTITY).to_cols_array();
    card.observe(Law::Orthonormal, off_identity.iter().fold(0.0, |worst: f64, v| worst.max(v.abs())), &at);
    card.observe(Law::RightHanded, (r.determinant() - 1.0).abs(), &at);
    if rules.looks_at_target(pose.frame) {
        let ahead = (pose.look_at - pose.position).try_normalize();
        card.observe(Law::LookAt, ahead.map_or(f64::INFINITY, |ahead| (ahead + r.z_axis).abs().max_element()), &at);
    }
    if let Some(start) = rules.start.as_ref().filter(|start| pose.frame == 0 && start.is_kept && !rules.is_second) {
        let turned = (r - start.world_from_camera).to_cols_array().iter().fold(0.0, |worst: f64, v| worst.max(v.abs()));
        card.observe(Law::StartPose, turned.max((pose.position - start.position).abs().max_element()), &at);
    }
    if let Some(limit) = rules.roll_limit_deg.filter(|_| !rules.is_given(pose.frame)) {
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

    fn rules(mode: &str, roll_limit_deg: Option<f64>) -> PlanRules {
        PlanRules { mode: mode.into(), roll_limit_deg, ..PlanRules::default() }
    }

    fn failures_of(rules: &PlanRules, change: impl Fn(&mut Trajectory)) -> Vec<Law> {
        let mut t = trajectory();
        change(&mut t);
        check_trajectory(&t, rules, "s/cam_00").failures()
    }

    fn failures(change: impl Fn(&mut Trajectory)) -> Vec<Law> {
        failures_of(&rules("walk", Some(5.0)), change)
    }

    #[test]
    fn good_poses_pass() {
        assert_eq!(failures(|_| ()), []);
    }

    #[test]
    fn the_limit_of_roll_is_that_of_the_plan() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan_report.json");
        assert_eq!(PlanRules::of(&path), rules("", None), "nothing was planned here");
        for (text, limit) in [("{}", Some(5.0)), (r#"{"roll_limit_deg": 12.5}"#, Some(12.5)), (r#"{"roll_limit_deg": null}"#, None)] {
            std::fs::write(&path, text).unwrap();
            assert_eq!(PlanRules::of(&path).roll_limit_deg, limit, "{text}");
        }
    }

    #[test]
    fn the_target_of_the_presets_start_may_lie_beside_the_axis_and_no_other() {
        for (rules, at_start) in [
            (rules("walk", None), vec![]),
            (rules("walk", Some(5.0)), vec![Law::LookAt]),
            (rules("keyframes", None), vec![Law::LookAt]),
            (PlanRules::default(), vec![Law::LookAt]),
        ] {
            let beside = |frame: usize| failures_of(&rules, move |t| t.poses[frame].look_at.z += 0.01);
            assert_eq!((beside(0), beside(1)), (at_start, vec![Law::LookAt]), "{rules:?}");
        }
    }

    #[test]
    fn the_start_camera_is_frame_0_whatever_its_roll_and_no_other_pose_is() {
        let first = trajectory().poses[0];
        let turn = DMat3::from_rotation_z(8f64.to_radians());
        let start = |is_kept| PlannedStart {
            name: "door".into(),
            position: first.position,
            world_from_camera: first.world_from_camera * turn,
            is_kept,
            looks_along_axis: true,
        };
        let rules = |is_kept| PlanRules { start: Some(start(is_kept)), ..rules("walk", Some(5.0)) };
        let turned = |frame: usize| move |t: &mut Trajectory| t.poses[frame].world_from_camera *= turn;
        assert_eq!(failures_of(&rules(true), turned(0)), []);
        assert_eq!(failures_of(&rules(true), turned(1)), [Law::Roll, Law::StartPose]);
        assert_eq!(failures_of(&rules(false), turned(0)), [Law::Roll]);
        let moved = |t: &mut Trajectory| {
            turned(0)(t);
            let back = t.poses[0].world_from_camera.z_axis;
            t.poses[0].position += 1e-6 * back;
        };
        assert_eq!(failures_of(&rules(true), moved), [Law::StartPose]);
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
            assert_eq!(check_trajectory(&rolled, &rules("walk", limit), "s/cam_00").failures(), [], "{limit:?}");
        }
    }
}
