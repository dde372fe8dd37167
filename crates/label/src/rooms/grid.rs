//! Squares of a plane.

use enfilade_math::DVec2;

/// Squares, or rectangles, row by row.
pub struct Grid {
    pub low: DVec2,
    pub step: DVec2,
    pub columns: usize,
    pub rows: usize,
}

impl Grid {
    /// From one corner to at least the other.
    pub fn new(low: DVec2, high: DVec2, step: DVec2) -> Self {
        let [columns, rows] = ((high - low) / step).to_array().map(|n| (n.ceil() as usize).max(1));
        Self { low, step, columns, rows }
    }

    pub fn count(&self) -> usize {
        self.columns * self.rows
    }

    /// The middle of a square.
    pub fn middle(&self, i: usize) -> DVec2 {
        self.low + self.step * (DVec2::new((i % self.columns) as f64, (i / self.columns) as f64) + 0.5)
    }

    /// Calls `visit` for each square whose middle lies in a convex polygon, counter-clockwise.
    pub fn each_in(&self, polygon: &[DVec2], mut visit: impl FnMut(usize)) {
        let Some((low, high)) = polygon.iter().map(|&p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else { return };
        if !(low.is_finite() && high.is_finite()) {
            return;
        }
        let place = |p: f64, axis: usize, count: usize| (((p - self.low[axis]) / self.step[axis]).max(0.0) as usize).min(count - 1);
        let is_in = |p: DVec2| (0..polygon.len()).all(|i| (polygon[(i + 1) % polygon.len()] - polygon[i]).perp_dot(p - polygon[i]) >= 0.0);
        for row in place(low.y, 1, self.rows)..=place(high.y, 1, self.rows) {
            for column in place(low.x, 0, self.columns)..=place(high.x, 0, self.columns) {
                let i = row * self.columns + column;
                if is_in(self.middle(i)) {
                    visit(i);
                }
            }
        }
    }

    /// Visits the cells in a triangle, either way round.
    pub fn each_in_triangle(&self, [a, b, c]: [DVec2; 3], visit: impl FnMut(usize)) {
        self.each_in(&if (b - a).perp_dot(c - a) > 0.0 { [a, b, c] } else { [a, c, b] }, visit);
    }
}
