//! Unity's space and ours.

use super::house::Euler;
use enfilade_math::{DMat3, DVec3};

/// From Unity's axes to right-handed ones with y up: factors of the coordinates.
pub(super) const MIRROR: DVec3 = DVec3::new(-1.0, 1.0, 1.0);

/// A rotation of Unity's: degrees about z, then x, then y.
pub(super) fn turn(euler: Euler) -> DMat3 {
    let [x, y, z] = [euler.x, euler.y, euler.z].map(f64::to_radians);
    DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x) * DMat3::from_rotation_z(z)
}
