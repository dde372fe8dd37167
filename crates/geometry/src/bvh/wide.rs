//! Sixteen boxes at a time: two vectors of eight for AVX2 and the plain path, or one of AVX-512.

use super::lanes::{Eight, Lanes, Sixteen, lane_of};
use super::stack::Stack;

/// Sixteen `f32` values, and what the traversal does with the children of a node.
///
/// `min` and `max` return the second operand when one is NaN; comparisons with NaN are false.
pub(super) trait Wide: Copy {
    fn splat(value: f32) -> Self;
    fn load(values: &Sixteen<f32>) -> Self;
    fn store(self) -> Sixteen<f32>;
    fn add(self, o: Self) -> Self;
    fn sub(self, o: Self) -> Self;
    fn mul(self, o: Self) -> Self;
    fn min(self, o: Self) -> Self;
    fn max(self, o: Self) -> Self;
    fn le(self, o: Self) -> u32;
    fn lt(self, o: Self) -> u32;
    fn ne(self, o: Self) -> u32;
    fn div(self, o: Self) -> Self;

    /// The values of two eights, from wherever they are.
    fn of_halves(first: &[f32; 8], last: &[f32; 8]) -> Self;

    /// The size of `self` with the sign of `o`.
    fn copysign(self, o: Self) -> Self;

    /// Writes the lanes of `mask`, one after the other and bit by bit, from place `at` on, which is at most 16. The places beyond the last
    /// may be overwritten.
    fn compress(self, mask: u32, to: &mut [f32; 32], at: usize);

    /// The lanes of `mask` from `self`, bit by bit, the others from `other`.
    fn select(self, mask: u32, other: Self) -> Self;

    /// The smallest of the lanes, none of which may be NaN.
    fn min_lane(self) -> f32;

    /// Returns the nearest of two or more children that the ray enters at `self` and puts the others on the stack, the farthest first.
    fn push_by_distance(self, entered: u32, children: &Sixteen<u32>, stack: &mut Stack<'_>) -> u32;

    /// Returns the last of the children that the ray enters (at least one) and puts the others on the stack in their order.
    fn push_in_order(entered: u32, children: &Sixteen<u32>, stack: &mut Stack<'_>) -> u32;

    /// Drops what the ray enters beyond `limit`.
    fn retain(stack: &mut Stack<'_>, limit: f32);

    /// Asks for the line of memory at `place`, which may be read soon.
    fn prefetch(place: *const u8);
}

/// Two vectors of eight.
#[derive(Clone, Copy)]
pub(super) struct Pair<L>(L, L);

impl<L: Lanes> Wide for Pair<L> {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self(L::splat(value), L::splat(value))
    }
    #[inline(always)]
    fn load(values: &Sixteen<f32>) -> Self {
        let [first, last] = values.halves();
        Self(L::load(first), L::load(last))
    }
    #[inline(always)]
    fn store(self) -> Sixteen<f32> {
        Sixteen::of_halves([self.0.store(), self.1.store()])
    }
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self(self.0.add(o.0), self.1.add(o.1))
    }
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self(self.0.sub(o.0), self.1.sub(o.1))
    }
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self(self.0.mul(o.0), self.1.mul(o.1))
    }
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        Self(self.0.min(o.0), self.1.min(o.1))
    }
    #[inline(always)]
    fn max(self, o: Self) -> Self {
        Self(self.0.max(o.0), self.1.max(o.1))
    }
    #[inline(always)]
    fn le(self, o: Self) -> u32 {
        self.0.le(o.0) | self.1.le(o.1) << 8
    }
    #[inline(always)]
    fn lt(self, o: Self) -> u32 {
        self.0.lt(o.0) | self.1.lt(o.1) << 8
    }
    #[inline(always)]
    fn ne(self, o: Self) -> u32 {
        self.0.ne(o.0) | self.1.ne(o.1) << 8
    }
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        Self(self.0.div(o.0), self.1.div(o.1))
    }
    #[inline(always)]
    fn of_halves(first: &[f32; 8], last: &[f32; 8]) -> Self {
        Self(L::read(first), L::read(last))
    }
    #[inline(always)]
    fn copysign(self, o: Self) -> Self {
        Self(self.0.copysign(o.0), self.1.copysign(o.1))
    }
    #[inline(always)]
    fn compress(self, mut mask: u32, to: &mut [f32; 32], mut at: usize) {
        let values = self.store();
        while mask != 0 {
            to[at & 31] = values.0[lane_of(&mut mask)];
            at += 1;
        }
    }
    #[inline(always)]
    fn select(self, mask: u32, other: Self) -> Self {
        Self(self.0.select(mask, other.0), self.1.select(mask >> 8, other.1))
    }
    #[inline(always)]
    fn min_lane(self) -> f32 {
        let low = self.0.min(self.1).store().0;
        let low = [low[0].min(low[4]), low[1].min(low[5]), low[2].min(low[6]), low[3].min(low[7])];
        low[0].min(low[2]).min(low[1].min(low[3]))
    }

    #[inline(always)]
    fn push_by_distance(self, mut entered: u32, children: &Sixteen<u32>, stack: &mut Stack<'_>) -> u32 {
        let t: [Eight<f32>; 2] = [self.0.store(), self.1.store()];
        let at = |lane: usize| t[lane >> 3].0[lane & 7];
        let mut nearest = lane_of(&mut entered);
        let base = stack.len;
        while entered != 0 {
            let other = lane_of(&mut entered);
            let farther = if at(other) < at(nearest) { std::mem::replace(&mut nearest, other) } else { other };
            stack.insert(base, children.0[farther], at(farther));
        }
        children.0[nearest]
    }

    #[inline(always)]
    fn push_in_order(mut entered: u32, children: &Sixteen<u32>, stack: &mut Stack<'_>) -> u32 {
        let mut lane = lane_of(&mut entered);
        while entered != 0 {
            stack.push(children.0[lane], 0.0);
            lane = lane_of(&mut entered);
        }
        children.0[lane]
    }

    #[inline(always)]
    fn retain(stack: &mut Stack<'_>, limit: f32) {
        stack.retain_up_to(limit);
    }

    #[inline(always)]
    fn prefetch(_: *const u8) {}
}

#[cfg(target_arch = "x86_64")]
pub(super) use avx512::Avx512;

#[cfg(target_arch = "x86_64")]
mod avx512 {
    use super::{Sixteen, Stack, Wide};
    use std::arch::x86_64::*;

    /// One AVX-512 register.
    ///
    /// May only be used inside a function compiled with the features of `walk_avx512` that runs on a machine with them. That is the
    /// safety argument of each `unsafe` block.
    #[derive(Clone, Copy)]
    pub(in super::super) struct Avx512(__m512);

    impl Wide for Avx512 {
        #[inline(always)]
        fn splat(value: f32) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm512_set1_ps(value) })
        }
        #[inline(always)]
        fn load(values: &Sixteen<f32>) -> Self {
            // SAFETY: see the type; `Sixteen` is 64 bytes long and aligned to 64.
            Self(unsafe { _mm512_load_ps(values.0.as_ptr()) })
        }
        #[inline(always)]
        fn store(self) -> Sixteen<f32> {
            let mut out = Sixteen([0.0; 16]);
            // SAFETY: see the type; `Sixteen` is 64 bytes long and aligned to 64.
            unsafe { _mm512_store_ps(out.0.as_mut_ptr(), self.0) };
            out
        }
        #[inline(always)]
        fn add(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm512_add_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn sub(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm512_sub_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn mul(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm512_mul_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn min(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm512_min_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn max(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm512_max_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn le(self, o: Self) -> u32 {
            // SAFETY: see the type.
            u32::from(unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, o.0) })
        }
        #[inline(always)]
        fn lt(self, o: Self) -> u32 {
            // SAFETY: see the type.
            u32::from(unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, o.0) })
        }
        #[inline(always)]
        fn ne(self, o: Self) -> u32 {
            // SAFETY: see the type.
            u32::from(unsafe { _mm512_cmp_ps_mask::<_CMP_NEQ_UQ>(self.0, o.0) })
        }
        #[inline(always)]
        fn div(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm512_div_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn of_halves(first: &[f32; 8], last: &[f32; 8]) -> Self {
            // SAFETY: see the type. Of `loadu` compilers make two halves; see `Lanes::read`.
            unsafe {
                let (first, last) = (_mm256_lddqu_si256(first.as_ptr().cast()), _mm256_lddqu_si256(last.as_ptr().cast()));
                Self(_mm512_castsi512_ps(_mm512_inserti64x4::<1>(_mm512_castsi256_si512(first), last)))
            }
        }
        #[inline(always)]
        fn copysign(self, o: Self) -> Self {
            // SAFETY: see the type.
            unsafe {
                let sign = _mm512_set1_epi32(i32::MIN);
                let (size, of) = (_mm512_castps_si512(self.0), _mm512_castps_si512(o.0));
                Self(_mm512_castsi512_ps(_mm512_or_si512(_mm512_andnot_si512(sign, size), _mm512_and_si512(sign, of))))
            }
        }
        #[inline(always)]
        fn compress(self, mask: u32, to: &mut [f32; 32], at: usize) {
            assert!(at <= 16);
            // SAFETY: see the type; sixteen values fit from there on.
            unsafe { _mm512_storeu_ps(to.as_mut_ptr().add(at), _mm512_maskz_compress_ps(mask as u16, self.0)) };
        }
        #[inline(always)]
        fn select(self, mask: u32, other: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm512_mask_mov_ps(other.0, mask as u16, self.0) })
        }
        #[inline(always)]
        fn min_lane(self) -> f32 {
            // SAFETY: see the type.
            unsafe { _mm512_reduce_min_ps(self.0) }
        }

        /// Two, the usual case, are compared; up to eight go through a sorting network.
        ///
        /// The network sorts integers: the bits of the distance, whose four lowest are replaced by the lane. So distances that differ
        /// by less than 2⁻¹⁹ count as equal, and those below zero too, which costs nothing but order.
        #[inline(always)]
        fn push_by_distance(self, entered: u32, children: &Sixteen<u32>, stack: &mut Stack<'_>) -> u32 {
            const LANE: i32 = 15;
            let count = entered.count_ones() as usize;
            if count == 2 {
                // SAFETY: see the type.
                let (t, ids) = unsafe {
                    let t = _mm512_castps512_ps128(_mm512_maskz_compress_ps(entered as u16, self.0));
                    let ids = _mm512_maskz_compress_epi32(entered as u16, _mm512_load_si512(children.0.as_ptr().cast()));
                    ([_mm_cvtss_f32(t), _mm_cvtss_f32(_mm_movehdup_ps(t))], _mm_cvtsi128_si64(_mm512_castsi512_si128(ids)) as u64)
                };
                let (near, far, at) = if t[0] <= t[1] { (ids, ids >> 32, t[1]) } else { (ids >> 32, ids, t[0]) };
                stack.push(far as u32, at);
                return near as u32;
            }
            // SAFETY: see the type; the stack has room for sixteen entries beyond its last.
            unsafe {
                let lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
                let ids = _mm512_load_si512(children.0.as_ptr().cast());
                let bits = _mm512_max_epi32(_mm512_castps_si512(self.0), _mm512_setzero_si512());
                let keys = _mm512_or_si512(_mm512_and_si512(bits, _mm512_set1_epi32(!LANE)), lanes);
                let nowhere = _mm512_set1_epi32(-1);
                let mask = entered as u16;
                let nearest = lowest(_mm512_mask_mov_epi32(nowhere, mask, keys)) as i32 & LANE;
                // Complements, so that the farthest comes first and unused places last.
                let from_far = _mm512_mask_compress_epi32(nowhere, mask, _mm512_xor_si512(keys, nowhere));
                let sorted = if count <= 8 { _mm512_castsi256_si512(sort_8(_mm512_castsi512_si256(from_far))) } else { sort_16(from_far) };
                let order = _mm512_xor_si512(sorted, nowhere);
                let (places, distances) = (stack.children.as_mut_ptr().add(stack.len), stack.enter_at.as_mut_ptr().add(stack.len));
                _mm512_storeu_si512(places.cast(), _mm512_permutexvar_epi32(order, ids));
                _mm512_storeu_ps(distances.cast(), _mm512_permutexvar_ps(order, self.0));
                stack.len += count - 1;
                *children.0.get_unchecked(nearest as usize)
            }
        }

        #[inline(always)]
        fn push_in_order(entered: u32, children: &Sixteen<u32>, stack: &mut Stack<'_>) -> u32 {
            // SAFETY: see the type; the stack has room for sixteen entries beyond its last. `enter_at` is not read by those who push so,
            // and need not be initialised for `pop`.
            unsafe {
                let ids = _mm512_load_si512(children.0.as_ptr().cast());
                let places = stack.children.as_mut_ptr().add(stack.len);
                _mm512_storeu_si512(places.cast(), _mm512_maskz_compress_epi32(entered as u16, ids));
                stack.len += entered.count_ones() as usize - 1;
                *children.0.get_unchecked((31 - entered.leading_zeros()) as usize & 15)
            }
        }

        #[inline(always)]
        fn retain(stack: &mut Stack<'_>, limit: f32) {
            let mut kept = 0;
            let mut at = 0;
            // SAFETY: see the type; there is room for sixteen entries beyond the last, and what is read there is masked out.
            unsafe {
                let (children, enter_at) = (stack.children.as_mut_ptr().cast::<i32>(), stack.enter_at.as_mut_ptr().cast::<f32>());
                let limit = _mm512_set1_ps(limit);
                while at < stack.len {
                    let valid = if stack.len - at < 16 { (1 << (stack.len - at)) - 1 } else { u16::MAX };
                    let (t, ids) = (_mm512_loadu_ps(enter_at.add(at)), _mm512_loadu_si512(children.add(at).cast()));
                    let mask = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(valid, t, limit);
                    _mm512_storeu_ps(enter_at.add(kept), _mm512_maskz_compress_ps(mask, t));
                    _mm512_storeu_si512(children.add(kept).cast(), _mm512_maskz_compress_epi32(mask, ids));
                    kept += mask.count_ones() as usize;
                    at += 16;
                }
            }
            stack.len = kept;
        }

        #[inline(always)]
        fn prefetch(place: *const u8) {
            // SAFETY: see the type; asking for memory that does not exist does nothing.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(place.cast()) };
        }
    }

    /// The lowest of sixteen unsigned numbers.
    ///
    /// # Safety
    /// See [`Avx512`].
    #[inline(always)]
    unsafe fn lowest(v: __m512i) -> u32 {
        // SAFETY: the caller's.
        unsafe {
            let v = _mm256_min_epu32(_mm512_castsi512_si256(v), _mm512_extracti64x4_epi64::<1>(v));
            let v = _mm_min_epu32(_mm256_castsi256_si128(v), _mm256_extracti128_si256::<1>(v));
            let v = _mm_min_epu32(v, _mm_shuffle_epi32::<0b01_00_11_10>(v));
            let v = _mm_min_epu32(v, _mm_shuffle_epi32::<0b10_11_00_01>(v));
            _mm_cvtsi128_si32(v) as u32
        }
    }

    /// Sorts eight unsigned numbers: Batcher's bitonic network in the form whose comparisons all point one way.
    ///
    /// # Safety
    /// See [`Avx512`].
    #[inline(always)]
    unsafe fn sort_8(v: __m256i) -> __m256i {
        macro_rules! exchange {
            ($v:ident with $partner:expr, upper $upper:literal) => {{
                let partner = $partner;
                _mm256_blend_epi32::<$upper>(_mm256_min_epu32($v, partner), _mm256_max_epu32($v, partner))
            }};
        }
        // SAFETY: the caller's.
        unsafe {
            let v = exchange!(v with _mm256_shuffle_epi32::<0b10_11_00_01>(v), upper 0b1010_1010);
            let v = exchange!(v with _mm256_shuffle_epi32::<0b00_01_10_11>(v), upper 0b1100_1100);
            let v = exchange!(v with _mm256_shuffle_epi32::<0b10_11_00_01>(v), upper 0b1010_1010);
            let reverse = _mm256_setr_epi32(7, 6, 5, 4, 3, 2, 1, 0);
            let v = exchange!(v with _mm256_permutevar8x32_epi32(v, reverse), upper 0b1111_0000);
            let v = exchange!(v with _mm256_shuffle_epi32::<0b01_00_11_10>(v), upper 0b1100_1100);
            exchange!(v with _mm256_shuffle_epi32::<0b10_11_00_01>(v), upper 0b1010_1010)
        }
    }

    /// Sorts sixteen unsigned numbers, which is rarely needed.
    ///
    /// # Safety
    /// See [`Avx512`].
    #[cold]
    #[inline(never)]
    unsafe fn sort_16(v: __m512i) -> __m512i {
        let mut numbers = Sixteen([0u32; 16]);
        // SAFETY: the caller's; `Sixteen` is 64 bytes long and aligned to 64.
        unsafe {
            _mm512_store_si512(numbers.0.as_mut_ptr().cast(), v);
            numbers.0.sort_unstable();
            _mm512_load_si512(numbers.0.as_ptr().cast())
        }
    }
}
