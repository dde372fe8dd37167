//! How a camera moves, as an inertial measurement unit inside it would feel it.

use crate::Pose;
use enfilade_math::{DMat3, DQuat, DVec3};

/// Standard gravity, m/s² (3rd CGPM, 1901); it pulls along −z.
pub const GRAVITY_M_S2: f64 = 9.806_65;

/// Half of the time over which a curve is differentiated, seconds: rounding and curvature both stay below 10⁻⁶ m/s².
const STEP_S: f64 = 5e-4;

/// A camera's body: the axes of OpenCV, x to the right, y down, z ahead.
const BODY_FROM_OURS: DMat3 = DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z);

/// A moment of a camera's motion. Its body has the axes of OpenCV: x to the right, y down, z ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionSample {
    /// Since frame 0.
    pub time_s: f64,
    /// Where the camera is, world, metres.
    pub position: DVec3,
    /// Takes the body's axes to the world's; a unit quaternion with w ≥ 0.
    pub rotation: DQuat,
    /// World, m/s.
    pub velocity: DVec3,
    /// What an ideal gyroscope reads: about the body's axes, rad/s.
    pub angular_rate: DVec3,
    /// What an ideal accelerometer reads: acceleration less gravity, along the body's axes, m/s². At rest and level that is 9.80665 along −y.
    pub specific_force: DVec3,
}

impl MotionSample {
    /// The motion at a time of a camera whose pose is a smooth function of it, by central differences over a millisecond; `None` where it
    /// has no pose.
    ///
    /// ```
    /// use enfilade_math::DVec3;
    /// use enfilade_scene::{GRAVITY_M_S2, MotionSample, Pose};
    /// // Level, and faster and faster to its right: 2 m/s².
    /// let curve = |t: f64| Pose::look_at(0, DVec3::X * t * t, DVec3::X * t * t + DVec3::Y, DVec3::Z);
    /// let felt = MotionSample::of_curve(1.0, curve).unwrap();
    /// assert!(felt.specific_force.abs_diff_eq(DVec3::new(2.0, -GRAVITY_M_S2, 0.0), 1e-6));
    /// assert!(felt.velocity.abs_diff_eq(2.0 * DVec3::X, 1e-9) && felt.angular_rate.length() < 1e-9);
    /// ```
    pub fn of_curve(time_s: f64, pose: impl Fn(f64) -> Option<Pose>) -> Option<Self> {
        let [before, at, after] = [pose(time_s - STEP_S)?, pose(time_s)?, pose(time_s + STEP_S)?];
        let [from, rotation, to] = [before, at, after].map(|pose| body_rotation(&pose));
        let velocity = (after.position - before.position) / (2.0 * STEP_S);
        let acceleration = (after.position - 2.0 * at.position + before.position) / (STEP_S * STEP_S);
        let world_force = acceleration + GRAVITY_M_S2 * DVec3::Z;
        Some(Self {
            time_s,
            position: at.position,
            rotation,
            velocity,
            angular_rate: (from.inverse() * to).to_scaled_axis() / (2.0 * STEP_S),
            specific_force: rotation.inverse() * world_force,
        })
    }
}

/// Takes the axes of a camera's body to the world's; of the two quaternions that do, the one with w ≥ 0.
pub fn body_rotation(pose: &Pose) -> DQuat {
    let q = DQuat::from_mat3(&(pose.world_from_camera * BODY_FROM_OURS)).normalize();
    if q.w < 0.0 { -q } else { q }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_a_circle_the_camera_feels_its_turning_and_the_pull_to_the_middle() {
        let (radius, rate) = (2.0, 0.7);
        let curve = |t: f64| {
            let (sin, cos) = (rate * t).sin_cos();
            let p = radius * DVec3::new(cos, sin, 0.0);
            Pose::look_at(0, p, p + DVec3::new(-sin, cos, 0.0), DVec3::Z)
        };
        for time in [0.0, 0.4, 3.1, 8.0] {
            let felt = MotionSample::of_curve(time, curve).unwrap();
            // Ahead along the tangent, the middle to the left; down is +y, and the turn to the left is about −y.
            assert!(felt.angular_rate.abs_diff_eq(DVec3::new(0.0, -rate, 0.0), 1e-6), "{felt:?}");
            assert!(felt.specific_force.abs_diff_eq(DVec3::new(-radius * rate * rate, -GRAVITY_M_S2, 0.0), 1e-5), "{felt:?}");
            assert!((felt.rotation.inverse() * felt.velocity).abs_diff_eq(DVec3::new(0.0, 0.0, radius * rate), 1e-6), "{felt:?}");
        }
    }
}
