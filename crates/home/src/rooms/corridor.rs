//! The corridor of an office or a school: lockers, seats for those who wait, boards, and the ways out.

use super::Furnisher;
use super::wishes::{by_door, centred, cornered, in_view, tucked_away};
use enfilade_furniture::school::Lockers;
use enfilade_furniture::{Furniture, RoomKind};

/// Furnishes the corridor.
pub fn furnish(f: &mut Furnisher) {
    let school = f.home_has(RoomKind::Classroom) || f.home_has(RoomKind::ComputerLab);
    if school {
        let usual = Lockers::random(&mut f.rng);
        for columns in [5, 4, 5, 3] {
            f.stand(&Lockers { columns, ..usual }, |floor, s| centred(floor, s) + 0.2 * floor.to_corner(s));
        }
    }
    f.perhaps(0.5, "bench", centred);
    f.perhaps(if school { 0.2 } else { 0.6 }, "water_dispenser", tucked_away);
    if !school {
        f.perhaps(0.4, "copier", tucked_away);
        f.perhaps(0.4, "office_cabinet", tucked_away);
    }
    f.hang_one(0.8, "pin_board", 1.5, |_, s| s.x.abs());
    f.hang_one(if school { 0.6 } else { 0.2 }, "pin_board", 1.5, in_view);
    f.hang_one(0.9, "fire_extinguisher", 1.0, by_door);
    f.hang_one(0.4, "wall_clock", 2.15, in_view);
    f.sign_over_door();
    f.perhaps(0.5, "plant", cornered);
    f.perhaps(0.4, "waste_bin", by_door);
    f.art(3, |_, s| s.x.abs());
    f.work_lights();
}
