//! Vectors, rays, colour, random numbers, sampling warps and distributions.
//!
//! Conventions of the whole workspace: right-handed world, z up, metres, radians; column vectors, so that
//! `world_from_camera * p_camera` is a point in the world. Vectors are `glam`'s; names state what a value is (point, direction, normal) and
//! its space: `p_world`, `n_camera`, `dir_world`.

pub mod angle;
mod bounds;
mod distribution;
mod hash;
mod nearest_rotation;
mod onb;
mod oriented_box;
mod quantile;
mod ray;
mod rgb;
mod sampler;
mod spline;
pub mod warp;
mod way;

pub use bounds::Bounds3;
pub use distribution::{Distribution1, Distribution2};
pub use glam::{Affine3A, DAffine3, DMat2, DMat3, DMat4, DQuat, DVec2, DVec3, Mat2, Mat3, Mat4, Quat, UVec2, Vec2, Vec3, Vec3A, Vec4};
pub use hash::{Rng, hash_text, hash_u32, hash_u64};
pub use nearest_rotation::nearest_rotation;
pub use onb::Onb;
pub use oriented_box::OrientedBox;
pub use quantile::quantile;
pub use ray::{Ray, offset_origin};
pub use rgb::{Rgb, linear_from_srgb, srgb_from_linear};
pub use sampler::Sampler;
pub use spline::NaturalSpline;
pub use way::free_way;

/// A point in another space: in double precision, rounded once.
///
/// Everything that is placed in the world uses this function, so that all users get the same position to the last bit.
#[inline]
pub fn place(to_from: &DAffine3, p: Vec3) -> Vec3 {
    to_from.transform_point3(p.as_dvec3()).as_vec3()
}

/// `1 / π`.
pub const INV_PI: f32 = std::f32::consts::FRAC_1_PI;

/// The largest `f32` below one: the upper end of "uniform on [0,1)".
pub const ONE_MINUS_EPSILON: f32 = 1.0 - f32::EPSILON / 2.0;
