//! Why denoising fails: the library is not there or not the right one, it fails itself, or the frame lacks a layer.

use std::path::PathBuf;

/// Why layers cannot be denoised.
#[derive(Debug, thiserror::Error)]
pub enum DenoiseError {
    /// No library under any of the names.
    #[error("Open Image Denoise was not found; tried {}", tried.join("; "))]
    NotFound {
        /// Each name or path with the system's answer.
        tried: Vec<String>,
    },
    /// A statically linked program, which could load a C library that is not only by chance.
    #[error("this program is linked statically and cannot load the library of Open Image Denoise")]
    Static,
    /// A library without a function that we need.
    #[error("{} is not Open Image Denoise 2: it has no function `{function}`", library.display())]
    Function {
        /// What was loaded.
        library: PathBuf,
        /// The function.
        function: &'static str,
    },
    /// Another major version.
    #[error("{} is Open Image Denoise {found}; expected version 2", library.display())]
    Version {
        /// What was loaded.
        library: PathBuf,
        /// Version of the library, as in `1.4.3`.
        found: String,
    },
    /// The library's own error.
    #[error("Open Image Denoise: {message} ({kind})")]
    Library {
        /// Words of the library.
        message: String,
        /// The kind of error.
        kind: &'static str,
    },
    /// A frame without a layer that is denoised or guides.
    #[error("the frame has no layer `{layer}`, which denoising needs; render it again")]
    MissingLayer {
        /// Name of the layer.
        layer: &'static str,
    },
}
