//! The café: a counter with a machine and cakes, and small tables.

use super::Furnisher;
use super::stations::Part;
use super::wishes::{by_window, centred, cornered, in_view};
use crate::place::{Floor, Spot};
use crate::room::Wall;
use enfilade_furniture::school::{ClassBoard, StackingChair};
use enfilade_furniture::shop::{BistroTable, CakeCase, Counter, EspressoMachine, Till};
use enfilade_furniture::{CONTACT, CeilingLamp, Chair, Furniture, Pendant, ShellChair, SpindleChair, UpholsteredChair, on};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::PI;

/// Floor between a counter and what is behind it, for people who work, metres.
const STAFF: f32 = 0.95;
/// Distance of the middle of a chair from the edge of its table, metres.
const SEAT: f32 = 0.16;
/// From one table to the next, metres.
const TABLES: Vec2 = Vec2::new(2.0, 2.1);
/// Height of a lamp's lower end over a table or counter, metres.
const LAMP: f32 = 1.75;

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    if let Some((wall, x)) = bar(f) {
        f.accent = Some(wall);
        for _ in 0..1 + f.rng.below(2) {
            let menu = ClassBoard::menu(&mut f.rng);
            f.hang(&menu, 1.85, &[wall], |_, s| (s.x - x).abs());
        }
    }
    f.perhaps(0.6, "bottle_fridge", centred);
    tables(f);
    f.perhaps(0.5, "sofa", by_window);
    for _ in 0..1 + f.rng.below(3) {
        f.furnish("plant", cornered);
    }
    f.hang_one(0.4, "wall_shelf", 1.7, |_, s| s.x.abs());
    f.hang_plant(0.4);
    f.art(4, in_view);
    f.public_things();
    lamps(f);
}

/// The counter, with a sideboard at the wall behind it; returns the wall and the place along it.
fn bar(f: &mut Furnisher) -> Option<(Wall, f32)> {
    let longest = (0.45 * f.room.size.truncate().max_element()).min(3.0);
    for share in [1.0, 0.8, 0.65] {
        let counter = Counter { width: (share * longest).max(1.5), raised: false, ..Counter::random(&mut f.rng) };
        let behind = f.any("sideboard")?;
        let low = behind.size();
        let depth = counter.size().y;
        let parts = [
            Part::new(&counter, [0.0, low.y + STAFF + 0.5 * depth], 0.0).reached(0.7),
            Part::new(behind.as_ref(), [0.0, 0.5 * low.y], 0.0),
        ];
        let cost = |floor: &Floor, s: &Spot| {
            let windows = floor.room().windows().filter(|window| Some(window.wall) == s.wall).count() as f32;
            0.6 * floor.to_corner(s) + 3.0 * windows + 0.1 * floor.to_way(s.origin)
        };
        let spots = f.floor.along_walls(counter.width.max(low.x));
        let group: Vec<_> = parts.iter().map(|part| part.piece).collect();
        let Some((spot, poses)) = f.floor.place(&group, spots, cost) else { continue };
        f.build(&counter, poses[0]);
        f.build(behind.as_ref(), poses[1]);
        f.litter(&behind.surfaces(), poses[1], 1.8);
        on_counter(f, &counter, poses[0]);
        return Some((spot.wall?, spot.x));
    }
    None
}

/// A coffee machine, cakes and a till on the counter.
fn on_counter(f: &mut Furnisher, counter: &Counter, pose: DAffine3) {
    let half = 0.5 * counter.width;
    let top = |x: f32, y: f32, yaw: f32| on(pose, Vec3::new(x, y, Counter::HEIGHT), yaw);
    let machine = EspressoMachine::random(&mut f.rng);
    let case = CakeCase { width: (counter.width - machine.size().x - 0.9).clamp(0.0, 1.1) };
    let side = if f.rng.below(2) == 0 { 1.0 } else { -1.0 };
    f.build(&machine, top(side * (half - 0.5 * machine.size().x - 0.06), 0.02, 0.0));
    f.build(&Till, top(-side * (half - 0.36), -0.04, 0.0));
    if case.width > 0.55 {
        let x = side * (half - machine.size().x - 0.5 * case.width - 0.14);
        f.build(&case, top(x, 0.08, 0.0));
    }
}

/// Chairs of one sort.
fn chair(rng: &mut Rng) -> Box<dyn Furniture> {
    match rng.below(5) {
        0 => Box::new(Chair::random(rng)),
        1 => Box::new(SpindleChair::random(rng)),
        2 => Box::new(ShellChair::random(rng)),
        3 => Box::new(UpholsteredChair::random(rng)),
        _ => Box::new(StackingChair::random(rng)),
    }
}

/// Small tables with two to four chairs each, all over the room.
fn tables(f: &mut Furnisher) {
    let table = BistroTable::random(&mut f.rng);
    let chair = chair(&mut f.rng);
    let half = 0.5 * table.width + SEAT;
    let turn = if f.chance(0.5) { 0.25 * PI } else { 0.0 };
    for spot in f.lines(0.0, TABLES, Vec2::splat(0.95)) {
        let seats = [2, 2, 3, 4][f.rng.below(4)];
        let first = turn + 0.5 * PI * f.rng.below(4) as f32;
        let mut parts = vec![Part::new(&table, [0.0, 0.0], turn)];
        for k in 0..seats {
            let angle = first + if seats == 2 { PI * k as f32 } else { 0.5 * PI * k as f32 };
            let at = Vec2::from_angle(angle) * (half + f.rng.range(0.0, 0.12));
            parts.push(Part::new(chair.as_ref(), at.to_array(), angle + 0.5 * PI + f.rng.range(-0.3, 0.3)));
        }
        let shift = Vec2::new(f.rng.range(-0.12, 0.12), f.rng.range(-0.12, 0.12));
        let spot = Spot { origin: spot.origin + shift, ..spot };
        let poses = f.once(vec![spot], &parts, |_, _| 0.0).or_else(|| f.once(vec![spot], &parts[..3], |_, _| 0.0));
        if let Some(poses) = poses {
            f.litter(&table.surfaces(), poses[0], 0.8);
        }
    }
}

/// Lamps of one sort in a pattern, above people's heads.
fn lamps(f: &mut Furnisher) {
    let drop = (f.room.size.z - LAMP - 0.35).max(0.35);
    let pendant = Pendant { drop, ..Pendant::random(&mut f.rng) };
    let spots = f.lines(0.0, Vec2::splat(2.3), Vec2::splat(1.15));
    let track = CeilingLamp::Track(1.4);
    let lamp: &dyn Furniture = if f.chance(0.7) { &pendant } else { &track };
    for spot in spots {
        let (half, height) = (0.5 * lamp.size().truncate(), f.room.size.z);
        let around = crate::room::Footprint { center: spot.origin, half, yaw: 0.0 };
        let z = [height - lamp.size().z, height - CONTACT];
        if f.room.slopes.is_empty() && f.room.holds(&around, 0.1) && f.floor.is_free(&around, z) {
            f.above(spot.origin, lamp);
        }
    }
}
