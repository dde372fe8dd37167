//! Simulation of real cameras and depth sensors from rendered frames.
//!
//! A rendered frame is what an ideal sensor sees. This crate turns finished frames into the readings of others: a [`CameraSensor`] with its
//! exposure, noise and tone curve, depth by [`TimeOfFlight`] and by [`Triangulation`] (structured light and stereo), and the beams of a
//! [`Lidar`]; of a video also an [`Imu`]. Nothing is rendered, and every effect is optional: a sensor with only its required keys returns
//! the stored truth, bit by bit.
//!
//! Every reading is a pure function of the sensor, the seed and the stored frame, so `verify` can make it again and compare.
//! [`sense`] does it for a dataset.

mod amount;
mod camera;
mod depth;
mod driver;
mod error;
mod imu;
mod lidar;
mod raw;
mod reading;
mod sensors;
mod time_of_flight;
mod triangulation;

pub use amount::Amount;
pub use camera::{CameraFormat, CameraSensor};
pub use depth::Glass;
pub use driver::{sense, sense_frames};
pub use error::SensorError;
pub use imu::Imu;
pub use lidar::Lidar;
pub use reading::{Data, Reading, Subject};
pub use sensors::{Kind, Sensor, Sensors};
pub use time_of_flight::TimeOfFlight;
pub use triangulation::Triangulation;
