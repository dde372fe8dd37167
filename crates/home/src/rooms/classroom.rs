//! Classrooms: rows of tables before a board, or of computers.

use super::Furnisher;
use super::office::Workplaces;
use super::stations::Part;
use super::wishes::{by_door, by_window, centred, cornered, in_view, tucked_away};
use crate::place::{Floor, Piece, Spot};
use crate::room::Wall;
use enfilade_furniture::office::{ComputerCase, ProjectionScreen, Projector};
use enfilade_furniture::school::{BoardSheet, ClassBoard, StackingChair, StudentDesk};
use enfilade_furniture::study::OfficeChair;
use enfilade_furniture::{Furniture, on};
use enfilade_math::{Vec2, Vec3};
use std::f32::consts::PI;

/// Height of the middle of boards, metres.
const BOARD: f32 = 1.45;
/// Distance of the first row's edge from the board's wall, and from one row to the next, metres.
const FIRST: f32 = 2.5;
const ROW: f32 = 1.42;
/// Aisle between the tables of a row, metres.
const AISLE: f32 = 0.66;
/// Floor that rows leave free along walls, metres.
const BESIDE: f32 = 0.35;
/// Floor behind the last chairs, metres.
const BEHIND: f32 = 0.75;
/// Distance of the middle of a pupil's chair from the edge of the table, metres.
const CHAIR: f32 = 0.17;

/// Furnishes a classroom.
pub fn furnish(f: &mut Furnisher) {
    let board = ClassBoard::random(&mut f.rng);
    let front = front_board(f, board);
    f.accent = None;
    teacher(f, front);
    let desk = StudentDesk::random(&mut f.rng);
    let chair = StackingChair::of_school(&mut f.rng);
    pupils(f, front, &desk, &chair);
    if f.chance(0.5) {
        projection(f, front);
    }
    around(f);
    f.work_lights();
}

/// Furnishes a room with a computer for each pupil.
pub fn furnish_lab(f: &mut Furnisher) {
    let board = ClassBoard { sheet: BoardSheet::White, panels: 1, ..ClassBoard::random(&mut f.rng) };
    let front = front_board(f, ClassBoard { size: Vec2::new(board.size.x.min(2.4), 1.1), ..board });
    teacher(f, front);
    computers(f, front);
    if f.chance(0.6) {
        projection(f, front);
    }
    f.perhaps(0.6, "office_cabinet", tucked_away);
    f.perhaps(0.3, "water_dispenser", cornered);
    f.hang_one(0.5, "pin_board", 1.5, in_view);
    f.art(2, |_, s| s.x.abs());
    f.public_things();
    f.work_lights();
}

/// Hangs the board at the wall that all look at: a short one without windows, far from the door; returns the wall.
fn front_board(f: &mut Furnisher, board: ClassBoard) -> Wall {
    let windows = |floor: &Floor, wall: Wall| floor.room().windows().filter(|window| window.wall == wall).count() as f32;
    let cost = |floor: &Floor, s: &Spot| {
        let Some(wall) = s.wall else { return f32::INFINITY };
        let before = floor.room().depths(wall).first().copied().unwrap_or(0.0);
        s.x.abs() + 5.0 * windows(floor, wall) - 0.8 * before
    };
    for share in [1.0, 0.75, 0.5] {
        let board =
            ClassBoard { size: Vec2::new(share * board.size.x, board.size.y), panels: if share < 1.0 { 1 } else { board.panels }, ..board };
        if let Some(wall) = f.hang(&board, BOARD, &f.room.walls(), cost) {
            return wall;
        }
    }
    let mut walls = f.room.walls();
    walls.sort_by(|a, b| f.room.length(*a).total_cmp(&f.room.length(*b)));
    walls[0]
}

/// The teacher's desk beside the board's middle, its chair towards the board.
fn teacher(f: &mut Furnisher, front: Wall) {
    let chair = OfficeChair { arms: false, ..OfficeChair::random(&mut f.rng) };
    for _ in 0..3 {
        let Some(desk) = f.any("desk") else { return };
        let size = desk.size();
        let turn = f.rng.range(-0.4, 0.4);
        let parts = [Part::new(desk.as_ref(), [0.0, 1.05 + 0.5 * size.y], PI), Part::new(&chair, [0.0, 0.68], turn)];
        let half = 0.5 * f.room.length(front);
        let spots = f.floor.along(front, size.x);
        let aside = |_: &Floor, s: &Spot| (s.x.abs() - 0.5 * half).abs();
        if let Some(poses) = f.once(spots, &parts, aside) {
            f.litter(&desk.surfaces(), poses[0], 1.0);
            return;
        }
    }
}

/// Rows of tables, each with its chairs.
fn pupils(f: &mut Furnisher, front: Wall, desk: &StudentDesk, chair: &StackingChair) {
    let (length, depth) = (f.room.length(front), f.room.depths(front).first().copied().unwrap_or(0.0));
    let (size, seat) = (desk.size(), chair.size());
    let pitch = Vec2::new(size.x + AISLE, ROW);
    let columns = ((length - 2.0 * BESIDE + AISLE) / pitch.x) as usize;
    let rows = ((depth - FIRST - size.y - BEHIND) / pitch.y + 1.0).max(0.0) as usize;
    let mut group = vec![Piece::standing(size, 0.0).at(0.0, 0.0, 0.0)];
    let y = 0.5 * size.y + CHAIR;
    group.extend(desk.places().into_iter().map(|x| Piece::standing(seat + Vec3::new(0.0, 0.1, 0.0), 0.0).at(x, y + 0.05, PI)));
    for spot in f.rows_before(front, [columns.min(6), rows.min(6)], pitch, FIRST + 0.5 * size.y) {
        let Some((_, poses)) = f.floor.place(&group, vec![spot], |_, _| 0.0) else { continue };
        f.build(desk, poses[0]);
        for pose in &poses[1..] {
            let (out, turn) = (f.rng.range(-0.08, 0.07), if f.chance(0.2) { f.rng.range(-0.35, 0.35) } else { f.rng.range(-0.06, 0.06) });
            f.build(chair, on(*pose, Vec3::new(0.0, out, 0.0), turn));
        }
        let density = if f.chance(0.6) { 0.7 } else { 0.0 };
        f.litter(&desk.surfaces(), poses[0], density);
    }
}

/// Rows of desks with computers that face the board, side by side.
fn computers(f: &mut Furnisher, front: Wall) {
    let width = 1.2;
    let places = Workplaces::new(width, &mut f.rng);
    let (length, depth) = (f.room.length(front), f.room.depths(front).first().copied().unwrap_or(0.0));
    let (size, chair) = (places.size(), places.chair());
    let pitch = Vec2::new(width + 0.03, 1.85);
    // One aisle in the middle of each row, or along a wall.
    let columns = ((length - 0.9) / pitch.x) as usize;
    let rows = ((depth - FIRST - size.y - BEHIND - 0.3) / pitch.y + 1.0).max(0.0) as usize;
    let group = [Piece::standing(size, 0.0).at(0.0, 0.0, 0.0), Piece::standing(chair, 0.0).at(0.0, 0.5 * size.y + 0.34, PI)];
    let case = f.chance(0.6).then(|| ComputerCase::random(&mut f.rng));
    let aside = 0.5 * (length - pitch.x * columns as f32) - 0.12;
    for spot in f.rows_before(front, [columns, rows.min(5)], pitch, FIRST + 0.5 * size.y) {
        let along = f.room.face(front).along();
        let spot = Spot { origin: spot.origin + along * aside, ..spot };
        let Some((_, poses)) = f.floor.place(&group, vec![spot], |_, _| 0.0) else { continue };
        f.plugs.push(spot.origin);
        places.build(f, poses[0], poses[1], 0.25);
        if let Some(case) = case {
            f.build(&case, on(poses[0], Vec3::new(0.5 * width - 0.13, -0.12, 0.0), PI));
        }
    }
}

/// A projector before the board, and a screen over it where there is room.
fn projection(f: &mut Furnisher, front: Wall) {
    let height = f.room.size.z;
    let screen = ProjectionScreen { sheet: Vec2::new(1.8, 1.35) };
    let middle = height - 0.05 - 0.5 * screen.size().z;
    f.hang(&screen, middle, &[front], |_, s| s.x.abs());
    let projector = Projector { drop: (height - 2.4).clamp(0.1, 0.8), ..Projector::random(&mut f.rng) };
    f.fix_before(front, 0.0, 2.9, &projector);
}

/// What is along the walls of a classroom.
fn around(f: &mut Furnisher) {
    f.perhaps(0.7, "office_cabinet", tucked_away);
    f.perhaps(0.5, "bookshelf", centred);
    f.perhaps(0.4, "binder_shelf", tucked_away);
    f.hang_one(0.7, "pin_board", 1.5, in_view);
    f.hang_one(0.4, "pin_board", 1.5, |_, s| s.x.abs());
    f.hang_one(0.5, "coat_hooks", 1.65, by_door);
    f.perhaps(0.6, "waste_bin", by_door);
    f.perhaps(0.4, "plant", by_window);
    f.art(3, |_, s| s.x.abs());
    f.public_things();
}
