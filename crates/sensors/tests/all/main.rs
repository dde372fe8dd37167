//! Sensors before frames whose answer is known.

mod camera;
mod common;
mod depth;
mod imu;
