//! The direction of one thing for someone who stands at another and looks at a third, seen from above.

use enfilade_math::DVec2;

/// Answers must be so far from where they would change, degrees.
const MARGIN_DEG: f64 = 10.0;

/// The angle from the way to `facing` to the way to `asked`, for someone at `standing`: degrees on (−180, 180], positive to the left.
pub fn angle_deg(standing: DVec2, facing: DVec2, asked: DVec2) -> f64 {
    (facing - standing).angle_to(asked - standing).to_degrees()
}

/// Left or right; `None` where it is nearly ahead or behind.
pub fn side(angle_deg: f64) -> Option<usize> {
    let clear = (MARGIN_DEG..=180.0 - MARGIN_DEG).contains(&angle_deg.abs());
    clear.then_some(usize::from(angle_deg < 0.0))
}

/// Left, right or back, each 90 degrees wide; `None` ahead, and near where they meet.
pub fn third(angle_deg: f64) -> Option<usize> {
    let far = angle_deg.abs();
    if (45.0 + MARGIN_DEG..=135.0 - MARGIN_DEG).contains(&far) {
        Some(usize::from(angle_deg < 0.0))
    } else {
        (far >= 135.0 + MARGIN_DEG).then_some(2)
    }
}

/// Front-left, front-right, back-left or back-right; `None` near where they meet.
pub fn quarter(angle_deg: f64) -> Option<usize> {
    let (far, right) = (angle_deg.abs(), usize::from(angle_deg < 0.0));
    if (MARGIN_DEG..=90.0 - MARGIN_DEG).contains(&far) {
        Some(right)
    } else {
        (90.0 + MARGIN_DEG..=180.0 - MARGIN_DEG).contains(&far).then_some(2 + right)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_those_of_someone_who_turns_there() {
        let at = |x: f64, y: f64| angle_deg(DVec2::ZERO, DVec2::Y, DVec2::new(x, y));
        assert_eq!([side(at(-1.0, 0.3)), side(at(1.0, -0.3)), side(at(0.1, 1.0)), side(at(0.1, -1.0))], [Some(0), Some(1), None, None]);
        assert_eq!(
            [third(at(-1.0, 0.0)), third(at(1.0, 0.0)), third(at(0.2, -1.0)), third(at(0.0, 1.0)), third(at(1.0, 0.9))],
            [Some(0), Some(1), Some(2), None, None]
        );
        assert_eq!([at(-1.0, 1.0), at(1.0, 1.0), at(-1.0, -1.0), at(1.0, -1.0)].map(quarter), [Some(0), Some(1), Some(2), Some(3)]);
        assert_eq!(quarter(at(1.0, 0.05)), None);
    }
}
