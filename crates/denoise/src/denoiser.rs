//! The denoiser: the network in the binary.

use crate::Noisy;
use crate::network::{Instructions, NAME, Network};
use std::sync::{Arc, LazyLock};

/// A filter that removes noise from pictures.
pub struct Denoiser(Arc<Network>);

impl Denoiser {
    /// The network in the binary, which needs nothing installed. It works on the threads of the rayon pool in which
    /// [`Self::filter`] is called, and gives the same bytes on every processor and any number of threads. The first of a process takes some
    /// hundredths of a second, and all of them together 65 MB of memory.
    pub fn built_in() -> Self {
        static NETWORK: LazyLock<Arc<Network>> = LazyLock::new(|| Arc::new(Network::new(Instructions::best())));
        Self(NETWORK.clone())
    }

    /// The built-in denoiser with instructions of choice, for tests and measurements.
    pub fn built_in_with(instructions: Instructions) -> Self {
        Self(Arc::new(Network::new(instructions)))
    }

    /// Name of the network, as it is written in records: `built-in (rt_hdr_calb_cnrm_large of Open Image Denoise 2)`.
    pub fn name(&self) -> String {
        NAME.into()
    }

    /// Denoises one picture of any size: the filter for ray-traced pictures of high dynamic range, with guides that are taken to be
    /// free of noise. The result is linear.
    ///
    /// Any values are taken: what is not a number or is negative counts as 0, what is infinite as the greatest number, and guides are brought
    /// to their range. The result has finite numbers that are not negative. Pictures of more than 2048 pixels a side are filtered in parts, so
    /// that memory stays below 1.3 GB.
    ///
    /// # Panics
    /// When a picture is not three values per pixel.
    pub fn filter(&self, noisy: &Noisy<'_>) -> Vec<f32> {
        self.0.filter(noisy)
    }
}
