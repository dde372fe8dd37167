//! Denoised companions of the noisy colour layers, by Open Image Denoise where it is installed.
//!
//! Diffuse light and residual are denoised apart, with the normals of the geometry pass as guides, and put together with the exact
//! reflectance as the renderer puts them together. So texture never goes through the denoiser, the identity holds to the last
//! bit, and the layers that were rendered stay as they are. [`denoise`] is a pure function of a frame and a filter; a
//! [`Denoiser`] is the filter. The library is loaded when a [`Denoiser`] is opened, and nothing else needs it.

mod denoiser;
mod error;
mod layers;
mod library;

pub use denoiser::Denoiser;
pub use error::DenoiseError;
pub use layers::{INPUTS, Noisy, denoise};
