//! Types of the simulation beside ours.

use enfilade_math::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use rapier3d_f64::math::{Pose3, Rot3, Vector};

/// A point or direction of the simulation.
pub fn vector(v: DVec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

/// A point of ours in the simulation.
pub fn point(v: Vec3) -> Vector {
    vector(v.as_dvec3())
}

/// A point or direction of ours.
pub fn ours(v: Vector) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}

/// A rigid pose of the simulation.
pub fn pose(rotation: DQuat, translation: DVec3) -> Pose3 {
    Pose3::from_parts(vector(translation), Rot3::from_xyzw(rotation.x, rotation.y, rotation.z, rotation.w))
}

/// Rotation and translation of a pose as a map of ours.
pub fn placement(pose: &Pose3) -> DAffine3 {
    let q = pose.rotation;
    let rotation = DQuat::from_xyzw(q.x, q.y, q.z, q.w).normalize();
    DAffine3 { matrix3: DMat3::from_quat(rotation), translation: ours(pose.translation) }
}
