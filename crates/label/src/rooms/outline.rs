//! Polygons of the plan.

use enfilade_math::DVec2;

/// The edges of an outline, from corner to corner.
pub fn edges(outline: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> + '_ {
    (0..outline.len()).map(|i| [outline[i], outline[(i + 1) % outline.len()]])
}

/// The area of a polygon, negative where it runs clockwise.
pub fn area(polygon: &[DVec2]) -> f64 {
    0.5 * edges(polygon).map(|[a, b]| a.perp_dot(b)).sum::<f64>()
}
