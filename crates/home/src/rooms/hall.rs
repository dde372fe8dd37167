//! The hall: where coats and shoes stay, and a last look into the mirror.

use super::Furnisher;
use super::wishes::{by_door, centred, cornered, in_view};

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    if f.hang_one(0.6, "coat_hooks", 1.65, by_door).is_none() {
        f.furnish("coat_stand", by_door);
    }
    f.perhaps(0.7, "shoe_cabinet", by_door);
    f.perhaps(0.5, "console", centred);
    f.perhaps(0.6, "shoes", by_door);
    f.perhaps(0.3, "bench", cornered);
    f.perhaps(0.3, "umbrella_stand", cornered);
    if f.perhaps(0.4, "tall_mirror", in_view).is_none() {
        f.hang_one(0.8, "mirror", 1.5, in_view);
    }
    f.art(2, in_view);
    let center = f.room.center;
    f.mat("door_mat", |floor, s| floor.to_way(s.origin));
    f.rug(0.5, |_, s| s.origin.distance(center));
    f.ceiling_lamp();
}
