//! Inverting functions that rise from zero up to where they first fall.

/// Newton's steps before bisection has the last word; a lens takes five.
const STEPS: usize = 100;

/// The first of the ascending `places` at which `slope` is not positive, refined by bisection; `None` when there is none.
pub(super) fn first_fall(places: impl Iterator<Item = f64>, slope: impl Fn(f64) -> f64) -> Option<f64> {
    let mut low = 0.0;
    for place in places {
        // NaN is a fall.
        let rises = slope(place) > 0.0;
        if !rises {
            let mut high = place;
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if slope(middle) > 0.0 { low = middle } else { high = middle }
            }
            return Some(low);
        }
        low = place;
    }
    None
}

/// The x in [0, `x_max`] at which a function that rises from 0 has the value `wanted`. `function` gives value and slope.
#[inline]
pub(super) fn solve_rising(wanted: f64, x_max: f64, function: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut high) = (0.0, x_max);
    let mut x = wanted.min(x_max);
    for _ in 0..STEPS {
        let (value, slope) = function(x);
        let error = value - wanted;
        if error == 0.0 {
            return x;
        }
        if error > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - error / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - x).abs() <= f64::EPSILON * x.abs() {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_found_up_to_the_last_rise() {
        let function = |x: f64| (x - x.powi(3) / 3.0, 1.0 - x * x);
        let end = first_fall((1..100).map(|i| 0.03 * f64::from(i)), |x| function(x).1).unwrap();
        assert!((end - 1.0).abs() < 1e-12);
        for x in [0.0, 1e-9, 0.3, 0.9, 0.999_999] {
            assert!((solve_rising(function(x).0, end, function) - x).abs() < 1e-9, "{x}");
        }
        assert_eq!(first_fall([1.0, 2.0].into_iter(), |_| 1.0), None);
    }
}
