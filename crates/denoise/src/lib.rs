//! The colour layers without noise, by the network of Open Image Denoise.
//!
//! Diffuse light and residual are denoised apart, guided by normals and by what is seen in mirrors and through glass, and put together with
//! the exact reflectance as the renderer puts them together. So texture never goes through the denoiser, and the identity is exact to the last bit.
//! [`denoise`] is a pure function of a frame and a filter; a [`Denoiser`] is the filter: the network in the binary, run by our own kernels
//! with the same bytes on every processor.
//!
//! ```
//! use enfilade_denoise::{DenoiseError, denoise};
//! use enfilade_frame::{Frame, Layer, Values, f16};
//!
//! // One pixel: light of 2 on a surface that reflects half of it, and 0.25 of other light.
//! let channels = |value: f32| Values::F16(vec![f16::from_f32(value); 3]);
//! let mut frame = Frame::new(1, 1);
//! frame.insert(Layer::DiffuseIllumination, channels(2.0));
//! frame.insert(Layer::Residual, channels(0.25));
//! frame.insert(Layer::DiffuseReflectance, channels(0.5));
//! frame.insert(Layer::NormalBumpWorld, channels(0.0));
//!
//! // With `let denoiser = Denoiser::built_in()`, the filter is `|noisy| denoiser.filter(noisy)`; this one changes nothing.
//! let denoised = denoise(&frame, |noisy| noisy.color.to_vec())?;
//! assert_eq!(denoised.get(Layer::Color).map(|color| color.get(0)), Some(0.5 * 2.0 + 0.25));
//! # Ok::<(), DenoiseError>(())
//! ```

mod denoiser;
mod error;
mod layers;
mod network;

pub use denoiser::Denoiser;
pub use error::DenoiseError;
pub use layers::{GUIDES, INPUTS, Noisy, denoise, inputs_of};
pub use network::Instructions;
