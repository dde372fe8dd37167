//! Rooms with water: bathroom, toilet, laundry.

use super::Furnisher;
use super::wishes::{by_door, by_window, cornered, in_view, tucked_away};

/// Furnishes a bathroom: the largest things first, so that the others find their places around them, and the indispensable ones before a
/// second place to wash.
pub fn furnish(f: &mut Furnisher) {
    let large = f.room.area > 6.0;
    let first = if large || f.chance(0.55) { "bathtub" } else { "shower" };
    let has_tub = f.furnish(first, cornered).is_some() && first == "bathtub";
    f.toilet();
    f.basin();
    if !has_tub && first == "bathtub" {
        f.furnish("shower", cornered);
    } else if has_tub && large {
        f.perhaps(0.5, "shower", cornered);
    }
    if !f.home_has(enfilade_furniture::RoomKind::Laundry) {
        f.perhaps(0.5, "washing_machine", cornered);
    }
    f.perhaps(0.7, "towel_radiator", by_door);
    f.hang_one(0.6, "towel_rail", 1.2, by_window);
    f.perhaps(0.4, "laundry_basket", tucked_away);
    let center = f.room.center;
    f.mat("bath_mat", |_, s| s.origin.distance(center));
    f.dome();
}

/// Furnishes a toilet.
pub fn furnish_toilet(f: &mut Furnisher) {
    f.toilet();
    f.basin();
    f.art(1, in_view);
    f.dome();
}

/// Furnishes a laundry or storeroom.
pub fn furnish_laundry(f: &mut Furnisher) {
    f.furnish("washing_machine", cornered);
    f.furnish("laundry_basket", tucked_away);
    f.perhaps(0.6, "drying_rack", in_view);
    f.perhaps(0.5, "ironing_board", tucked_away);
    f.perhaps(0.7, "vacuum_cleaner", tucked_away);
    f.perhaps(0.5, "bucket", cornered);
    f.perhaps(0.5, "cardboard_box", cornered);
    f.dome();
}
