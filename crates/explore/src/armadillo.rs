//! The random numbers of Hypersim's programs: those of the library Armadillo, which draws them from `std::mt19937_64` by way of
//! libstdc++'s distributions. Only for the preset that repeats those programs; everything else uses [`enfilade_math::Rng`].

use enfilade_math::DVec3;
use rand_mt::Mt64;

pub(crate) struct Armadillo {
    engine: Mt64,
    /// The number that the polar method made beside the last one.
    spare_normal: Option<f64>,
}

impl Armadillo {
    pub(crate) fn new(seed: u64) -> Self {
        Self { engine: Mt64::new(seed), spare_normal: None }
    }

    /// Uniform on [0, 1).
    pub(crate) fn uniform(&mut self) -> f64 {
        const BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;
        (self.engine.next_u64() as f64 / 18_446_744_073_709_551_616.0).min(BELOW_ONE)
    }

    /// Normal with mean 0 and variance 1: Marsaglia's polar method, the second number first.
    pub(crate) fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare_normal.take() {
            return spare;
        }
        loop {
            let (x, y) = (2.0 * self.uniform() - 1.0, 2.0 * self.uniform() - 1.0);
            let square = x * x + y * y;
            if square <= 1.0 && square != 0.0 {
                let scale = (-2.0 * square.ln() / square).sqrt();
                self.spare_normal = Some(x * scale);
                return y * scale;
            }
        }
    }

    /// Uniform below `n`, which must not be 0: Lemire 2019, "Fast Random Integer Generation in an Interval".
    pub(crate) fn below(&mut self, n: usize) -> usize {
        let n = n as u64;
        let mut product = u128::from(self.engine.next_u64()) * u128::from(n);
        if (product as u64) < n {
            let threshold = n.wrapping_neg() % n;
            while (product as u64) < threshold {
                product = u128::from(self.engine.next_u64()) * u128::from(n);
            }
        }
        (product >> 64) as usize
    }

    /// A matrix of `rows` rows and three columns, drawn column by column.
    pub(crate) fn rows(rows: usize, mut draw: impl FnMut() -> f64) -> Vec<DVec3> {
        let mut matrix = vec![DVec3::ZERO; rows];
        for axis in 0..3 {
            for row in &mut matrix {
                row[axis] = draw();
            }
        }
        matrix
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // Printed by a C++ program that calls the library after arma_rng::set_seed(0).
    #[test]
    fn numbers_are_those_of_the_library() {
        let mut rng = Armadillo::new(0);
        let uniform: Vec<f64> = (0..4).map(|_| rng.uniform()).collect();
        assert_eq!(uniform, [0.159_793_363_370_460_85, 0.992_145_209_629_828_8, 0.039_569_025_844_865_664, 0.597_494_662_694_671_8]);
        let mut rng = Armadillo::new(0);
        let normal: Vec<f64> = (0..300).map(|_| rng.normal()).collect();
        assert_eq!(normal[..3], [0.101_918_555_514_537_92, -0.481_323_371_998_367_17, -0.680_603_032_563_542_9]);
        assert!((normal.iter().sum::<f64>() - 36.168_829_208_033_216).abs() < 1e-9);
        assert_eq!(rng.uniform(), 0.598_360_910_790_168_7);
    }

    #[test]
    fn whole_numbers_are_uniform() {
        let mut rng = Armadillo::new(3);
        let mut counts = [0u32; 7];
        for _ in 0..70_000 {
            counts[rng.below(7)] += 1;
        }
        let chi_square: f64 = counts.iter().map(|c| (f64::from(*c) - 1e4).powi(2) / 1e4).sum();
        // 6 degrees of freedom: beyond 27.9 once in 10,000 times.
        assert!(chi_square < 27.9, "{counts:?}");
    }

    #[test]
    fn matrices_fill_column_by_column() {
        let mut next = 0.0;
        let rows = Armadillo::rows(2, || {
            next += 1.0;
            next
        });
        assert_eq!(rows, [DVec3::new(1.0, 3.0, 5.0), DVec3::new(2.0, 4.0, 6.0)]);
    }
}
