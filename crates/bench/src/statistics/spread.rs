//! The distribution of values: mean, quantiles, largest.

/// Values in ascending order.
pub struct Spread(Vec<f64>);

impl FromIterator<f64> for Spread {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        Self(values)
    }
}

impl Spread {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// Mean of the values; 0 of none.
    pub fn mean(&self) -> f64 {
        self.0.iter().sum::<f64>() / self.0.len().max(1) as f64
    }

    /// The value that the share `q` of them, 0 to 1, does not exceed; 0 of none.
    pub fn quantile(&self, q: f64) -> f64 {
        let last = self.0.len().saturating_sub(1) as f64;
        self.0.get((q * last).round() as usize).copied().unwrap_or(0.0)
    }
}

/// Three figures that count, and thousands whole.
pub fn tidy(value: f64) -> String {
    match value.abs() {
        v if v >= 99.95 => format!("{value:.0}"),
        v if v >= 9.995 => format!("{value:.1}"),
        v if v >= 0.0995 || v == 0.0 => format!("{value:.2}"),
        _ => format!("{value:.4}"),
    }
}
