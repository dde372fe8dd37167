//! The shop: lines of shelves with goods, or rails with clothes, and a counter with its till near the door.

use super::Furnisher;
use super::stations::Part;
use super::wishes::{centred, cornered, in_view, tucked_away};
use crate::place::{Floor, Spot};
use enfilade_furniture::shop::{ClothesRail, Counter, DisplayTable, Gondola, Till};
use enfilade_furniture::{Furniture, on};
use enfilade_math::{Vec2, Vec3};

/// Free floor between lines of shelves, and between rails, metres.
const AISLE: f32 = 1.25;
const RAILS: f32 = 1.1;
/// Floor behind a counter, metres.
const STAFF: f32 = 0.9;

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    till(f);
    if f.chance(0.7) {
        goods(f);
    } else {
        clothes(f);
    }
    f.perhaps(0.4, "cardboard_box", tucked_away);
    f.perhaps(0.4, "plant", cornered);
    f.hang_one(0.6, "mirror", 1.5, in_view);
    f.art(2, in_view);
    f.public_things();
    f.work_lights();
}

/// A counter with a till, and room for one person behind it; true if it found a place.
pub(super) fn till(f: &mut Furnisher) -> bool {
    for width in [2.2, 1.6] {
        let counter = Counter { width, ..Counter::random(&mut f.rng) };
        let size = counter.size();
        let parts = [Part::new(&counter, [0.0, STAFF + 0.5 * size.y], 0.0).reached(0.8)];
        let near = |floor: &Floor, s: &Spot| floor.to_way(s.origin) + 0.5 * floor.to_corner(s);
        let Some(poses) = f.once(f.floor.along_walls(size.x), &parts, near) else { continue };
        let z = if counter.raised { 0.76 } else { Counter::HEIGHT };
        let side = if f.rng.below(2) == 0 { 1.0 } else { -1.0 };
        let back = if counter.raised { -0.12 } else { -0.05 };
        f.build(&Till, on(poses[0], Vec3::new(side * (0.5 * width - 0.42), back, z), 0.0));
        f.plugs.push(poses[0].translation.truncate().as_vec2());
        return true;
    }
    false
}

/// Refrigerators and shelves along the walls, and lines of shelves between them.
fn goods(f: &mut Furnisher) {
    for _ in 0..f.rng.below(3) {
        f.furnish("bottle_fridge", centred);
    }
    let wall = Gondola::single(&mut f.rng);
    for _ in 0..4 {
        for sections in [4, 3, 2, 1] {
            let shelf = Gondola { sections, ..wall };
            if f.stand(&shelf, |floor: &Floor, s: &Spot| floor.to_corner(s) - 0.3 * floor.to_way(s.origin)).is_some() {
                break;
            }
        }
    }
    let usual = Gondola { finish: wall.finish, ..Gondola::random(&mut f.rng) };
    for sections in [4, 3, 2, 1] {
        let shelf = Gondola { sections, ..usual };
        let size = shelf.size();
        let parts = [Part::new(&shelf, [0.0, 0.0], 0.0)];
        let spots = f.best_lines(&parts, Vec2::new(size.x + AISLE, size.y + AISLE), Vec2::new(0.5 * size.x + 0.8, 0.5 * size.y + 1.2));
        if f.fitting(&spots, &parts) >= 2 || sections == 1 {
            f.each(spots, &parts);
            break;
        }
    }
}

/// Rails with clothes along the walls and over the floor, and tables with folded ones.
fn clothes(f: &mut Furnisher) {
    let usual = ClothesRail::random(&mut f.rng);
    for _ in 0..3 {
        let rail = ClothesRail { metal: usual.metal, ..ClothesRail::random(&mut f.rng) };
        f.stand(&rail, |floor: &Floor, s: &Spot| floor.to_corner(s) - 0.2 * floor.to_way(s.origin));
    }
    let table = DisplayTable::random(&mut f.rng);
    let lines = f.lines(0.0, Vec2::new(usual.length.max(table.size.x) + RAILS, 0.8 + RAILS), Vec2::splat(1.6));
    for (k, spot) in lines.into_iter().enumerate() {
        if k % 3 == 0 {
            let Some(poses) = f.once(vec![spot], &[Part::new(&table, [0.0, 0.0], 0.0)], |_, _| 0.0) else { continue };
            folded(f, &table, poses[0]);
        } else {
            let rail = ClothesRail { metal: usual.metal, length: usual.length, ..ClothesRail::random(&mut f.rng) };
            f.once(vec![spot], &[Part::new(&rail, [0.0, 0.0], 0.0)], |_, _| 0.0);
        }
    }
}

/// Piles of folded clothes in a row on a table.
fn folded(f: &mut Furnisher, table: &DisplayTable, pose: enfilade_math::DAffine3) {
    let counts = ((table.size - 0.1) / Vec2::new(0.38, 0.34)).floor();
    for row in 0..counts.y as usize {
        for column in 0..counts.x as usize {
            let at = (Vec2::new(column as f32, row as f32) - 0.5 * (counts - 1.0)) * Vec2::new(0.38, 0.34);
            let Some(pile) = f.any("clothes") else { return };
            f.build(pile.as_ref(), on(pose, Vec3::new(at.x, at.y, table.top), 0.0));
        }
    }
}
