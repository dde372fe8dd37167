//! The dining room: a table for the household and its guests, and what is needed to lay it.

use super::Furnisher;
use super::wishes::{centred, cornered, in_view};

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    let center = f.room.center;
    if !f.dine([4, 10], |_, s| s.origin.distance(center)) {
        f.dine([2, 4], |_, s| s.origin.distance(center));
    }
    let board = f.perhaps(0.85, "sideboard", centred);
    f.accent = board.and_then(|b| b.spot.wall);
    f.perhaps(0.4, "glass_cabinet", cornered);
    f.perhaps(0.7, "plant", cornered);
    f.art(2, in_view);
}
