//! Rigid motion of nodes whose placements change with time in any way: matrices, chains of operations, scales that stay.
//!
//! A placement's rotation is the orthogonal factor of its polar decomposition (Higham, "Computing the polar decomposition – with
//! applications", 1986), which is the rotation itself for placements that scale first and rotate then. What remains is scale and shear; it
//! stays that of rest.

use super::{MOST_STATES, Side, states};
use crate::assembly::TimedPoses;
use enfilade_math::{DAffine3, DMat3, DQuat};
use enfilade_scene::RigidPose;

/// Scales and shears that differ by no more, as a share, are the same.
const SAME_SHAPE: f64 = 1e-4;
/// Placements that differ by no more, as a share, are the same.
const SAME_PLACE: f64 = 1e-12;
/// Greatest rotation by which straight pieces depart from the file's motion, radians.
const ANGLE_RAD: f64 = 1e-4;
/// Pieces are not cut shorter, seconds.
const SHORTEST_S: f64 = 1.0 / 960.0;
/// Below this ratio of a determinant to the product of the axes' lengths, a placement is flat.
const SINGULAR: f64 = 1e-12;

/// How a node moves.
pub(crate) struct RigidMotion {
    /// The frame that the states are stated in, in the node's parent.
    pub parent_from_frame: DAffine3,
    /// The states; the identity is rest.
    pub states: TimedPoses,
    /// The first moment whose scale or shear is not that of rest.
    pub distorted_at_s: Option<f64>,
}

impl RigidMotion {
    /// True where nothing moves.
    pub(crate) fn is_rest(&self) -> bool {
        self.states.1.iter().all(|pose| *pose == RigidPose::IDENTITY)
    }
}

/// The motion of a node from `rest` by its placements in its parent: `local` at any moment. It is straight between `moments`, or is cut into
/// pieces that are, to within `length` in the parent's units and a ten-thousandth radian.
///
/// # Errors
/// When the node is flat at rest, or has too many states; a clause that begins with "it".
pub(crate) fn rigid(
    rest: DAffine3,
    mut moments: Vec<f64>,
    length: f64,
    local: impl Fn(f64, Side) -> DAffine3,
) -> Result<RigidMotion, String> {
    let axes = Axes::of(&rest).ok_or("it is flat where it rests, so that it has no rotation")?;
    moments.sort_by(f64::total_cmp);
    moments.dedup();
    if moments.len() > MOST_STATES {
        return Err(format!("it has {} states, more than {MOST_STATES}", moments.len()));
    }
    let pose = |time_s: f64, side: Side| axes.pose(&local(time_s, side)).0;
    let mut cut = Vec::new();
    for pair in moments.windows(2) {
        let ends = [(pair[0], pose(pair[0], Side::After)), (pair[1], pose(pair[1], Side::Before))];
        divide(ends, &|time_s| pose(time_s, Side::After), length, &mut cut);
    }
    let keeps = |time_s: &f64| [Side::Before, Side::After].into_iter().all(|side| axes.pose(&local(*time_s, side)).1);
    let distorted_at_s = moments.iter().copied().find(|time_s| !keeps(time_s));
    moments.extend(cut);
    let states = states(moments, pose)?.unwrap_or((vec![0.0], vec![RigidPose::IDENTITY]));
    let parent_from_frame = DAffine3::from_rotation_translation(axes.rotation, rest.translation);
    Ok(RigidMotion { parent_from_frame, states, distorted_at_s })
}

/// The placement between two: its rotation along the shortest way where both have the same scale and shear, else number by number.
pub(crate) fn between_placements(from: &DAffine3, to: &DAffine3, share: f64) -> DAffine3 {
    let translation = from.translation.lerp(to.translation, share);
    let plain = || from.matrix3 + (to.matrix3 - from.matrix3) * share;
    let turned = || {
        let axes = Axes::of(from)?;
        let (pose, is_alike) = axes.pose(to);
        let rotation = DQuat::IDENTITY.slerp(pose.rotation, share);
        let turn = DMat3::from_quat(axes.rotation * rotation * axes.rotation.inverse());
        is_alike.then(|| turn * from.matrix3)
    };
    DAffine3 { matrix3: turned().unwrap_or_else(plain), translation }
}

/// A placement at rest.
struct Axes {
    rest: DAffine3,
    /// The orthogonal factor, mirrored if the placement mirrors.
    orthogonal: DMat3,
    /// The rotation.
    rotation: DQuat,
}

impl Axes {
    /// `None` for a placement that is flat.
    fn of(rest: &DAffine3) -> Option<Self> {
        let orthogonal = orthogonal(rest.matrix3)?;
        let rotation = DQuat::from_mat3(&(orthogonal * orthogonal.determinant().signum())).normalize();
        Some(Self { rest: *rest, orthogonal, rotation })
    }

    /// The pose of a placement relative to rest, and whether it has the scale and shear of rest.
    fn pose(&self, local: &DAffine3) -> (RigidPose, bool) {
        let size = self.rest.matrix3.determinant().abs().cbrt().max(self.rest.translation.length());
        if local.abs_diff_eq(self.rest, SAME_PLACE * size) {
            return (RigidPose::IDENTITY, true);
        }
        let back = self.rotation.inverse();
        let translation = back * (local.translation - self.rest.translation);
        let turned = orthogonal(local.matrix3).map(|now| (now, self.orthogonal.transpose() * now));
        let Some((now, turn)) = turned.filter(|(_, turn)| turn.determinant() > 0.0) else {
            return (RigidPose { rotation: DQuat::IDENTITY, translation }, false);
        };
        // In the frame's axes, which are those of rest.
        let rotation = DQuat::from_mat3(&turn).normalize();
        let shape = |orthogonal: &DMat3, matrix: DMat3| orthogonal.transpose() * matrix;
        let (at_rest, now) = (shape(&self.orthogonal, self.rest.matrix3), shape(&now, local.matrix3));
        let most = |m: DMat3| m.to_cols_array().iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        (RigidPose { rotation, translation }, most(now - at_rest) <= SAME_SHAPE * most(at_rest))
    }
}

/// Adds the moments at which the way from one state to another is cut into straight pieces.
fn divide([from, to]: [(f64, RigidPose); 2], pose: &impl Fn(f64) -> RigidPose, length: f64, cut: &mut Vec<f64>) {
    let at = |share: f64| from.0 + (to.0 - from.0) * share;
    let is_straight = |share: f64| {
        let straight = RigidPose {
            rotation: from.1.rotation.slerp(to.1.rotation, share),
            translation: from.1.translation.lerp(to.1.translation, share),
        };
        let true_one = pose(at(share));
        let off = straight.rotation.inverse() * true_one.rotation;
        2.0 * off.xyz().length() <= ANGLE_RAD && straight.translation.distance(true_one.translation) <= length
    };
    if to.0 - from.0 <= SHORTEST_S || cut.len() > MOST_STATES || [0.25, 0.5, 0.75].into_iter().all(is_straight) {
        return;
    }
    let middle = (at(0.5), pose(at(0.5)));
    cut.push(middle.0);
    divide([from, middle], pose, length, cut);
    divide([middle, to], pose, length, cut);
}

/// The orthogonal matrix that is nearest to a matrix, by Newton's iteration; `None` where it is flat.
fn orthogonal(matrix: DMat3) -> Option<DMat3> {
    let determinant = matrix.determinant();
    let size = matrix.x_axis.length() * matrix.y_axis.length() * matrix.z_axis.length();
    if !(determinant.is_finite() && determinant.abs() > SINGULAR * size) {
        return None;
    }
    let mut factor = matrix * (1.0 / determinant.abs().cbrt());
    // It converges quadratically; axes whose lengths differ a millionfold take thirty steps.
    for _ in 0..64 {
        let next = (factor + factor.inverse().transpose()) * 0.5;
        let step = (next - factor).to_cols_array().iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        factor = next;
        if step <= 1e-15 {
            break;
        }
    }
    factor.is_finite().then_some(factor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DVec3;

    fn placed(angle: f64, scale: DVec3, x: f64) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(scale, DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, angle), DVec3::X * x)
    }

    /// Where the motion has the node at a moment that is one of its states.
    fn at(motion: &RigidMotion, time_s: f64) -> DAffine3 {
        let i = motion.states.0.iter().position(|t| *t == time_s).unwrap();
        let pose = motion.states.1[i];
        motion.parent_from_frame * DAffine3::from_rotation_translation(pose.rotation, pose.translation)
    }

    #[test]
    fn scales_stay_and_rotations_are_followed_whatever_the_handedness() {
        for scale in [DVec3::ONE, DVec3::new(2.0, 0.5, 3.0), DVec3::new(-1.0, 1.0, 2.0)] {
            let local = |time_s: f64, _: Side| placed(0.3 + time_s, scale, 2.0 * time_s);
            let rest = placed(0.3, scale, 0.0);
            let motion = rigid(rest, vec![0.0, 1.0], 1e-4, local).unwrap();
            // An even turn about the node's own origin is straight.
            assert_eq!((motion.states.0.as_slice(), motion.distorted_at_s, motion.is_rest()), (&[0.0, 1.0][..], None, false));
            let expected = placed(1.3, scale, 2.0) * rest.inverse();
            let found = at(&motion, 1.0) * at(&motion, 0.0).inverse();
            assert!(found.abs_diff_eq(expected, 1e-12), "{scale}: {found:?}");
        }
    }

    #[test]
    fn bent_ways_are_cut_until_they_are_straight() {
        // About a point a metre away, by 1.5 rad in one second.
        let local = |time_s: f64, _: Side| DAffine3::from_rotation_z(1.5 * time_s) * DAffine3::from_translation(DVec3::X);
        let motion = rigid(local(0.0, Side::After), vec![0.0, 1.0], 1e-4, local).unwrap();
        let (times_s, poses) = &motion.states;
        assert!((40..140).contains(&times_s.len()), "{} states", times_s.len());
        for i in 1..times_s.len() {
            let middle = 0.5 * (times_s[i - 1] + times_s[i]);
            let straight = poses[i - 1].translation.lerp(poses[i].translation, 0.5);
            let found = motion.parent_from_frame.transform_point3(straight);
            assert!(found.distance(local(middle, Side::After).translation) <= 1e-4);
        }
    }

    #[test]
    fn changing_scales_and_flat_rest_are_told() {
        let local = |time_s: f64, _: Side| placed(time_s, DVec3::new(1.0, 1.0, 1.0 + time_s), 0.0);
        let motion = rigid(local(0.0, Side::After), vec![0.0, 0.5], 1e-4, local).unwrap();
        assert_eq!(motion.distorted_at_s, Some(0.5));
        assert!(at(&motion, 0.5).abs_diff_eq(placed(0.5, DVec3::ONE, 0.0), 1e-12));
        assert!(rigid(placed(0.0, DVec3::new(1.0, 0.0, 1.0), 0.0), vec![0.0], 1e-4, local).err().unwrap().contains("flat"));
        let gone = |time_s: f64, _: Side| placed(0.0, DVec3::splat(1.0 - time_s), time_s);
        let motion = rigid(placed(0.0, DVec3::ONE, 0.0), vec![0.0, 1.0], 1e-4, gone).unwrap();
        assert_eq!(motion.distorted_at_s, Some(1.0));
    }
}
