//! Measures of walls, and of what overlaps them.

use crate::room::{Back, Room, Wall};
use enfilade_math::Vec2;

/// Overlap of floor, walls and ceiling, metres, so that no light comes through the joints.
pub(super) const OVERLAP: f32 = 0.1;
/// The overlap at walls between rooms, which are thin.
pub(super) const THIN_OVERLAP: f32 = 0.03;
/// Thickness of ceilings, metres.
pub(super) const THICKNESS: f32 = 0.2;
/// Half the air between the two halves of a wall.
pub(super) const AIR: f32 = 0.0005;
/// Overlap of floor coverings and walls, metres.
pub(super) const UNDER_WALLS: f32 = 0.04;
/// Thickness and height of skirting boards, metres.
pub(super) const SKIRTING: Vec2 = Vec2::new(0.014, 0.085);

/// Depth of the part of a piece of wall that belongs to the room, metres.
pub(super) fn depth(back: &Back) -> f32 {
    if back.outer { back.thickness } else { 0.5 * back.thickness - AIR }
}

/// The openings of a wall, measured from the point `middle` of its x axis.
pub(super) fn holes(room: &Room, wall: Wall, middle: f32) -> Vec<[f32; 4]> {
    let of_wall = room.openings.iter().filter(|o| o.wall == wall);
    of_wall.map(|o| [o.x[0] - middle, o.x[1] - middle, if o.z[0] <= 0.0 { -OVERLAP } else { o.z[0] }, o.z[1]]).collect()
}
