//! Rooms for things: the storeroom with its racks, and the workshop with its bench.

use super::Furnisher;
use super::stations::Part;
use super::wishes::{by_door, by_window, cornered, tucked_away};
use crate::place::{Floor, Spot};
use enfilade_furniture::Furniture;
use enfilade_furniture::store::{SteelRack, ToolBoard, Workbench};
use enfilade_math::Vec2;

/// Free floor between lines of racks, metres.
const AISLE: f32 = 0.95;
/// Height of the middle of a board with tools over a bench, metres.
const TOOLS: f32 = 1.5;

/// Furnishes a storeroom.
pub fn furnish(f: &mut Furnisher) {
    racks(f, 6);
    let usual = SteelRack::random(&mut f.rng);
    let size = usual.size();
    let parts = [Part::new(&usual, [0.0, 0.0], 0.0).reached(0.5)];
    let spots = f.best_lines(&parts, Vec2::new(size.x + 0.04, size.y + AISLE), Vec2::new(0.5 * size.x + 0.7, 0.5 * size.y + 1.3));
    f.each(spots, &parts);
    for _ in 0..2 + f.rng.below(4) {
        f.furnish("cardboard_box", tucked_away);
    }
    f.perhaps(0.6, "step_ladder", cornered);
    f.perhaps(0.4, "bucket", cornered);
    f.perhaps(0.4, "vacuum_cleaner", cornered);
    f.hang_one(0.4, "fire_extinguisher", 1.0, by_door);
    f.work_lights();
}

/// Furnishes a workshop.
pub fn furnish_workshop(f: &mut Furnisher) {
    for _ in 0..1 + f.rng.below(2) {
        bench(f);
    }
    racks(f, 3);
    f.perhaps(0.5, "bar_stool", by_window);
    f.perhaps(0.5, "step_ladder", cornered);
    for _ in 0..1 + f.rng.below(3) {
        f.furnish("cardboard_box", tucked_away);
    }
    f.perhaps(0.5, "bucket", cornered);
    f.perhaps(0.5, "waste_bin", cornered);
    f.public_things();
    f.work_lights();
}

/// Racks of one sort along up to `most` pieces of wall.
fn racks(f: &mut Furnisher, most: usize) {
    let usual = SteelRack::random(&mut f.rng);
    for _ in 0..most {
        for width in [usual.width, 0.9] {
            let rack = SteelRack { width, ..usual };
            if f.stand(&rack, |floor: &Floor, s: &Spot| floor.to_corner(s) - 0.3 * floor.to_way(s.origin)).is_some() {
                break;
            }
        }
    }
}

/// A bench with tools over it.
fn bench(f: &mut Furnisher) {
    for width in [2.2, 1.8, 1.4] {
        let bench = Workbench { width, ..Workbench::random(&mut f.rng) };
        let Some(found) = f.stand(&bench, |floor: &Floor, s: &Spot| 0.3 * floor.to_window(s.origin) + s.x.abs()) else { continue };
        f.litter(&bench.surfaces(), found.pose, 0.9);
        let (Some(wall), x) = (found.spot.wall, found.spot.x) else { return };
        let tools = ToolBoard { size: Vec2::new((width - 0.2).min(1.7), 0.82), ..ToolBoard::random(&mut f.rng) };
        let over = |s: &Spot| if (s.x - x).abs() < 0.5 { (s.x - x).abs() } else { f32::INFINITY };
        f.hang(&tools, TOOLS, &[wall], |_, s| over(s));
        return;
    }
}
