//! Arithmetic on sixteen numbers at once, in the instructions that a processor has.
//!
//! All ways do the same: each operation rounds once, by IEEE 754, a multiplication and the addition after it together. So the
//! kernels, which are written once over [`Simd`], give the same bytes whichever way they are compiled for.

use super::block::{Block, LANES};
use super::fused::fma;

/// A set of instructions. A value of the type is proof that the processor has them.
pub(super) trait Simd: Copy + Send + Sync {
    /// Sixteen numbers in registers.
    type Lanes: Copy;

    fn load(self, from: &Block) -> Self::Lanes;
    fn store(self, value: Self::Lanes, to: &mut Block);
    fn splat(self, value: f32) -> Self::Lanes;
    fn add(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;
    fn sub(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;
    /// a·b + c, rounded once.
    fn fma(self, a: Self::Lanes, b: Self::Lanes, c: Self::Lanes) -> Self::Lanes;
    /// `a` where it is greater than `b`, else `b`.
    fn max(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;
}

/// Plain Rust, for every processor. Where every processor has fused multiply-add, as on 64-bit ARM, the compiler vectorises it; for x86
/// before 2013 it is emulated in double precision.
#[derive(Clone, Copy)]
pub(super) struct Portable;

impl Simd for Portable {
    type Lanes = [f32; LANES];

    #[inline(always)]
    fn load(self, from: &Block) -> Self::Lanes {
        from.0
    }

    #[inline(always)]
    fn store(self, value: Self::Lanes, to: &mut Block) {
        to.0 = value;
    }

    #[inline(always)]
    fn splat(self, value: f32) -> Self::Lanes {
        [value; LANES]
    }

    #[inline(always)]
    fn add(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes {
        std::array::from_fn(|i| a[i] + b[i])
    }

    #[inline(always)]
    fn sub(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes {
        std::array::from_fn(|i| a[i] - b[i])
    }

    #[inline(always)]
    fn fma(self, a: Self::Lanes, b: Self::Lanes, c: Self::Lanes) -> Self::Lanes {
        if cfg!(all(target_arch = "x86_64", not(target_feature = "fma"))) {
            std::array::from_fn(|i| fma(a[i], b[i], c[i]))
        } else {
            std::array::from_fn(|i| a[i].mul_add(b[i], c[i]))
        }
    }

    #[inline(always)]
    fn max(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes {
        std::array::from_fn(|i| if a[i] > b[i] { a[i] } else { b[i] })
    }
}

#[cfg(target_arch = "x86_64")]
pub(super) use x86::{Avx2, Avx512};

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{Block, Simd};
    use std::arch::x86_64::*;

    /// AVX2 and FMA, with two registers of eight numbers.
    #[derive(Clone, Copy)]
    pub struct Avx2(());

    /// The foundation of AVX-512.
    #[derive(Clone, Copy)]
    pub struct Avx512(());

    impl Avx2 {
        /// Where this processor has it.
        pub fn detect() -> Option<Self> {
            (is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")).then_some(Self(()))
        }
    }

    impl Avx512 {
        /// Where this processor has it.
        pub fn detect() -> Option<Self> {
            is_x86_feature_detected!("avx512f").then_some(Self(()))
        }
    }

    /// Methods of [`Avx2`], each an instruction on both halves.
    macro_rules! halves {
        ($($name:ident($($argument:ident),*) = $instruction:ident;)*) => {$(
            #[inline(always)]
            fn $name(self, $($argument: Self::Lanes),*) -> Self::Lanes {
                // SAFETY: `detect` alone makes an `Avx2`, where the processor has AVX2 and FMA.
                unsafe { ($instruction($($argument.0),*), $instruction($($argument.1),*)) }
            }
        )*};
    }

    impl Simd for Avx2 {
        type Lanes = (__m256, __m256);

        #[inline(always)]
        fn load(self, from: &Block) -> Self::Lanes {
            // SAFETY: as below; a block is 16 numbers, aligned to 64 bytes.
            unsafe { (_mm256_load_ps(from.0.as_ptr()), _mm256_load_ps(from.0.as_ptr().add(8))) }
        }

        #[inline(always)]
        fn store(self, value: Self::Lanes, to: &mut Block) {
            // SAFETY: as in `load`.
            unsafe {
                _mm256_store_ps(to.0.as_mut_ptr(), value.0);
                _mm256_store_ps(to.0.as_mut_ptr().add(8), value.1);
            }
        }

        #[inline(always)]
        fn splat(self, value: f32) -> Self::Lanes {
            // SAFETY: as below.
            let half = unsafe { _mm256_set1_ps(value) };
            (half, half)
        }

        halves! {
            add(a, b) = _mm256_add_ps;
            sub(a, b) = _mm256_sub_ps;
            fma(a, b, c) = _mm256_fmadd_ps;
            max(a, b) = _mm256_max_ps;
        }
    }

    /// Methods of [`Avx512`], each an instruction.
    macro_rules! whole {
        ($($name:ident($($argument:ident),*) = $instruction:ident;)*) => {$(
            #[inline(always)]
            fn $name(self, $($argument: Self::Lanes),*) -> Self::Lanes {
                // SAFETY: `detect` alone makes an `Avx512`, where the processor has it.
                unsafe { $instruction($($argument),*) }
            }
        )*};
    }

    impl Simd for Avx512 {
        type Lanes = __m512;

        #[inline(always)]
        fn load(self, from: &Block) -> Self::Lanes {
            // SAFETY: as below; a block is 16 numbers, aligned to 64 bytes.
            unsafe { _mm512_load_ps(from.0.as_ptr()) }
        }

        #[inline(always)]
        fn store(self, value: Self::Lanes, to: &mut Block) {
            // SAFETY: as in `load`.
            unsafe { _mm512_store_ps(to.0.as_mut_ptr(), value) }
        }

        #[inline(always)]
        fn splat(self, value: f32) -> Self::Lanes {
            // SAFETY: as below.
            unsafe { _mm512_set1_ps(value) }
        }

        whole! {
            add(a, b) = _mm512_add_ps;
            sub(a, b) = _mm512_sub_ps;
            fma(a, b, c) = _mm512_fmadd_ps;
            max(a, b) = _mm512_max_ps;
        }
    }
}
