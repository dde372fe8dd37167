//! A piecewise constant density over the unit square, sampled by inversion so that stratified points stay stratified.

use enfilade_math::ONE_MINUS_EPSILON;

/// Bins along each side.
pub(super) const SIDE: usize = 16;

/// Bins of a square.
pub(super) const BINS: usize = SIDE * SIDE;

/// Share of the density that is uniform, whatever was learned: nothing is ever missed.
const UNIFORM_SHARE: f32 = 0.2;

/// What a cumulative distribution ends at.
const ONE: u32 = 1 << 16;

/// The density, as 16-bit cumulative distributions: of the rows, and within each row. The last entry, 2¹⁶, is not stored.
#[derive(Clone, Debug)]
pub(super) struct SquareDensity {
    rows: [u16; SIDE],
    columns: [[u16; SIDE]; SIDE],
}

impl SquareDensity {
    /// In proportion to `values` ≥ 0, row by row, lifted by the uniform share.
    pub fn new(values: &[f32; BINS]) -> Self {
        let total: f32 = values.iter().sum();
        let floor = if total > 0.0 { UNIFORM_SHARE / (1.0 - UNIFORM_SHARE) * total / BINS as f32 } else { 1.0 };
        let row = |r: usize| -> [f32; SIDE] { std::array::from_fn(|c| values[r * SIDE + c] + floor) };
        Self { rows: cumulative(&std::array::from_fn(|r| row(r).iter().sum())), columns: std::array::from_fn(|r| cumulative(&row(r))) }
    }

    /// A point for `u` uniform on [0,1)², and the density there.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> ([f32; 2], f32) {
        let (row, y, p_row) = invert(&self.rows, u[1]);
        let (_, x, p_column) = invert(&self.columns[row], u[0]);
        ([x, y], p_row * p_column)
    }

    /// The density at a point of the square.
    #[inline]
    pub fn density(&self, u: [f32; 2]) -> f32 {
        let bin = |v: f32| ((v * SIDE as f32) as usize).min(SIDE - 1);
        let (row, column) = (bin(u[1]), bin(u[0]));
        share(&self.rows, row) * share(&self.columns[row], column)
    }
}

/// Starts of the bins; every bin keeps at least one step.
fn cumulative(values: &[f32; SIDE]) -> [u16; SIDE] {
    let total: f32 = values.iter().sum();
    let free = (ONE as usize - SIDE) as f32;
    let mut sum = 0.0;
    let mut starts = [0u16; SIDE];
    for (i, value) in values.iter().enumerate() {
        starts[i] = ((sum / total * free) as u32).min(free as u32) as u16 + i as u16;
        sum += value;
    }
    starts
}

#[inline]
fn end(starts: &[u16; SIDE], bin: usize) -> u32 {
    if bin + 1 < SIDE { u32::from(starts[bin + 1]) } else { ONE }
}

/// Density of a bin relative to uniform.
#[inline]
fn share(starts: &[u16; SIDE], bin: usize) -> f32 {
    (end(starts, bin) - u32::from(starts[bin])) as f32 * (SIDE as f32 / ONE as f32)
}

/// The bin that `u` falls into, the place on [0,1), and the density there.
#[inline]
fn invert(starts: &[u16; SIDE], u: f32) -> (usize, f32, f32) {
    let at = u * ONE as f32;
    let below = starts.iter().map(|&s| u16::from(f32::from(s) <= at)).sum::<u16>();
    let bin = usize::from(below.max(1)) - 1;
    let start = u32::from(starts[bin]);
    let width = (end(starts, bin) - start) as f32;
    let within = ((at - start as f32) / width).clamp(0.0, ONE_MINUS_EPSILON);
    let place = ((bin as f32 + within) / SIDE as f32).min(ONE_MINUS_EPSILON);
    (bin, place, width * (SIDE as f32 / ONE as f32))
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
