//! Piecewise-constant distributions by inversion of the cumulative sum, which keeps stratified samples stratified.

use crate::ONE_MINUS_EPSILON;

/// A discrete distribution over indices in proportion to weights.
///
/// ```
/// use enfilade_math::Distribution1;
///
/// // Lamps of 60, 0 and 20 watts: the first is chosen three times in four, the second never.
/// let lamps = Distribution1::new(&[60.0, 0.0, 20.0]).unwrap();
/// let (index, probability, rest) = lamps.sample(0.875);
/// assert_eq!((index, probability), (2, 0.25));
/// // The rest of the random number can be used again: 0.875 lies in the middle of the last quarter.
/// assert_eq!(rest, 0.5);
/// assert_eq!([0, 1, 2].map(|i| lamps.pmf(i)), [0.75, 0.0, 0.25]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution1 {
    /// `cdf[i]` is the probability of an index below i+1; the last is 1.
    cdf: Vec<f32>,
    /// `guide[k]` is the index for u = k/n, where the search for u in [k/n, (k+1)/n) begins: one step on average.
    /// Chen & Asau 1974, "On generating random variates from an empirical distribution".
    guide: Vec<u32>,
    total: f64,
}

impl Distribution1 {
    /// A distribution in proportion to `weights` (finite, ≥ 0). `None` when they sum to zero or there are none.
    pub fn new(weights: &[f32]) -> Option<Self> {
        let total: f64 = weights.iter().map(|&w| f64::from(w)).sum();
        if total <= 0.0 || !total.is_finite() {
            return None;
        }
        let mut running = 0.0f64;
        let mut cdf: Vec<f32> = weights
            .iter()
            .map(|&w| {
                running += f64::from(w);
                (running / total) as f32
            })
            .collect();
        // Rounding must never leave a gap at the top that selects a weightless index.
        let last = weights.iter().rposition(|&w| w > 0.0)?;
        cdf[last..].fill(1.0);
        let n = cdf.len();
        let guide = (0..n).map(|k| cdf.partition_point(|&c| c <= k as f32 / n as f32) as u32).collect();
        Some(Self { cdf, guide, total })
    }

    /// Number of indices.
    pub fn len(&self) -> usize {
        self.cdf.len()
    }

    /// Never true: a distribution has at least one index with positive weight.
    pub fn is_empty(&self) -> bool {
        self.cdf.is_empty()
    }

    /// Sum of the weights.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Probability of `index`.
    #[inline]
    pub fn pmf(&self, index: usize) -> f32 {
        self.cdf[index] - if index == 0 { 0.0 } else { self.cdf[index - 1] }
    }

    /// Index for `u` uniform on [0,1), its probability, and `u` renewed to be uniform on [0,1) within the index.
    #[inline]
    pub fn sample(&self, u: f32) -> (usize, f32, f32) {
        let n = self.cdf.len();
        let mut index = self.guide[((u * n as f32) as usize).min(n - 1)] as usize;
        // The product above may have been rounded up past the cell of u.
        while index > 0 && self.cdf[index - 1] > u {
            index -= 1;
        }
        while index + 1 < n && self.cdf[index] <= u {
            index += 1;
        }
        let low = if index == 0 { 0.0 } else { self.cdf[index - 1] };
        let pmf = self.cdf[index] - low;
        (index, pmf, ((u - low) / pmf).clamp(0.0, ONE_MINUS_EPSILON))
    }
}

/// A distribution on the unit square, constant on the cells of a grid.
///
/// ```
/// use enfilade_math::Distribution2;
///
/// // Two rows of two cells; only the lower right one and the one above it have weight.
/// let d = Distribution2::new(&[0.0, 1.0, 0.0, 3.0], 2).unwrap();
/// assert_eq!(d.pdf([0.75, 0.75]), 3.0);
/// assert_eq!(d.pdf([0.25, 0.75]), 0.0);
/// let (point, density) = d.sample([0.5, 0.5]);
/// assert!(point[0] >= 0.5 && density == d.pdf(point));
/// ```
#[derive(Clone, Debug)]
pub struct Distribution2 {
    rows: Vec<Option<Distribution1>>,
    marginal: Distribution1,
    width: usize,
    /// Density of each cell: one place in memory to look at.
    densities: Vec<f32>,
}

impl Distribution2 {
    /// In proportion to `weights`, row by row, `width` cells a row. `None` when all are zero.
    pub fn new(weights: &[f32], width: usize) -> Option<Self> {
        let rows: Vec<_> = weights.chunks(width).map(Distribution1::new).collect();
        let sums: Vec<f32> = rows.iter().map(|r| r.as_ref().map_or(0.0, |r| r.total() as f32)).collect();
        let marginal = Distribution1::new(&sums)?;
        let cells = (width * rows.len()) as f32;
        let density = |(row, of_row): (usize, &Option<Distribution1>)| -> Vec<f32> {
            let pmf = |column: usize| of_row.as_ref().map_or(0.0, |d| marginal.pmf(row) * d.pmf(column) * cells);
            (0..width).map(pmf).collect()
        };
        let densities = rows.iter().enumerate().flat_map(density).collect();
        Some(Self { rows, marginal, width, densities })
    }

    /// Point (x, y) on the unit square for `u` uniform on it, and its density per unit area of the square.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> ([f32; 2], f32) {
        let (row, p_row, v) = self.marginal.sample(u[1]);
        let Some(conditional) = &self.rows[row] else { return ([u[0], u[1]], 0.0) };
        let (column, p_column, w) = conditional.sample(u[0]);
        let point = [(column as f32 + w) / self.width as f32, (row as f32 + v) / self.rows.len() as f32];
        (point, p_row * p_column * (self.width * self.rows.len()) as f32)
    }

    /// Density at the point (x, y) of the unit square.
    #[inline]
    pub fn pdf(&self, point: [f32; 2]) -> f32 {
        let row = ((point[1] * self.rows.len() as f32) as usize).min(self.rows.len() - 1);
        let column = ((point[0] * self.width as f32) as usize).min(self.width - 1);
        self.densities[row * self.width + column]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weightless_indices_are_never_chosen() {
        let d = Distribution1::new(&[0.0, 1.0, 0.0, 3.0, 0.0]).unwrap();
        for i in 0..1000 {
            let (index, pmf, u) = d.sample(i as f32 / 1000.0);
            assert!(index == 1 || index == 3);
            assert_eq!(pmf, d.pmf(index));
            assert!((0.0..1.0).contains(&u));
        }
        assert_eq!(d.sample(ONE_MINUS_EPSILON).0, 3);
        assert!(Distribution1::new(&[0.0, 0.0]).is_none());
        assert!(Distribution1::new(&[]).is_none());
    }

    #[test]
    fn the_guided_search_finds_what_a_binary_search_finds() {
        let weights: Vec<f32> = (0..1000).map(|i| if i % 7 == 0 { 0.0 } else { ((i * 37 % 101) as f32).powi(3) }).collect();
        let d = Distribution1::new(&weights).unwrap();
        let mut rng = crate::Rng::new(4);
        for _ in 0..100_000 {
            let u = rng.next_f32();
            assert_eq!(d.sample(u).0, d.cdf.partition_point(|&c| c <= u));
        }
    }

    #[test]
    fn grid_density_integrates_to_one_and_matches_its_samples() {
        let weights = [1.0, 0.0, 3.0, 0.5, 2.0, 0.25, 0.0, 0.0, 0.0];
        let d = Distribution2::new(&weights, 3).unwrap();
        let mut integral = 0.0;
        for y in 0..3 {
            for x in 0..3 {
                integral += d.pdf([(x as f32 + 0.5) / 3.0, (y as f32 + 0.5) / 3.0]) / 9.0;
            }
        }
        assert!((integral - 1.0).abs() < 1e-5);
        for i in 0..100 {
            let (p, pdf) = d.sample([(i as f32 + 0.5) / 100.0, ((i * 37 % 100) as f32 + 0.5) / 100.0]);
            assert!((d.pdf(p) - pdf).abs() < 1e-4 * pdf, "{p:?}");
        }
    }
}
