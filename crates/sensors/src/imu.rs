//! Inertial measurement units: gyroscope and accelerometer with white noise and wandering biases, as Kalibr and OpenVINS model them.
//!
//! A reading is `angular rate + bias + noise`, `specific force + bias + noise`, for each axis by itself. Noise of density σ has the standard
//! deviation σ √rate; a bias begins at a normal deviate and wanders by steps of standard deviation σ_walk / √rate (Brownian motion).

use crate::SensorError;
use crate::reading::{Data, Reading, Subject};
use enfilade_math::{DVec3, Rng};
use enfilade_scene::MotionSample;
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// An inertial measurement unit in the camera: `[[imu]]`. What is not given is 0, so that the unit is ideal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Imu {
    /// Name of its folder.
    pub name: String,
    /// Noise density of the gyroscope, rad/s/√Hz.
    pub gyroscope_noise: f64,
    /// How its bias wanders, rad/s²/√Hz.
    pub gyroscope_walk: f64,
    /// Standard deviation of its bias at frame 0, rad/s.
    pub gyroscope_bias: f64,
    /// Noise density of the accelerometer, m/s²/√Hz.
    pub accelerometer_noise: f64,
    /// How its bias wanders, m/s³/√Hz.
    pub accelerometer_walk: f64,
    /// Standard deviation of its bias at frame 0, m/s².
    pub accelerometer_bias: f64,
}

impl Imu {
    /// Checks every key.
    pub(crate) fn check(&self) -> Result<(), String> {
        let keys = [
            ("gyroscope_noise", self.gyroscope_noise),
            ("gyroscope_walk", self.gyroscope_walk),
            ("gyroscope_bias", self.gyroscope_bias),
            ("accelerometer_noise", self.accelerometer_noise),
            ("accelerometer_walk", self.accelerometer_walk),
            ("accelerometer_bias", self.accelerometer_bias),
        ];
        match keys.iter().find(|(_, value)| !(value.is_finite() && *value >= 0.0)) {
            Some((key, value)) => Err(format!("{key} = {value}: expected a number from 0 on")),
            None => Ok(()),
        }
    }

    /// The readings from a frame up to the next.
    pub(crate) fn sense(&self, subject: &Subject<'_>, seed: u64) -> Result<Reading, SensorError> {
        let motion = subject.motion.ok_or_else(|| {
            let problem =
                "it is of no video, so how its camera moves is not known; plan with mode = { kind = \"video\" }, or choose others";
            subject.unseen(&self.name, problem.into())
        })?;
        let rate_hz = motion.rate_hz();
        // The biases before this frame follow from the random numbers of the frames before.
        let rng = |number: u32| subject.rng(seed, &self.name, number);
        let mut bias = self.first_bias(&mut rng(u32::MAX));
        let wanders = self.gyroscope_walk > 0.0 || self.accelerometer_walk > 0.0;
        for before in (0..subject.number).filter(|_| wanders) {
            let mut rng = rng(before);
            for _ in 0..motion.per_frame() {
                self.step(&mut rng, rate_hz, &mut bias);
            }
        }
        let (mut rng, first) = (rng(subject.number), bias);
        let mut text = format!("{HEADER}\n");
        for sample in motion.from_frame(subject.number) {
            let [turn_noise, force_noise] = self.step(&mut rng, rate_hz, &mut bias);
            let MotionSample { time_s, angular_rate, specific_force, .. } = sample;
            let (w, a) = (angular_rate + bias[0] + turn_noise, specific_force + bias[1] + force_noise);
            let _ = writeln!(text, "{time_s},{},{},{},{},{},{}", w.x, w.y, w.z, a.x, a.y, a.z);
        }
        let names = ["gyroscope_bias_x", "gyroscope_bias_y", "gyroscope_bias_z"];
        let others = ["accelerometer_bias_x", "accelerometer_bias_y", "accelerometer_bias_z"];
        let drawn = names.into_iter().zip(first[0].to_array()).chain(others.into_iter().zip(first[1].to_array()));
        Ok(Reading { drawn: drawn.collect(), data: Data::File { name: "imu.csv", bytes: text.into_bytes() } })
    }

    fn first_bias(&self, rng: &mut Rng) -> [DVec3; 2] {
        [self.gyroscope_bias, self.accelerometer_bias].map(|deviation| deviation * normal(rng))
    }

    /// Lets the biases wander by one sample, and draws its noise. The same random numbers are drawn for all settings.
    fn step(&self, rng: &mut Rng, rate_hz: f64, bias: &mut [DVec3; 2]) -> [DVec3; 2] {
        let root = rate_hz.sqrt();
        let noise = [self.gyroscope_noise, self.accelerometer_noise].map(|density| density * root * normal(rng));
        let walk = [self.gyroscope_walk, self.accelerometer_walk].map(|density| density / root * normal(rng));
        bias.iter_mut().zip(walk).for_each(|(bias, step)| *bias += step);
        noise
    }
}

/// The first line of a reading: seconds since frame 0, rad/s and m/s² along OpenCV's axes of the camera.
const HEADER: &str = "time_s,angular_rate_x,angular_rate_y,angular_rate_z,specific_force_x,specific_force_y,specific_force_z";

fn normal(rng: &mut Rng) -> DVec3 {
    DVec3::new(rng.normal(), rng.normal(), rng.normal())
}
