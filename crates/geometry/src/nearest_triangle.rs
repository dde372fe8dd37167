//! The nearest triangle and its distance, for many questions about the same triangles: a binary tree of boxes.

use crate::nearest::nearest_point;
use enfilade_math::{Bounds3, DVec3, Vec3};

/// Number of the nearest given points from which the distance between two surfaces is searched.
const STARTS: usize = 8;
/// Number of steps there and back.
const STEPS: usize = 12;

/// Triangles in a leaf.
const LEAF: usize = 8;

/// A binary tree of boxes over triangles, halved at the median of their middles.
///
/// ```
/// use enfilade_geometry::NearestTriangle;
/// use enfilade_math::{DVec3, Vec3};
///
/// let triangle = |z: f32| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| p + z * Vec3::Z);
/// let shelves = NearestTriangle::new(&[triangle(0.0), triangle(1.0), triangle(2.0)]);
/// assert_eq!(shelves.nearest(DVec3::new(0.2, 0.2, 1.25)), Some((1, 0.25)));
/// ```
pub struct NearestTriangle {
    /// In the order of the leaves.
    corners: Vec<[Vec3; 3]>,
    /// The number of each, as it was given.
    numbers: Vec<u32>,
    nodes: Vec<Node>,
}

/// The first child of an inner node is the next node.
struct Node {
    bounds: Bounds3,
    /// The first triangle of a leaf; the second child of an inner node.
    first: u32,
    /// Triangles of a leaf; 0 for inner nodes.
    count: u32,
}

impl NearestTriangle {
    /// Builds the tree; triangles are numbered in their order.
    pub fn new(corners: &[[Vec3; 3]]) -> Self {
        let mut numbers: Vec<u32> = (0..corners.len() as u32).collect();
        let mut nodes = Vec::new();
        if !corners.is_empty() {
            build(corners, &mut numbers, 0, &mut nodes);
        }
        Self { corners: numbers.iter().map(|&i| corners[i as usize]).collect(), numbers, nodes }
    }

    /// The distance to another surface, from the nearest of points of this one: back and forth to the nearest point of the other, which never
    /// gets farther. An upper bound, and the distance itself where either surface is convex near its end. Infinite without points.
    pub fn distance_m(&self, other: &Self, points: &[DVec3]) -> f64 {
        let mut starts: Vec<(f64, DVec3)> = points.iter().filter_map(|&p| Some((other.nearest(p)?.1, p))).collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let walk = |&(_, start): &(f64, DVec3)| {
            let (mut here, mut there) = (start, start);
            for _ in 0..STEPS {
                let before = here;
                there = other.nearest_point(here).unwrap_or(here);
                here = self.nearest_point(there).unwrap_or(there);
                if here == before {
                    break;
                }
            }
            here.distance(there)
        };
        starts.iter().take(STARTS).map(walk).fold(f64::INFINITY, f64::min)
    }

    /// The point nearest to another; `None` without triangles.
    pub fn nearest_point(&self, p: DVec3) -> Option<DVec3> {
        self.search(p).map(|(_, point, _)| point)
    }

    /// The number of the triangle nearest to a point and the distance to it, metres; the lowest number of several at the same distance.
    /// `None` without triangles.
    pub fn nearest(&self, p: DVec3) -> Option<(u32, f64)> {
        self.search(p).map(|(number, _, distance)| (number, distance))
    }

    /// Number, nearest point and distance.
    fn search(&self, p: DVec3) -> Option<(u32, DVec3, f64)> {
        let (mut best, mut point) = ((f64::INFINITY, u32::MAX), p);
        let mut stack = Vec::with_capacity(64);
        // Squared: no triangle below a node is nearer than its box.
        let lower_bound = |node: usize| {
            let Bounds3 { min, max } = self.nodes[node].bounds;
            p.clamp(min.as_dvec3(), max.as_dvec3()).distance_squared(p)
        };
        if !self.nodes.is_empty() {
            stack.push((0, lower_bound(0)));
        }
        while let Some((index, distance)) = stack.pop() {
            // At an equal distance there may still be a triangle with a lower number.
            if distance > best.0 {
                continue;
            }
            let node = &self.nodes[index];
            if node.count == 0 {
                let children = [index + 1, node.first as usize].map(|child| (child, lower_bound(child)));
                let nearer_last = children[0].1 < children[1].1;
                stack.extend(if nearer_last { [children[1], children[0]] } else { children });
                continue;
            }
            for i in node.first as usize..(node.first + node.count) as usize {
                let nearest = nearest_point(p, self.corners[i].map(|c| c.as_dvec3()));
                let distance = nearest.distance_squared(p);
                if (distance, self.numbers[i]) < best {
                    (best, point) = ((distance, self.numbers[i]), nearest);
                }
            }
        }
        (best.1 != u32::MAX).then(|| (best.1, point, best.0.sqrt()))
    }
}

/// Appends the tree over `numbers`, whose position among all numbers starts at `first`.
fn build(corners: &[[Vec3; 3]], numbers: &mut [u32], first: usize, nodes: &mut Vec<Node>) {
    let of = |number: u32| corners[number as usize];
    let bounds = Bounds3::from_points(numbers.iter().flat_map(|&i| of(i)));
    let here = nodes.len();
    nodes.push(Node { bounds, first: first as u32, count: numbers.len() as u32 });
    if numbers.len() <= LEAF {
        return;
    }
    let middle = |number: u32| of(number).iter().sum::<Vec3>();
    let axis = Bounds3::from_points(numbers.iter().map(|&i| middle(i))).extent().max_position();
    let half = numbers.len() / 2;
    numbers.select_nth_unstable_by(half, |&a, &b| middle(a)[axis].total_cmp(&middle(b)[axis]).then(a.cmp(&b)));
    let (left, right) = numbers.split_at_mut(half);
    build(corners, left, first, nodes);
    nodes[here] = Node { bounds, first: nodes.len() as u32, count: 0 };
    build(corners, right, first + half, nodes);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Surfaces;
    use enfilade_math::Rng;

    #[test]
    fn triangles_without_area_have_a_nearest_point_too() {
        let (a, c, p) = (Vec3::ZERO, Vec3::X, DVec3::new(0.5, 1.0, 0.0));
        for corners in [[a, a, c], [a, c, a], [c, a, a], [a, c, c], [c, c, a], [a, c, 0.25 * c], [a, a, a]] {
            let expected = if corners == [a; 3] { 1.25f64.sqrt() } else { 1.0 };
            assert_eq!(Surfaces::new(&[corners]).distance_m(p), Some(expected), "{corners:?}");
            assert_eq!(NearestTriangle::new(&[corners]).nearest(p), Some((0, expected)), "{corners:?}");
        }
    }

    #[test]
    fn the_nearest_of_many_is_found_and_ties_go_to_the_lowest_number() {
        let mut rng = Rng::new(7);
        let mut point = |scale: f32| scale * Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32());
        let corners: Vec<[Vec3; 3]> = (0..500)
            .map(|_| {
                let at = point(5.0);
                [at, at + point(0.5), at + point(0.5)]
            })
            .collect();
        let doubled = [corners.clone(), corners.clone()].concat();
        let tree = NearestTriangle::new(&doubled);
        for _ in 0..300 {
            let p = point(6.0).as_dvec3();
            let (number, distance) = tree.nearest(p).unwrap();
            assert_eq!(distance, Surfaces::new(&corners).distance_m(p).unwrap());
            assert!(number < 500);
            assert_eq!(Surfaces::new(&corners[number as usize..=number as usize]).distance_m(p), Some(distance));
        }
        assert_eq!(NearestTriangle::new(&[]).nearest(DVec3::ZERO), None);
    }
}
