//! The voxels that Hypersim's `generate_octomap` marks as occupied. It samples each triangle at points a quarter voxel apart.

use super::VoxelGrid;
use enfilade_math::{DVec3, Vec3};
use enfilade_parallel::each;

/// Distance of the samples, voxels. Their grid begins at the centroid.
const SPACING: f64 = 0.25;

impl VoxelGrid {
    /// Marks the voxels of sample points on triangles that have a vertex in the box from `min` to `max` (metres).
    pub(crate) fn occupy_samples(&self, triangles: &[[Vec3; 3]], min: DVec3, max: DVec3) {
        let inside = |p: DVec3| p.cmpge(min).all() && p.cmple(max).all();
        each(triangles, |corners| {
            let corners = corners.map(|p| p.as_dvec3());
            if corners.iter().any(|p| inside(*p)) {
                self.sample_triangle(corners, inside);
            }
        });
    }

    fn sample_triangle(&self, corners: [DVec3; 3], inside: impl Fn(DVec3) -> bool) {
        let occupy = |p: DVec3| {
            let cell = self.cell_at(p);
            if inside(p) && self.inside(cell) {
                self.occupy_row(cell, 1);
            }
        };
        let [a, b, c] = corners;
        let cells = corners.map(|p| self.cell_at(p));
        if cells[0] == cells[1] && cells[1] == cells[2] {
            return occupy(a);
        }
        let center = (a + b + c) / 3.0;
        occupy(center);

        // A frame in the triangle's plane: x toward the first corner.
        let normal = (b - a).cross(c - a);
        if normal.length_squared() == 0.0 || center == a {
            return;
        }
        let x = (a - center).normalize();
        let y = normal.normalize().cross(x);
        let flat = corners.map(|p| [(p - center).dot(x), (p - center).dot(y)]);
        let range = |axis: usize| {
            let steps = flat.map(|p| p[axis] / (SPACING * self.voxel_m()));
            let (low, high) = (steps[0].min(steps[1]).min(steps[2]), steps[0].max(steps[1]).max(steps[2]));
            (low.floor() as i64..=high.ceil() as i64).map(|i| i as f64 * SPACING * self.voxel_m())
        };
        let is_within = Barycentric::new(flat);
        for u in range(0) {
            for v in range(1) {
                if is_within.strictly([u, v]) {
                    occupy(center + u * x + v * y);
                }
            }
        }
    }

    /// OctoMap takes points in single precision.
    fn cell_at(&self, p: DVec3) -> [i32; 3] {
        self.cells(p.as_vec3().as_dvec3()).floor().to_array().map(|c| c as i32)
    }
}

/// The test whether a point is in a flat triangle.
struct Barycentric {
    origin: [f64; 2],
    /// Rows of the inverse of the matrix of the two edges.
    inverse: [[f64; 2]; 2],
}

impl Barycentric {
    fn new([a, b, c]: [[f64; 2]; 3]) -> Self {
        let (e, f) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let determinant = e[0] * f[1] - f[0] * e[1];
        Self { origin: a, inverse: [[f[1] / determinant, -f[0] / determinant], [-e[1] / determinant, e[0] / determinant]] }
    }

    fn strictly(&self, p: [f64; 2]) -> bool {
        let q = [p[0] - self.origin[0], p[1] - self.origin[1]];
        let [v, w] = self.inverse.map(|row| row[0] * q[0] + row[1] * q[1]);
        v > 0.0 && w > 0.0 && v + w < 1.0
    }
}
