//! A curve of continuous curvature that stays near its points.

use enfilade_math::DVec3;

/// A uniform cubic B-spline: at parameter i it is near point i, it begins and ends in the first and last point, and each segment of it is
/// in the convex hull of the four points around, so it never overshoots.
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

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;

    fn points(n: usize) -> Vec<DVec3> {
        let mut rng = Rng::new(6);
        (0..n).map(|_| DVec3::from([0; 3].map(|_| rng.next_f64()))).collect()
    }

    #[test]
    fn curvature_is_continuous() {
        let near = NearSpline::new(points(8));
        let e = 1e-3;
        let second = |t: f64| (near.at(t - e) - 2.0 * near.at(t) + near.at(t + e)) / (e * e);
        for knot in 1..7 {
            let knot = f64::from(knot);
            assert!((second(knot - 2.0 * e) - second(knot + 2.0 * e)).length() < 0.05);
        }
    }

    #[test]
    fn it_begins_and_ends_in_its_points() {
        for n in [1, 2, 3, 9] {
            let points = points(n);
            let near = NearSpline::new(points.clone());
            assert!(near.at(0.0).distance(points[0]) < 1e-12 && near.at(near.end()).distance(points[n - 1]) < 1e-12);
        }
    }

    #[test]
    fn straight_lines_stay_straight() {
        let line: Vec<DVec3> = (0..6).map(|i| DVec3::new(f64::from(i), 2.0, -f64::from(i))).collect();
        let near = NearSpline::new(line);
        for t in [0.3, 1.5, 2.0, 4.9] {
            assert!(near.at(t).distance(DVec3::new(t, 2.0, -t)) < 1e-12, "{} at {t}", near.at(t));
        }
    }
}
