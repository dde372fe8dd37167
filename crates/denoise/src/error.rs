//! Why denoising fails: the frame lacks a layer.

/// Why layers cannot be denoised.
#[derive(Debug, thiserror::Error)]
pub enum DenoiseError {
    /// A frame without a layer that is denoised or guides.
    #[error("the frame has no layer `{layer}`, which denoising needs; render it again")]
    MissingLayer {
        /// Name of the layer.
        layer: &'static str,
    },
}
