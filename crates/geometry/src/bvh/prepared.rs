//! What is computed once per ray.

use enfilade_math::{Ray, Vec3};

/// By which share of a bound of the distance from a ray's origin boxes grow; see [`Prepared::new`].
pub(super) const SLACK: f32 = 6.0 * f32::EPSILON;

/// By how much boxes grow on all sides, for a ray among triangles with coordinates of at most `largest_coordinate`.
#[inline(always)]
pub(super) fn slack(ray: &Ray, largest_coordinate: f32) -> f32 {
    SLACK * (largest_coordinate + ray.origin.abs().max_element())
}

/// A ray made ready: constants of the box test and of the triangle test.
pub(super) struct Prepared {
    pub origin: [f32; 3],
    /// 1/direction, finite (see [`Prepared::new`]).
    pub inverse: [f32; 3],
    /// The origin moved back, for the planes by which the ray leaves boxes.
    pub behind: [f32; 3],
    /// The origin moved ahead, for the planes by which it enters them.
    pub ahead: [f32; 3],
    /// Per axis, which bound of a box the ray enters by: 0 (min) or 1 (max).
    pub enters_by: [usize; 3],
    /// The axes of the sheared space; the last is the one of the largest component of the direction.
    pub axes: [usize; 3],
    pub shear: [f32; 3],
}

impl Prepared {
    /// The triangle test moves corners by up to 3 ε of their distance from the origin, and the box test errs by up to 2 ε; a box must not
    /// be missed that holds a triangle accepted with those roundings (nor whose thickness is zero, nor in whose side the ray lies). So
    /// boxes grow on all sides by 6 ε of a bound of that distance, by moving the origin the other way.
    ///
    /// A component of the direction that is zero would make 0 · ∞ = NaN in the plane of a wall; its inverse is kept finite.
    #[inline(always)]
    pub fn new(ray: &Ray, largest_coordinate: f32) -> Self {
        Self::with_slack(ray.origin, ray.direction, slack(ray, largest_coordinate))
    }

    /// As [`Prepared::new`], with boxes that grow on all sides by `slack`.
    #[inline(always)]
    pub fn with_slack(origin: Vec3, direction: Vec3, slack: f32) -> Self {
        const MAX_INVERSE: f32 = 1e18;
        let (origin, d) = (origin.to_array(), direction.to_array());
        let size = d.map(f32::abs);
        let x_or_y = usize::from(size[1] > size[0]);
        let z = if size[2] > size[x_or_y] { 2 } else { x_or_y };
        let axes = [[1, 2, 0], [2, 0, 1], [0, 1, 2]][z];
        let inverse_z = 1.0 / d[z];
        let shear = [d[axes[0]] * inverse_z, d[axes[1]] * inverse_z, inverse_z];

        let limit = (MAX_INVERSE * inverse_z.abs()).min(f32::MAX);
        let (mut inverse, mut behind, mut ahead, mut enters_by) = ([0.0; 3], [0.0; 3], [0.0; 3], [0; 3]);
        for k in 0..3 {
            let exact = 1.0 / d[k];
            inverse[k] = if exact.abs() < limit { exact } else { limit.copysign(d[k]) };
            behind[k] = origin[k] - slack.copysign(d[k]);
            ahead[k] = origin[k] + slack.copysign(d[k]);
            enters_by[k] = usize::from(d[k].is_sign_negative());
        }
        Self { origin, inverse, behind, ahead, enters_by, axes, shear }
    }
}
