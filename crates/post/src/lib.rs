//! Labels, previews, verification and questions about finished frames.
//!
//! Everything here is a pure function of frames, labels and poses, but for [`drivers`], [`planview`], [`stats`] and
//! [`verify::verify_scene`], which run these over a dataset on disk.

pub mod animation;
pub mod boxes;
mod channels;
pub mod confusion;
mod drawing;
pub mod drivers;
pub mod exposure;
pub mod gates;
pub mod inspect;
pub mod instances;
pub mod label;
mod page;
pub mod palette;
pub mod picture;
pub mod planview;
pub mod preview;
pub mod sheet;
pub mod split;
mod statistics;
pub mod stats;
pub mod stretch;
#[cfg(test)]
mod testing;
pub mod tonemap;
pub mod verify;
pub mod view_gates;
