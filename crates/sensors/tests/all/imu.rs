//! Inertial measurement units on the curve of a video.

use crate::common::{camera, refused, sensor};
use enfilade_frame::Frame;
use enfilade_math::DVec3;
use enfilade_scene::{Motion, MotionSample, Pose};
use enfilade_sensors::{Data, Subject};

const FRAME_TIME_S: f64 = 0.04;
const PER_FRAME: usize = 8;

/// A camera that looks ahead on a circle.
fn motion(frames: u32) -> Motion {
    let pose = |frame: u32| {
        let (sin, cos) = (0.5 * FRAME_TIME_S * f64::from(frame)).sin_cos();
        let p = DVec3::new(cos, sin, 1.5);
        Pose::look_at(frame, p, p + DVec3::new(-sin, cos, 0.1), DVec3::Z).unwrap()
    };
    Motion::through(&(0..frames).map(pose).collect::<Vec<_>>(), FRAME_TIME_S).unwrap()
}

/// Readings of a unit from a frame on: rows of time, rates and forces.
fn read(text: &str, motion: &Motion, number: u32) -> Vec<[f64; 7]> {
    let (projection, frame) = (camera(), Frame::new(0, 0));
    let subject = Subject { scene: "room", camera: "cam_00", number, projection: &projection, frame: &frame, motion: Some(motion) };
    let Data::File { name: "imu.csv", bytes } = sensor(text).sense(&subject).unwrap().data else { panic!("no table") };
    let row = |line: &str| -> [f64; 7] { line.split(',').map(|v| v.parse().unwrap()).collect::<Vec<_>>().try_into().unwrap() };
    String::from_utf8(bytes).unwrap().lines().skip(1).map(row).collect()
}

#[test]
fn an_ideal_unit_reads_the_motion_to_the_bit_and_each_sample_once() {
    let motion = motion(5);
    let rows: Vec<[f64; 7]> = (0..5u32).flat_map(|number| read("[[imu]]\nname = \"ideal\"", &motion, number)).collect();
    assert_eq!((rows.len(), motion.per_frame()), (4 * PER_FRAME + 1, PER_FRAME));
    for (row, sample) in rows.iter().zip(motion.samples()) {
        let expected: Vec<f64> =
            [sample.time_s].into_iter().chain(sample.angular_rate.to_array()).chain(sample.specific_force.to_array()).collect();
        assert_eq!(row.as_slice(), expected);
    }
}

#[test]
fn noise_has_its_density_and_biases_wander_as_far_as_said() {
    let frames = 400;
    let motion = motion(frames as u32);
    let rate_hz = PER_FRAME as f64 / FRAME_TIME_S;
    let errors = |text: &str| -> Vec<[f64; 7]> {
        let rows: Vec<[f64; 7]> = (0..frames as u32).flat_map(|number| read(text, &motion, number)).collect();
        let ideal = |s: &MotionSample| {
            [s.time_s, s.angular_rate.x, s.angular_rate.y, s.angular_rate.z, s.specific_force.x, s.specific_force.y, s.specific_force.z]
        };
        rows.iter().zip(motion.samples()).map(|(row, sample)| std::array::from_fn(|i| row[i] - ideal(&sample)[i])).collect()
    };
    let deviation = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    let of = |rows: &[[f64; 7]], columns: std::ops::Range<usize>| {
        rows.iter().flat_map(|row| row[columns.clone()].to_vec()).collect::<Vec<f64>>()
    };

    // 3,193 samples on three axes: 1 % is one standard deviation of what is measured.
    let noisy = errors("[[imu]]\nname = \"a\"\ngyroscope_noise = 0.002\naccelerometer_noise = 0.02");
    let expected = [0.002 * rate_hz.sqrt(), 0.02 * rate_hz.sqrt()];
    assert!((deviation(&of(&noisy, 1..4)) / expected[0] - 1.0).abs() < 0.04);
    assert!((deviation(&of(&noisy, 4..7)) / expected[1] - 1.0).abs() < 0.04);

    // Steps of the bias from sample to sample, across the borders of frames too.
    let wandering = errors("[[imu]]\nname = \"a\"\ngyroscope_walk = 0.001\naccelerometer_bias = 0.1");
    let steps: Vec<f64> = wandering.windows(2).flat_map(|pair| [1, 2, 3].map(|i| pair[1][i] - pair[0][i])).collect();
    assert!((deviation(&steps) / (0.001 / rate_hz.sqrt()) - 1.0).abs() < 0.04);
    // A bias that does not wander is the same everywhere.
    let first = &wandering[0][4..7];
    assert!(
        first.iter().all(|v| v.abs() > 1e-6) && wandering.iter().all(|row| row[4..7].iter().zip(first).all(|(a, b)| (a - b).abs() < 1e-9))
    );
}

#[test]
fn what_is_wrong_is_told() {
    let (projection, frame) = (camera(), Frame::new(0, 0));
    let subject = Subject { scene: "room", camera: "cam_00", number: 3, projection: &projection, frame: &frame, motion: None };
    let message = sensor("[[imu]]\nname = \"a\"").sense(&subject).unwrap_err().to_string();
    assert!(message.contains("room/cam_00/frame.0003") && message.contains("kind = \"video\""), "{message}");
    let message = refused("[[imu]]\nname = \"a\"\ngyroscope_noise = -1.0");
    assert!(message.contains("gyroscope_noise = -1: expected a number from 0 on"), "{message}");
}
