//! Films of a camera's frames, as MP4 (H.264) or GIF.
//!
//! [`animate_camera`] runs over the frames of a dataset; [`Animation`] encodes a row of pictures of any origin. The pictures are those of
//! `enfilade-show`.

mod animation;
mod colors;
mod films;
mod format;
mod gif;
mod mp4;
#[cfg(test)]
mod tests;

pub use animation::Animation;
pub use films::{AnimateConfig, AnimateError, Animated, Film, NoFrames, animate_camera};
pub use format::{AnimationError, AnimationFormat};
