//! What the demo makes unless told otherwise. Chosen so that all of it takes less than a minute on two cores.

/// Name of the demo's scene.
pub const SCENE: &str = "home";
/// Seed: the low sun falls across a table in front of a sofa, and every view of the trajectory is composed.
pub const SEED: u64 = 2;
/// What is made of it: one room by day.
pub const HOME: &str = "{ rooms = [\"living\"], moment = \"day\" }";
/// The camera that the trajectory starts from; every home with a living room has it.
pub const CAMERA: &str = "living_1";
/// Frames of the trajectory.
pub const FRAMES: u32 = 4;
/// Image width and height.
pub const SIZE: [u32; 2] = [640, 480];
/// Samples per pixel.
pub const SAMPLES: u32 = 16;
