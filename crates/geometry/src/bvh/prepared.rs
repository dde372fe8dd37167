//! A ray made ready for box tests: what is computed once per ray, and by how much boxes grow to make up for rounding.

use enfilade_math::{Ray, Vec3, Vec3A};

/// Growth of boxes, as a share of an upper bound on their distance from the ray's origin; see [`Prepared::new`].
pub(super) const SLACK: f32 = 6.0 * f32::EPSILON;

/// Growth of boxes on all sides, for a ray among triangles with coordinates of at most `largest_coordinate`.
#[inline(always)]
pub(super) fn slack(ray: &Ray, largest_coordinate: f32) -> f32 {
    SLACK * (largest_coordinate + ray.origin.abs().max_element())
}

/// A ray made ready for the box test.
pub(super) struct Prepared {
    /// 1/direction, finite (see [`Prepared::new`]).
    pub inverse: Vec3A,
    /// The origin moved back, for the planes by which the ray leaves boxes.
    pub behind: Vec3A,
    /// The origin moved ahead, for the planes by which it enters them.
    pub ahead: Vec3A,
    /// Per axis, which bound of a box the ray enters by: 0 (min) or 1 (max).
    pub enters_by: [usize; 3],
}

impl Prepared {
    /// The triangle test moves corners by up to 3 ε of their distance from the origin, and the box test errs by up to 2 ε; a box must not
    /// be missed if it has a triangle accepted with those roundings (nor if its thickness is zero, nor if the ray runs in one of its
    /// sides). So boxes grow on all sides by 6 ε of a bound of that distance, by moving the origin the other way.
    ///
    /// A component of the direction that is zero would make 0 · ∞ = NaN in the plane of a wall; its inverse is kept finite.
    #[inline(always)]
    pub fn new(ray: &Ray, largest_coordinate: f32) -> Self {
        Self::with_slack(ray.origin, ray.direction, slack(ray, largest_coordinate))
    }

    /// Prepares a ray as [`Prepared::new`] does, with boxes that grow on all sides by `slack`.
    #[inline(always)]
    pub fn with_slack(origin: Vec3, direction: Vec3, slack: f32) -> Self {
        const MAX_INVERSE: f32 = 1e18;
        let (origin, direction) = (Vec3A::from(origin), Vec3A::from(direction));
        let exact = Vec3A::ONE / direction;
        let size = exact.abs();
        // The largest component has the smallest inverse.
        let limit = Vec3A::splat((MAX_INVERSE * size.min_element()).min(f32::MAX));
        let inverse = Vec3A::select(size.cmplt(limit), exact, limit.copysign(direction));
        let slack = Vec3A::splat(slack).copysign(direction);
        let negative = direction.is_negative_bitmask() as usize;
        let enters_by = [negative & 1, negative >> 1 & 1, negative >> 2 & 1];
        Self { inverse, behind: origin - slack, ahead: origin + slack, enters_by }
    }
}
