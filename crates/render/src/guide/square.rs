//! A piecewise constant density over the unit square, sampled by inversion so that stratified points stay stratified.

use enfilade_math::ONE_MINUS_EPSILON;

/// Bins along each side.
pub(super) const SIDE: usize = 16;

/// Bins of a square.
pub(super) const BINS: usize = SIDE * SIDE;

/// The fraction of the density that is uniform, so that every direction keeps a chance.
const UNIFORM_FRACTION: f32 = 0.2;

/// Final values of the cumulative distributions of the rows and within a row.
const ROWS_END: u32 = 1 << 16;
const COLUMNS_END: u32 = 1 << 8;

/// The density, as cumulative distributions: of the rows, and within each row. The last entry, 1, is not stored. Small, because the data of
/// a scene's cells should stay in the processor's cache.
#[derive(Clone, Debug)]
pub(super) struct SquareDensity {
    rows: [u16; SIDE],
    columns: [[u8; SIDE]; SIDE],
}

impl SquareDensity {
    /// In proportion to `values` ≥ 0, row by row, lifted by the uniform fraction.
    pub fn new(values: &[f32; BINS]) -> Self {
        let total: f32 = values.iter().sum();
        let floor = if total > 0.0 { UNIFORM_FRACTION / (1.0 - UNIFORM_FRACTION) * total / BINS as f32 } else { 1.0 };
        let row = |r: usize| -> [f32; SIDE] { std::array::from_fn(|c| values[r * SIDE + c] + floor) };
        let sums = std::array::from_fn(|r| row(r).iter().sum());
        Self {
            rows: cumulative(&sums, ROWS_END).map(|start| start as u16),
            columns: std::array::from_fn(|r| cumulative(&row(r), COLUMNS_END).map(|start| start as u8)),
        }
    }

    /// A point for `u` uniform on [0,1)², and the density there.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> ([f32; 2], f32) {
        let (row, y, p_row) = invert(&self.rows, ROWS_END, u[1]);
        let (_, x, p_column) = invert(&self.columns[row], COLUMNS_END, u[0]);
        ([x, y], p_row * p_column)
    }

    /// The density at a point of the square.
    #[inline]
    pub fn density(&self, u: [f32; 2]) -> f32 {
        let (row, column) = (row_of(u[1]), row_of(u[0]));
        width(&self.rows, ROWS_END, row) * width(&self.columns[row], COLUMNS_END, column)
    }
}

/// The bin that contains a point of the square, row by row.
pub(super) fn bin_of(u: [f32; 2]) -> usize {
    row_of(u[1]) * SIDE + row_of(u[0])
}

/// The row, or the column, of a coordinate.
#[inline]
fn row_of(v: f32) -> usize {
    ((v * SIDE as f32) as usize).min(SIDE - 1)
}

/// Starts of the bins in whole steps of 1/`end`; every bin keeps at least one step.
fn cumulative(values: &[f32; SIDE], end: u32) -> [u32; SIDE] {
    let total: f32 = values.iter().sum();
    let free = end - SIDE as u32;
    let mut sum = 0.0;
    let mut starts = [0; SIDE];
    for (i, value) in values.iter().enumerate() {
        starts[i] = ((sum / total * free as f32) as u32).min(free) + i as u32;
        sum += value;
    }
    starts
}

/// Density of a bin relative to uniform.
#[inline]
fn width<T: Copy + Into<u32>>(starts: &[T; SIDE], end: u32, bin: usize) -> f32 {
    let next = if bin + 1 < SIDE { starts[bin + 1].into() } else { end };
    (next - starts[bin].into()) as f32 * (SIDE as f32 / end as f32)
}

/// The bin that `u` falls into, the place on [0,1), and the density there.
#[inline]
fn invert<T: Copy + Into<u32>>(starts: &[T; SIDE], end: u32, u: f32) -> (usize, f32, f32) {
    let at = u * end as f32;
    let whole = at as u32;
    let bin = starts.iter().map(|&start| usize::from(start.into() <= whole)).sum::<usize>() - 1;
    let density = width(starts, end, bin);
    let start: u32 = starts[bin].into();
    let within = (at - start as f32) * (SIDE as f32 / end as f32) / density;
    let place = ((bin as f32 + within.clamp(0.0, ONE_MINUS_EPSILON)) / SIDE as f32).min(ONE_MINUS_EPSILON);
    (bin, place, density)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn peaked() -> SquareDensity {
        let mut values = [0.0; BINS];
        values[37] = 5.0;
        values[200] = 1.0;
        SquareDensity::new(&values)
    }

    #[test]
    fn density_integrates_to_one_and_agrees_with_sampling() {
        let square = peaked();
        let n = 512;
        let mut integral = 0.0f64;
        let mut counts = vec![0u32; BINS];
        for y in 0..n {
            for x in 0..n {
                let u = [(x as f32 + 0.5) / n as f32, (y as f32 + 0.5) / n as f32];
                integral += f64::from(square.density(u));
                let (v, density) = square.sample(u);
                assert_eq!(density, square.density(v), "at {v:?}");
                counts[(v[1] * SIDE as f32) as usize * SIDE + (v[0] * SIDE as f32) as usize] += 1;
            }
        }
        assert!((integral / f64::from(n * n) - 1.0).abs() < 1e-4);
        for (bin, &count) in counts.iter().enumerate() {
            let centre = [(bin % SIDE) as f32 + 0.5, (bin / SIDE) as f32 + 0.5].map(|v| v / SIDE as f32);
            let expected = square.density(centre) / BINS as f32;
            assert!((f64::from(count) / f64::from(n * n) - f64::from(expected)).abs() < 0.1 * f64::from(expected) + 2e-3, "bin {bin}");
        }
    }

    #[test]
    fn without_light_it_is_uniform_and_the_borders_stay_inside() {
        let square = SquareDensity::new(&[0.0; BINS]);
        for u in [[0.0, 0.0], [ONE_MINUS_EPSILON, ONE_MINUS_EPSILON], [0.3, 0.7]] {
            let (v, density) = square.sample(u);
            assert!((density - 1.0).abs() < 1e-3 && v.iter().all(|x| (0.0..1.0).contains(x)));
            assert!((v[0] - u[0]).abs() < 1e-3 && (v[1] - u[1]).abs() < 1e-3);
        }
    }
}
