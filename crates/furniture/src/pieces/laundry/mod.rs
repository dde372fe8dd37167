//! The laundry: washing machines and dryers, drying racks, ironing boards, vacuum cleaners and buckets.

mod cleaning;
mod drying;
mod machine;

pub use cleaning::{Bucket, Vacuum};
pub use drying::{DryingRack, IroningBoard};
pub use machine::WashingMachine;
