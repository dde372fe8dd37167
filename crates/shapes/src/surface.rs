//! How well two surfaces agree: points are drawn from both, and each looks for its nearest on the other.
//!
//! Mesh R-CNN's `compare_meshes`, after Fan et al. 2017 and Knapitsch et al. 2017: both meshes are scaled alike so that the longest edge of
//! the true one's box is 10, and as many points are drawn from either, uniform by area.

use crate::ShapesError;
use crate::kdtree::KdTree;
use enfilade_math::{DVec3, Rng};

/// Triangles whose corners are all there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    vertices: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
}

impl Surface {
    /// Checks that vertices are finite and corners name vertices.
    ///
    /// # Errors
    /// When they are not.
    pub fn new(vertices: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Result<Self, ShapesError> {
        if let Some(i) = vertices.iter().position(|v| !v.is_finite()) {
            return Err(ShapesError::Value(format!("vertex {i} is {}; expected finite numbers", vertices[i])));
        }
        let count = vertices.len();
        if let Some(i) = faces.iter().position(|face| face.iter().any(|&corner| corner as usize >= count)) {
            return Err(ShapesError::Value(format!("face {i} has corners {:?}; there are {count} vertices, counted from 0", faces[i])));
        }
        Ok(Self { vertices, faces })
    }

    /// Vertices of the surface.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Three vertices each, by index.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    fn corners(&self, face: usize) -> [DVec3; 3] {
        self.faces[face].map(|corner| self.vertices[corner as usize])
    }

    /// Points that are uniform on the surface, and the unit normals there; `None` when it has no area.
    fn sample(&self, count: usize, rng: &mut Rng) -> Option<(Vec<DVec3>, Vec<DVec3>)> {
        let mut total = 0.0;
        let mut ends = Vec::with_capacity(self.faces.len());
        for face in 0..self.faces.len() {
            let [a, b, c] = self.corners(face);
            total += (b - a).cross(c - a).length();
            ends.push(total);
        }
        if total <= 0.0 || !total.is_finite() {
            return None;
        }
        let mut uniform = || (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        let one = |_| {
            let chosen = uniform() * total;
            let face = ends.partition_point(|&end| end <= chosen).min(ends.len() - 1);
            let [a, b, c] = self.corners(face);
            let (root, v) = (uniform().sqrt(), uniform());
            (a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v), (b - a).cross(c - a).normalize_or_zero())
        };
        Some((0..count).map(one).unzip())
    }

    /// Longest edge of the box around the vertices that faces use.
    fn longest_edge(&self) -> f64 {
        let used = self.faces.iter().flatten().map(|&corner| self.vertices[corner as usize]);
        let (min, max) = used.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        (max - min).max_element()
    }
}

/// How surfaces are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct CompareConfig {
    /// Points drawn from either surface; 10 000 by default.
    pub samples: usize,
    /// Longest edge of the true surface's box after scaling; 10. `None`: as they are.
    pub longest_edge: Option<f64>,
    /// Distances within which a point counts as met; 0.1 to 0.5.
    pub thresholds: Vec<f64>,
    /// Seed of the points.
    pub seed: u64,
}

impl Default for CompareConfig {
    fn default() -> Self {
        Self { samples: 10_000, longest_edge: Some(10.0), thresholds: vec![0.1, 0.2, 0.3, 0.4, 0.5], seed: 0 }
    }
}

/// How well two surfaces agree.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Mean squared distance from the found to the true surface, plus the one back, after scaling.
    pub chamfer_l2: f64,
    /// Mean cosine between normals of nearest points, both ways, −1 to 1.
    pub normal_consistency: f64,
    /// Mean absolute value of these cosines: which way normals point does not matter.
    pub abs_normal_consistency: f64,
    /// By threshold.
    pub agreement: Vec<Agreement>,
}

/// Shares of points that are met within a distance, per cent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// The distance after scaling.
    pub threshold: f64,
    /// Share of the found surface's points near the true one.
    pub precision: f64,
    /// Share of the true surface's points near the found one.
    pub recall: f64,
    /// Harmonic mean of precision and recall.
    pub f1: f64,
}

/// Compares a found surface with the true one. A found surface without area agrees nowhere, at an infinite distance.
///
/// # Errors
/// When the true surface has no area, or the configuration asks for no points.
pub fn compare(found: &Surface, truth: &Surface, config: &CompareConfig) -> Result<Comparison, ShapesError> {
    if config.samples == 0 {
        return Err(ShapesError::Value("0 points are to be drawn; expected at least 1".into()));
    }
    let scale = config.longest_edge.map_or(1.0, |edge| edge / truth.longest_edge());
    let rng = Rng::new(config.seed);
    let no_truth = || ShapesError::Value("the true mesh has no area; leave it out".into());
    let (true_points, true_normals) = truth.sample(config.samples, &mut rng.fork(1)).ok_or_else(no_truth)?;
    let Some((points, normals)) = found.sample(config.samples, &mut rng.fork(2)) else {
        let agreement = config.thresholds.iter().map(|&threshold| Agreement { threshold, precision: 0.0, recall: 0.0, f1: 0.0 });
        let agreement = agreement.collect();
        return Ok(Comparison { chamfer_l2: f64::INFINITY, normal_consistency: 0.0, abs_normal_consistency: 0.0, agreement });
    };
    let there = nearest(&points, &normals, &true_points, &true_normals);
    let back = nearest(&true_points, &true_normals, &points, &normals);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let both =
        |of: fn(f64) -> f64| 0.5 * [&there, &back].iter().map(|way| mean(&way.1.iter().map(|&c| of(c)).collect::<Vec<_>>())).sum::<f64>();
    let within = |squared: &[f64], threshold: f64| {
        100.0 * squared.iter().filter(|d| d.sqrt() * scale < threshold).count() as f64 / squared.len() as f64
    };
    let agreement = config.thresholds.iter().map(|&threshold| {
        let (precision, recall) = (within(&there.0, threshold), within(&back.0, threshold));
        let f1 = if precision + recall > 0.0 { 2.0 * precision * recall / (precision + recall) } else { 0.0 };
        Agreement { threshold, precision, recall, f1 }
    });
    Ok(Comparison {
        chamfer_l2: (mean(&there.0) + mean(&back.0)) * scale * scale,
        normal_consistency: both(|cosine| cosine),
        abs_normal_consistency: both(f64::abs),
        agreement: agreement.collect(),
    })
}

/// Squared distance from every point to the nearest other, and the cosine between their normals.
fn nearest(points: &[DVec3], normals: &[DVec3], others: &[DVec3], other_normals: &[DVec3]) -> (Vec<f64>, Vec<f64>) {
    let tree = KdTree::new(others);
    let one = |(&p, n): (&DVec3, &DVec3)| tree.nearest(p).map_or((f64::INFINITY, 0.0), |(i, squared)| (squared, n.dot(other_normals[i])));
    points.iter().zip(normals).map(one).unzip()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A box from `low` to `high` with outward faces.
    pub(crate) fn block(low: DVec3, high: DVec3) -> Surface {
        let corner = |i: usize| DVec3::from_array(std::array::from_fn(|axis| if i >> axis & 1 == 0 { low[axis] } else { high[axis] }));
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let faces = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Surface::new((0..8).map(corner).collect(), faces).unwrap()
    }

    /// A square in a plane of constant z, its sides 1 long.
    fn square(z: f64) -> Surface {
        let vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, z));
        Surface::new(vertices.into(), vec![[0, 1, 2], [0, 2, 3]]).unwrap()
    }

    fn f1(comparison: &Comparison) -> Vec<f64> {
        comparison.agreement.iter().map(|a| a.f1).collect()
    }

    #[test]
    fn a_surface_agrees_with_itself() {
        let table = block(DVec3::new(0.0, 0.0, 0.7), DVec3::new(1.0, 0.5, 0.75));
        let found = compare(&table, &table, &CompareConfig::default()).unwrap();
        assert!(found.agreement[2].f1 > 99.9 && found.chamfer_l2 < 0.01 && found.abs_normal_consistency > 0.97, "{found:?}");
        assert!(found.normal_consistency > 0.97);
    }

    #[test]
    fn a_shifted_plane_has_the_shift_as_its_distance() {
        // 10 long after scaling, so a shift of 0.025 becomes 0.25; the contribution of points that are apart in the plane does not change
        // with the shift.
        let config = CompareConfig { samples: 20_000, ..CompareConfig::default() };
        let same = compare(&square(0.0), &square(0.0), &config).unwrap().chamfer_l2;
        let found = compare(&square(0.025), &square(0.0), &config).unwrap();
        assert!((found.chamfer_l2 - same - 2.0 * 0.25 * 0.25).abs() < 1e-9, "{found:?}");
        assert_eq!((f1(&found)[0], f1(&found)[1]), (0.0, 0.0));
        assert!(f1(&found)[2] > 85.0 && f1(&found)[4] > 99.9, "{found:?}");
        let away = compare(&square(0.06), &square(0.0), &config).unwrap();
        assert_eq!(f1(&away), [0.0; 5]);
    }

    #[test]
    fn half_a_surface_is_precise_and_half_complete() {
        let vertices = [[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let half = Surface::new(vertices.into(), vec![[0, 1, 2], [0, 2, 3]]).unwrap();
        let found = compare(&half, &square(0.0), &CompareConfig::default()).unwrap().agreement[2];
        // A strip of 0.3 beside the edge is met as well: 5.3 of 10.
        assert!(found.precision > 99.5 && (found.recall - 53.0).abs() < 1.5, "{found:?}");
        assert!((found.f1 - 2.0 * found.precision * found.recall / (found.precision + found.recall)).abs() < 1e-12);
    }

    #[test]
    fn points_are_uniform_by_area_and_normals_are_the_faces() {
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::Z + 3.0 * DVec3::X, DVec3::Z + DVec3::Y];
        let two = Surface::new(vertices, vec![[0, 1, 2], [3, 5, 4]]).unwrap();
        let (points, normals) = two.sample(40_000, &mut Rng::new(1)).unwrap();
        let upper: Vec<usize> = (0..points.len()).filter(|&i| points[i].z > 0.5).collect();
        assert!((upper.len() as f64 / 40_000.0 - 0.75).abs() < 0.01);
        assert!(points.iter().zip(&normals).all(|(p, n)| *n == if p.z > 0.5 { -DVec3::Z } else { DVec3::Z }));
        let middle = upper.iter().map(|&i| points[i]).sum::<DVec3>() / upper.len() as f64;
        assert!(middle.distance(DVec3::new(1.0, 1.0 / 3.0, 1.0)) < 0.02, "{middle}");
    }

    #[test]
    fn scale_and_seed_do_not_matter_much() {
        let (a, b) = (block(DVec3::ZERO, DVec3::new(1.0, 2.0, 0.5)), block(DVec3::ZERO, DVec3::new(1.1, 2.0, 0.5)));
        let scaled = |surface: &Surface| Surface::new(surface.vertices.iter().map(|v| v * 70.0).collect(), surface.faces.clone()).unwrap();
        let config = CompareConfig::default();
        let (small, large) = (compare(&a, &b, &config).unwrap(), compare(&scaled(&a), &scaled(&b), &config).unwrap());
        assert!((small.chamfer_l2 - large.chamfer_l2).abs() < 1e-9 && (small.agreement[2].f1 - large.agreement[2].f1).abs() < 0.03);
        let other = compare(&a, &b, &CompareConfig { seed: 5, ..config }).unwrap();
        assert!(other != small && (other.agreement[2].f1 - small.agreement[2].f1).abs() < 1.5);
    }

    #[test]
    fn what_has_no_area_agrees_nowhere_and_is_no_truth() {
        let line = Surface::new(vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X], vec![[0, 1, 2]]).unwrap();
        for nothing in [&line, &Surface::default()] {
            let found = compare(nothing, &square(0.0), &CompareConfig::default()).unwrap();
            assert_eq!((f1(&found), found.chamfer_l2), (vec![0.0; 5], f64::INFINITY));
            assert!(compare(&square(0.0), nothing, &CompareConfig::default()).unwrap_err().to_string().contains("no area"));
        }
        assert!(Surface::new(vec![DVec3::ZERO], vec![[0, 0, 1]]).unwrap_err().to_string().contains("there are 1 vertices"));
        assert!(Surface::new(vec![DVec3::NAN], vec![]).is_err());
    }
}
