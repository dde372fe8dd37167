//! Surfaces of things on which smaller ones stand: level rectangles, and the pose and distance of things on them.

use enfilade_math::{DAffine3, Vec2, Vec3};

/// A level rectangle on which small things can stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The corner with the smallest x and y, in the thing's own space.
    pub min: Vec2,
    /// The corner with the largest x and y.
    pub max: Vec2,
    /// Height of the rectangle.
    pub z: f32,
    /// Free height above it; infinite under the open sky of the room.
    pub headroom: f32,
}

/// The pose of something at `at` in another thing's space, turned by `yaw`.
pub fn on(pose: DAffine3, at: Vec3, yaw: f32) -> DAffine3 {
    pose * DAffine3::from_translation(at.as_dvec3()) * DAffine3::from_rotation_z(f64::from(yaw))
}

/// Distance between things and what carries them, metres: contact without faces in one plane.
pub const CONTACT: f32 = 0.0005;
