//! Curves of drawings as polygons: arcs and Bézier curves of SVG, bulges and circles of DXF.
//!
//! A curve becomes the fewest straight pieces that are within [`NEAR_M`] of it. Their corners are moved outwards by what a chord cuts off,
//! so that areas stay those of the curves.

use enfilade_math::DVec2;
use std::f64::consts::TAU;

/// Greatest distance between a curve and the pieces in its place, metres.
pub(super) const NEAR_M: f64 = 0.005;
/// Most pieces of a curve.
const MOST: usize = 96;
/// Places of each piece at which its distance is measured.
const BETWEEN: usize = 8;

/// The corners of pieces in place of `curve` over 0 to 1, without its beginning.
pub(super) fn flattened(curve: &dyn Fn(f64) -> DVec2, near: f64) -> Vec<DVec2> {
    let count = (1..MOST).find(|&n| (0..n).all(|k| off(curve, k, n) <= near)).unwrap_or(MOST);
    let corners: Vec<DVec2> = (0..=count).map(|k| curve(k as f64 / count as f64)).collect();
    let lost: Vec<f64> = (0..count).map(|k| cut_off(curve, k, count)).collect();
    let moved = |k: usize| {
        if k == count {
            return corners[k];
        }
        // A corner makes up for half of what the pieces beside it cut off; for all of it at the ends, which stay where they are.
        let share = |piece: usize| if count > 1 && (piece == 0 || piece + 1 == count) { 1.0 } else { 0.5 };
        let area = share(k - 1) * lost[k - 1] + share(k) * lost[k];
        let across = corners[k + 1] - corners[k - 1];
        corners[k] - across.normalize_or_zero().perp() * (2.0 * area / across.length().max(f64::MIN_POSITIVE))
    };
    (1..=count).map(moved).collect()
}

/// Places of a piece of a curve, its ends included.
fn places(curve: &dyn Fn(f64) -> DVec2, k: usize, n: usize) -> impl Iterator<Item = DVec2> {
    (0..=BETWEEN).map(move |i| curve((k as f64 + i as f64 / BETWEEN as f64) / n as f64))
}

/// Greatest distance of a piece of a curve from its chord.
fn off(curve: &dyn Fn(f64) -> DVec2, k: usize, n: usize) -> f64 {
    let all: Vec<DVec2> = places(curve, k, n).collect();
    let (from, chord) = (all[0], all[BETWEEN] - all[0]);
    let along = chord / chord.length_squared().max(f64::MIN_POSITIVE);
    all.iter().map(|p| (from + chord * along.dot(*p - from).clamp(0.0, 1.0)).distance(*p)).fold(0.0, f64::max)
}

/// Area between a piece of a curve and its chord, positive to the right of the chord.
fn cut_off(curve: &dyn Fn(f64) -> DVec2, k: usize, n: usize) -> f64 {
    let all: Vec<DVec2> = places(curve, k, n).collect();
    0.5 * (0..=BETWEEN).map(|i| (all[i] - all[0]).perp_dot(all[(i + 1) % (BETWEEN + 1)] - all[0])).sum::<f64>()
}

/// A Bézier curve of degree two or three over 0 to 1.
pub(super) fn bezier(points: &[DVec2], t: f64) -> DVec2 {
    let mut points = points.to_vec();
    while points.len() > 1 {
        points = points.windows(2).map(|pair| pair[0].lerp(pair[1], t)).collect();
    }
    points[0]
}

/// An arc of an ellipse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arc {
    pub center: DVec2,
    /// Half its axes.
    pub radii: DVec2,
    /// Turn of its first axis, radians.
    pub turn: f64,
    /// Where it begins, from the first axis, and how far it goes, counter-clockwise, radians.
    pub from: f64,
    pub sweep: f64,
}

impl Arc {
    pub fn at(&self, t: f64) -> DVec2 {
        let (sin, cos) = (self.from + t * self.sweep).sin_cos();
        self.center + DVec2::from_angle(self.turn).rotate(self.radii * DVec2::new(cos, sin))
    }

    /// A whole circle or ellipse along the axes.
    pub fn whole(center: DVec2, radii: DVec2) -> Self {
        Self { center, radii, turn: 0.0, from: 0.0, sweep: TAU }
    }

    /// The corners of pieces in place of a whole ellipse, all around.
    pub fn corners(&self, near: f64) -> Vec<DVec2> {
        let quarter = |k: usize| Self { from: self.from + 0.25 * self.sweep * k as f64, sweep: 0.25 * self.sweep, ..*self };
        (0..4).flat_map(|k| flattened(&|t| quarter(k).at(t), near)).collect()
    }

    /// The arc between two points of an SVG path (SVG 1.1, appendix F.6.5); `None` where it is a straight line.
    pub fn of_svg([p, q]: [DVec2; 2], radii: DVec2, turn: f64, [large, sweep]: [bool; 2]) -> Option<Self> {
        let half = DVec2::from_angle(-turn).rotate(0.5 * (p - q));
        let unscaled = radii.abs();
        if unscaled.min_element() == 0.0 || p == q {
            return None;
        }
        // Radii that are too small grow until the ends are on the ellipse.
        let radii = unscaled * (half / unscaled).length().max(1.0);
        let on = half / radii;
        let away = ((1.0 - on.length_squared()).max(0.0) / on.length_squared()).sqrt() * if large == sweep { -1.0 } else { 1.0 };
        let middle = away * DVec2::new(on.y, -on.x);
        let center = DVec2::from_angle(turn).rotate(middle * radii) + 0.5 * (p + q);
        let angle = |v: DVec2| v.y.atan2(v.x);
        let (from, to) = (angle(on - middle), angle(-on - middle));
        let full = (to - from).rem_euclid(TAU);
        Some(Self { center, radii, turn, from, sweep: if sweep { full } else { full - TAU } })
    }

    /// The arc of a DXF bulge, the tangent of a quarter of its angle, positive counter-clockwise; `None` where it is a straight line.
    pub fn of_bulge([p, q]: [DVec2; 2], bulge: f64) -> Option<Self> {
        let chord = q - p;
        if bulge == 0.0 || chord.length() == 0.0 || !bulge.is_finite() {
            return None;
        }
        let sweep = 4.0 * bulge.atan();
        let center = 0.5 * (p + q) + chord.perp() * (0.5 * (1.0 - bulge * bulge) / (2.0 * bulge));
        let radius = center.distance(p);
        let from = (p - center).y.atan2((p - center).x);
        Some(Self { center, radii: DVec2::splat(radius), turn: 0.0, from, sweep })
    }
}

#[cfg(test)]
mod tests {
    use super::super::loops::area;
    use super::*;
    use std::f64::consts::PI;

    /// Greatest distance of corners and middles of edges from a circle.
    fn off_circle(corners: &[DVec2], center: DVec2, radius: f64) -> f64 {
        let edge = |i: usize| [corners[i], 0.5 * (corners[i] + corners[(i + 1) % corners.len()])];
        (0..corners.len()).flat_map(edge).map(|p| (p.distance(center) - radius).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn circles_keep_their_area_and_are_near() {
        for radius in [0.4, 1.0, 2.5, 8.0] {
            let center = DVec2::new(3.0, -1.0);
            let corners = Arc::whole(center, DVec2::splat(radius)).corners(NEAR_M);
            let expected = PI * radius * radius;
            assert!((area(&corners) - expected).abs() < 1e-3 * expected, "{radius}: {} of {expected}", area(&corners));
            assert!(off_circle(&corners, center, radius) <= NEAR_M && corners.len() < 100, "{radius}: {} corners", corners.len());
        }
    }

    #[test]
    fn a_bulge_of_one_is_half_a_circle_and_its_sign_is_its_side() {
        let ends = [DVec2::ZERO, DVec2::new(2.0, 0.0)];
        for (bulge, low) in [(1.0, -1.0), (-1.0, 1.0)] {
            let arc = Arc::of_bulge(ends, bulge).unwrap();
            assert!((arc.sweep.abs() - PI).abs() < 1e-12 && arc.at(0.5).distance(DVec2::new(1.0, low)) < 1e-12, "{arc:?}");
            assert!(arc.at(0.0).distance(ends[0]) < 1e-12 && arc.at(1.0).distance(ends[1]) < 1e-12);
        }
        // A quarter: tan(90° / 4).
        let quarter = Arc::of_bulge([DVec2::X, DVec2::Y], (PI / 8.0).tan()).unwrap();
        assert!(quarter.center.length() < 1e-12 && (quarter.radii.x - 1.0).abs() < 1e-12, "{quarter:?}");
        assert_eq!(Arc::of_bulge(ends, 0.0), None);
    }

    #[test]
    fn arcs_of_svg_go_the_way_their_flags_say() {
        let ends = [DVec2::X, DVec2::Y];
        for (large, sweep, middle) in [
            (false, true, DVec2::splat(0.5f64.sqrt())),
            (true, false, DVec2::splat(-(0.5f64.sqrt()))),
            (false, false, DVec2::splat(1.0 - 0.5f64.sqrt())),
            (true, true, DVec2::splat(1.0 + 0.5f64.sqrt())),
        ] {
            let arc = Arc::of_svg(ends, DVec2::ONE, 0.0, [large, sweep]).unwrap();
            assert!(arc.at(0.0).distance(ends[0]) < 1e-9 && arc.at(1.0).distance(ends[1]) < 1e-9, "{arc:?}");
            assert!(arc.at(0.5).distance(middle) < 1e-9, "{large} {sweep}: {}", arc.at(0.5));
        }
        // Radii that are too small make half a circle.
        let arc = Arc::of_svg([DVec2::ZERO, DVec2::new(4.0, 0.0)], DVec2::splat(0.1), 0.0, [false, true]).unwrap();
        assert!((arc.radii.x - 2.0).abs() < 1e-9 && (arc.sweep.abs() - PI).abs() < 1e-6, "{arc:?}");
    }
}
