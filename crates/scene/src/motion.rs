//! Motion of a camera, as measured by an inertial measurement unit inside it.

use crate::Pose;
use enfilade_math::{DMat3, DQuat, DVec3, NaturalSpline};

/// Standard gravity, m/s² (3rd CGPM, 1901); it pulls along −z.
pub const GRAVITY_M_S2: f64 = 9.806_65;

/// Half of the time over which a rotation is differentiated, seconds.
const STEP_S: f64 = 5e-4;

/// Samples a second, at least; between frames there is an equal number of them.
const RATE_HZ: f64 = 200.0;

/// Turns y and z around: our camera axes (x right, y up, z backward) to OpenCV's (x right, y down, z ahead) and back.
pub const OPENCV: DMat3 = DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z);

/// A moment of a camera's motion. Its body has the axes of OpenCV: x to the right, y down, z ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionSample {
    /// Since frame 0.
    pub time_s: f64,
    /// Position of the camera, world, metres.
    pub position: DVec3,
    /// Takes the body's axes to the world's; a unit quaternion with w ≥ 0.
    pub rotation: DQuat,
    /// World, m/s.
    pub velocity: DVec3,
    /// Reading of an ideal gyroscope: about the body's axes, rad/s.
    pub angular_rate: DVec3,
    /// Reading of an ideal accelerometer: acceleration less gravity, along the body's axes, m/s². At rest and level that is 9.80665 along
    /// −y.
    pub specific_force: DVec3,
}

/// The path of a camera through its frames: natural cubic splines in time through positions and, component by component, rotations.
/// Velocity and acceleration are continuous.
///
/// ```
/// use enfilade_math::DVec3;
/// use enfilade_scene::{GRAVITY_M_S2, Motion, Pose};
/// // At rest and level: the reading is the force of the ground that supports the camera.
/// let pose = |frame| Pose::look_at(frame, DVec3::Z, DVec3::Z + DVec3::Y, DVec3::Z).unwrap();
/// let motion = Motion::through(&[pose(0), pose(1)], 0.04).unwrap();
/// assert_eq!(motion.rate_hz(), 200.0);
/// assert!(motion.samples().all(|felt| felt.specific_force.abs_diff_eq(GRAVITY_M_S2 * DVec3::NEG_Y, 1e-9)));
/// ```
#[derive(Clone, Debug)]
pub struct Motion {
    /// Seconds.
    frame_time_s: f64,
    first: u32,
    last: u32,
    positions: NaturalSpline,
    /// Vector and scalar part of the unit quaternions, of which neighbours have one sign.
    vectors: NaturalSpline,
    scalars: NaturalSpline,
}

impl Motion {
    /// Through the poses of a trajectory, `frame_time_s` apart; `None` of none, and where their frames do not ascend. A single one is at rest.
    pub fn through(poses: &[Pose], frame_time_s: f64) -> Option<Self> {
        let (first, last) = (poses.first()?, poses.last()?);
        let knots = || poses.iter().map(|pose| f64::from(pose.frame) * frame_time_s).collect::<Vec<_>>();
        if !poses.windows(2).all(|pair| pair[0].frame < pair[1].frame) {
            return None;
        }
        let mut rotations: Vec<DQuat> = poses.iter().map(body_rotation).collect();
        for i in 1..rotations.len() {
            if rotations[i].dot(rotations[i - 1]) < 0.0 {
                rotations[i] = -rotations[i];
            }
        }
        Some(Self {
            frame_time_s,
            first: first.frame,
            last: last.frame,
            positions: NaturalSpline::new(knots(), poses.iter().map(|pose| pose.position).collect()),
            vectors: NaturalSpline::new(knots(), rotations.iter().map(|q| q.xyz()).collect()),
            scalars: NaturalSpline::new(knots(), rotations.iter().map(|q| DVec3::X * q.w).collect()),
        })
    }

    /// Samples from one frame to the next, chosen to give 200 a second or a little more.
    pub fn per_frame(&self) -> usize {
        (RATE_HZ * self.frame_time_s).ceil().max(1.0) as usize
    }

    /// Samples a second.
    pub fn rate_hz(&self) -> f64 {
        self.per_frame() as f64 / self.frame_time_s
    }

    /// The samples from a frame up to the next, of the last frame one; none of frames outside of the trajectory.
    pub fn from_frame(&self, frame: u32) -> Vec<MotionSample> {
        let count = match frame {
            frame if frame < self.first || frame > self.last => 0,
            frame if frame == self.last => 1,
            _ => self.per_frame(),
        };
        let step_s = self.frame_time_s / self.per_frame() as f64;
        let start_s = f64::from(frame) * self.frame_time_s;
        (0..count).map(|k| self.at(start_s + k as f64 * step_s)).collect()
    }

    /// All samples, from the first frame to the last.
    pub fn samples(&self) -> impl Iterator<Item = MotionSample> + '_ {
        (self.first..=self.last).flat_map(|frame| self.from_frame(frame))
    }

    /// The sample of a time.
    fn at(&self, time_s: f64) -> MotionSample {
        let rotation = self.rotation(time_s);
        let [velocity, acceleration] = self.positions.derivatives_at(time_s);
        let turn = self.rotation(time_s - STEP_S).inverse() * self.rotation(time_s + STEP_S);
        MotionSample {
            time_s,
            position: self.positions.at(time_s),
            rotation,
            velocity,
            angular_rate: upper(turn).to_scaled_axis() / (2.0 * STEP_S),
            specific_force: rotation.inverse() * (acceleration + GRAVITY_M_S2 * DVec3::Z),
        }
    }

    /// The body's rotation at a time.
    fn rotation(&self, time_s: f64) -> DQuat {
        let (vector, scalar) = (self.vectors.at(time_s), self.scalars.at(time_s).x);
        upper(DQuat::from_xyzw(vector.x, vector.y, vector.z, scalar).normalize())
    }
}

/// Takes the axes of a camera's body to the world's; of the two quaternions that do, the one with w ≥ 0.
fn body_rotation(pose: &Pose) -> DQuat {
    upper(DQuat::from_mat3(&(pose.world_from_camera * OPENCV)).normalize())
}

/// The quaternion with w ≥ 0 of the two that are the same rotation.
fn upper(q: DQuat) -> DQuat {
    if q.w < 0.0 { -q } else { q }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS_M: f64 = 2.0;
    const RATE: f64 = 0.7;

    /// On a circle, looking along it; the middle is to the left.
    fn poses(frames: u32, frame_time_s: f64) -> Vec<Pose> {
        let pose = |frame: u32| {
            let (sin, cos) = (RATE * f64::from(frame) * frame_time_s).sin_cos();
            let p = RADIUS_M * DVec3::new(cos, sin, 0.0);
            Pose::look_at(frame, p, p + DVec3::new(-sin, cos, 0.0), DVec3::Z).unwrap()
        };
        (0..frames).map(pose).collect()
    }

    #[test]
    fn on_a_circle_the_camera_feels_its_turning_and_the_pull_to_the_middle() {
        // Ten seconds, more than a whole turn. Natural splines are straight at their ends, which the first and last few frames show.
        let motion = Motion::through(&poses(240, 1.0 / 24.0), 1.0 / 24.0).unwrap();
        assert_eq!((motion.per_frame(), motion.rate_hz()), (9, 216.0));
        assert_eq!(motion.samples().count(), 239 * 9 + 1);
        for felt in (15..225).flat_map(|frame| motion.from_frame(frame)) {
            // The turn to the left is about up, and down is +y.
            assert!(felt.angular_rate.abs_diff_eq(DVec3::new(0.0, -RATE, 0.0), 1e-5), "{felt:?}");
            assert!(felt.specific_force.abs_diff_eq(DVec3::new(-RADIUS_M * RATE * RATE, -GRAVITY_M_S2, 0.0), 1e-3), "{felt:?}");
            assert!((felt.rotation.inverse() * felt.velocity).abs_diff_eq(DVec3::new(0.0, 0.0, RADIUS_M * RATE), 1e-5), "{felt:?}");
            assert!(felt.rotation.w >= 0.0);
        }
    }

    /// Trapezoids from sample to sample, as a program that is given the readings would.
    #[test]
    fn readings_lead_from_frame_to_frame() {
        let mut poses = poses(60, 0.04);
        for pose in &mut poses {
            pose.position.z += 0.3 * (0.2 * f64::from(pose.frame)).sin();
        }
        let motion = Motion::through(&poses, 0.04).unwrap();
        let samples: Vec<MotionSample> = motion.samples().collect();
        let pull = GRAVITY_M_S2 * DVec3::NEG_Z;
        for (first, pair) in samples.windows(motion.per_frame() + 1).step_by(motion.per_frame()).zip(poses.windows(2)) {
            let MotionSample { mut position, mut rotation, mut velocity, .. } = first[0];
            for two in first.windows(2) {
                let step_s = two[1].time_s - two[0].time_s;
                let turned = rotation * DQuat::from_scaled_axis(0.5 * (two[0].angular_rate + two[1].angular_rate) * step_s);
                let [a, b] = [rotation * two[0].specific_force + pull, turned * two[1].specific_force + pull];
                position += velocity * step_s + (2.0 * a + b) * (step_s * step_s / 6.0);
                velocity += 0.5 * (a + b) * step_s;
                rotation = turned;
            }
            assert!(position.distance(pair[1].position) < 1e-5, "{}", position.distance(pair[1].position));
            assert!(rotation.angle_between(body_rotation(&pair[1])) < 1e-5);
        }
    }

    #[test]
    fn frames_may_be_missing_but_not_out_of_order() {
        let whole = poses(30, 0.04);
        let some: Vec<Pose> = whole.iter().copied().filter(|pose| pose.frame % 3 != 1).collect();
        let motion = Motion::through(&some, 0.04).unwrap();
        let off = |pose: &Pose| motion.from_frame(pose.frame)[0].position.distance(pose.position);
        assert!(whole[10..20].iter().all(|pose| off(pose) < 1e-4) && some.iter().all(|pose| off(pose) < 1e-9));
        assert!(motion.from_frame(30).is_empty());
        assert!(Motion::through(&[], 0.04).is_none() && Motion::through(&[whole[1], whole[0]], 0.04).is_none());
        let still: Vec<MotionSample> = Motion::through(&whole[..1], 0.04).unwrap().samples().collect();
        assert!(still.len() == 1 && still[0].velocity == DVec3::ZERO);
    }
}
