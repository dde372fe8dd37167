//! The four sides of the compass, as plans and names of walls use them.

use super::Wall;
use enfilade_math::Vec2;
use std::f64::consts::{FRAC_PI_2, PI};

/// A side of a rectangle along the axes, named after where it is. North is +y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Side {
    South,
    East,
    North,
    West,
}

impl Side {
    /// All, counter-clockwise from the south.
    pub const ALL: [Self; 4] = [Self::South, Self::East, Self::North, Self::West];

    /// The side `steps` further, counter-clockwise.
    pub fn turned(self, steps: usize) -> Self {
        Self::ALL[(self as usize + steps) % 4]
    }

    /// Unit vector inwards.
    pub fn inward(self) -> Vec2 {
        [Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y, Vec2::X][self as usize]
    }

    /// Unit vector along the side, to the left for someone inside who faces it.
    pub fn along(self) -> Vec2 {
        let n = self.inward();
        Vec2::new(n.y, -n.x)
    }

    /// Rotation that takes +y to [`Side::inward`].
    pub fn yaw(self) -> f64 {
        [0.0, FRAC_PI_2, PI, -FRAC_PI_2][self as usize]
    }

    /// The wall on this side of a rectangular room.
    pub fn wall(self) -> Wall {
        Wall(self as usize)
    }

    /// The side that a wall with this normal into the room is on, as nearly as it is on one.
    pub fn facing(inward: Vec2) -> Self {
        Self::ALL.into_iter().fold(
            Self::South,
            |best, side| {
                if side.inward().dot(inward) > best.inward().dot(inward) + 1e-4 { side } else { best }
            },
        )
    }

    /// Name in lower case.
    pub const fn name(self) -> &'static str {
        ["south", "east", "north", "west"][self as usize]
    }
}
