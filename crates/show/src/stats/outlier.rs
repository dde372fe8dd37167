//! Outliers among the frames.
//!
//! The score is a value's distance from the median relative to the median distance (Iglewicz & Hoaglin 1993, "How to Detect and Handle
//! Outliers": the modified z-score, outlying beyond 3.5), so that the outliers themselves do not widen the measure.

use enfilade_math::quantile;
use serde::Serialize;

/// Score beyond which a value is an outlier.
pub const LIMIT: f64 = 3.5;
/// With fewer values no outliers can be found.
const FEWEST: usize = 5;
/// Scales the score to a normal distribution's: the 0.75-quantile of that.
const NORMAL: f64 = 0.674_5;

/// A frame that is an outlier in one respect.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outlier {
    /// Name of the scene.
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
    /// In what respect.
    pub quantity: &'static str,
    /// Value of the image.
    pub value: f64,
    /// The median over the dataset.
    pub median: f64,
    /// Modified z-score: below 0 where the value is less than the median.
    pub score: f64,
}

/// The modified z-score of each value; `None` for values that are not finite, and when there are fewer than five others.
///
/// Where the values hardly differ, `least` replaces their standard deviation, so that tiny differences are not outliers.
pub fn scores(values: &[f64], least: f64) -> Vec<Option<f64>> {
    let finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let median = quantile(&mut finite.clone(), 0.5).filter(|_| finite.len() >= FEWEST);
    let Some(median) = median else { return vec![None; values.len()] };
    let mut distances: Vec<f64> = finite.iter().map(|v| (v - median).abs()).collect();
    let deviation = quantile(&mut distances, 0.5).unwrap_or(0.0) / NORMAL;
    values.iter().map(|v| v.is_finite().then(|| (v - median) / deviation.max(least))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_score_of_a_normal_distribution_is_its_standard_deviations() {
        // Quantiles of the normal distribution: ±0.6745 at a quarter and three quarters.
        let values: Vec<f64> = [-1.645, -0.674_5, 0.0, 0.674_5, 1.645].iter().map(|z| 10.0 + 2.0 * z).collect();
        let found = scores(&values, 1e-9);
        for (score, z) in found.iter().zip([-1.645, -0.674_5, 0.0, 0.674_5, 1.645]) {
            assert!((score.unwrap() - z).abs() < 1e-9, "{score:?}, expected {z}");
        }
    }

    #[test]
    fn one_far_value_among_many_stands_apart_and_no_other_does() {
        let mut values: Vec<f64> = (0..20).map(f64::from).collect();
        values.push(1e6);
        values.push(f64::NAN);
        let apart: Vec<usize> = (0..22).filter(|&i| scores(&values, 1e-9)[i].is_some_and(|s| s.abs() > LIMIT)).collect();
        assert_eq!(apart, [20]);
    }

    #[test]
    fn equal_values_have_no_outliers_and_few_have_no_scores() {
        assert_eq!(scores(&[7.0; 6], 0.1), [Some(0.0); 6]);
        assert_eq!(scores(&[1.0, 2.0, 3.0, 900.0], 0.1), [None; 4]);
        let nearly_equal = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.97, 0.5];
        let found = scores(&nearly_equal, 0.02);
        assert!(found[7].unwrap() < -LIMIT && found[6].unwrap().abs() < LIMIT && found[0] == Some(0.0), "{found:?}");
    }
}
