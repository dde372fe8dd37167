//! Labels, previews, verification and questions about finished frames.
//!
//! Everything here is a pure function of frames, labels and poses, but for [`drivers`], [`planview`] and [`verify::verify_dataset`],
//! which run these over a dataset on disk.

pub mod drivers;
pub mod inspect;
pub mod label;
pub mod palette;
pub mod picture;
pub mod planview;
pub mod preview;
pub mod sheet;
mod statistics;
#[cfg(test)]
mod testing;
pub mod tonemap;
pub mod verify;
