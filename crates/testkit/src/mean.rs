//! A running mean with its standard error, and tests whether it is credibly the expected one.

use crate::{chi_square_survival, threshold, write_evidence};

/// The mean of independent samples, with how sure it is: for estimators that must be right on average.
///
/// The test relies on the central limit theorem, so feed it at least some thousand samples of finite variance.
#[derive(Clone, Debug, Default)]
pub struct Mean {
    count: u64,
    mean: f64,
    /// Σ (sample − mean)², updated as Welford 1962 does.
    squares: f64,
}

impl Mean {
    /// No samples yet.
    pub const EMPTY: Self = Self { count: 0, mean: 0.0, squares: 0.0 };

    /// The mean of `samples`.
    pub fn of(samples: impl IntoIterator<Item = f64>) -> Self {
        let mut mean = Self::default();
        samples.into_iter().for_each(|sample| mean.add(sample));
        mean
    }

    /// Takes one more sample in.
    pub fn add(&mut self, sample: f64) {
        self.count += 1;
        let before = sample - self.mean;
        self.mean += before / self.count as f64;
        self.squares += before * (sample - self.mean);
    }

    /// The mean; zero without samples.
    pub fn value(&self) -> f64 {
        self.mean
    }

    /// Standard deviation of the mean; infinite for fewer than two samples.
    pub fn standard_error(&self) -> f64 {
        if self.count < 2 { f64::INFINITY } else { (self.squares / (self.count - 1) as f64 / self.count as f64).sqrt() }
    }

    /// Probability of a mean at least as far from `expected`, were that the true one (z-test, two-sided).
    pub fn p_value(&self, expected: f64) -> f64 {
        two_sided(self.mean - expected, self.standard_error())
    }

    /// Fails unless `expected` is credible as the true mean at the family-wise level, as one of `tests` in its suite.
    ///
    /// # Panics
    /// If it is not, or the samples are not enough to decide; the numbers are then in `target/evidence/<name>.txt`.
    pub fn assert_is(&self, name: &str, expected: f64, tests: usize) {
        self.judge(name, self.p_value(expected), tests, &format!("expected {expected}"));
    }

    /// Fails unless both have credibly the same true mean: an estimator and its reference, independent of each other.
    ///
    /// # Panics
    /// As [`Mean::assert_is`].
    pub fn assert_agrees(&self, name: &str, other: &Self, tests: usize) {
        let p_value = two_sided(self.mean - other.mean, self.standard_error().hypot(other.standard_error()));
        self.judge(name, p_value, tests, &format!("expected {} ± {} ({} samples)", other.mean, other.standard_error(), other.count));
    }

    fn judge(&self, name: &str, p_value: f64, tests: usize, expected: &str) {
        assert!(self.standard_error().is_finite(), "{name}: {} samples with mean {} cannot be judged", self.count, self.mean);
        if p_value >= threshold(tests) {
            return;
        }
        let found = format!("mean {} ± {} ({} samples), {expected}, p = {p_value:.2e}", self.mean, self.standard_error(), self.count);
        let place = write_evidence(&format!("{name}.txt"), found.as_bytes());
        panic!("{name}: the mean is wrong: {found}, threshold {:.2e}; evidence in {place}", threshold(tests));
    }
}

/// The tail of the normal distribution beyond ±`difference`, by way of its square. Without spread, only equality is credible.
fn two_sided(difference: f64, standard_error: f64) -> f64 {
    if standard_error == 0.0 {
        return if difference == 0.0 { 1.0 } else { 0.0 };
    }
    chi_square_survival((difference / standard_error).powi(2), 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;

    fn uniform(count: usize, seed: u64) -> Mean {
        let mut rng = Rng::new(seed);
        Mean::of((0..count).map(|_| rng.next_f64()))
    }

    #[test]
    fn mean_and_its_error_match_known_values() {
        let mean = Mean::of([1.0, 2.0, 3.0, 4.0]);
        assert_eq!(mean.value(), 2.5);
        assert!((mean.standard_error() - (5.0f64 / 3.0 / 4.0).sqrt()).abs() < 1e-15);
        assert!((two_sided(1.959_964, 1.0) - 0.05).abs() < 1e-6);
        assert!((two_sided(-3.290_527, 1.0) - 0.001).abs() < 1e-6);
    }

    #[test]
    fn the_right_mean_is_credible_and_a_wrong_one_is_not() {
        let mean = uniform(100_000, 1);
        mean.assert_is("uniform", 0.5, 1);
        mean.assert_agrees("uniform twice", &uniform(50_000, 2), 1);
        assert!(mean.p_value(0.49) < 1e-12);
        Mean::of([3.0; 10]).assert_is("constant", 3.0, 1);
        assert_eq!(Mean::of([3.0; 10]).p_value(3.1), 0.0);
    }

    #[test]
    #[should_panic(expected = "cannot be judged")]
    fn samples_that_are_not_numbers_fail() {
        Mean::of([1.0, f64::NAN, 2.0]).assert_is("not a number", 1.0, 1);
    }
}
