//! Random numbers of the distributions.

use enfilade_math::Rng;

/// Uniform between two numbers.
pub fn uniform(rng: &mut Rng, [low, high]: [f64; 2]) -> f64 {
    low + (high - low) * rng.next_f64()
}

/// Uniform in the logarithm between two positive numbers.
pub fn log_uniform(rng: &mut Rng, [low, high]: [f64; 2]) -> f64 {
    uniform(rng, [low.ln(), high.ln()]).exp()
}

/// Uniform in the reciprocal between two positive numbers.
pub fn reciprocal_uniform(rng: &mut Rng, [low, high]: [f64; 2]) -> f64 {
    1.0 / uniform(rng, [1.0 / high, 1.0 / low])
}

/// True with a probability of `share`.
pub fn chance(rng: &mut Rng, share: f64) -> bool {
    rng.next_f64() < share
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_stay_within_their_ends_and_have_the_medians_of_their_distributions() {
        let median = |draw: &dyn Fn(&mut Rng) -> f64| {
            let rng = &mut Rng::new(1);
            let mut values: Vec<f64> = (0..4001).map(|_| draw(rng)).collect();
            values.sort_by(f64::total_cmp);
            assert!(values[0] >= 2.0 && values[4000] <= 8.0);
            values[2000]
        };
        assert!((median(&|rng| uniform(rng, [2.0, 8.0])) - 5.0).abs() < 0.15);
        assert!((median(&|rng| log_uniform(rng, [2.0, 8.0])) - 4.0).abs() < 0.15);
        assert!((median(&|rng| reciprocal_uniform(rng, [2.0, 8.0])) - 3.2).abs() < 0.15);
        assert_eq!(uniform(&mut Rng::new(3), [0.5, 0.5]), 0.5);
    }
}
