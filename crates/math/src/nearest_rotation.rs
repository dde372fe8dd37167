//! The rotation nearest to a matrix: what to make of axes that a file gives only roughly orthonormal, or scaled.

use crate::DMat3;

/// Iterations after which a matrix that has not converged is rejected; a matrix within a factor of 1000 of a rotation needs 15.
const MAX_STEPS: usize = 100;

/// The rotation nearest to `m` (sum of squared differences of the entries): the orthogonal factor of its polar decomposition.
///
/// A scale of the whole matrix does not matter. `None` when `m` is not finite, has no inverse, or mirrors (determinant not above 0), for
/// then there is no one nearest rotation. Newton's iteration, R ← (R + R⁻ᵀ)/2; Higham 1986, "Computing the Polar Decomposition".
pub fn nearest_rotation(m: DMat3) -> Option<DMat3> {
    let largest = m.to_cols_array().iter().fold(0.0, |max: f64, v| max.max(v.abs()));
    let mut r = m * (1.0 / largest);
    if !(r.is_finite() && r.determinant() > 0.0) {
        return None;
    }
    for _ in 0..MAX_STEPS {
        let next = (r + r.inverse().transpose()) * 0.5;
        let moved = (next - r).to_cols_array().iter().fold(0.0, |max: f64, v| max.max(v.abs()));
        if !next.is_finite() {
            return None;
        }
        r = next;
        if moved < 1e-15 {
            break;
        }
    }
    Some(r)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn off(a: DMat3, b: DMat3) -> f64 {
        (a - b).to_cols_array().iter().fold(0.0, |max: f64, v| max.max(v.abs()))
    }

    #[test]
    fn a_stretched_rotation_comes_back() {
        let r = DMat3::from_rotation_z(0.7) * DMat3::from_rotation_x(-1.1);
        let stretch = DMat3::from_cols_array(&[1.3, 0.2, 0.1, 0.2, 0.9, -0.05, 0.1, -0.05, 1.1]);
        assert!(off(nearest_rotation(r).unwrap(), r) < 1e-15);
        // A rotation times a symmetric matrix with positive eigenvalues is a polar decomposition.
        for scale in [1.0, 0.0254, 400.0] {
            assert!(off(nearest_rotation(r * stretch * scale).unwrap(), r) < 1e-14);
        }
    }

    #[test]
    fn no_other_rotation_is_nearer() {
        let m = DMat3::from_cols_array(&[0.9, 0.3, 0.1, -0.4, 1.1, 0.2, 0.0, -0.1, 1.2]);
        let distance = |r: DMat3| (m - r).to_cols_array().iter().map(|v| v * v).sum::<f64>();
        let nearest = nearest_rotation(m).unwrap();
        for turn in [DMat3::from_rotation_x(0.01), DMat3::from_rotation_y(-0.01), DMat3::from_rotation_z(0.01)] {
            assert!(distance(nearest) < distance(nearest * turn) && distance(nearest) < distance(turn * nearest));
        }
    }

    #[test]
    fn mirrors_and_flat_matrices_have_none() {
        for m in [DMat3::ZERO, DMat3::from_diagonal(crate::DVec3::new(1.0, 1.0, -1.0)), DMat3::NAN] {
            assert_eq!(nearest_rotation(m), None);
        }
    }
}
