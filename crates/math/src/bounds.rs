use glam::Vec3;

/// An axis-aligned box. [`Bounds3::EMPTY`] contains nothing and is the neutral element of `union`.
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

    /// True when no point lies inside.
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

    /// True when `p` lies inside or on the surface.
    pub fn contains(&self, p: Vec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }
}
