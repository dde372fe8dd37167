//! Rooms full of books: the bookshop, with tables on which they lie, and the library, with tables at which they are read.

use super::Furnisher;
use super::shop::till;
use super::stations::Part;
use super::wishes::{by_window, cornered, in_view, tucked_away};
use crate::place::{Floor, Spot};
use enfilade_furniture::office::ConferenceTable;
use enfilade_furniture::school::StackingChair;
use enfilade_furniture::shop::{BookAisle, DisplayTable};
use enfilade_furniture::{BookStack, Furniture, on};
use enfilade_math::{DAffine3, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

/// Free floor between shelves, metres.
const AISLE: f32 = 1.15;
/// Distance of the middle of a chair from the edge of its table, metres.
const SEAT: f32 = 0.2;

/// Furnishes a bookshop.
pub fn furnish(f: &mut Furnisher) {
    till(f);
    walls(f, 5);
    if f.chance(0.5) {
        aisles(f, 3);
    }
    let table = DisplayTable::random(&mut f.rng);
    let lines = f.lines(0.0, Vec2::new(table.size.x + AISLE, table.size.y + AISLE), Vec2::splat(1.5));
    for poses in f.each(lines, &[Part::new(&table, [0.0, 0.0], 0.0).reached(0.0)]) {
        piles(f, &table, poses[0]);
    }
    f.perhaps(0.6, "armchair", by_window);
    f.perhaps(0.4, "armchair", cornered);
    f.perhaps(0.7, "plant", cornered);
    f.art(2, in_view);
    f.public_things();
    f.work_lights();
}

/// Furnishes a library.
pub fn furnish_library(f: &mut Furnisher) {
    f.perhaps(0.6, "desk", tucked_away);
    walls(f, 3);
    reading(f);
    aisles(f, 6);
    f.perhaps(0.5, "copier", tucked_away);
    f.perhaps(0.5, "armchair", by_window);
    f.perhaps(0.6, "plant", cornered);
    f.hang_one(0.5, "pin_board", 1.5, in_view);
    f.art(2, in_view);
    f.public_things();
    f.work_lights();
}

/// Shelves along up to `most` pieces of wall, of one finish.
fn walls(f: &mut Furnisher, most: usize) {
    let usual = BookAisle::single(&mut f.rng);
    for _ in 0..most {
        for sections in [4, 3, 2, 1] {
            let shelf = BookAisle { sections, ..usual };
            if let Some(found) =
                f.stand(&shelf, |floor: &Floor, s: &Spot| 0.2 * s.x.abs() + floor.to_corner(s) - 0.2 * floor.to_way(s.origin))
            {
                f.accent = f.accent.or(found.spot.wall);
                break;
            }
        }
    }
}

/// Lines of shelves with books on both sides, at most `most`.
fn aisles(f: &mut Furnisher, most: usize) {
    let usual = BookAisle::random(&mut f.rng);
    for sections in [4, 3, 2] {
        let shelf = BookAisle { sections, ..usual };
        let size = shelf.size();
        let parts = [Part::new(&shelf, [0.0, 0.0], 0.0)];
        let spots = f.best_lines(&parts, Vec2::new(size.x + AISLE, size.y + AISLE), Vec2::new(0.5 * size.x + 0.75, 0.5 * size.y + 0.85));
        if f.fitting(&spots, &parts) >= 2 || sections == 2 {
            let spots: Vec<Spot> = spots.into_iter().filter(|spot| f.fitting(&[*spot], &parts) > 0).take(most).collect();
            f.each(spots, &parts);
            return;
        }
    }
}

/// A table with chairs on both sides, near the windows.
fn reading(f: &mut Furnisher) {
    let chair = StackingChair { arms: false, ..StackingChair::random(&mut f.rng) };
    for length in [2.6, 2.0] {
        let table = ConferenceTable::of_length(length, &mut f.rng);
        let mut parts = vec![Part::new(&table, [0.0, 0.0], 0.0)];
        for (edge, look) in table.seats().into_iter().take(table.seats().len() - 2) {
            let at = edge - look * (SEAT + f.rng.range(0.0, 0.12));
            parts.push(Part::new(&chair, at.to_array(), look.y.atan2(look.x) - FRAC_PI_2 + f.rng.range(-0.15, 0.15)));
        }
        let spots = f.floor.everywhere(0.2, &[0.0, FRAC_PI_2]);
        if let Some(poses) = f.once(spots, &parts, |floor, s| floor.to_window(s.origin)) {
            f.litter(&table.surfaces(), poses[0], 0.6);
            return;
        }
    }
}

/// Piles of books in rows on a table, and some on its shelf.
fn piles(f: &mut Furnisher, table: &DisplayTable, pose: DAffine3) {
    let counts = ((table.size - 0.06) / Vec2::new(0.31, 0.27)).floor();
    for row in 0..counts.y as usize {
        for column in 0..counts.x as usize {
            if f.chance(0.12) {
                continue;
            }
            let at = (Vec2::new(column as f32, row as f32) - 0.5 * (counts - 1.0)) * Vec2::new(0.31, 0.27);
            let pile = BookStack { count: 2 + f.rng.below(4) };
            f.build(&pile, on(pose, Vec3::new(at.x, at.y, table.top), if row % 2 == 0 { 0.0 } else { PI }));
        }
    }
}
