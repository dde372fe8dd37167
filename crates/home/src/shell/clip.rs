//! Polygons that are cut off along a line.

/// What of a convex polygon is where a linear function of its corners is not negative (Sutherland & Hodgman 1974).
pub(super) fn kept_where<P: Copy>(polygon: &[P], side: impl Fn(&P) -> f32, between: impl Fn(&P, &P, f32) -> P) -> Vec<P> {
    let mut kept = Vec::new();
    for (i, here) in polygon.iter().enumerate() {
        let next = &polygon[(i + 1) % polygon.len()];
        let (a, b) = (side(here), side(next));
        if a >= 0.0 {
            kept.push(*here);
        }
        if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
            let t = a / (a - b);
            kept.push(between(here, next, t));
        }
    }
    kept
}
