//! Nearest neighbours of points: a balanced k-d tree in three dimensions, with exact distances.

use enfilade_math::DVec3;

/// Points of a leaf: fewer cost more steps, more cost more distances.
const LEAF: usize = 8;

/// Points, in the order of a balanced tree that is split at medians along the longest extent.
pub(crate) struct KdTree {
    points: Vec<(DVec3, u32)>,
    /// Axis and place of each split by its middle index.
    splits: Vec<(u8, f64)>,
}

impl KdTree {
    /// A tree over points, which are known by their index.
    pub fn new(points: &[DVec3]) -> Self {
        let mut tree = Self { points: points.iter().copied().zip(0..).collect(), splits: vec![(0, 0.0); points.len()] };
        split(&mut tree.points, &mut tree.splits);
        tree
    }

    /// Index of the nearest point and its squared distance; `None` without points.
    pub fn nearest(&self, p: DVec3) -> Option<(usize, f64)> {
        let mut best = (0, f64::INFINITY);
        self.search(p, 0, self.points.len(), &mut best);
        (best.1 < f64::INFINITY).then_some((best.0 as usize, best.1))
    }

    fn search(&self, p: DVec3, from: usize, to: usize, best: &mut (u32, f64)) {
        if to - from <= LEAF {
            for &(point, index) in &self.points[from..to] {
                let distance = point.distance_squared(p);
                if distance < best.1 {
                    *best = (index, distance);
                }
            }
            return;
        }
        let middle = from + (to - from) / 2;
        let (axis, place) = self.splits[middle];
        let beyond = p[usize::from(axis)] - place;
        let (near, far) = if beyond < 0.0 { ((from, middle), (middle, to)) } else { ((middle, to), (from, middle)) };
        self.search(p, near.0, near.1, best);
        if beyond * beyond < best.1 {
            self.search(p, far.0, far.1, best);
        }
    }
}

fn split(points: &mut [(DVec3, u32)], splits: &mut [(u8, f64)]) {
    if points.len() <= LEAF {
        return;
    }
    let (min, max) = points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), (p, _)| (a.min(*p), b.max(*p)));
    let axis = (max - min).max_position();
    let middle = points.len() / 2;
    let (_, median, _) = points.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]));
    splits[middle] = (axis as u8, median.0[axis]);
    let ((low, high), (low_splits, high_splits)) = (points.split_at_mut(middle), splits.split_at_mut(middle));
    split(low, low_splits);
    split(high, high_splits);
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;

    #[test]
    fn the_nearest_point_is_that_of_brute_force() {
        let mut rng = Rng::new(3);
        for n in [1, 7, 8, 9, 64, 1000] {
            let mut point = |scale: f64| scale * (DVec3::from_array(std::array::from_fn(|_| f64::from(rng.next_f32()))) - 0.5);
            // A third of the points lie on a plane, and every fourth is there twice.
            let mut points: Vec<DVec3> = (0..n).map(|i| if i % 3 == 0 { point(1.0).with_z(0.25) } else { point(1.0) }).collect();
            (0..n).filter(|i| i % 4 == 3).for_each(|i| points[i] = points[i - 1]);
            let tree = KdTree::new(&points);
            for _ in 0..200 {
                let p = point(1.5);
                let expected = points.iter().map(|q| q.distance_squared(p)).fold(f64::INFINITY, f64::min);
                let (index, distance) = tree.nearest(p).unwrap();
                assert_eq!((distance, points[index].distance_squared(p)), (expected, expected));
            }
        }
        assert_eq!(KdTree::new(&[]).nearest(DVec3::ZERO), None);
    }
}
