//! The bedroom: a bed with room on both sides, and a place for clothes.

use super::Furnisher;
use super::television;
use super::wishes::{by_window, centred, cornered, in_view, tucked_away};
use crate::place::Piece;
use enfilade_furniture::{Bed, Furniture, Surface, TableLamp};
use enfilade_math::Vec2;

/// Distance between a bed and the things beside it, metres.
const BESIDE: f32 = 0.04;
/// Models of beds for as many sleepers differ less than this from ours in width, metres.
const WIDTHS: f32 = 0.25;

/// Things that people keep beside the bed, and their probabilities.
const BEDSIDE: [(&str, f32); 9] = [
    ("books", 0.6),
    ("phone", 0.5),
    ("glass", 0.5),
    ("photo_frame", 0.4),
    ("tissue_box", 0.25),
    ("bottle", 0.4),
    ("candle", 0.25),
    ("open_book", 0.3),
    ("mug", 0.3),
];
/// Density of things in open compartments of nightstands, relative to other surfaces.
const BELOW: f32 = 1.8;

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    let sleepers = if f.room.area > 9.5 { 2 } else { 1 };
    if !bed(f, sleepers) {
        bed(f, 1);
    }
    f.furnish("wardrobe", cornered);
    f.perhaps(0.85, "dresser", centred);
    f.perhaps(0.4, "dressing_table", by_window);
    f.perhaps(0.45, "armchair", tucked_away);
    f.perhaps(0.4, "laundry_basket", tucked_away);
    f.perhaps(0.6, "plant", by_window);
    f.hang_one(0.5, "mirror", 1.5, in_view);
    television::before_bed(f);
    f.art(3, |_, s| s.x.abs());
    f.hang_one(0.45, "wall_shelf", 1.55, |_, s| s.x.abs());
    f.hang_plant(0.25);
    // Slippers.
    f.perhaps(0.7, "shoes", |floor, s| floor.to_window(s.origin));
    f.ceiling_lamp();
}

/// Places a bed for one or two `sleepers`, with nightstands on both sides, on one, or none, as space allows; false where no bed fits.
pub fn bed(f: &mut Furnisher, sleepers: usize) -> bool {
    let stand = f.any("nightstand");
    for _ in 0..3 {
        let own = Bed::for_sleepers(sleepers, &mut f.rng);
        let width = own.size().x;
        let model = f.borrow("bed", &own, |size| (size.x - width).abs() < WIDTHS);
        let bed: &dyn Furniture = model.as_ref().map_or(&own, |model| model);
        for sides in [&[-1.0f32, 1.0][..], &[1.0], &[-1.0], &[]] {
            if sides.len() > sleepers {
                continue;
            }
            let size = bed.size();
            let mut group = vec![Piece::standing(size, 0.55)];
            if let Some(stand) = &stand {
                let aside = 0.5 * (size.x + stand.size().x) + BESIDE;
                let piece = Piece::standing(stand.size(), 0.3);
                group.extend(sides.iter().map(|s| piece.at(s * aside, piece.at.y, 0.0)));
            }
            let spots = f.floor.along_walls(size.x);
            let windows = |floor: &crate::place::Floor, s: &crate::place::Spot| {
                let before = floor.room().windows().filter(|o| Some(o.wall) == s.wall).count() as f32;
                0.5 * s.x.abs() + 0.6 * before - 0.35 * floor.to_way(s.origin)
            };
            // A single bed goes into a corner.
            let cost = |floor: &crate::place::Floor, s: &crate::place::Spot| {
                if sleepers == 1 { floor.to_corner(s) + windows(floor, s) - 0.5 * s.x.abs() } else { windows(floor, s) }
            };
            let Some((spot, poses)) = f.floor.place(&group, spots, cost) else { continue };
            f.build(bed, poses[0]);
            f.accent = spot.wall;
            if let Some(stand) = &stand {
                for pose in &poses[1..] {
                    f.build(stand.as_ref(), *pose);
                    bedside(f, stand.as_ref(), *pose);
                }
            }
            let foot = spot.point(Vec2::new(0.0, size.y));
            f.rug(0.7, move |_, s| s.origin.distance(foot));
            return true;
        }
    }
    false
}

/// A lamp, and what people read.
fn bedside(f: &mut Furnisher, stand: &dyn Furniture, pose: enfilade_math::DAffine3) {
    let surfaces = stand.surfaces();
    let own = TableLamp::random(&mut f.rng);
    let mut things: Vec<Box<dyn Furniture>> = vec![f.or_borrowed("table_lamp", own)];
    for (family, often) in BEDSIDE {
        if f.chance(often * f.clutter) {
            things.extend(f.any(family));
        }
    }
    let highest = |a: &&Surface, b: &&Surface| a.z.total_cmp(&b.z);
    let Some(top) = surfaces.iter().max_by(highest).copied() else { return };
    f.scatter(&[top], pose, &things);
    let below: Vec<Surface> = surfaces.into_iter().filter(|s| s.z < top.z).collect();
    f.litter(&below, pose, BELOW);
}
