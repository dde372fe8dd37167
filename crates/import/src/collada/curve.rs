//! Values over time, as samplers of animations have them: steps, lines, and curves of Bézier and Hermite.
//!
//! Control points have a time and a value. Those of Hermite's curves are tangents, of which Bézier's points are a third away (COLLADA 1.4.1,
//! "Curve interpolation").

use crate::motion::{self, MOST_STATES, Side, pieces};

/// A control point: seconds, and the value there.
pub(super) type Control = [f64; 2];

/// How values go from one moment to the next.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Segment {
    Step,
    Line,
    /// The two inner control points of each number.
    Bezier(Vec<[Control; 2]>),
}

/// Values over time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    /// Seconds; they do not descend.
    pub times_s: Vec<f64>,
    /// The numbers at each moment.
    pub values: Vec<Vec<f64>>,
    /// From each moment to the next.
    pub segments: Vec<Segment>,
}

impl Curve {
    /// The moments around a moment, and the share of the second one; the first one twice where nothing lies between.
    pub(super) fn around(&self, time_s: f64, side: Side) -> (usize, usize, f64) {
        let last = self.times_s.len() - 1;
        let after = match side {
            Side::Before => self.times_s.partition_point(|&t| t < time_s),
            Side::After => self.times_s.partition_point(|&t| t <= time_s),
        };
        if after == 0 || after > last {
            return (after.min(last), after.min(last), 0.0);
        }
        let [from, to] = [self.times_s[after - 1], self.times_s[after]];
        (after - 1, after, (time_s - from) / (to - from))
    }

    /// The numbers at a moment.
    pub(super) fn at(&self, time_s: f64, side: Side) -> Vec<f64> {
        let (from, to, share) = self.around(time_s, side);
        let (a, b) = (&self.values[from], &self.values[to]);
        if from == to || share == 0.0 {
            return a.clone();
        }
        match &self.segments[from] {
            Segment::Step => a.clone(),
            Segment::Line => a.iter().zip(b).map(|(a, b)| a + (b - a) * share).collect(),
            Segment::Bezier(controls) => {
                let ends = [self.times_s[from], self.times_s[to]];
                let number = |(controls, (a, b)): (&[Control; 2], (&f64, &f64))| {
                    let along = parameter([ends[0], controls[0][0], controls[1][0], ends[1]], time_s);
                    cubic([*a, controls[0][1], controls[1][1], *b], along)
                };
                controls.iter().zip(a.iter().zip(b)).map(number).collect()
            }
        }
    }

    /// The moments at which pieces end: those of the values, of curves many more, and so many that number `turns`, an angle in degrees,
    /// changes by a sixth of a turn at most from one to the next.
    pub(super) fn moments(&self, turns: Option<usize>) -> Vec<f64> {
        let mut moments = self.times_s.clone();
        for (i, pair) in self.times_s.windows(2).enumerate() {
            // More than that are refused anyway.
            if moments.len() > MOST_STATES {
                break;
            }
            let (mut turned, is_bent) = (0.0, matches!(self.segments[i], Segment::Bezier(_)));
            if let Some(number) = turns.filter(|_| self.segments[i] != Segment::Step) {
                let mut way = vec![self.values[i][number]];
                if let Segment::Bezier(controls) = &self.segments[i] {
                    way.extend(controls[number].map(|control| control[1]));
                }
                way.push(self.values[i + 1][number]);
                turned = way.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
            }
            // Curves are up to three times as fast as on average.
            moments.extend(motion::turns(pair[0], pair[1], turned * if is_bent { 3.0 } else { 1.0 }));
            if is_bent {
                moments.extend(pieces(pair[0], pair[1]));
            }
        }
        moments
    }
}

/// The parameter, 0 to 1, at which a cubic whose times do not descend reaches a time.
fn parameter(times_s: [f64; 4], time_s: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if cubic(times_s, middle) < time_s { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Bézier's cubic.
fn cubic([a, b, c, d]: [f64; 4], s: f64) -> f64 {
    let r = 1.0 - s;
    r * r * r * a + 3.0 * r * r * s * b + 3.0 * r * s * s * c + s * s * s * d
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_pass_through_their_values_by_way_of_their_control_points() {
        // Times bend as well: at half the parameter, 1 s · (0 + 3·0.1 + 3·0.2 + 1)/8.
        let bent = Segment::Bezier(vec![[[0.1, 0.0], [0.2, 8.0]]]);
        let curve =
            Curve { times_s: vec![0.0, 1.0, 2.0], values: vec![vec![0.0], vec![8.0], vec![4.0]], segments: vec![bent, Segment::Step] };
        assert!((curve.at(1.9 / 8.0, Side::After)[0] - 4.0).abs() < 1e-9);
        assert_eq!([0.0, 1.0, 1.5, 2.0, 9.0].map(|t| curve.at(t, Side::After)[0]), [0.0, 8.0, 8.0, 4.0, 4.0]);
        assert_eq!(curve.at(2.0, Side::Before)[0], 8.0);
    }
}
