//! Thicknesses of walls.

/// Thickness of walls between rooms that have none in the file, metres.
pub(super) const INNER_WALL: f32 = 0.12;
/// Thickness of outer walls, metres.
pub(super) const OUTER_WALL: f32 = 0.36;
/// Walls of two rooms farther from each other than this are two walls, metres.
pub(super) const THICKEST: f32 = 0.6;
