//! Instruments for statistical tests.
//!
//! [`ChiSquare`] asks whether a sampler draws from the density that it claims, [`Mean`] whether an estimator is right on average.
//! Seeds are fixed; a suite of many tests keeps one family-wise level (Šidák). A failing test writes what it saw to
//! `target/evidence/`, and is answered with more samples, never with another seed.

mod clock;
mod gamma;
mod machine;
mod mean;
mod npz;
mod selection;

pub use clock::{process_cpu_s, thread_cpu_s, wall_s};
pub use gamma::chi_square_survival;
pub use machine::processor;
pub use mean::Mean;
pub use npz::Npz;
pub use selection::seeds;

use enfilade_math::{Rng, Vec3};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Family-wise level: the probability that a correct suite of tests fails at all.
const LEVEL: f64 = 1e-3;

/// Cells with fewer expected counts are pooled, because the statistic's distribution is valid only for well-filled ones.
const MIN_EXPECTED: f64 = 5.0;

/// The outcome of a chi-square test of goodness of fit.
#[derive(Clone, Debug)]
pub struct ChiSquare {
    /// Σ (observed − expected)² / expected over the pooled cells.
    pub statistic: f64,
    /// Pooled cells minus one.
    pub degrees_of_freedom: usize,
    /// Probability of a statistic at least as large, were the density right.
    pub p_value: f64,
    /// Observed and expected count of every cell, before pooling.
    pub cells: Vec<(f64, f64)>,
}

impl ChiSquare {
    /// Tests a sampler of directions against its density per solid angle.
    ///
    /// `sample` maps uniform numbers on [0,1)³ to a unit direction, or `None` where it gives up; the density may therefore
    /// integrate to less than one. Cells are 24 × 48 in (cosθ, φ), so the density must not vary much below a few degrees.
    pub fn directions(samples: u32, mut sample: impl FnMut([f32; 3]) -> Option<Vec3>, pdf: impl Fn(Vec3) -> f32) -> Self {
        const ROWS: usize = 24;
        const COLUMNS: usize = 48;
        let draw = |u| {
            sample(u).map(|w| {
                let row = ((f64::from(w.z) + 1.0) * 0.5 * ROWS as f64) as usize;
                let column = (f64::from(w.y).atan2(f64::from(w.x)).rem_euclid(TAU) / TAU * COLUMNS as f64) as usize;
                row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)
            })
        };
        let cell_mass = |cell: usize| {
            const SUB: usize = 24;
            let mut sum = 0.0;
            for i in 0..SUB * SUB {
                let z = -1.0 + 2.0 * ((cell / COLUMNS) as f64 + ((i / SUB) as f64 + 0.5) / SUB as f64) / ROWS as f64;
                let phi = TAU * ((cell % COLUMNS) as f64 + ((i % SUB) as f64 + 0.5) / SUB as f64) / COLUMNS as f64;
                let r = (1.0 - z * z).max(0.0).sqrt();
                sum += f64::from(pdf(Vec3::new((r * phi.cos()) as f32, (r * phi.sin()) as f32, z as f32)));
            }
            sum / (SUB * SUB) as f64 * 2.0 * TAU / (ROWS * COLUMNS) as f64
        };
        Self::cells(samples, ROWS * COLUMNS, draw, cell_mass)
    }

    /// Tests a sampler of points on the unit square against its density per area; as [`ChiSquare::directions`].
    pub fn square(samples: u32, mut sample: impl FnMut([f32; 3]) -> Option<[f32; 2]>, pdf: impl Fn([f32; 2]) -> f32) -> Self {
        const SIDE: usize = 32;
        let draw = |u| {
            sample(u).map(|p| {
                let cell = |v: f32| ((v * SIDE as f32) as usize).min(SIDE - 1);
                cell(p[1]) * SIDE + cell(p[0])
            })
        };
        let cell_mass = |cell: usize| {
            const SUB: usize = 12;
            let at = |index: usize, i: usize| ((index as f32) + (i as f32 + 0.5) / SUB as f32) / SIDE as f32;
            let sum: f64 = (0..SUB * SUB).map(|i| f64::from(pdf([at(cell % SIDE, i % SUB), at(cell / SIDE, i / SUB)]))).sum();
            sum / (SUB * SUB * SIDE * SIDE) as f64
        };
        Self::cells(samples, SIDE * SIDE, draw, cell_mass)
    }

    /// Tests a sampler of cells against their probabilities. One more cell, "gave up", counts the samples and the probability outside of
    /// all cells.
    fn cells(samples: u32, count: usize, mut draw: impl FnMut([f32; 3]) -> Option<usize>, mass: impl Fn(usize) -> f64) -> Self {
        let mut rng = Rng::new(0x5eed);
        let mut observed = vec![0.0; count + 1];
        for _ in 0..samples {
            observed[draw([rng.next_f32(), rng.next_f32(), rng.next_f32()]).unwrap_or(count)] += 1.0;
        }
        let mut expected: Vec<f64> = (0..count).map(|cell| mass(cell) * f64::from(samples)).collect();
        expected.push((f64::from(samples) - expected.iter().sum::<f64>()).max(0.0));
        let cells: Vec<(f64, f64)> = observed.into_iter().zip(expected).collect();
        let pooled = pool(&cells);
        let statistic = pooled.iter().map(|(o, e)| (o - e) * (o - e) / e).sum();
        let degrees_of_freedom = pooled.len().saturating_sub(1);
        Self { statistic, degrees_of_freedom, p_value: chi_square_survival(statistic, degrees_of_freedom), cells }
    }

    /// Fails unless the density is credible at the family-wise level, as one of `tests` in its suite.
    ///
    /// # Panics
    /// When it is not; the cells are then in `target/evidence/<name>.csv`.
    pub fn assert(&self, name: &str, tests: usize) {
        let threshold = threshold(tests);
        if self.p_value >= threshold {
            return;
        }
        let mut csv = String::from("cell,observed,expected\n");
        for (i, (observed, expected)) in self.cells.iter().enumerate() {
            let _ = writeln!(csv, "{i},{observed},{expected}");
        }
        let place = write_evidence(&format!("{name}.csv"), csv.as_bytes());
        panic!(
            "{name}: the samples do not follow the density: chi-square {:.1} at {} degrees of freedom, p = {:.2e} below {threshold:.2e}; cells in {place}",
            self.statistic, self.degrees_of_freedom, self.p_value
        );
    }
}

/// The p-value below which one of `tests` tests fails (Šidák), so that a correct suite fails with probability [`LEVEL`].
fn threshold(tests: usize) -> f64 {
    1.0 - (1.0 - LEVEL).powf(1.0 / tests as f64)
}

/// Merges cells, from the emptiest on, until each is filled well enough.
fn pool(cells: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut order: Vec<(f64, f64)> = cells.to_vec();
    order.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut pooled = Vec::new();
    let mut open = (0.0, 0.0);
    for (observed, expected) in order {
        open = (open.0 + observed, open.1 + expected);
        if open.1 >= MIN_EXPECTED {
            pooled.push(open);
            open = (0.0, 0.0);
        }
    }
    if open != (0.0, 0.0) {
        match pooled.last_mut() {
            Some(last) => *last = (last.0 + open.0, last.1 + open.1),
            None => pooled.push((open.0, open.1.max(f64::MIN_POSITIVE))),
        }
    }
    pooled
}

/// Keeps what a failing test saw; returns where. Best effort: evidence that cannot be written must not hide the failure.
pub fn write_evidence(name: &str, bytes: &[u8]) -> String {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/evidence");
    let safe: String = name.chars().map(|c| if c.is_ascii_alphanumeric() || ".-_".contains(c) { c } else { '_' }).collect();
    let path = folder.join(safe);
    match std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(&path, bytes)) {
        Ok(()) => path.display().to_string(),
        Err(error) => format!("(could not be kept: {error})"),
    }
}
