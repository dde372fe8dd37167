//! Gyms: machines to run and cycle on, weights, mats, mirrors.

mod machine;
mod weights;

pub use machine::{ExerciseBike, Treadmill};
pub use weights::{DumbbellRack, ExerciseBall, ExerciseMat, MirrorWall, WeightBench};
