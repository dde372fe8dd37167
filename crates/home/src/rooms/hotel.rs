//! The hotel room: a bed, a place to write, a television, and a rack for a suitcase.

use super::Furnisher;
use super::bedroom::bed;
use super::wishes::{by_door, by_window, centred, cornered, in_view, tucked_away};
use enfilade_furniture::office::WallDisplay;

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    if !bed(f, 2) {
        bed(f, 1);
    }
    if !f.work_place(by_window) {
        f.furnish("console", by_window);
    }
    f.furnish("wardrobe", by_door);
    let behind = f.accent;
    let television = WallDisplay { width: f.rng.range(0.9, 1.2), shows: None };
    let walls: Vec<_> = f.room.walls().into_iter().filter(|wall| Some(f.room.face(*wall).opposite) == behind).collect();
    f.hang(&television, 1.3, &walls, |_, s| s.x.abs());
    f.perhaps(0.7, "bench", centred);
    f.perhaps(0.7, "armchair", by_window);
    f.perhaps(0.5, "side_table", by_window);
    f.perhaps(0.5, "suitcase", tucked_away);
    f.perhaps(0.5, "floor_lamp", cornered);
    f.hang_one(0.6, "mirror", 1.5, in_view);
    f.perhaps(0.6, "waste_bin", cornered);
    f.art(3, |_, s| s.x.abs());
    f.ceiling_lamp();
}
