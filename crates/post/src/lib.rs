//! Labels, previews, verification and questions about finished frames.
//!
//! Everything here is a pure function of frames, labels and poses, but for [`drivers`], [`planview`] and [`verify::verify_dataset`],
//! which run these over a dataset on disk.

pub mod boxes;
pub mod drivers;
pub mod inspect;
pub mod instances;
pub mod label;
pub mod palette;
pub mod picture;
pub mod planview;
pub mod preview;
pub mod sheet;
pub mod split;
mod statistics;
#[cfg(test)]
mod testing;
pub mod tonemap;
pub mod verify;
