//! Fused multiplication where the processor has no instruction for it, by double precision.

/// a·b + c, rounded once to single precision: what `f32::mul_add` gives, several times as fast where that is a function of the C library.
///
/// The product is exact in double precision. The sum is rounded to odd (where it is not exact, to the neighbour whose last bit is 1),
/// after which rounding to single precision is as if it had been exact. Boldo and Melquiond 2008, "Emulation of FMA and Correctly
/// Rounded Sums: Proved Algorithms Using Rounding to Odd".
#[inline(always)]
pub(super) fn fma(a: f32, b: f32, c: f32) -> f32 {
    let (product, c) = (f64::from(a) * f64::from(b), f64::from(c));
    let sum = product + c;
    // What the sum lacks, exactly (Knuth's 2Sum).
    let rest = sum - product;
    let error = (product - (sum - rest)) + (c - rest);
    // One step toward the error where the last bit is 0; steps in the sum's bits go away from zero.
    let bits = sum.to_bits();
    let inexact = u64::from(error.abs() > 0.0) & !bits & 1;
    let toward_zero = (error.to_bits() ^ bits) >> 63;
    f64::from_bits(bits.wrapping_add(inexact).wrapping_sub(2 * (inexact & toward_zero))) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_fused(a: f32, b: f32, c: f32) {
        let (found, expected) = (fma(a, b, c), a.mul_add(b, c));
        assert!(
            found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan(),
            "{a:e}·{b:e} + {c:e}: {found:e}, not {expected:e}"
        );
    }

    #[test]
    fn it_is_what_the_platform_gives() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 32) as u32
        };
        for _ in 0..200_000 {
            // Any bits; numbers of like size; and sums that nearly cancel or are half-way between two numbers.
            let [a, b, c] = [random(), random(), random()].map(f32::from_bits);
            assert_fused(a, b, c);
            let [a, b, c] = [a, b, c].map(|value| f32::from_bits(value.to_bits() & 0x81ff_ffff | 0x3e00_0000));
            assert_fused(a, b, c);
            assert_fused(a, b, -(a * b));
            let half = f32::from_bits((a * b).abs().to_bits() & 0x7f80_0000) * 2f32.powi(-24);
            assert_fused(f32::from_bits(a.to_bits() & !0xfff), f32::from_bits(b.to_bits() & !0xfff), half);
            assert_fused(half, half, a);
        }
        let special = [0.0, -0.0, 1.0, f32::MAX, f32::MIN_POSITIVE, 1e-45, -1e-45, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
        for a in special {
            for b in special {
                special.iter().for_each(|&c| assert_fused(a, b, c));
            }
        }
    }
}
