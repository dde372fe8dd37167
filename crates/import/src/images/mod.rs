//! Pictures: PNG, JPEG, TIFF, WebP, GIF, BMP, TGA, DDS, KTX2, PNM, Radiance HDR, OpenEXR and PFM into [`Image`](enfilade_scene::Image).
//!
//! Of animations and files of several pictures the first one counts. Eight bits a channel stay eight bits; sixteen are rounded to eight;
//! floating-point pictures become linear RGB without alpha, in which a value that is not a number or below zero becomes 0 and an infinite
//! one the largest half float.

mod dds;
mod decode;
mod exr;
mod float_picture;
mod ktx2;
mod layout;
mod looks;
mod mean;
mod pfm;
mod tiff;

pub(crate) use decode::{Decoded, Use, decode};
pub use exr::{check_exr_blocks, check_exr_table};
pub(crate) use looks::{cuts_out, is_grey, is_opaque, looks_like_normals};
pub(crate) use mean::{mean, mean_color};
