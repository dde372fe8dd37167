//! Signed distances to triangles at the corners of a block of cells.

use crate::meet::{Triangle, around};
use enfilade_math::Vec3;
use std::ops::Range;

/// Edge of a cell, metres.
pub(super) const CELL: f32 = 0.016;
/// Distances up to this one are exact, metres; greater ones are this one.
pub(super) const REACH: f32 = 0.048;
/// Two distances that differ by less are one, metres: of triangles that share the nearest point, the one that faces it most decides the sign.
const SAME: f32 = 1e-4;
/// Cells along an edge of a block, which is computed as a whole.
pub(super) const BLOCK: usize = 6;
/// Corners of cells along an edge of a block.
pub(super) const CORNERS: usize = BLOCK + 1;
/// Corners of cells in a block.
const SIZE: usize = CORNERS * CORNERS * CORNERS;

/// The distances of one block while they are computed.
pub(super) struct Grid {
    min: Vec3,
    /// Signed distances at the corners of cells.
    pub distance: [f32; SIZE],
    /// How directly the triangle faces the corner that decides its distance.
    facing: [f32; SIZE],
}

impl Grid {
    /// The block whose smallest corner is `min`, far from everything.
    pub fn new(min: Vec3) -> Self {
        Self { min, distance: [REACH; SIZE], facing: [0.0; SIZE] }
    }

    /// Takes a triangle into account.
    pub fn add(&mut self, triangle: &Triangle) {
        let [a, b, c] = *triangle;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let bounds = around(triangle);
        let low = ((bounds.min - REACH - self.min) / CELL).ceil();
        let high = ((bounds.max + REACH - self.min) / CELL).floor();
        let range = |axis: usize| span(low[axis], high[axis], CORNERS);
        for k in range(2) {
            for j in range(1) {
                for i in range(0) {
                    let p = self.min + CELL * Vec3::new(i as f32, j as f32, k as f32);
                    let cell = (k * CORNERS + j) * CORNERS + i;
                    let known = self.distance[cell].abs();
                    let height = normal.dot(p - a);
                    // Neither its plane nor its box is nearer than what is known.
                    let beside = p - p.clamp(bounds.min, bounds.max);
                    if height.abs() > known + SAME || beside.length_squared() > (known + SAME) * (known + SAME) {
                        continue;
                    }
                    let away = p.distance(nearest(p, triangle));
                    let faces = height.abs() / away.max(1e-6);
                    if away < known - SAME || (away < known + SAME && faces > self.facing[cell]) {
                        self.distance[cell] = if height < 0.0 { -away } else { away };
                        self.facing[cell] = faces;
                    }
                }
            }
        }
    }
}

/// Whole numbers from `low` to `high` that are below `count`.
pub(super) fn span(low: f32, high: f32, count: usize) -> Range<usize> {
    low.max(0.0) as usize..((high + 1.0).max(0.0) as usize).min(count)
}

/// The point of a triangle that is nearest to `p` (Ericson 2005, "Real-time collision detection", 5.1.5).
fn nearest(p: Vec3, [a, b, c]: &Triangle) -> Vec3 {
    let (ab, ac, ap) = (*b - *a, *c - *a, p - *a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let bp = p - *b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return *a + ab * (d1 / (d1 - d3));
    }
    let cp = p - *c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return *a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return *b + (*c - *b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = 1.0 / (va + vb + vc);
    *a + ab * (vb * sum) + ac * (vc * sum)
}
