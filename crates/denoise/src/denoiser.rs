//! The denoiser: the network in the binary, or the library where it is installed.

use crate::installed::Installed;
use crate::network::{Instructions, NAME, Network};
use crate::{DenoiseError, Noisy};
use std::path::Path;
use std::sync::{Arc, LazyLock};

/// What takes noise away from pictures. Both kinds compute the same network and differ in the last bits alone.
pub struct Denoiser(Kind);

enum Kind {
    BuiltIn(Arc<Network>),
    Installed(Installed),
}

impl Denoiser {
    /// The network in the binary, which needs nothing installed. It works on the threads of the rayon pool in which
    /// [`Self::filter`] is called, and gives the same bytes on every processor and any number of threads. The first of a process takes some
    /// hundredths of a second, and all of them together 65 MB of memory.
    pub fn built_in() -> Self {
        static NETWORK: LazyLock<Arc<Network>> = LazyLock::new(|| Arc::new(Network::new(Instructions::best())));
        Self(Kind::BuiltIn(NETWORK.clone()))
    }

    /// The built-in denoiser with instructions of choice, for tests and measurements.
    pub fn built_in_with(instructions: Instructions) -> Self {
        Self(Kind::BuiltIn(Arc::new(Network::new(instructions))))
    }

    /// Loads the library from `place` (its file, or the folder that it lies in; `None`: where the system's loader looks) and
    /// prepares it for `threads` threads, whose number changes no byte of what it makes. On Windows its folder must be in `PATH`
    /// too, where the system looks for the libraries that it needs itself.
    ///
    /// # Errors
    /// When it is not there, is not version 2, or the processor is not supported.
    pub fn open(place: Option<&Path>, threads: usize) -> Result<Self, DenoiseError> {
        Installed::open(place, threads).map(|installed| Self(Kind::Installed(installed)))
    }

    /// Name and version, as they stand in records: `Open Image Denoise 2.5.1`, or
    /// `built-in (rt_hdr_calb_cnrm_large of Open Image Denoise 2)`.
    pub fn name(&self) -> String {
        match &self.0 {
            Kind::BuiltIn(_) => NAME.into(),
            Kind::Installed(installed) => installed.name(),
        }
    }

    /// Denoises one picture of any size: the filter for ray-traced pictures of high dynamic range, with guides that are taken to be
    /// free of noise. The result is linear.
    ///
    /// The network in the binary takes any values: what is not a number or is negative counts as 0, what is infinite as the greatest
    /// number, and guides are brought to their range. It gives finite numbers that are not negative. Of pictures of more than 2048
    /// pixels a side it filters parts at a time, so that memory stays below 1.3 GB.
    ///
    /// # Errors
    /// With the library's own, such as too little memory. The network in the binary has none.
    ///
    /// # Panics
    /// When a picture is not three values per pixel.
    pub fn filter(&self, noisy: &Noisy<'_>) -> Result<Vec<f32>, DenoiseError> {
        match &self.0 {
            Kind::BuiltIn(network) => Ok(network.filter(noisy)),
            Kind::Installed(installed) => installed.filter(noisy),
        }
    }
}
