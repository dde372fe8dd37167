//! Eight numbers at a time, twice: with AVX2, and in plain Rust for every other machine.
//!
//! Both kinds do the same IEEE operations in the same order, so the traversal gives the same bits wherever it runs. There is no
//! fused multiply-add among them: the edge functions must not use it (see `triangle`), and without it the plain kind needs no emulation.

/// Eight `f32` values.
///
/// `min` and `max` return the second operand when one is NaN, as the x86 instructions do. With NaN, `ne` is true, the others are false.
/// A comparison returns one bit per lane.
pub(super) trait Lanes: Copy {
    fn splat(value: f32) -> Self;
    fn load(values: &Eight<f32>) -> Self;
    /// From wherever they are.
    fn read(values: &[f32; 8]) -> Self;
    fn store(self) -> Eight<f32>;
    fn add(self, o: Self) -> Self;
    fn sub(self, o: Self) -> Self;
    fn mul(self, o: Self) -> Self;
    fn div(self, o: Self) -> Self;
    fn min(self, o: Self) -> Self;
    fn max(self, o: Self) -> Self;
    fn le(self, o: Self) -> u32;
    fn lt(self, o: Self) -> u32;
    fn ne(self, o: Self) -> u32;

    /// The size of `self` with the sign of `o`.
    fn copysign(self, o: Self) -> Self;

    /// The lanes of `mask`'s lowest eight bits from `self`, bit by bit, the others from `other`.
    fn select(self, mask: u32, other: Self) -> Self;
}

/// Eight values on one 32-byte boundary.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Eight<T>(pub [T; 8]);

/// Sixteen values on one 64-byte boundary.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sixteen<T>(pub [T; 16]);

impl Sixteen<f32> {
    /// The first and the last eight.
    #[inline(always)]
    pub fn halves(&self) -> [&Eight<f32>; 2] {
        let first = self.0.as_ptr().cast::<Eight<f32>>();
        // SAFETY: sixteen values are twice eight, and both halves are aligned to 32 bytes.
        unsafe { [&*first, &*first.add(1)] }
    }

    /// Joins two halves to sixteen values.
    #[inline(always)]
    pub fn of_halves([first, last]: [Eight<f32>; 2]) -> Self {
        let mut all = Self([0.0; 16]);
        all.0[..8].copy_from_slice(&first.0);
        all.0[8..].copy_from_slice(&last.0);
        all
    }
}

/// Takes the lowest lane out of a mask that is not empty.
#[inline(always)]
pub(super) fn lane_of(mask: &mut u32) -> usize {
    let lane = mask.trailing_zeros() as usize;
    *mask &= *mask - 1;
    lane & 15
}

/// The plain kind; compilers turn most of it into whatever vector instructions the target has.
#[derive(Clone, Copy)]
pub(super) struct Portable(Eight<f32>);

impl Portable {
    #[inline(always)]
    fn map2(self, o: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let mut out = self;
        for i in 0..8 {
            out.0.0[i] = f(self.0.0[i], o.0.0[i]);
        }
        out
    }

    #[inline(always)]
    fn mask(self, o: Self, f: impl Fn(f32, f32) -> bool) -> u32 {
        let mut bits = 0;
        for i in 0..8 {
            bits |= u32::from(f(self.0.0[i], o.0.0[i])) << i;
        }
        bits
    }
}

impl Lanes for Portable {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self(Eight([value; 8]))
    }
    #[inline(always)]
    fn load(values: &Eight<f32>) -> Self {
        Self(*values)
    }
    #[inline(always)]
    fn read(values: &[f32; 8]) -> Self {
        Self(Eight(*values))
    }
    #[inline(always)]
    fn store(self) -> Eight<f32> {
        self.0
    }
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.map2(o, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self.map2(o, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.map2(o, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        self.map2(o, |a, b| a / b)
    }
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        self.map2(o, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, o: Self) -> Self {
        self.map2(o, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn le(self, o: Self) -> u32 {
        self.mask(o, |a, b| a <= b)
    }
    #[inline(always)]
    fn lt(self, o: Self) -> u32 {
        self.mask(o, |a, b| a < b)
    }
    #[inline(always)]
    fn ne(self, o: Self) -> u32 {
        self.mask(o, |a, b| a != b)
    }
    #[inline(always)]
    fn copysign(self, o: Self) -> Self {
        self.map2(o, f32::copysign)
    }
    #[inline(always)]
    fn select(self, mask: u32, other: Self) -> Self {
        let mut out = other;
        for i in 0..8 {
            if mask >> i & 1 != 0 {
                out.0.0[i] = self.0.0[i];
            }
        }
        out
    }
}

#[cfg(target_arch = "x86_64")]
pub(super) use avx2::Avx2;

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::{Eight, Lanes};
    use std::arch::x86_64::*;

    /// One AVX register.
    ///
    /// May only be used inside a function compiled with `#[target_feature(enable = "avx2")]` that runs on a machine with AVX2: there,
    /// every method below is inlined to one instruction. That is the safety argument of each `unsafe` block.
    #[derive(Clone, Copy)]
    pub(in super::super) struct Avx2(__m256);

    impl Lanes for Avx2 {
        #[inline(always)]
        fn splat(value: f32) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_set1_ps(value) })
        }
        #[inline(always)]
        fn load(values: &Eight<f32>) -> Self {
            // SAFETY: see the type; `Eight` is 32 bytes long and aligned to 32.
            Self(unsafe { _mm256_load_ps(values.0.as_ptr()) })
        }
        #[inline(always)]
        fn read(values: &[f32; 8]) -> Self {
            // SAFETY: see the type. Of `loadu` compilers make two halves, which was faster on processors of 2011.
            Self(unsafe { _mm256_castsi256_ps(_mm256_lddqu_si256(values.as_ptr().cast())) })
        }
        #[inline(always)]
        fn store(self) -> Eight<f32> {
            let mut out = Eight([0.0; 8]);
            // SAFETY: see the type; `Eight` is 32 bytes long and aligned to 32.
            unsafe { _mm256_store_ps(out.0.as_mut_ptr(), self.0) };
            out
        }
        #[inline(always)]
        fn add(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_add_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn sub(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_sub_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn mul(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_mul_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn div(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_div_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn min(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_min_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn max(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_max_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn le(self, o: Self) -> u32 {
            // SAFETY: see the type.
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, o.0)) as u32 }
        }
        #[inline(always)]
        fn lt(self, o: Self) -> u32 {
            // SAFETY: see the type.
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, o.0)) as u32 }
        }
        #[inline(always)]
        fn ne(self, o: Self) -> u32 {
            // SAFETY: see the type.
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_NEQ_UQ>(self.0, o.0)) as u32 }
        }
        #[inline(always)]
        fn copysign(self, o: Self) -> Self {
            // SAFETY: see the type.
            unsafe {
                let sign = _mm256_set1_ps(-0.0);
                Self(_mm256_or_ps(_mm256_andnot_ps(sign, self.0), _mm256_and_ps(sign, o.0)))
            }
        }
        #[inline(always)]
        fn select(self, mask: u32, other: Self) -> Self {
            // SAFETY: see the type.
            unsafe {
                let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
                let chosen = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(mask as i32), bits), bits);
                Self(_mm256_blendv_ps(other.0, self.0, _mm256_castsi256_ps(chosen)))
            }
        }
    }
}
