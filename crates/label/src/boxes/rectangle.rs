//! The rectangle of least area around points of a plane: convex hull and rotating calipers.
//!
//! A rectangle of least area has a side along an edge of the convex hull (Freeman & Shapira 1975), and the four points that touch
//! it move around the hull as that edge does (Toussaint 1983, "Solving geometric problems with the rotating calipers").

use enfilade_math::DVec2;

/// A direction of the sides of the rectangle of least area around `points`, unit length, and that area.
///
/// Points on a line give its direction and no area; a single point gives x.
pub(super) fn least_rectangle(points: &mut Vec<DVec2>) -> (DVec2, f64) {
    let hull = convex_hull(points);
    if hull.len() < 3 {
        let along = if hull.len() == 2 { (hull[1] - hull[0]).normalize() } else { DVec2::X };
        return (along, 0.0);
    }
    let n = hull.len();
    let farther = |direction: DVec2, mut at: usize| {
        // Each pointer only moves on, so that all edges together cost O(n).
        while direction.dot(hull[(at + 1) % n] - hull[at % n]) > 0.0 {
            at += 1;
        }
        at
    };
    let (mut right, mut top, mut left) = (1, 1, 1);
    let mut best = (DVec2::X, f64::INFINITY);
    for i in 0..n {
        let Some(along) = (hull[(i + 1) % n] - hull[i]).try_normalize() else { continue };
        right = farther(along, right.max(i + 1));
        top = farther(along.perp(), top.max(right));
        left = farther(-along, left.max(top));
        let width = along.dot(hull[right % n] - hull[left % n]);
        let area = width * along.perp().dot(hull[top % n] - hull[i]);
        if area < best.1 {
            best = (along, area);
        }
    }
    best
}

/// The corners of the convex hull, counter-clockwise, without points on its edges: Andrew's monotone chain. Sorts `points`.
pub(super) fn convex_hull(points: &mut Vec<DVec2>) -> Vec<DVec2> {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points.clone();
    }
    let mut hull: Vec<DVec2> = Vec::new();
    let mut chain = |points: &mut dyn Iterator<Item = DVec2>| {
        let first = hull.len();
        for p in points {
            while hull.len() >= first + 2 && (hull[hull.len() - 1] - hull[hull.len() - 2]).perp_dot(p - hull[hull.len() - 1]) <= 0.0 {
                hull.pop();
            }
            hull.push(p);
        }
        // The end of this chain begins the next.
        hull.pop();
    };
    chain(&mut points.iter().copied());
    chain(&mut points.iter().rev().copied());
    hull
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;

    fn area_along(points: &[DVec2], along: DVec2) -> f64 {
        let span = |d: DVec2| points.iter().map(|p| p.dot(d)).fold(f64::NEG_INFINITY, f64::max);
        (span(along) + span(-along)) * (span(along.perp()) + span(-along.perp()))
    }

    #[test]
    fn no_direction_of_many_gives_a_smaller_rectangle() {
        let mut rng = Rng::new(7);
        for count in [3, 4, 5, 8, 20, 300] {
            let points: Vec<DVec2> = (0..count).map(|_| DVec2::new(3.0 * rng.next_f64(), rng.next_f64())).collect();
            let (along, area) = least_rectangle(&mut points.clone());
            assert!((area_along(&points, along) - area).abs() < 1e-12, "{count} points");
            let turned = (0..20_000).map(|i| area_along(&points, DVec2::from_angle(f64::from(i) * 1e-4)));
            assert!(turned.fold(f64::INFINITY, f64::min) >= area - 1e-12, "{count} points");
        }
    }

    #[test]
    fn a_turned_rectangle_and_an_l_shape_are_found_exactly() {
        for angle in [0.0, 0.3, 1.2, 2.9] {
            let turn = |x: f64, y: f64| DVec2::from_angle(angle).rotate(DVec2::new(x, y));
            let mut rectangle = vec![turn(0.0, 0.0), turn(4.0, 0.0), turn(4.0, 1.0), turn(0.0, 1.0), turn(2.0, 1.0), turn(1.0, 0.5)];
            assert!((least_rectangle(&mut rectangle).1 - 4.0).abs() < 1e-12);
            let mut l = vec![turn(0.0, 0.0), turn(3.0, 0.0), turn(3.0, 1.0), turn(1.0, 1.0), turn(1.0, 3.0), turn(0.0, 3.0)];
            let (along, area) = least_rectangle(&mut l);
            // Along the hull's slanted edge: sqrt(8) + ... beats nothing here; the square of 9 is least.
            assert!((area - 9.0).abs() < 1e-12, "{along} {area}");
        }
    }

    #[test]
    fn lines_points_and_repeated_points_have_no_area() {
        let (along, area) = least_rectangle(&mut vec![DVec2::new(1.0, 1.0), DVec2::new(3.0, 3.0), DVec2::new(2.0, 2.0)]);
        assert!((along.perp_dot(DVec2::ONE).abs() < 1e-15) && area == 0.0);
        assert_eq!(least_rectangle(&mut vec![DVec2::ONE; 5]), (DVec2::X, 0.0));
        assert_eq!(least_rectangle(&mut Vec::new()), (DVec2::X, 0.0));
    }
}
