//! Boxes of any orientation: a middle, three orthonormal axes and three side lengths, in double precision.

use glam::{DMat3, DVec3};

/// A box of any orientation.
///
/// ```
/// use enfilade_math::{DMat3, DVec3, OrientedBox};
///
/// // A table top of 2 m by 1 m, turned by 30 degrees.
/// let turned = DMat3::from_rotation_z(30f64.to_radians());
/// let corners = [[-1.0, -0.5], [1.0, -0.5], [1.0, 0.5], [-1.0, 0.5]].map(|[x, y]| turned * DVec3::new(x, y, 0.75));
/// let tight = OrientedBox::around(corners, turned).unwrap();
/// assert!((tight.extents - DVec3::new(2.0, 1.0, 0.0)).length() < 1e-12);
/// assert!((tight.distance_beyond(turned * DVec3::new(1.5, 0.0, 0.75)) - 0.5).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox {
    /// Middle of the box.
    pub center: DVec3,
    /// Columns are the directions of its sides: orthonormal, right-handed.
    pub world_from_box: DMat3,
    /// Lengths of its sides, in the order of the columns.
    pub extents: DVec3,
}

impl OrientedBox {
    /// Pairs of [`OrientedBox::corners`] that are joined by an edge.
    pub const EDGES: [[usize; 2]; 12] = [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

    /// The smallest box around `points` whose sides have the directions of `world_from_box`; `None` without points.
    pub fn around(points: impl IntoIterator<Item = DVec3>, world_from_box: DMat3) -> Option<Self> {
        let box_from_world = world_from_box.transpose();
        let (min, max) = points.into_iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| {
            let p = box_from_world * p;
            (min.min(p), max.max(p))
        });
        let extents = max - min;
        (extents.x >= 0.0).then(|| Self { center: world_from_box * (min + 0.5 * extents), world_from_box, extents })
    }

    /// Product of the side lengths.
    pub fn volume(&self) -> f64 {
        self.extents.element_product()
    }

    /// The eight corners; corner i is at the positive end of axis k if bit k of i is set.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let side = |bit: usize| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
            self.center + self.world_from_box * (self.extents * DVec3::new(side(0), side(1), side(2)))
        })
    }

    /// A point of the world in the box's own axes, from its middle.
    pub fn local(&self, p_world: DVec3) -> DVec3 {
        self.world_from_box.transpose() * (p_world - self.center)
    }

    /// Distance of `p` outside: the largest distance beyond a pair of sides; at most 0 inside.
    pub fn distance_beyond(&self, p: DVec3) -> f64 {
        (self.local(p).abs() - 0.5 * self.extents).max_element()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_box_is_tight_around_its_corners() {
        let turned = DMat3::from_rotation_z(0.4) * DMat3::from_rotation_x(-1.1);
        let made = OrientedBox { center: DVec3::new(1.0, 2.0, 3.0), world_from_box: turned, extents: DVec3::new(3.0, 2.0, 0.5) };
        let back = OrientedBox::around(made.corners(), turned).unwrap();
        assert!((back.center - made.center).length() < 1e-14 && (back.extents - made.extents).length() < 1e-14);
        assert!((back.volume() - 3.0).abs() < 1e-13);
        assert!(made.corners().iter().all(|&p| made.distance_beyond(p).abs() < 1e-14));
        assert!((made.distance_beyond(made.center + 2.5 * turned.x_axis) - 1.0).abs() < 1e-14);
        assert_eq!(OrientedBox::around([], turned), None);
    }

    #[test]
    fn edges_join_corners_one_side_apart() {
        let unit = OrientedBox { center: DVec3::ZERO, world_from_box: DMat3::IDENTITY, extents: DVec3::ONE };
        let corners = unit.corners();
        assert!(OrientedBox::EDGES.iter().all(|&[a, b]| corners[a].distance(corners[b]) == 1.0));
    }
}
