//! From pixel samples to the stored colour layers.

use crate::budget::Estimate;
use crate::integrator::PixelSample;
use enfilade_frame::{compose, f16};
use enfilade_math::Rgb;

/// Sums of the samples of one pixel. Samples come from the reconstruction filter's distribution, so all weigh the same.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PixelSum {
    samples: u32,
    reflectance: Rgb,
    /// Sum of reflectance × illumination.
    diffuse: Rgb,
    illumination: Rgb,
    illumination_samples: u32,
    residual: Rgb,
    /// Sum of the squares of the samples' luminance.
    squares: f32,
}

/// The colour values of one pixel as they are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PixelColor {
    pub color: [f16; 3],
    pub illumination: [f16; 3],
    pub reflectance: [f16; 3],
    pub residual: [f16; 3],
    pub saturated: bool,
}

impl PixelSum {
    /// Adds a sample.
    pub fn add(&mut self, s: &PixelSample) {
        self.samples += 1;
        self.reflectance += s.reflectance;
        self.residual += s.residual;
        let luminance = (s.reflectance * s.illumination.unwrap_or_default() + s.residual).luminance();
        self.squares += luminance * luminance;
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
        let mean = (self.diffuse + self.residual).luminance() / n;
        Estimate { mean, variance: (self.squares / n - mean * mean).max(0.0) * n / (n - 1.0).max(1.0) }
    }

    /// The pixel's layers. The stored values satisfy color = reflectance × illumination + residual to the last bit: the first
    /// factors are rounded first and the sum is taken from the rounded values.
    pub fn resolve(&self) -> PixelColor {
        let n = self.samples.max(1) as f32;
        let reflectance = (self.reflectance / n).map(|v| v.clamp(0.0, 1.0));
        let diffuse = self.diffuse / n;
        let mean_illumination = self.illumination / self.illumination_samples.max(1) as f32;
        let residual = self.residual / n;
        let mut saturated = false;
        let mut out = PixelColor::default();
        for c in 0..3 {
            let a = f16::from_f32(reflectance[c]);
            let demodulated = if a > f16::ZERO { diffuse[c] / a.to_f32() } else { mean_illumination[c] };
            let stored = compose(a, demodulated, residual[c]);
            saturated |= stored.saturated;
            out.reflectance[c] = a;
            out.illumination[c] = stored.illumination;
            out.residual[c] = stored.residual;
            out.color[c] = stored.color;
        }
        out.saturated = saturated;
        out
    }
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
                sum.add(&PixelSample { reflectance, illumination: Some(rgb(1e5)), residual: rgb(3e4) });
            }
            identity_holds(&sum.resolve());
        }
    }

    #[test]
    fn an_edge_between_black_and_white_does_not_leak_into_the_residual() {
        let mut sum = PixelSum::default();
        sum.add(&PixelSample { reflectance: Rgb::WHITE, illumination: Some(Rgb::splat(2.0)), residual: Rgb::BLACK });
        sum.add(&PixelSample { reflectance: Rgb::BLACK, illumination: Some(Rgb::splat(7.0)), residual: Rgb::BLACK });
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
    fn values_beyond_half_precision_are_stored_at_the_limit_and_flagged() {
        let mut sum = PixelSum::default();
        sum.add(&PixelSample { reflectance: Rgb::splat(0.5), illumination: Some(Rgb::splat(60000.0)), residual: Rgb::splat(1e9) });
        let p = sum.resolve();
        identity_holds(&p);
        assert!(p.saturated && p.color[0].to_f32() > 65000.0);
    }
}
