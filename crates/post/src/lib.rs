//! Labels, previews, verification and questions about finished frames.
//!
//! Everything here is a pure function of frames, labels and poses.

pub mod label;
pub mod palette;
pub mod picture;
pub mod preview;
pub mod sheet;
mod statistics;
pub mod tonemap;
