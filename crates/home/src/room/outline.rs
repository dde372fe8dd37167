//! Simple polygons: outlines of rooms, counter-clockwise.

use enfilade_math::{DVec2, Vec2};
use std::f32::consts::{PI, TAU};

/// Step of the first grid on which the middle of a polygon is sought, as a share of its shorter extent.
const GRID: f32 = 1.0 / 24.0;
/// Angles of corners this near to half a turn count as straight, radians.
const STRAIGHT: f32 = 1e-3;

/// The corners of a simple polygon, counter-clockwise; edge i begins at corner i.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// In double precision, as files state them.
    pub corners: Vec<DVec2>,
    /// The same in single precision.
    points: Vec<Vec2>,
    convex: bool,
}

impl Outline {
    /// A polygon of at least three corners.
    pub fn new(corners: Vec<DVec2>) -> Self {
        let points: Vec<Vec2> = corners.iter().map(|p| p.as_vec2()).collect();
        let mut outline = Self { corners, points, convex: false };
        outline.convex = (0..outline.count()).all(|i| outline.angle(i) < PI + STRAIGHT);
        outline
    }

    /// Number of corners.
    pub fn count(&self) -> usize {
        self.points.len()
    }

    /// True where no corner points inwards.
    pub fn is_convex(&self) -> bool {
        self.convex
    }

    /// A corner; they go round.
    pub fn corner(&self, i: usize) -> Vec2 {
        self.points[i % self.count()]
    }

    /// An edge, from its beginning to its end.
    pub fn edge(&self, i: usize) -> [Vec2; 2] {
        [self.corner(i), self.corner(i + 1)]
    }

    /// All edges.
    pub fn edges(&self) -> impl Iterator<Item = [Vec2; 2]> {
        (0..self.count()).map(|i| self.edge(i))
    }

    /// The angle inside at a corner, radians: above π where the corner points into the polygon.
    pub fn angle(&self, i: usize) -> f32 {
        let (before, at, after) = (self.corner(i + self.count() - 1), self.corner(i), self.corner(i + 1));
        let turn = (after - at).angle_to(before - at);
        if turn < 0.0 { turn + TAU } else { turn }
    }

    /// Area, m².
    pub fn area(&self) -> f32 {
        let corner = |i: usize| self.corners[i % self.count()];
        let twice: f64 = (0..self.count()).map(|i| corner(i).perp_dot(corner(i + 1))).sum();
        (0.5 * twice) as f32
    }

    /// The smallest and the largest coordinates.
    pub fn bounds(&self) -> [Vec2; 2] {
        let fold = |of: fn(Vec2, Vec2) -> Vec2| self.points.iter().copied().reduce(of).unwrap_or(Vec2::ZERO);
        [fold(Vec2::min), fold(Vec2::max)]
    }

    /// True inside.
    pub fn contains(&self, p: Vec2) -> bool {
        let crosses = |&[a, b]: &[Vec2; 2]| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
        self.edges().filter(crosses).count() % 2 == 1
    }

    /// Distance of a point from the nearest edge: positive inside, negative outside.
    pub fn depth(&self, p: Vec2) -> f32 {
        let nearest = self.edges().map(|edge| distance(edge, p)).fold(f32::INFINITY, f32::min);
        if self.contains(p) { nearest } else { -nearest }
    }

    /// Distance from a point in the unit direction `way` to the first edge that the ray meets from inside or outside, and its number.
    pub fn cast(&self, from: Vec2, way: Vec2) -> Option<(f32, usize)> {
        let meets = |i: usize| {
            let [a, b] = self.edge(i);
            let across = way.perp_dot(b - a);
            let (t, u) = ((a - from).perp_dot(b - a) / across, (a - from).perp_dot(way) / across);
            (across.abs() > 1e-9 && t > 1e-4 && (-1e-6..=1.0 + 1e-6).contains(&u)).then_some((t, i))
        };
        (0..self.count()).filter_map(meets).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The point farthest from all edges, which is in the middle of the widest part (on a grid that is refined around the best points).
    pub fn middle(&self) -> Vec2 {
        let [low, high] = self.bounds();
        let mut step = (high - low).min_element() * GRID;
        let count = ((high - low) / step).ceil();
        let grid = (0..=count.y as usize).flat_map(|j| (0..=count.x as usize).map(move |i| Vec2::new(i as f32, j as f32)));
        // Of equally deep points the one nearest to the middle of all.
        let middle = 0.5 * (low + high);
        let worth = |p: Vec2| self.depth(p) - 1e-3 * p.distance(middle);
        let better = |best: Vec2, p: Vec2| if worth(p) > worth(best) { p } else { best };
        let mut best = grid.map(|k| low + k * step).fold(middle, better);
        for _ in 0..6 {
            step *= 0.5;
            let around = (0..9).map(|k| best + step * Vec2::new((k % 3) as f32 - 1.0, (k / 3) as f32 - 1.0));
            best = around.fold(best, better);
        }
        best
    }

    /// The deepest point that is far from the first, if one is deep enough to be the middle of something.
    pub fn second_middle(&self, first: Vec2) -> Option<Vec2> {
        /// Distance between the middles, and of the second from walls, metres.
        const APART: [f32; 2] = [2.4, 0.6];
        let [low, high] = self.bounds();
        let count = ((high - low) / 0.1).ceil();
        let grid = (0..=count.y as usize).flat_map(|j| (0..=count.x as usize).map(move |i| low + 0.1 * Vec2::new(i as f32, j as f32)));
        let deep = grid.filter(|p| p.distance(first) > APART[0]).map(|p| (self.depth(p), p)).filter(|(depth, _)| *depth > APART[1]);
        deep.reduce(|a, b| if b.0 > a.0 + 1e-4 { b } else { a }).map(|(_, p)| p)
    }

    /// The polygon with every edge moved outwards by `by` metres.
    pub fn grown(&self, by: f32) -> Vec<Vec2> {
        let outward = |i: usize| {
            let [a, b] = self.edge(i % self.count());
            -(b - a).normalize_or_zero().perp()
        };
        let corner = |i: usize| {
            let (n, m) = (outward(i + self.count() - 1), outward(i));
            self.corner(i) + by * (n + m) / (1.0 + n.dot(m)).max(0.15)
        };
        (0..self.count()).map(corner).collect()
    }
}

/// Distance of a point from a line segment.
pub fn distance([a, b]: [Vec2; 2], p: Vec2) -> f32 {
    let along = (b - a) / (b - a).length_squared().max(f32::MIN_POSITIVE);
    (a + (b - a) * along.dot(p - a).clamp(0.0, 1.0)).distance(p)
}

/// Triangles that cover a simple counter-clockwise polygon, by cutting off ears.
pub fn triangles(corners: &[Vec2]) -> Vec<[usize; 3]> {
    let mut left: Vec<usize> = (0..corners.len()).collect();
    let mut found = Vec::new();
    while left.len() > 3 {
        let n = left.len();
        let ear = |k: usize| [left[(k + n - 1) % n], left[k], left[(k + 1) % n]];
        let shape = |t: [usize; 3]| {
            let [a, b, c] = t.map(|i| corners[i]);
            let area = (b - a).perp_dot(c - a);
            // Long thin ears last.
            area / (a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a)).max(f32::MIN_POSITIVE)
        };
        let is_free = |t: [usize; 3]| left.iter().all(|&i| t.contains(&i) || !in_triangle(t.map(|k| corners[k]), corners[i]));
        let best = (0..n).filter(|&k| shape(ear(k)) > 0.0 && is_free(ear(k))).max_by(|&a, &b| shape(ear(a)).total_cmp(&shape(ear(b))));
        // A simple polygon has an ear; where rounding hides it, the best corner goes.
        let k = best.unwrap_or_else(|| (0..n).max_by(|&a, &b| shape(ear(a)).total_cmp(&shape(ear(b)))).unwrap_or(0));
        found.push(ear(k));
        left.remove(k);
    }
    if let [a, b, c] = left[..] {
        found.push([a, b, c]);
    }
    found
}

fn in_triangle([a, b, c]: [Vec2; 3], p: Vec2) -> bool {
    [(a, b), (b, c), (c, a)].iter().all(|(from, to)| (*to - *from).perp_dot(p - *from) >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(corners: &[[f64; 2]]) -> Outline {
        Outline::new(corners.iter().map(|&c| DVec2::from(c)).collect())
    }

    /// 4 × 1 and 1 × 2 metres.
    fn l_shape() -> Outline {
        polygon(&[[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]])
    }

    #[test]
    fn an_l_has_its_area_its_angles_and_its_depths() {
        let l = l_shape();
        assert_eq!((l.area(), l.is_convex()), (6.0, false));
        let turns: Vec<f32> = (0..6).map(|i| l.angle(i).to_degrees().round()).collect();
        assert_eq!(turns, [90.0, 90.0, 90.0, 270.0, 90.0, 90.0]);
        for (p, depth) in [([0.5, 2.0], 0.5), ([2.0, 2.0], -1.0), ([3.9, 0.5], 0.1), ([0.5, 0.5], 0.5)] {
            assert!((l.depth(Vec2::from(p)) - depth).abs() < 1e-6, "{p:?}");
        }
        assert_eq!(l.cast(Vec2::new(0.5, 0.0), Vec2::Y), Some((3.0, 4)));
        assert_eq!(l.cast(Vec2::new(3.0, 0.0), Vec2::Y), Some((1.0, 2)));
        // The widest part is around the corner at the origin.
        assert!(l.middle().distance(Vec2::new(0.58, 0.58)) < 0.03, "{}", l.middle());
    }

    #[test]
    fn triangles_cover_the_polygon_and_no_more() {
        let star: Vec<[f64; 2]> = (0..10)
            .map(|k| {
                let (sin, cos) = (f64::from(k) * std::f64::consts::PI / 5.0).sin_cos();
                let radius = if k % 2 == 0 { 2.0 } else { 0.8 };
                [radius * cos, radius * sin]
            })
            .collect();
        for outline in [l_shape(), polygon(&star)] {
            let points: Vec<Vec2> = (0..outline.count()).map(|i| outline.corner(i)).collect();
            let covering = triangles(&points);
            let area: f32 = covering.iter().map(|t| t.map(|i| points[i])).map(|[a, b, c]| 0.5 * (b - a).perp_dot(c - a)).sum();
            assert_eq!(covering.len(), points.len() - 2);
            assert!((area - outline.area()).abs() < 1e-4);
        }
    }

    #[test]
    fn a_grown_polygon_keeps_its_distance() {
        let grown = l_shape().grown(0.1);
        let expected = [[-0.1, -0.1], [4.1, -0.1], [4.1, 1.1], [1.1, 1.1], [1.1, 3.1], [-0.1, 3.1]];
        assert!(grown.iter().zip(expected).all(|(p, q)| p.distance(Vec2::from(q)) < 1e-6), "{grown:?}");
    }
}
