//! Frames of a dataset as samples to train with.
//!
//! [`Samples`] is a list of frames, ours or those of Hypersim's release, with the layers that were asked for: chosen by scene, camera and
//! side of the split, cropped, resized and tone-mapped as [`Options`] say, with mask, K and pose. A sample is a function of (options, seed,
//! epoch, index) and of nothing else. [`Stream`] decodes samples ahead on several threads and gives them in order.
//!
//! [`NyuV2`] gives samples of the same kind from that dataset's published file.
//!
//! Nothing here keeps threads between calls but a [`Stream`], so a process may be forked while it holds [`Samples`].

pub mod confusion;
mod error;
mod nyuv2;
mod options;
mod resize;
mod sample;
mod samples;
mod stream;
mod tone;

pub use error::LoaderError;
pub use nyuv2::{NYU_LAYERS, NyuChoice, NyuClasses, NyuSplit, NyuV2, PUBLISHED_IMAGES, nyu13_of_nyu40, side_of};
pub use options::{Choice, Crop, CropPlace, Options};
pub use sample::{Image, Matrix3, Matrix4, Sample, Values};
pub use samples::{Place, Samples};
pub use stream::{Stream, shuffled};
