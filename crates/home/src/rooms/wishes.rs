//! Costs of places: what people like and dislike about where a thing stands.

use crate::place::{Floor, Spot};

/// In a corner.
pub fn cornered(floor: &Floor, spot: &Spot) -> f32 {
    floor.to_corner(spot)
}

/// In the middle of a wall, and rather of a long one.
pub fn centred(floor: &Floor, spot: &Spot) -> f32 {
    spot.x.abs() - 0.3 * spot.wall.map_or(0.0, |wall| floor.room().length(wall))
}

/// In a corner far from doors.
pub fn tucked_away(floor: &Floor, spot: &Spot) -> f32 {
    floor.to_corner(spot) - 0.5 * floor.to_way(spot.origin)
}

/// By a window, where the light is.
pub fn by_window(floor: &Floor, spot: &Spot) -> f32 {
    floor.to_window(spot.origin) + 0.2 * floor.to_corner(spot)
}

/// By the door.
pub fn by_door(floor: &Floor, spot: &Spot) -> f32 {
    floor.to_way(spot.origin)
}

/// In view of the door: opposite to it.
pub fn in_view(floor: &Floor, spot: &Spot) -> f32 {
    spot.x.abs() - floor.to_way(spot.origin)
}
