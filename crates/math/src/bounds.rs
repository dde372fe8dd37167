//! Axis-aligned boxes, grown point by point and joined; the empty box is the neutral element.

use glam::Vec3;

/// An axis-aligned box. [`Bounds3::EMPTY`] contains nothing and is the neutral element of `union`.
///
/// ```
/// use enfilade_math::{Bounds3, Vec3};
///
/// let room = Bounds3::from_points([Vec3::ZERO, Vec3::new(4.0, 3.0, 2.5)]);
/// assert_eq!(room.center(), Vec3::new(2.0, 1.5, 1.25));
/// assert!(room.contains(Vec3::ONE) && !room.contains(Vec3::NEG_X));
/// assert_eq!(room.union(Bounds3::EMPTY), room);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds3 {
    /// The corner with the smallest coordinates.
    pub min: Vec3,
    /// The corner with the largest coordinates.
    pub max: Vec3,
}

impl Bounds3 {
    /// The box that contains no point.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The smallest box around `points`; empty when there are none.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, p| bounds.include(p))
    }

    /// The smallest box around this one and `p`.
    #[must_use]
    pub fn include(self, p: Vec3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// True if no point is inside.
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// The centre; meaningless for an empty box.
    pub fn center(&self) -> Vec3 {
        0.5 * (self.min + self.max)
    }

    /// Side lengths; negative for an empty box.
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// Along each axis how far apart the two boxes are; 0 where they overlap.
    pub fn gap(&self, other: &Self) -> Vec3 {
        (self.min - other.max).max(other.min - self.max).max(Vec3::ZERO)
    }

    /// True if `p` is inside or on the surface.
    pub fn contains(&self, p: Vec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }
}
