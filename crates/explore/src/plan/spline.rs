//! Two curves of continuous curvature: one that stays near its points, and one that passes through them.

use enfilade_math::DVec3;

/// A uniform cubic B-spline: at parameter i it is near point i, it begins and ends in the first and last point, and each stretch of it
/// lies in the hull of the four points around, so it never overshoots.
pub(super) struct NearSpline {
    points: Vec<DVec3>,
}

impl NearSpline {
    /// Near the given points, of which there is at least one.
    pub fn new(points: Vec<DVec3>) -> Self {
        assert!(!points.is_empty(), "a spline needs a point");
        Self { points }
    }

    /// The greatest parameter.
    pub fn end(&self) -> f64 {
        (self.points.len() - 1) as f64
    }

    /// The curve at `u`, from 0 to [`NearSpline::end`].
    pub fn at(&self, u: f64) -> DVec3 {
        let last = self.points.len() as i64 - 1;
        let i = (u.floor() as i64).clamp(0, (last - 1).max(0));
        let t = u - i as f64;
        let s = 1.0 - t;
        let weights = [s * s * s, 3.0 * t * t * t - 6.0 * t * t + 4.0, 3.0 * s * s * s - 6.0 * s * s + 4.0, t * t * t];
        // Points beyond the ends are mirrored, so that the curve reaches the ends.
        let point = |k: i64| match k {
            k if k < 0 => 2.0 * self.points[0] - self.points[last.min(-k) as usize],
            k if k > last => 2.0 * self.points[last as usize] - self.points[(2 * last - k).max(0) as usize],
            k => self.points[k as usize],
        };
        (0..4).map(|k| weights[k as usize] / 6.0 * point(i + k - 1)).sum()
    }
}

/// The natural cubic spline: passes through its points at the given parameters, and has no curvature at its ends.
pub(super) struct ThroughSpline {
    knots: Vec<f64>,
    points: Vec<DVec3>,
    /// Second derivatives at the knots.
    bends: Vec<DVec3>,
}

impl ThroughSpline {
    /// Through `points` at ascending `knots`, as many of them and at least one.
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

    /// The curve at `t` between the first and the last knot.
    pub fn at(&self, t: f64) -> DVec3 {
        let n = self.points.len();
        if n == 1 {
            return self.points[0];
        }
        let i = self.knots.partition_point(|knot| *knot <= t).clamp(1, n - 1) - 1;
        let h = self.knots[i + 1] - self.knots[i];
        let (a, b) = ((self.knots[i + 1] - t) / h, (t - self.knots[i]) / h);
        let bend = (a * a * a - a) * self.bends[i] + (b * b * b - b) * self.bends[i + 1];
        a * self.points[i] + b * self.points[i + 1] + bend * (h * h / 6.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;

    fn points(n: usize) -> Vec<DVec3> {
        let mut rng = Rng::new(6);
        (0..n).map(|_| DVec3::from([0; 3].map(|_| rng.next_f64()))).collect()
    }

    /// Largest jump of the second derivative at the inner knots.
    fn jump(curve: impl Fn(f64) -> DVec3, knots: &[f64]) -> f64 {
        let e = 1e-3;
        let second = |t: f64| (curve(t - e) - 2.0 * curve(t) + curve(t + e)) / (e * e);
        knots[1..knots.len() - 1].iter().map(|k| (second(k - 2.0 * e) - second(k + 2.0 * e)).length()).fold(0.0, f64::max)
    }

    #[test]
    fn curvature_is_continuous() {
        let near = NearSpline::new(points(8));
        assert!(jump(|t| near.at(t), &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]) < 0.05);
        let knots = vec![0.0, 1.0, 3.0, 4.0, 7.0, 8.0, 10.0, 11.0];
        let through = ThroughSpline::new(knots.clone(), points(8));
        assert!(jump(|t| through.at(t), &knots) < 0.05);
    }

    #[test]
    fn one_begins_and_ends_in_its_points_and_the_other_passes_through_all() {
        for n in [1, 2, 3, 9] {
            let points = points(n);
            let near = NearSpline::new(points.clone());
            assert!(near.at(0.0).distance(points[0]) < 1e-12 && near.at(near.end()).distance(points[n - 1]) < 1e-12);
            let knots: Vec<f64> = (0..n).map(|i| (i * i + i) as f64).collect();
            let through = ThroughSpline::new(knots.clone(), points.clone());
            for (knot, point) in knots.iter().zip(&points) {
                assert!(through.at(*knot).distance(*point) < 1e-12);
            }
        }
    }

    #[test]
    fn straight_lines_stay_straight() {
        let line: Vec<DVec3> = (0..6).map(|i| DVec3::new(f64::from(i), 2.0, -f64::from(i))).collect();
        let (near, through) = (NearSpline::new(line.clone()), ThroughSpline::new((0..6).map(f64::from).collect(), line));
        for t in [0.3, 1.5, 2.0, 4.9] {
            for p in [near.at(t), through.at(t)] {
                assert!(p.distance(DVec3::new(t, 2.0, -t)) < 1e-12, "{p} at {t}");
            }
        }
    }
}
