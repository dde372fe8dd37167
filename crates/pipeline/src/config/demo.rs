//! What the demo makes unless told otherwise. Chosen so that all of it takes less than a minute on two cores.

/// Name of the demo's scene.
pub const SCENE: &str = "home";
/// Seed: a living room in the evening, whose lamps leave less noise in a minute than the sun does.
pub const SEED: u64 = 16;
/// The camera that the trajectory starts from; every home with a living room has it.
pub const CAMERA: &str = "living_1";
/// Frames of the trajectory.
pub const FRAMES: u32 = 4;
/// Image width and height.
pub const SIZE: [u32; 2] = [320, 240];
/// Samples per pixel.
pub const SAMPLES: u32 = 96;
