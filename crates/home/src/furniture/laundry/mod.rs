//! What washes, dries and cleans.

mod cleaning;
mod drying;
mod machine;

pub use cleaning::{Bucket, Vacuum};
pub use drying::{DryingRack, IroningBoard};
pub use machine::{LaundryMachine, WashingMachine};
