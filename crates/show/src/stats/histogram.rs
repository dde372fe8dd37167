//! Histograms of fixed bins, which add up over images in any order.

use serde::Serialize;

/// How values are spread over bins.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Scale {
    /// Bins of equal width.
    Linear,
    /// Bins of equal ratio.
    Log,
}

/// Bins of a histogram: the lower border counts to a bin, the upper one to the next; the last bin has both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bins {
    /// Lower border of the first; more than 0 on a logarithmic scale.
    pub low: f64,
    /// Upper border of the last.
    pub high: f64,
    /// How many.
    pub count: usize,
    /// Their spacing.
    pub scale: Scale,
}

impl Bins {
    /// `count` bins of equal width from `low` to `high`.
    pub const fn linear(low: f64, high: f64, count: usize) -> Self {
        Self { low, high, count, scale: Scale::Linear }
    }

    /// `count` bins of equal ratio from `low` to `high`.
    pub const fn log(low: f64, high: f64, count: usize) -> Self {
        Self { low, high, count, scale: Scale::Log }
    }

    /// Position of a value: 0 at the lower border of the first bin, `count` at the upper border of the last.
    fn place(&self, value: f64) -> f64 {
        let share = match self.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Log => (value / self.low).ln() / (self.high / self.low).ln(),
        };
        share * self.count as f64
    }

    /// The value at a place, as [`Bins::place`] counts.
    pub fn value(&self, place: f64) -> f64 {
        let share = place / self.count as f64;
        match self.scale {
            Scale::Linear => self.low + share * (self.high - self.low),
            Scale::Log => self.low * (self.high / self.low).powf(share),
        }
    }
}

/// The number of values in each bin, below the first and above the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// Bins of the histogram.
    pub bins: Bins,
    /// Count of each bin.
    pub counts: Vec<u64>,
    /// Below the first bin.
    pub below: u64,
    /// Above the last bin.
    pub above: u64,
}

impl Histogram {
    /// A histogram without values.
    pub fn new(bins: Bins) -> Self {
        Self { bins, counts: vec![0; bins.count], below: 0, above: 0 }
    }

    /// Counts a value; NaN is none.
    pub fn add(&mut self, value: f64) {
        if value.is_nan() {
            return;
        }
        if value < self.bins.low {
            self.below += 1;
        } else if value > self.bins.high {
            self.above += 1;
        } else {
            let bin = (self.bins.place(value) as usize).min(self.bins.count - 1);
            self.counts[bin] += 1;
        }
    }

    /// Adds what another of the same bins has counted.
    pub fn merge(&mut self, other: &Self) {
        debug_assert_eq!(self.bins, other.bins);
        add_counts(&mut self.counts, &other.counts);
        self.below += other.below;
        self.above += other.above;
    }

    /// How many values were counted, within the bins or beyond.
    pub fn total(&self) -> u64 {
        self.below + self.counts.iter().sum::<u64>() + self.above
    }

    /// The value with the share `q` of all values below it, to within a bin: values within a bin are taken as spread evenly. It is the
    /// outer border if it is beyond the bins. `None` without values.
    pub fn quantile(&self, q: f64) -> Option<f64> {
        let total = self.total();
        let wanted = q.clamp(0.0, 1.0) * total as f64;
        let mut passed = self.below as f64;
        if total == 0 {
            return None;
        }
        if wanted < passed {
            return Some(self.bins.low);
        }
        for (i, &count) in self.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            if wanted <= passed + count as f64 {
                return Some(self.bins.value(i as f64 + (wanted - passed) / count as f64));
            }
            passed += count as f64;
        }
        Some(self.bins.high)
    }

    /// A histogram with `of` bins in one; `of` must divide their number.
    pub fn coarser(&self, of: usize) -> Self {
        let counts: Vec<u64> = self.counts.chunks(of).map(|chunk| chunk.iter().sum()).collect();
        Self { bins: Bins { count: counts.len(), ..self.bins }, counts, below: self.below, above: self.above }
    }

    /// A histogram without the values beyond the bins, which stored histograms do not have.
    pub fn within(&self) -> Self {
        Self { below: 0, above: 0, ..self.clone() }
    }

    /// Lower border, upper border and share of all values, of each bin.
    pub fn shares(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let total = self.total().max(1) as f64;
        let edge = |i: usize| self.bins.value(i as f64);
        self.counts.iter().enumerate().map(move |(i, &count)| [edge(i), edge(i + 1), count as f64 / total])
    }
}

/// Adds counts to counts, bin by bin.
pub(super) fn add_counts(to: &mut [u64], from: &[u64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_lie_in_their_bins_and_beyond() {
        let mut linear = Histogram::new(Bins::linear(0.0, 10.0, 5));
        [-0.1, 0.0, 1.9, 2.0, 9.9, 10.0, 10.1, f64::NAN].iter().for_each(|v| linear.add(*v));
        assert_eq!((linear.below, linear.counts.as_slice(), linear.above), (1, [2, 1, 0, 0, 2].as_slice(), 1));
        let mut log = Histogram::new(Bins::log(0.01, 100.0, 4));
        [0.0, 0.02, 0.5, 0.9, 50.0, 1e3].iter().for_each(|v| log.add(*v));
        assert_eq!((log.below, log.counts.as_slice(), log.above), (1, [1, 2, 0, 1].as_slice(), 1));
        assert_eq!(log.coarser(2).counts, [3, 1]);
        assert_eq!(log.total(), 6);
    }

    #[test]
    fn quantiles_of_even_values_are_where_they_should_be() {
        let mut histogram = Histogram::new(Bins::linear(0.0, 1.0, 100));
        (0..10_000).for_each(|i| histogram.add((f64::from(i) + 0.5) / 1e4));
        for q in [0.05, 0.25, 0.5, 0.95] {
            assert!((histogram.quantile(q).unwrap() - q).abs() < 1e-3, "{q}");
        }
        let mut log = Histogram::new(Bins::log(1e-3, 10.0, 1000));
        (0..1000).for_each(|_| log.add(0.25));
        assert!((log.quantile(0.5).unwrap() / 0.25 - 1.0).abs() < 0.01);
        assert_eq!(Histogram::new(log.bins).quantile(0.5), None);
        log.above = 2000;
        assert_eq!(log.quantile(0.5), Some(10.0));
    }

    #[test]
    fn shares_add_up_to_what_lies_within() {
        let mut histogram = Histogram::new(Bins::linear(0.0, 4.0, 2));
        [1.0, 1.0, 3.0, 5.0].iter().for_each(|v| histogram.add(*v));
        assert_eq!(histogram.shares().collect::<Vec<_>>(), [[0.0, 2.0, 0.5], [2.0, 4.0, 0.25]]);
    }
}
