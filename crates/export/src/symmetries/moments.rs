//! The centroid and the second moments of a surface's area, with their principal axes.

use crate::mesh::SurfaceMesh;
use enfilade_math::{DMat3, DVec3};

/// Moments that differ by less than so many times the tolerance over the diameter, as a share of the greatest, count as alike. A moment goes
/// with the square of a length, and a diameter is several of the lengths that matter. Too many alike only cost time.
const ALIKE: f64 = 6.0;

/// Sweeps of Jacobi's method; a matrix of three rows needs five or six.
const SWEEPS: usize = 30;

/// The moments of a surface.
pub(super) struct Moments {
    /// Mean of the area.
    pub centroid: DVec3,
    /// Principal axes as columns, right-handed.
    pub axes: DMat3,
    /// Second moments about the centroid along the axes, over the area.
    along: DVec3,
}

/// Which of the three moments are alike.
pub(super) enum Likeness {
    /// None: the axes are the only candidates.
    None,
    /// Two: the axis of the third, and what is across it.
    Two(DVec3),
    /// All: any direction.
    All,
}

impl Moments {
    /// `None` without area.
    pub fn of(mesh: &SurfaceMesh) -> Option<Self> {
        let (mut area, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
        let origin = *mesh.vertices.first()?;
        for face in &mesh.faces {
            let [a, b, c] = face.map(|i| mesh.vertices[i as usize] - origin);
            let sum = a + b + c;
            let part = 0.5 * (b - a).cross(c - a).length();
            area += part;
            first += part / 3.0 * sum;
            // The integral of x xᵀ over a triangle.
            second += (outer(a) + outer(b) + outer(c) + outer(sum)) * (part / 12.0);
        }
        if !(area > 0.0 && area.is_finite()) {
            return None;
        }
        let mean = first / area;
        let (axes, along) = eigen(second * (1.0 / area) - outer(mean));
        Some(Self { centroid: origin + mean, axes, along })
    }

    /// Which moments are alike, where deviations up to a share of the diameter are tolerated.
    pub fn likeness(&self, tolerance: f64) -> Likeness {
        let [x, y, z] = self.along.to_array();
        let alike = |a: f64, b: f64| (a - b).abs() <= ALIKE * tolerance * self.along.max_element();
        let [xy, yz, zx] = [alike(x, y), alike(y, z), alike(z, x)];
        match [xy, yz, zx].into_iter().filter(|alike| *alike).count() {
            0 => Likeness::None,
            1 if xy => Likeness::Two(self.axes.z_axis),
            1 if yz => Likeness::Two(self.axes.x_axis),
            1 => Likeness::Two(self.axes.y_axis),
            _ => Likeness::All,
        }
    }
}

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// Eigenvectors as columns, and eigenvalues, of a symmetric matrix, by Jacobi's rotations.
fn eigen(mut m: DMat3) -> (DMat3, DVec3) {
    let mut axes = DMat3::IDENTITY;
    for (p, q) in (0..SWEEPS).flat_map(|_| [(0, 1), (0, 2), (1, 2)]) {
        let off = m.col(q)[p];
        if off == 0.0 {
            continue;
        }
        let theta = (m.col(q)[q] - m.col(p)[p]) / (2.0 * off);
        let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
        let cos = 1.0 / t.hypot(1.0);
        let sin = t * cos;
        let mut turn = DMat3::IDENTITY;
        turn.col_mut(p)[p] = cos;
        turn.col_mut(q)[q] = cos;
        turn.col_mut(q)[p] = sin;
        turn.col_mut(p)[q] = -sin;
        m = turn.transpose() * m * turn;
        axes *= turn;
    }
    if axes.determinant() < 0.0 {
        axes.z_axis = -axes.z_axis;
    }
    (axes, DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvectors_diagonalise_a_symmetric_matrix() {
        let turn = DMat3::from_rotation_z(0.4) * DMat3::from_rotation_x(1.2);
        let m = turn * DMat3::from_diagonal(DVec3::new(3.0, 0.5, 1.0)) * turn.transpose();
        let (axes, values) = eigen(m);
        assert!((axes.determinant() - 1.0).abs() < 1e-12);
        let back = axes * DMat3::from_diagonal(values) * axes.transpose();
        assert!((back - m).to_cols_array().iter().all(|v| v.abs() < 1e-12), "{back}");
    }

    #[test]
    fn a_square_has_the_moments_of_a_square() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|[x, y]| DVec3::new(x, y, 5.0));
        let mesh = SurfaceMesh { vertices: corners.to_vec(), faces: vec![[0, 1, 2], [0, 2, 3]] };
        let moments = Moments::of(&mesh).unwrap();
        assert!((moments.centroid - DVec3::new(1.0, 1.0, 5.0)).length() < 1e-14);
        // Mean of x² over a side of 2 about its middle: 1/3.
        let mut along = moments.along.to_array();
        along.sort_by(f64::total_cmp);
        assert!(along[0].abs() < 1e-14 && (along[1] - 1.0 / 3.0).abs() < 1e-14 && (along[2] - 1.0 / 3.0).abs() < 1e-14);
        assert!(matches!(moments.likeness(0.02), Likeness::Two(axis) if axis.z.abs() > 0.999));
    }
}
