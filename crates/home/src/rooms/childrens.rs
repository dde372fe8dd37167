//! The children's room: a bed in a corner, a desk at the window, and floor to play on.

use super::Furnisher;
use super::bedroom::bed;
use super::wishes::{by_window, centred, cornered, in_view, tucked_away};

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    bed(f, 1);
    f.furnish("wardrobe", cornered);
    f.work_place(by_window);
    f.perhaps(0.8, "play_table", centred);
    f.perhaps(0.5, "bookshelf", tucked_away);
    f.perhaps(0.5, "dresser", cornered);
    f.perhaps(0.7, "toy_chest", tucked_away);
    f.perhaps(0.4, "basket", tucked_away);
    f.strew(&["toy", "plush_toy", "books"], 5);
    let center = f.room.center;
    f.rug(0.8, |_, s| s.origin.distance(center));
    f.art(3, in_view);
    f.ceiling_lamp();
}
