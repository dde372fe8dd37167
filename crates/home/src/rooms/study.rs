//! The study: a desk by the window, books, and a seat for reading.

use super::Furnisher;
use super::wishes::{by_window, centred, in_view, tucked_away};

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    f.work_place(by_window);
    let shelf = f.furnish("bookshelf", centred);
    f.accent = shelf.and_then(|s| s.spot.wall);
    f.perhaps(0.4, "bookshelf", tucked_away);
    f.perhaps(0.5, "filing_cabinet", tucked_away);
    f.perhaps(0.65, "armchair", tucked_away);
    f.perhaps(0.6, "floor_lamp", tucked_away);
    f.perhaps(0.6, "waste_bin", by_window);
    f.perhaps(0.7, "plant", tucked_away);
    let center = f.room.center;
    f.rug(0.8, |_, s| s.origin.distance(center));
    f.hang_one(0.4, "whiteboard", 1.5, in_view);
    f.art(2, in_view);
    f.hang_plant(0.25);
    f.ceiling_lamp();
}
