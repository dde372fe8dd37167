//! The distance to the nearest surface, for a few questions about many triangles: no tree, only boxes around runs of triangles.

use enfilade_math::{Bounds3, DVec3, Vec3};

/// Triangles in a block: neighbours in a mesh are neighbours in its list, so blocks are small in space.
const BLOCK: usize = 32;

/// Triangles, in blocks with bounds, that can be asked for the nearest of them.
pub struct Surfaces<'a> {
    corners: &'a [[Vec3; 3]],
    bounds: Vec<Bounds3>,
}

impl<'a> Surfaces<'a> {
    /// Blocks of 32 triangles each, in their order. Copies nothing but makes a box for each block.
    pub fn new(corners: &'a [[Vec3; 3]]) -> Self {
        let bounds = corners.chunks(BLOCK).map(|block| Bounds3::from_points(block.iter().flatten().copied())).collect();
        Self { corners, bounds }
    }

    /// Distance from a point to the nearest triangle, metres; `None` without triangles.
    pub fn distance_m(&self, p: DVec3) -> Option<f64> {
        // Squared: no triangle of a block is nearer than its box.
        let lower_bound = |bounds: &Bounds3| p.clamp(bounds.min.as_dvec3(), bounds.max.as_dvec3()).distance_squared(p);
        let blocks = || self.bounds.iter().zip(self.corners.chunks(BLOCK));
        let nearest = |block: &[[Vec3; 3]]| {
            let distances = block.iter().map(|corners| nearest_point(p, corners.map(|c| c.as_dvec3())).distance_squared(p));
            distances.fold(f64::INFINITY, f64::min)
        };
        // Begin with the block whose bounds are nearest: most others are then too far away to be looked at.
        let (_, first) = blocks().min_by(|(a, _), (b, _)| lower_bound(a).total_cmp(&lower_bound(b)))?;
        let best =
            blocks().fold(nearest(first), |best, (bounds, block)| if lower_bound(bounds) < best { best.min(nearest(block)) } else { best });
        Some(best.sqrt())
    }
}

/// The point of a triangle nearest to `p`. Ericson, "Real-Time Collision Detection", section 5.1.5.
pub(crate) fn nearest_point(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    // In a triangle without area, an edge may have length 0; the nearest point is then on another edge.
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3 {
        return a + ab * (d1 / (d1 - d3));
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 && (d4 - d3) + (d5 - d6) > 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    a + (ab * vb + ac * vc) / (va + vb + vc)
}
