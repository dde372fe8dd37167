//! Allocation of samples: to each pixel in proportion to the error that it would have left.
//!
//! The error of a pixel is estimated from the first samples of the pixels *around* it. Its own samples do not influence their number. So
//! the mean of a pixel stays unbiased; it would be biased if a dark first sample could prevent further samples (Kirk & Arvo 1991, "Unbiased
//! sampling techniques for image synthesis").
//!
//! The estimate of the noise from the first samples is not exact, and the allocated samples leave somewhat more noise than predicted. So
//! the remaining noise is measured once they are taken, and while it is above its target, [`Budget::more`] adds samples. There a pixel's
//! own samples matter only as a small part of the whole picture's noise.

use enfilade_frame::NOISE_FLOOR;

/// A pixel's error is estimated from its neighbours within this many rows and columns.
const REACH: usize = 3;
/// No pixel gets more than this many times the mean number of samples.
const MAX_RATIO: f32 = 16.0;
/// Further samples aim for this fraction of the noise target: a smaller reduction would not be worth another round.
const BELOW_TARGET: f64 = 0.985;

/// Statistics of the luminance of a pixel's samples.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Estimate {
    /// Mean luminance of its samples.
    pub mean: f32,
    /// Variance of one sample's luminance.
    pub variance: f32,
}

/// How a frame's samples are allocated to its pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget {
    /// Samples that every pixel has already.
    pub first: u32,
    /// Mean over the image of the samples wanted in the end; an upper bound when there is a noise target.
    pub mean: u32,
    /// Noise target: see [`crate::RenderConfig::noise`].
    pub noise: Option<f32>,
}

impl Budget {
    /// The number of samples of every pixel, row by row.
    pub fn allocate(&self, width: usize, estimates: &[Estimate]) -> Vec<u32> {
        let errors = errors(width, estimates);

        // Without a usable total error, either the picture is clean or nothing is known.
        let total: f64 = errors.iter().sum();
        if !(total > 0.0 && total.is_finite()) {
            let is_clean = total == 0.0 && self.noise.is_some();
            return vec![if is_clean { self.first } else { self.mean }; errors.len()];
        }
        let taken = vec![self.first; errors.len()];
        self.spread(&errors, &taken, self.noise.map(f64::from))
    }

    /// The number of samples of every pixel, row by row, after `taken` samples left the noise `measured`, which is above its target. `None`
    /// if no more can be taken, or nothing indicates where.
    pub fn more(&self, width: usize, estimates: &[Estimate], taken: &[u32], measured: f64) -> Option<Vec<u32>> {
        let errors = errors(width, estimates);
        // The ratio of the noise estimated from neighbouring pixels to the measured noise hardly changes with further samples.
        let told = (errors.iter().zip(taken).map(|(e, &n)| e * e / f64::from(n)).sum::<f64>() / errors.len() as f64).sqrt();
        let target = BELOW_TARGET * f64::from(self.noise?) * told / measured;
        if !(target > 0.0 && target.is_finite()) {
            return None;
        }
        let wanted = self.spread(&errors, taken, Some(target));
        (wanted != taken).then_some(wanted)
    }

    /// Distributes samples over pixels of these errors, in addition to `taken`, up to the mean number or until at most `noise` is left.
    ///
    /// The variance that is left, Σ e²/n, has its minimum for a given number of samples where n is in proportion to e: this finds the
    /// factor of proportion.
    fn spread(&self, errors: &[f64], taken: &[u32], noise: Option<f64>) -> Vec<u32> {
        let max = MAX_RATIO * self.mean as f32;
        let count = errors.len() as f64;
        let samples = |e: f64, taken: u32, scale: f64| (e * scale).clamp(f64::from(taken), f64::from(max).max(f64::from(taken)));
        let sum = |value: &dyn Fn(f64, f64) -> f64, scale: f64| -> f64 {
            errors.iter().zip(taken).map(|(&e, &n)| value(e, samples(e, n, scale))).sum()
        };
        let for_mean = bisect(count * f64::from(self.mean), |scale| sum(&|_, n| n, scale));
        let scale = noise.map_or(for_mean, |target| bisect(-count * target * target, |scale| -sum(&|e, n| e * e / n, scale)).min(for_mean));
        errors.iter().zip(taken).map(|(&e, &n)| samples(e, n, scale).round() as u32).collect()
    }
}

/// The error of one sample in each pixel, row by row, estimated from the pixels around it.
fn errors(width: usize, estimates: &[Estimate]) -> Vec<f64> {
    let height = estimates.len() / width.max(1);
    let mean = estimates.iter().map(|e| f64::from(e.mean)).sum::<f64>() / estimates.len().max(1) as f64;
    let floor = NOISE_FLOOR as f32 * mean as f32;
    let around = |p: usize| f64::from(error_around(estimates, [width, height], [p % width, p / width], floor));
    enfilade_parallel::map_up_to(estimates.len(), around)
}

/// Root mean square, over the pixels around one, of a sample's standard deviation in relation to luminance.
fn error_around(estimates: &[Estimate], [width, height]: [usize; 2], [x, y]: [usize; 2], floor: f32) -> f32 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for ny in y.saturating_sub(REACH)..height.min(y + REACH + 1) {
        for nx in x.saturating_sub(REACH)..width.min(x + REACH + 1) {
            if [nx, ny] == [x, y] {
                continue;
            }
            let near = 1.0 / (nx.abs_diff(x).pow(2) + ny.abs_diff(y).pow(2)) as f32;
            let e = estimates[ny * width + nx];
            sum += near * e.variance / (e.mean + floor).powi(2).max(f32::MIN_POSITIVE);
            weights += near;
        }
    }
    if weights > 0.0 { (sum / weights).sqrt() } else { 1.0 }
}

/// The scale ≥ 0 at which the rising function `f` reaches `value`; the largest one tried (10¹²) where it does not.
fn bisect(value: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0f64, 1.0f64);
    while f(high) < value && high < 1e12 {
        low = high;
        high *= 2.0;
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if f(middle) < value { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half_noisy() -> Vec<Estimate> {
        (0..64 * 32).map(|p| Estimate { mean: 1.0, variance: if p % 64 < 32 { 0.01 } else { 1.0 } }).collect()
    }

    #[test]
    fn noisy_pixels_get_more_and_the_mean_is_kept() {
        let counts = Budget { first: 8, mean: 64, noise: None }.allocate(64, &half_noisy());
        let mean = counts.iter().sum::<u32>() as f32 / counts.len() as f32;
        assert!((mean - 64.0).abs() < 1.0, "mean {mean}");
        let (quiet, noisy) = (counts[10 * 64 + 5], counts[10 * 64 + 60]);
        assert!(noisy > 8 * quiet && quiet >= 8, "{quiet} and {noisy}");
    }

    #[test]
    fn a_noise_target_takes_what_it_needs_up_to_the_bound() {
        let budget = |noise| Budget { first: 8, mean: 4096, noise: Some(noise) };
        let counts = budget(0.05).allocate(64, &half_noisy());
        let left =
            half_noisy().iter().zip(&counts).map(|(e, &n)| e.variance / (1.2f32.powi(2) * n as f32)).sum::<f32>() / counts.len() as f32;
        assert!((left.sqrt() - 0.05).abs() < 0.003, "left {}", left.sqrt());
        let bounded = budget(1e-6).allocate(64, &half_noisy());
        assert!(bounded.iter().map(|&n| u64::from(n)).sum::<u64>() <= 4097 * 64 * 32);
        // An infinite variance does not count as clean.
        let wild = vec![Estimate { mean: 1.0, variance: f32::INFINITY }; 25];
        assert_eq!(budget(0.05).allocate(5, &wild), [4096; 25]);
        assert_eq!(budget(0.05).allocate(5, &[Estimate::default(); 25]), [8; 25]);
    }

    #[test]
    fn more_samples_take_the_noise_as_it_was_measured_below_the_target() {
        // The measured noise is ten per cent above the estimate from neighbouring pixels.
        let estimates = half_noisy();
        let budget = Budget { first: 8, mean: 4096, noise: Some(0.05) };
        let taken = budget.allocate(64, &estimates);
        let noise = |counts: &[u32]| {
            let squares = estimates.iter().zip(counts).map(|(e, &n)| f64::from(e.variance) / (1.44 * f64::from(n)));
            1.1 * (squares.sum::<f64>() / counts.len() as f64).sqrt()
        };
        assert!(noise(&taken) > 0.054);
        let more = budget.more(64, &estimates, &taken, noise(&taken)).expect("there are samples left");
        assert!(noise(&more) < 0.05 && noise(&more) > 0.048, "{}", noise(&more));
        assert!(more.iter().zip(&taken).all(|(more, taken)| more >= taken));
        // Neither where all are taken nor where no error is seen.
        assert_eq!(Budget { mean: 8, ..budget }.more(64, &estimates, &vec![8; estimates.len()], 0.2), None);
        assert_eq!(budget.more(5, &[Estimate::default(); 25], &[8; 25], 0.2), None);
    }

    #[test]
    fn a_pixel_has_no_say_in_its_own_number() {
        let flat = vec![Estimate { mean: 1.0, variance: 1.0 }; 25];
        let mut one = flat.clone();
        one[12] = Estimate { mean: 0.0, variance: 0.0 };
        let budget = Budget { first: 1, mean: 16, noise: None };
        // Only the image's totals connect the two.
        let (a, b) = (budget.allocate(5, &flat)[12], budget.allocate(5, &one)[12]);
        assert!(a.abs_diff(b) <= 2, "{a} and {b}");
        assert_eq!(Budget { first: 4, mean: 16, noise: None }.allocate(1, &[Estimate::default()]), [16]);
    }
}
