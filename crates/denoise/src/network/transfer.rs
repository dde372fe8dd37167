//! The transfer function from radiance to the network's values, and back: exposure and a curve of perceptual uniformity.
//!
//! The fit of the PU2 curve (Aydın et al. 2008, "Extending Quality Metrics to Full Luminance Range Images") that the published
//! network was trained with: linear, then a power, then a logarithm. Logarithm and exponential are our own, so that every platform
//! rounds them alike; they err by less than 10⁻¹⁰, which is far below the precision of 32 bits.

use crate::Noisy;
use rayon::prelude::*;

/// The three parts of the curve: slope; factor, power and offset; factor, shift and offset of the logarithm.
const SLOPE: f64 = 1.41283765e+03;
const POWER: [f64; 3] = [1.64593172e+00, 4.31384981e-01, -2.94139609e-03];
const LOG: [f64; 3] = [1.92653254e-01, 6.26026094e-03, 9.98620152e-01];
/// Radiances at which the parts of the curve meet, and its values there.
const RADIANCE: [f64; 2] = [1.57945760e-06, 3.22087631e-02];
const VALUE: [f64; 2] = [2.23151711e-03, 3.70974749e-01];
/// The radiance that the network sees as 1: the greatest of 16 bits.
const GREATEST: f64 = 65504.0;

/// Share that the mean (of logarithms) of a picture is brought to.
const KEY: f64 = 0.18;
/// Luminance below which a part of the picture is black, and does not count.
const BLACK: f64 = 1e-8;
/// Greatest side in pixels of the parts whose mean luminances count.
const PART: usize = 16;

/// The curve from radiance to the network's values, by which the picture's exposure has been multiplied.
#[derive(Clone, Copy, Debug)]
pub(super) struct Transfer {
    exposure: f32,
    /// The curve at [`GREATEST`].
    top: f64,
}

impl Transfer {
    /// For a picture, by the mean logarithm of the luminances of its parts. What is not a number, or negative, counts as 0.
    pub fn new(noisy: &Noisy<'_>) -> Self {
        let parts = Parts::of(noisy);
        let logarithms: Vec<f64> = (0..parts.rows * parts.columns)
            .into_par_iter()
            .filter_map(|index| {
                let luminance = parts.luminance(index);
                (luminance > BLACK).then(|| log(luminance))
            })
            .collect();
        let mean = logarithms.iter().sum::<f64>() / logarithms.len() as f64;
        let exposure = if logarithms.is_empty() { 1.0 } else { (KEY / exp(mean)) as f32 };
        Self { exposure, top: curve(GREATEST) }
    }

    /// The network's value for a radiance, which is first clamped to the non-negative finite range of 32 bits; 0 for NaN.
    pub fn encode(self, radiance: f32) -> f32 {
        (curve(within(radiance * self.exposure, 0.0, f32::MAX).into()) / self.top) as f32
    }

    /// The radiance for a value of the network.
    pub fn decode(self, value: f32) -> f32 {
        let x = f64::from(within(value, 0.0, f32::MAX)) * self.top;
        let radiance = if x <= VALUE[0] {
            x / SLOPE
        } else if x <= VALUE[1] {
            exp(log((x - POWER[2]) / POWER[0]) / POWER[1])
        } else {
            exp((x - LOG[2]) / LOG[0]) - LOG[1]
        };
        (radiance / f64::from(self.exposure)).min(f64::from(f32::MAX)) as f32
    }
}

/// A number clamped to a range that contains 0; 0 for NaN.
pub(super) fn within(value: f32, least: f32, most: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value.clamp(least, most) }
}

fn curve(radiance: f64) -> f64 {
    if radiance <= RADIANCE[0] {
        SLOPE * radiance
    } else if radiance <= RADIANCE[1] {
        POWER[0] * exp(log(radiance) * POWER[1]) + POWER[2]
    } else {
        LOG[0] * log(radiance + LOG[1]) + LOG[2]
    }
}

/// A picture in parts of nearly equal size.
struct Parts<'a> {
    noisy: &'a Noisy<'a>,
    columns: usize,
    rows: usize,
}

impl<'a> Parts<'a> {
    fn of(noisy: &'a Noisy<'a>) -> Self {
        let [columns, rows] = [noisy.width, noisy.height].map(|length| (length as usize).div_ceil(PART));
        Self { noisy, columns, rows }
    }

    /// Mean luminance of a part.
    fn luminance(&self, index: usize) -> f64 {
        let (width, height) = (self.noisy.width as usize, self.noisy.height as usize);
        let (column, row) = (index % self.columns, index / self.columns);
        let x = column * width / self.columns..(column + 1) * width / self.columns;
        let y = row * height / self.rows..(row + 1) * height / self.rows;
        let count = x.len() * y.len();
        let pixels = y.flat_map(|y| self.noisy.color[3 * (y * width + x.start)..3 * (y * width + x.end)].chunks_exact(3));
        let sane = |value| f64::from(within(value, 0.0, f32::MAX));
        pixels.map(|c| 0.212671 * sane(c[0]) + 0.715160 * sane(c[1]) + 0.072169 * sane(c[2])).sum::<f64>() / count as f64
    }
}

/// The natural logarithm of a positive number in the range of 32 bits.
fn log(x: f64) -> f64 {
    // x = m·2ᵉ with m within a factor √2 of 1; ln m = 2 artanh s.
    let bits = x.to_bits().wrapping_sub(std::f64::consts::FRAC_1_SQRT_2.to_bits());
    let exponent = (bits as i64) >> 52;
    let m = f64::from_bits(x.to_bits().wrapping_sub((exponent as u64) << 52));
    let s = (m - 1.0) / (m + 1.0);
    let q = s * s;
    let series = 1.0 + q * (1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + q * (1.0 / 9.0 + q * (1.0 / 11.0 + q / 13.0)))));
    2.0 * s * series + exponent as f64 * std::f64::consts::LN_2
}

/// The exponential of a number, which is first clamped to [−700, 700].
fn exp(x: f64) -> f64 {
    let x = x.clamp(-700.0, 700.0);
    // x = k ln 2 + r with r within ±(ln 2)/2.
    let k = (x * std::f64::consts::LOG2_E + 0.5).floor();
    let r = x - k * std::f64::consts::LN_2;
    let mut series = 0.0;
    for share in SHARES {
        series = share + r * series;
    }
    series * f64::from_bits(((k as i64 + 1023) as u64) << 52)
}

/// 1/n! for n from 11 down to 0.
const SHARES: [f64; 12] = {
    let mut shares = [1.0; 12];
    let mut n = 1;
    while n < 12 {
        shares[11 - n] = shares[12 - n] / n as f64;
        n += 1;
    }
    shares
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithm_and_exponential_agree_with_the_platforms() {
        for i in -1400..=1280 {
            let x = 2f64.powf(f64::from(i) / 10.0) * 1.01;
            assert!((log(x) - x.ln()).abs() < 1e-10 * x.ln().abs().max(1.0), "ln {x}: {} and {}", log(x), x.ln());
            let y = f64::from(i) / 20.0;
            assert!((exp(y) / y.exp() - 1.0).abs() < 1e-10, "exp {y}");
        }
        assert_eq!((log(1.0), exp(0.0)), (0.0, 1.0));
    }

    #[test]
    fn decoding_undoes_encoding_in_all_three_parts() {
        for exposure in [0.01, 1.0, 300.0] {
            let transfer = Transfer { exposure, top: curve(GREATEST) };
            for i in 0..120 {
                let radiance = 1e-7 * 1.25f32.powi(i) / exposure;
                let back = transfer.decode(transfer.encode(radiance));
                assert!((back / radiance - 1.0).abs() < 3e-5, "{radiance} became {back}");
            }
        }
    }

    #[test]
    fn a_picture_of_one_radiance_is_exposed_to_the_key_and_a_black_one_as_it_is() {
        let of = |color: &[f32]| Transfer::new(&Noisy { width: 5, height: 1, color, albedo: color, normal: color }).exposure;
        assert!((of(&[0.5; 15]) - 0.36).abs() < 1e-6);
        assert_eq!(of(&[0.0; 15]), 1.0);
        assert_eq!(of(&[f32::NAN; 15]), 1.0);
        assert!(of(&[f32::INFINITY; 15]) > 0.0);
    }

    #[test]
    fn what_is_not_a_radiance_becomes_one() {
        let transfer = Transfer { exposure: 2.0, top: curve(GREATEST) };
        assert_eq!([f32::NAN, -1.0, f32::NEG_INFINITY, 0.0].map(|value| transfer.encode(value)), [0.0; 4]);
        assert!(transfer.encode(f32::INFINITY).is_finite() && transfer.decode(1e9).is_finite());
        assert_eq!(transfer.decode(f32::NAN), 0.0);
    }
}
