//! What real cameras and depth sensors would make of rendered frames.
//!
//! A rendered frame is what an ideal sensor sees. Here frames that are finished become what others would see: a [`CameraSensor`] with its
//! exposure, noise and tone curve, depth by [`TimeOfFlight`] and by [`Triangulation`] (structured light and stereo), and the beams of a
//! [`Lidar`]; of a video also an [`Imu`]. Nothing is rendered, and nothing is done that is not asked for: a sensor of which only what it
//! must have is told gives the stored truth back, bit by bit.
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
