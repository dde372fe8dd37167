//! The law of motion: what an inertial measurement unit in the camera would read leads from each frame to the next.

use super::card::Card;
use super::law::Law;
use super::read::readable;
use enfilade_dataset::Dataset;
use enfilade_math::{DQuat, DVec3};
use enfilade_scene::{GRAVITY_M_S2, MotionSample, Pose, Trajectory, body_rotation};

/// A sample belongs to a frame when their times differ by less, seconds.
const SAME_TIME_S: f64 = 1e-6;

/// Checks the motion of a camera, where it is known.
pub(super) fn check(dataset: &Dataset, scene: &str, trajectory: &Trajectory, card: &mut Card) {
    let Some(motion) = readable(card, dataset.read_motion(scene, &trajectory.name)).filter(|motion| !motion.is_empty()) else { return };
    let Some(step_s) = readable(card, dataset.read_frame_time(scene, &trajectory.name)) else { return };
    let place = format!("{scene}/{}", trajectory.name);
    let sample_of = |pose: &Pose| {
        let time_s = f64::from(pose.frame) * step_s;
        let at = motion.partition_point(|sample| sample.time_s < time_s - SAME_TIME_S);
        motion.get(at).filter(|sample| (sample.time_s - time_s).abs() < SAME_TIME_S).map(|_| at)
    };
    let places: Vec<Option<usize>> = trajectory.poses.iter().map(sample_of).collect();
    for (pose, at) in trajectory.poses.iter().zip(&places) {
        let off = at.map_or(f64::INFINITY, |at| apart(&motion[at], pose.position, body_rotation(pose)));
        card.observe(Law::Motion, off, || format!("{place}/frame.{:04}: metadata_camera_motion.csv", pose.frame));
    }
    for pair in places.windows(2) {
        let [Some(from), Some(to)] = *pair else { continue };
        let (position, rotation) = integrate(&motion[from..=to]);
        let at = || format!("{place}: metadata_camera_motion.csv from {:.4} s on", motion[from].time_s);
        card.observe(Law::Motion, apart(&motion[to], position, rotation), at);
    }
}

/// How far a sample is from a pose: metres, or radians if that is more.
fn apart(sample: &MotionSample, position: DVec3, rotation: DQuat) -> f64 {
    sample.position.distance(position).max((sample.rotation.inverse() * rotation).to_scaled_axis().length())
}

/// Where the first of the samples and the readings from there on lead, both readings taken as even between samples (trapezoids).
fn integrate(samples: &[MotionSample]) -> (DVec3, DQuat) {
    let MotionSample { mut position, mut rotation, mut velocity, .. } = samples[0];
    for pair in samples.windows(2) {
        let step_s = pair[1].time_s - pair[0].time_s;
        let turned = rotation * DQuat::from_scaled_axis(0.5 * (pair[0].angular_rate + pair[1].angular_rate) * step_s);
        let pull = GRAVITY_M_S2 * DVec3::NEG_Z;
        let [a, b] = [rotation * pair[0].specific_force + pull, turned * pair[1].specific_force + pull];
        // Acceleration changes evenly from one to the other.
        position += velocity * step_s + (2.0 * a + b) * (step_s * step_s / 6.0);
        velocity += 0.5 * (a + b) * step_s;
        rotation = turned;
    }
    (position, rotation)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spiral with a turning view.
    fn curve(time_s: f64) -> Option<Pose> {
        let (sin, cos) = (0.6 * time_s).sin_cos();
        let position = DVec3::new(cos, sin, 0.1 * time_s) * (1.0 + 0.2 * time_s);
        Pose::look_at(0, position, position + DVec3::new(-sin, cos, 0.2 * (0.9 * time_s).sin()), DVec3::Z)
    }

    #[test]
    fn readings_lead_from_frame_to_frame_and_others_do_not() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = enfilade_testroom::dataset(folder.path());
        dataset.write_frame_time("room", "cam_00", 0.04).unwrap();
        let poses = (0..10).map(|frame| Pose { frame, ..curve(0.04 * f64::from(frame)).unwrap() }).collect();
        let trajectory = Trajectory { name: "cam_00".into(), poses };
        let motion: Vec<MotionSample> = (0..=72).filter_map(|k| MotionSample::of_curve(f64::from(k) * 0.005, curve)).collect();
        let worst = |motion: &[MotionSample]| {
            dataset.write_motion("room", "cam_00", motion).unwrap();
            let mut card = Card::default();
            check(&dataset, "room", &trajectory, &mut card);
            card.finding(Law::Motion).map(|found| found.value)
        };
        assert!(worst(&motion).unwrap() < 1e-5, "{:?}", worst(&motion));
        let changed = |change: fn(&mut MotionSample)| {
            let mut motion = motion.clone();
            motion.iter_mut().for_each(change);
            worst(&motion).unwrap()
        };
        let bound = Law::Motion.spec().bound;
        assert!(changed(|sample| sample.specific_force.y += 2.0) > bound);
        assert!(changed(|sample| sample.angular_rate.x += 0.1) > bound);
        assert!(changed(|sample| sample.position.z += 0.01) > bound);
        assert!(changed(|sample| sample.time_s += 0.001).is_infinite());
        assert_eq!(worst(&[]), None);
    }
}
