//! Order statistics.

/// The `q`-quantile (0 to 1) of `values` by linear interpolation between order statistics, as numpy's `percentile` has it.
///
/// Reorders the values. `None` when there are none. Values must not be NaN.
pub fn quantile(values: &mut [f64], q: f64) -> Option<f64> {
    let last = values.len().checked_sub(1)?;
    let place = q.clamp(0.0, 1.0) * last as f64;
    let below = place.floor() as usize;
    let (_, &mut low, above) = values.select_nth_unstable_by(below, f64::total_cmp);
    let high = above.iter().copied().min_by(f64::total_cmp).unwrap_or(low);
    let share = place - below as f64;
    // Infinity less itself, and infinity times 0, are no numbers.
    let gap = if high == low || share == 0.0 { 0.0 } else { high - low };
    Some(low + gap * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_interpolate_between_neighbours() {
        assert_eq!(quantile(&mut [], 0.5), None);
        assert_eq!(quantile(&mut [7.0], 0.9), Some(7.0));
        assert_eq!(quantile(&mut [4.0, 1.0, 3.0, 2.0], 0.5), Some(2.5));
        assert_eq!(quantile(&mut [4.0, 1.0, 3.0, 2.0], 1.0), Some(4.0));
        assert!((quantile(&mut [10.0, 0.0], 0.9).unwrap() - 9.0).abs() < 1e-12);
    }

    #[test]
    fn infinities_are_values_like_others() {
        const INFINITY: f64 = f64::INFINITY;
        assert_eq!(quantile(&mut [INFINITY], 0.5), Some(INFINITY));
        assert_eq!(quantile(&mut [INFINITY, INFINITY], 0.5), Some(INFINITY));
        assert_eq!(quantile(&mut [INFINITY, 2.0], 0.0), Some(2.0));
        assert_eq!(quantile(&mut [INFINITY, 2.0], 0.5), Some(INFINITY));
    }
}
