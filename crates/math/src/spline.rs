//! Curves through points.

use crate::DVec3;

/// The natural cubic spline: passes through its points at the given parameters, and has no curvature at its ends.
#[derive(Clone, Debug)]
pub struct NaturalSpline {
    knots: Vec<f64>,
    points: Vec<DVec3>,
    /// Second derivatives at the knots.
    bends: Vec<DVec3>,
}

impl NaturalSpline {
    /// Through `points` at ascending `knots`, as many of them and at least one.
    ///
    /// # Panics
    /// When there is no point, or not one for each knot.
    ///
    /// ```
    /// use enfilade_math::{DVec3, NaturalSpline};
    /// let curve = NaturalSpline::new(vec![0.0, 1.0, 3.0], vec![DVec3::ZERO, DVec3::X, DVec3::Y]);
    /// assert_eq!(curve.at(1.0), DVec3::X);
    /// ```
    pub fn new(knots: Vec<f64>, points: Vec<DVec3>) -> Self {
        assert!(!points.is_empty() && knots.len() == points.len(), "{} knots for {} points", knots.len(), points.len());
        let n = points.len();
        let mut bends = vec![DVec3::ZERO; n];
        // Thomas' algorithm for the tridiagonal system of continuous first derivatives.
        let mut upper = vec![0.0; n];
        for i in 1..n.saturating_sub(1) {
            let (before, after) = (knots[i] - knots[i - 1], knots[i + 1] - knots[i]);
            let right = 6.0 * ((points[i + 1] - points[i]) / after - (points[i] - points[i - 1]) / before);
            let pivot = 2.0 * (before + after) - before * upper[i - 1];
            upper[i] = after / pivot;
            bends[i] = (right - before * bends[i - 1]) / pivot;
        }
        for i in (1..n.saturating_sub(1)).rev() {
            let next = bends[i + 1];
            bends[i] -= upper[i] * next;
        }
        Self { knots, points, bends }
    }

    /// First and second derivative at `t`.
    pub fn derivatives_at(&self, t: f64) -> [DVec3; 2] {
        let n = self.points.len();
        if n == 1 {
            return [DVec3::ZERO; 2];
        }
        let i = self.stretch(t);
        let h = self.knots[i + 1] - self.knots[i];
        let (a, b) = ((self.knots[i + 1] - t) / h, (t - self.knots[i]) / h);
        let slope = (self.points[i + 1] - self.points[i]) / h;
        let bend = (3.0 * b * b - 1.0) * self.bends[i + 1] - (3.0 * a * a - 1.0) * self.bends[i];
        [slope + bend * (h / 6.0), a * self.bends[i] + b * self.bends[i + 1]]
    }

    /// The interval between two knots that determines the curve at `t`, by its first knot.
    fn stretch(&self, t: f64) -> usize {
        self.knots.partition_point(|knot| *knot <= t).clamp(1, self.knots.len() - 1) - 1
    }

    /// The curve at `t`; before the first knot and after the last the stretch beside them continues.
    pub fn at(&self, t: f64) -> DVec3 {
        let n = self.points.len();
        if n == 1 {
            return self.points[0];
        }
        let i = self.stretch(t);
        let h = self.knots[i + 1] - self.knots[i];
        let (a, b) = ((self.knots[i + 1] - t) / h, (t - self.knots[i]) / h);
        let bend = (a * a * a - a) * self.bends[i] + (b * b * b - b) * self.bends[i + 1];
        a * self.points[i] + b * self.points[i + 1] + bend * (h * h / 6.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rng;

    fn points(n: usize) -> Vec<DVec3> {
        let mut rng = Rng::new(6);
        (0..n).map(|_| DVec3::from([0; 3].map(|_| rng.next_f64()))).collect()
    }

    #[test]
    fn curvature_is_continuous() {
        let knots = vec![0.0, 1.0, 3.0, 4.0, 7.0, 8.0, 10.0, 11.0];
        let through = NaturalSpline::new(knots.clone(), points(8));
        let e = 1e-3;
        let second = |t: f64| (through.at(t - e) - 2.0 * through.at(t) + through.at(t + e)) / (e * e);
        for knot in &knots[1..7] {
            assert!((second(knot - 2.0 * e) - second(knot + 2.0 * e)).length() < 0.05);
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let through = NaturalSpline::new(vec![0.0, 1.0, 3.0, 4.0], points(4));
        for t in [0.3, 1.7, 3.5] {
            let e = 1e-4;
            let [first, second] = through.derivatives_at(t);
            assert!(first.distance((through.at(t + e) - through.at(t - e)) / (2.0 * e)) < 1e-6);
            assert!(second.distance((through.at(t + e) - 2.0 * through.at(t) + through.at(t - e)) / (e * e)) < 1e-5);
        }
        assert_eq!(NaturalSpline::new(vec![0.0], points(1)).derivatives_at(2.0), [DVec3::ZERO; 2]);
    }

    #[test]
    fn it_passes_through_all_points_and_straight_lines_stay_straight() {
        for n in [1, 2, 3, 9] {
            let points = points(n);
            let knots: Vec<f64> = (0..n).map(|i| (i * i + i) as f64).collect();
            let through = NaturalSpline::new(knots.clone(), points.clone());
            for (knot, point) in knots.iter().zip(&points) {
                assert!(through.at(*knot).distance(*point) < 1e-12);
            }
        }
        let line: Vec<DVec3> = (0..6).map(|i| DVec3::new(f64::from(i), 2.0, -f64::from(i))).collect();
        let through = NaturalSpline::new((0..6).map(f64::from).collect(), line);
        for t in [0.3, 1.5, 2.0, 4.9] {
            assert!(through.at(t).distance(DVec3::new(t, 2.0, -t)) < 1e-12);
        }
    }
}
