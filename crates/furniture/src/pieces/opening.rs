//! The openings that doors, passages, windows and curtains are made for.

use super::on;
use enfilade_math::{DAffine3, Vec2, Vec3};

/// An opening through a wall, as what fills it needs to know it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallOpening {
    /// The wall's own space in the home: the origin is on the floor at the middle of the inner face, x runs along it, y into the room.
    pub wall: DAffine3,
    /// From and to along the wall, metres.
    pub x: [f32; 2],
    /// From and to above the floor, metres.
    pub z: [f32; 2],
    /// Thickness of the wall, from this room to the next or to the outside, metres.
    pub thickness: f32,
    /// True where the outside is behind the wall.
    pub outer: bool,
}

impl WallOpening {
    /// Width and height, metres.
    pub fn size(&self) -> Vec2 {
        Vec2::new(self.x[1] - self.x[0], self.z[1] - self.z[0])
    }

    /// The pose at the middle of the opening's width on the inner face, `z` metres above the floor.
    pub fn pose(&self, z: f32) -> DAffine3 {
        on(self.wall, Vec3::new(0.5 * (self.x[0] + self.x[1]), 0.0, z), 0.0)
    }
}
