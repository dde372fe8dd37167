//! The film: sums of a pixel's samples, and how they become the stored colour layers, in which reflectance × illumination + residual is
//! colour to the last bit.

use crate::budget::Estimate;
use crate::light_parts::LightParts;
use crate::pixel_sample::{FOLLOWED, PixelSample};
use enfilade_frame::{F16_LIMIT, compose, f16};
use enfilade_math::{Rgb, Vec3};

/// Sums of the samples of one pixel. Samples come from the reconstruction filter's distribution, so all weigh the same.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PixelSum {
    samples: u32,
    /// Sum of the reflectance, or of what is expected of it.
    reflectance: Rgb,
    /// Sum of reflectance × illumination.
    diffuse: Rgb,
    illumination: Rgb,
    illumination_samples: u32,
    residual: Rgb,
    /// Mean of the samples' luminance, and the sum of its squared deviations (Welford 1962): samples that are all alike have none,
    /// which sums of squares would lose in rounding.
    mean: f32,
    deviations: f32,
    normal: Vec3,
    /// Sums of what is seen in mirrors and through glass, over the samples that were followed there.
    normal_beyond: Vec3,
    reflectance_beyond: Rgb,
}

/// The stored guides of one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PixelGuides {
    pub normal: [f16; 3],
    pub normal_beyond: [f16; 3],
    pub reflectance_beyond: [f16; 3],
}

/// The stored colour values of one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PixelColor {
    pub color: [f16; 3],
    pub illumination: [f16; 3],
    pub reflectance: [f16; 3],
    pub residual: [f16; 3],
    /// Standard error of the luminance of `color`; NaN after one sample.
    pub standard_error: f16,
    pub saturated: bool,
}

impl PixelSum {
    /// Words of [`PixelSum::to_words`].
    pub const WORDS: usize = 25;

    /// Adds a sample.
    pub fn add(&mut self, s: &PixelSample) {
        self.samples += 1;
        self.normal += s.normal;
        if self.samples <= FOLLOWED {
            self.normal_beyond += s.beyond.normal;
            self.reflectance_beyond += s.beyond.reflectance;
        }
        self.reflectance += s.expected_reflectance.unwrap_or(s.reflectance);
        self.residual += s.residual;
        let luminance = (s.reflectance * s.illumination.unwrap_or_default() + s.residual).luminance();
        let off = luminance - self.mean;
        self.mean += off / self.samples as f32;
        self.deviations += off * (luminance - self.mean);
        if let Some(illumination) = s.illumination {
            self.diffuse += s.reflectance * illumination;
            self.illumination += illumination;
            self.illumination_samples += 1;
        }
    }

    /// Number of samples.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Mean and variance of the samples' luminance.
    pub fn estimate(&self) -> Estimate {
        let n = self.samples.max(1) as f32;
        Estimate { mean: (self.diffuse + self.residual).luminance() / n, variance: self.deviations / (n - 1.0).max(1.0) }
    }

    /// Standard error of the mean luminance, as if samples were independent; NaN if there are too few samples.
    pub fn standard_error(&self) -> f32 {
        if self.samples < 2 { f32::NAN } else { (self.estimate().variance / self.samples as f32).sqrt() }
    }

    /// The sums, bit by bit.
    pub fn to_words(self) -> [u32; Self::WORDS] {
        let mut words = [0; Self::WORDS];
        let colors = [self.reflectance, self.diffuse, self.illumination, self.residual].into_iter().flat_map(Rgb::to_array);
        let guides = [self.normal, self.normal_beyond].into_iter().flat_map(|v| v.to_array()).chain(self.reflectance_beyond.to_array());
        let floats = colors.chain([self.mean, self.deviations]).chain(guides).map(f32::to_bits);
        words.iter_mut().zip([self.samples, self.illumination_samples].into_iter().chain(floats)).for_each(|(word, bits)| *word = bits);
        words
    }

    /// The inverse of [`PixelSum::to_words`].
    pub fn from_words(words: &[u32; Self::WORDS]) -> Self {
        let float = |index: usize| f32::from_bits(words[index]);
        let color = |index: usize| Rgb::new(float(index), float(index + 1), float(index + 2));
        let vector = |index: usize| Vec3::new(float(index), float(index + 1), float(index + 2));
        Self {
            samples: words[0],
            illumination_samples: words[1],
            reflectance: color(2),
            diffuse: color(5),
            illumination: color(8),
            residual: color(11),
            mean: float(14),
            deviations: float(15),
            normal: vector(16),
            normal_beyond: vector(19),
            reflectance_beyond: color(22),
        }
    }

    /// The stored diffuse reflectance.
    fn stored_reflectance(&self) -> [f16; 3] {
        (self.reflectance / self.samples.max(1) as f32).to_array().map(|v| f16::from_f32(v.clamp(0.0, 1.0)))
    }

    /// The pixel's guides; without samples, those of the background.
    pub fn guides(&self) -> PixelGuides {
        let (all, followed) = (self.samples.max(1) as f32, self.samples.clamp(1, FOLLOWED) as f32);
        let reflectance = if self.samples == 0 { Rgb::WHITE } else { self.reflectance_beyond / followed };
        PixelGuides {
            normal: (self.normal / all).to_array().map(f16::from_f32),
            normal_beyond: (self.normal_beyond / followed).to_array().map(f16::from_f32),
            reflectance_beyond: reflectance.to_array().map(|v| f16::from_f32(v.clamp(0.0, 1.0))),
        }
    }

    /// The pixel's layers. The stored values satisfy color = reflectance × illumination + residual to the last bit: the first
    /// factors are rounded first and the sum is taken from the rounded values.
    pub fn resolve(&self) -> PixelColor {
        let n = self.samples.max(1) as f32;
        let reflectance = self.stored_reflectance();
        let diffuse = self.diffuse / n;
        let mean_illumination = self.illumination / self.illumination_samples.max(1) as f32;
        let residual = self.residual / n;
        let mut saturated = false;
        let mut out = PixelColor::default();
        for c in 0..3 {
            let a = reflectance[c];
            let demodulated = if a > f16::ZERO { diffuse[c] / a.to_f32() } else { mean_illumination[c] };
            let stored = compose(a, demodulated, residual[c] + beyond(diffuse[c], a));
            saturated |= stored.saturated;
            out.reflectance[c] = a;
            out.illumination[c] = stored.illumination;
            out.residual[c] = stored.residual;
            out.color[c] = stored.color;
        }
        let error = self.standard_error();
        out.standard_error = f16::from_f32(if error > F16_LIMIT { F16_LIMIT } else { error });
        out.saturated = saturated;
        out
    }
}

/// The stored parts of a pixel's light, given the sum over its samples and their number.
pub(crate) fn resolve_light_parts(sum: &LightParts, samples: u32) -> [[f16; 3]; LightParts::PARTS] {
    let n = samples.max(1) as f32;
    std::array::from_fn(|index| (sum.part(index) / n).to_array().map(|v| f16::from_f32(v.min(F16_LIMIT))))
}

/// The part of a pixel's diffuse light beyond its stored reflectance times the brightest illumination; it is added to the residual.
fn beyond(diffuse: f32, reflectance: f16) -> f32 {
    (diffuse - reflectance.to_f32() * F16_LIMIT).max(0.0)
}

/// The stored light of a fixture: its part of the illumination and of the residual, given the sums of reflectance × illumination and
/// of the residual over the pixel's samples.
///
/// Where the reflectance is zero the illumination is zero. Light that it cannot represent is in the residual.
pub(crate) fn resolve_fixture(pixel: &PixelSum, [diffuse, residual]: [Rgb; 2]) -> [[f16; 3]; 2] {
    let n = pixel.samples.max(1) as f32;
    let mut stored = [[f16::ZERO; 3]; 2];
    for (c, a) in pixel.stored_reflectance().into_iter().enumerate() {
        let diffuse = diffuse[c] / n;
        let illumination = if a > f16::ZERO { diffuse / a.to_f32() } else { 0.0 };
        stored[0][c] = f16::from_f32(illumination.min(F16_LIMIT));
        stored[1][c] = f16::from_f32((residual[c] / n + beyond(diffuse, a)).min(F16_LIMIT));
    }
    stored
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identity_holds(p: &PixelColor) {
        for c in 0..3 {
            let recomposed = f16::from_f32(p.reflectance[c].to_f32() * p.illumination[c].to_f32() + p.residual[c].to_f32());
            assert_eq!(recomposed, p.color[c]);
            assert!(p.color[c].is_finite());
        }
    }

    #[test]
    fn identity_holds_in_stored_bits() {
        let mut rng = enfilade_math::Rng::new(1);
        for _ in 0..20_000 {
            let mut sum = PixelSum::default();
            for _ in 0..3 {
                let mut rgb = |scale: f32| Rgb::new(rng.next_f32().powi(4), rng.next_f32(), rng.next_f32()) * scale;
                let reflectance = rgb(1.0);
                sum.add(&PixelSample { reflectance, illumination: Some(rgb(1e5)), residual: rgb(3e4), ..PixelSample::default() });
            }
            identity_holds(&sum.resolve());
        }
    }

    fn lit(luminance: f32) -> PixelSample {
        PixelSample { residual: Rgb::splat(luminance), ..PixelSample::default() }
    }

    #[test]
    fn the_standard_error_of_samples_of_two_kinds_is_that_of_a_coin() {
        // A fraction p of ones: variance p(1 - p) n/(n - 1), and the mean of n has an n-th of it.
        for (ones, n) in [(1u32, 2u32), (16, 64), (1, 1000), (512, 1024)] {
            let mut sum = PixelSum::default();
            (0..n).for_each(|i| sum.add(&lit(if i < ones { 1.0 } else { 0.0 })));
            let p = f64::from(ones) / f64::from(n);
            let expected = (p * (1.0 - p) / f64::from(n - 1)).sqrt();
            let found = f64::from(sum.standard_error());
            assert!((found - expected).abs() < 1e-4 * expected, "{ones} of {n}: {found}, expected {expected}");
            assert!((sum.resolve().standard_error.to_f64() - expected).abs() < 1e-3 * expected);
        }
    }

    #[test]
    fn equal_samples_have_no_error_and_a_single_one_has_none_that_is_known() {
        let mut sum = PixelSum::default();
        sum.add(&lit(0.1));
        assert!(sum.standard_error().is_nan() && sum.resolve().standard_error.is_nan());
        (0..500).for_each(|_| sum.add(&lit(0.1)));
        assert_eq!(sum.resolve().standard_error, f16::ZERO);
    }

    #[test]
    fn sums_survive_as_words() {
        let mut sum = PixelSum::default();
        let color = |v: f32| Rgb::new(v, 2.0 * v, 3.0 * v);
        let sample =
            PixelSample { reflectance: color(0.1), illumination: Some(color(5.0)), residual: color(7.0), ..PixelSample::default() };
        sum.add(&sample);
        sum.add(&lit(11.0));
        assert_eq!(PixelSum::from_words(&sum.to_words()), sum);
        assert_eq!(PixelSum::from_words(&std::array::from_fn(|i| i as u32)).to_words(), std::array::from_fn(|i| i as u32));
    }

    #[test]
    fn an_edge_between_black_and_white_does_not_leak_into_the_residual() {
        let mut sum = PixelSum::default();
        sum.add(&PixelSample {
            reflectance: Rgb::WHITE,
            illumination: Some(Rgb::splat(2.0)),
            residual: Rgb::BLACK,
            ..PixelSample::default()
        });
        sum.add(&PixelSample {
            reflectance: Rgb::BLACK,
            illumination: Some(Rgb::splat(7.0)),
            residual: Rgb::BLACK,
            ..PixelSample::default()
        });
        let p = sum.resolve();
        assert_eq!((p.reflectance[0].to_f32(), p.illumination[0].to_f32(), p.residual[0].to_f32()), (0.5, 2.0, 0.0));
    }

    #[test]
    fn without_reflectance_the_illumination_is_the_mean_of_what_was_measured() {
        let mut sum = PixelSum::default();
        sum.add(&PixelSample { illumination: Some(Rgb::splat(3.0)), ..PixelSample::default() });
        sum.add(&PixelSample::default());
        assert_eq!(sum.resolve().illumination[1].to_f32(), 3.0);
    }

    #[test]
    fn light_of_fixtures_sums_to_the_pixel_and_what_illumination_cannot_hold_is_residual() {
        let mut sum = PixelSum::default();
        let reflectance = Rgb::new(0.5, 1e-6, 0.0);
        sum.add(&PixelSample { reflectance, illumination: Some(Rgb::splat(7.0)), residual: Rgb::splat(0.25), ..PixelSample::default() });
        let [illumination, residual] = resolve_fixture(&sum, [Rgb::new(1.5, 1.0, 0.0), Rgb::splat(0.25)]).map(|part| part.map(f16::to_f32));
        assert_eq!((illumination[0], residual[0], illumination[2], residual[2]), (3.0, 0.25, 0.0, 0.25));
        assert_eq!(illumination[1], F16_LIMIT);
        let a = f16::from_f32(1e-6).to_f32();
        assert!((a * illumination[1] + residual[1] - 1.25).abs() < 1e-3, "{residual:?}");
    }

    #[test]
    fn light_of_what_is_hardly_there_is_not_lost() {
        for expected in [1e-3, 1e-6, 1e-8] {
            let (reflectance, illumination) = (Rgb::splat(0.5), Some(Rgb::splat(4.0)));
            let mut sum = PixelSum::default();
            let expected_reflectance = Some(Rgb::splat(expected));
            sum.add(&PixelSample { reflectance, expected_reflectance, illumination, ..PixelSample::default() });
            sum.add(&PixelSample { expected_reflectance, ..PixelSample::default() });
            let p = sum.resolve();
            identity_holds(&p);
            assert!((p.color[0].to_f32() - 1.0).abs() < 1e-3, "{expected}: {p:?}");
        }
    }

    #[test]
    fn values_beyond_half_precision_are_stored_at_the_limit_and_flagged() {
        let mut sum = PixelSum::default();
        sum.add(&PixelSample {
            reflectance: Rgb::splat(0.5),
            illumination: Some(Rgb::splat(60000.0)),
            residual: Rgb::splat(1e9),
            ..PixelSample::default()
        });
        let p = sum.resolve();
        identity_holds(&p);
        assert!(p.saturated && p.color[0].to_f32() > 65000.0);
    }
}
