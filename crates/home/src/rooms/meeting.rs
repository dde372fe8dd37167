//! The meeting room: a table for all, and something to look at.

use super::Furnisher;
use super::stations::Part;
use super::wishes::{by_window, centred, cornered, in_view};
use crate::room::Wall;
use enfilade_furniture::office::{ConferenceTable, ProjectionScreen, Projector, WallDisplay};
use enfilade_furniture::school::{ClassBoard, StackingChair};
use enfilade_furniture::study::OfficeChair;
use enfilade_furniture::{Finish, Furniture};
use enfilade_math::Vec2;
use std::f32::consts::FRAC_PI_2;

/// Floor around the table that people need to pass behind those who sit, metres.
const AROUND: f32 = 1.05;
/// Distance of the middle of a chair from the table's edge, and how far it varies, metres.
const SEAT: [f32; 2] = [0.2, 0.1];
/// Shortest table, and the step by which shorter ones are tried, metres.
const SHORTEST: f32 = 1.6;
const STEP: f32 = 0.35;

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    let shown = shown(f);
    f.accent = shown;
    table(f);
    f.perhaps(0.5, "sideboard", centred);
    if f.chance(0.5) {
        let board = ClassBoard { size: Vec2::new(f.rng.range(1.2, 2.2), 1.1), panels: 1, ..ClassBoard::random(&mut f.rng) };
        let walls: Vec<Wall> = f.room.walls().into_iter().filter(|wall| Some(*wall) != shown).collect();
        f.hang(&board, 1.45, &walls, |_, s| s.x.abs());
    }
    f.perhaps(0.6, "plant", cornered);
    f.perhaps(0.4, "waste_bin", by_window);
    f.art(2, in_view);
    f.hang_one(0.4, "wall_clock", 2.1, |_, s| s.x.abs());
    f.work_lights();
}

/// A display, or a screen with its projector, at an end of the room; returns the wall.
fn shown(f: &mut Furnisher) -> Option<Wall> {
    let size = f.room.size.truncate();
    let along_x = size.x >= size.y;
    // At an end of the table, and not beside windows.
    let ends: Vec<Wall> = f.room.walls().into_iter().filter(|wall| (f.room.inward(*wall).x.abs() > 0.7) == along_x).collect();
    let height = f.room.size.z;
    if f.chance(0.6) {
        let display = WallDisplay::random(&mut f.rng);
        return f.hang(&display, 1.45, &ends, |floor, s| s.x.abs() - 0.3 * floor.to_way(s.origin));
    }
    let screen = ProjectionScreen { sheet: Vec2::new(1.9, (height - 1.25).min(1.3)) };
    let middle = height - 0.06 - 0.5 * screen.size().z;
    let wall = f.hang(&screen, middle, &ends, |floor, s| s.x.abs() - 0.3 * floor.to_way(s.origin))?;
    let projector = Projector { drop: (height - 2.25).clamp(0.1, 0.6), ..Projector::random(&mut f.rng) };
    f.fix_before(wall, 0.0, 2.6_f32.min(0.6 * f.room.face(wall).across), &projector);
    Some(wall)
}

/// The longest table that fits, with chairs around it.
fn table(f: &mut Furnisher) {
    let size = f.room.size.truncate();
    let yaw = if size.x >= size.y { 0.0 } else { FRAC_PI_2 };
    let swivel =
        OfficeChair { cloth: [Finish::Leather, Finish::Felt, Finish::BlackPlastic][f.rng.below(3)], ..OfficeChair::random(&mut f.rng) };
    let stacked = StackingChair {
        padded: true,
        finish: [Finish::Felt, Finish::Leather, Finish::SofaCloth][f.rng.below(3)],
        ..StackingChair::random(&mut f.rng)
    };
    let chair: &dyn Furniture = if f.chance(0.5) { &swivel } else { &stacked };
    let center = f.room.center;
    let mut length = (size.max_element() - 2.0 * AROUND).min(4.4);
    while length >= SHORTEST {
        let table = ConferenceTable::of_length(length, &mut f.rng);
        let out = SEAT[0] + 0.12 * f32::from(u8::from(chair.size().y > 0.7));
        let mut parts = vec![Part::new(&table, [0.0, 0.0], 0.0)];
        for (edge, look) in table.seats() {
            let at = edge - look * (out + SEAT[1] * f.rng.range(0.0, 1.0));
            let turn = look.y.atan2(look.x) - FRAC_PI_2 + f.rng.range(-0.2, 0.2);
            parts.push(Part::new(chair, at.to_array(), turn));
        }
        for ends in [parts.len(), parts.len() - 2] {
            let spots = f.floor.everywhere(0.15, &[yaw]);
            if let Some(poses) = f.once(spots, &parts[..ends], |_, s| s.origin.distance(center)) {
                f.litter(&table.surfaces(), poses[0], 0.45);
                return;
            }
        }
        length -= STEP;
    }
}
