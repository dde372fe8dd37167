//! The instruction sets that the kernels are compiled for and run with.

#[cfg(target_arch = "x86_64")]
use super::simd::{Avx2, Avx512};
use super::simd::{Portable, Simd};

/// The instructions that the built-in network computes with. All give the same bytes.
#[derive(Clone, Copy)]
pub struct Instructions(Set);

#[derive(Clone, Copy)]
enum Set {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
}

/// Work that is compiled for each set of instructions. `TILES` tiles and `BLOCKS` blocks of output channels at a time leave its
/// registers room for their sums.
pub(super) trait Kernel: Sized {
    fn run<S: Simd, const TILES: usize, const BLOCKS: usize>(self, s: S);
}

impl Instructions {
    /// Sets of instructions that this processor has, the slowest first: at least one.
    pub fn available() -> Vec<Self> {
        let mut sets = vec![Set::Portable];
        #[cfg(target_arch = "x86_64")]
        {
            sets.extend(Avx2::detect().map(Set::Avx2));
            sets.extend(Avx512::detect().map(Set::Avx512));
        }
        sets.into_iter().map(Self).collect()
    }

    /// The fastest of them.
    pub fn best() -> Self {
        *Self::available().last().expect("every processor has the portable ones")
    }

    /// Name of the set: `portable`, `AVX2` or `AVX-512`.
    pub fn name(self) -> &'static str {
        match self.0 {
            Set::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Set::Avx2(_) => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Set::Avx512(_) => "AVX-512",
        }
    }

    /// `TILES` of a [`Kernel`].
    pub(super) fn tiles(self) -> usize {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Set::Avx512(_) => 14,
            _ => 6,
        }
    }

    /// `BLOCKS` of a [`Kernel`].
    pub(super) fn blocks(self) -> usize {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Set::Avx512(_) => 2,
            _ => 1,
        }
    }

    /// Number of tiles whose input of a layer stays in a core's cache.
    pub(super) fn tiles_at_a_time(self) -> usize {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Set::Avx512(_) => 28,
            _ => 24,
        }
    }

    /// Runs `kernel`, compiled for the instructions.
    pub(super) fn run(self, kernel: impl Kernel) {
        match self.0 {
            Set::Portable => kernel.run::<_, 6, 1>(Portable),
            #[cfg(target_arch = "x86_64")]
            // SAFETY: an `Avx2` exists only where the processor has it.
            Set::Avx2(s) => unsafe { avx2(kernel, s) },
            #[cfg(target_arch = "x86_64")]
            // SAFETY: an `Avx512` exists only where the processor has it.
            Set::Avx512(s) => unsafe { avx512(kernel, s) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn avx2(kernel: impl Kernel, s: Avx2) {
    kernel.run::<_, 6, 1>(s);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn avx512(kernel: impl Kernel, s: Avx512) {
    kernel.run::<_, 14, 2>(s);
}
