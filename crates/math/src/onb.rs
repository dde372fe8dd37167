//! Orthonormal bases around a normal, with the changes of coordinates into and out of them: the shading space of a surface point.

use glam::Vec3;

/// A right-handed orthonormal basis: the local space of a surface point, z along the normal.
///
/// ```
/// use enfilade_math::{Onb, Vec3};
///
/// // A wall that faces along x: a direction along the wall has no z in its local space, one away from it has nothing else.
/// let wall = Onb::from_z(Vec3::X);
/// assert_eq!(wall.to_local(Vec3::X), Vec3::Z);
/// assert_eq!(wall.to_local(Vec3::Y).z, 0.0);
/// assert_eq!(wall.to_world(Vec3::Z), Vec3::X);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Onb {
    /// First tangent.
    pub x: Vec3,
    /// Second tangent.
    pub y: Vec3,
    /// The normal.
    pub z: Vec3,
}

impl Onb {
    /// A basis whose z axis is the unit vector `z`; continuous except for one direction.
    ///
    /// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
    #[inline]
    pub fn from_z(z: Vec3) -> Self {
        let sign = 1.0f32.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Self { x: Vec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x), y: Vec3::new(b, sign + z.y * z.y * a, -z.y), z }
    }

    /// Local coordinates of the world direction `v`.
    #[inline]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }

    /// World coordinates of the local direction `v`.
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn basis_is_orthonormal_and_right_handed() {
        for z in [Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::new(0.6, -0.64, -0.48), Vec3::new(1e-6, 0.0, -1.0)] {
            let b = Onb::from_z(z.normalize());
            assert!((b.x.cross(b.y) - b.z).length() < 1e-5, "{b:?}");
            assert!((b.to_world(b.to_local(Vec3::new(0.3, -2.0, 0.7))) - Vec3::new(0.3, -2.0, 0.7)).length() < 1e-5);
        }
    }
}
