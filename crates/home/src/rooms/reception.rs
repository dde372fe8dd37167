//! The reception of an office or hotel: a counter, and seats for those who wait.

use super::Furnisher;
use super::stations::Part;
use super::wishes::{by_door, by_window, centred, cornered, in_view};
use crate::place::{Floor, Spot};
use enfilade_furniture::office::WallDisplay;
use enfilade_furniture::school::StackingChair;
use enfilade_furniture::shop::Counter;
use enfilade_furniture::study::{Keyboard, Monitor, OfficeChair};
use enfilade_furniture::{CoffeeTable, Furniture, on};
use enfilade_math::{Vec2, Vec3};
use std::f32::consts::PI;

/// Floor behind the counter, for a chair, metres.
const STAFF: f32 = 1.25;

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    desk(f);
    seats(f);
    f.perhaps(0.6, "magazine_rack", by_window);
    f.perhaps(0.4, "water_dispenser", cornered);
    f.perhaps(0.3, "coat_stand", by_door);
    for _ in 0..1 + f.rng.below(3) {
        f.furnish("plant", cornered);
    }
    if f.chance(0.4) {
        let display = WallDisplay::random(&mut f.rng);
        f.hang(&display, 1.6, &f.room.walls(), in_view);
    }
    f.art(3, |_, s| s.x.abs());
    f.public_things();
    f.work_lights();
}

/// The counter, with a chair and a computer behind it.
fn desk(f: &mut Furnisher) {
    let chair = OfficeChair::random(&mut f.rng);
    for width in [2.8, 2.2, 1.7] {
        let counter = Counter { width, raised: true, ..Counter::random(&mut f.rng) };
        let size = counter.size();
        let parts = [
            Part::new(&counter, [0.0, STAFF + 0.5 * size.y], 0.0).reached(0.9),
            Part::new(&chair, [0.1, STAFF - 0.4], f.rng.range(-0.3, 0.3)),
        ];
        let cost = |floor: &Floor, s: &Spot| {
            let windows = floor.room().windows().filter(|window| Some(window.wall) == s.wall).count() as f32;
            s.x.abs() + 2.0 * windows - 0.3 * floor.to_way(s.origin)
        };
        let spots = f.floor.along_walls(size.x);
        let group: Vec<_> = parts.iter().map(|part| part.piece).collect();
        let Some((spot, poses)) = f.floor.place(&group, spots, cost) else { continue };
        f.build(&counter, poses[0]);
        f.build(&chair, poses[1]);
        f.accent = spot.wall;
        let low = |x: f32, y: f32, yaw: f32| on(poses[0], Vec3::new(x, y, 0.76), yaw);
        let monitor = Monitor { width: 0.54, aspect: 16.0 / 9.0, ..Monitor::random(&mut f.rng) };
        f.build(&monitor, low(0.1, -0.05, PI));
        f.build(&Keyboard { columns: 15, white: false }, low(0.1, -0.25, PI));
        f.plugs.push(spot.origin);
        // Beside the screen.
        let tops: Vec<_> = counter
            .surfaces()
            .into_iter()
            .map(|surface| enfilade_furniture::Surface { min: Vec2::new(0.55, surface.min.y), ..surface })
            .collect();
        f.litter(&tops, poses[0], 0.8);
        return;
    }
}

/// Sofas or chairs around a low table.
fn seats(f: &mut Furnisher) {
    let center = f.room.center;
    if f.chance(0.6) {
        let family = ["sofa", "armchair", "chesterfield"][f.rng.below(3)];
        let Some(seat) = f.any(family) else { return };
        let size = seat.size();
        let table = CoffeeTable::random(&mut f.rng);
        let low = table.size();
        let out = 0.5 * low.y + 0.38;
        let mut parts = vec![Part::new(seat.as_ref(), [0.0, 0.5 * size.y], 0.0), Part::new(&table, [0.0, size.y + out], 0.0)];
        parts.push(Part::new(seat.as_ref(), [0.0, 1.5 * size.y + 2.0 * out], PI));
        for count in [3, 2, 1] {
            let spots = f.floor.along_walls(size.x.max(low.x));
            if let Some(poses) = f.once(spots, &parts[..count], |floor, s| floor.to_window(s.origin) + 0.3 * floor.to_corner(s)) {
                if count > 1 {
                    f.litter(&table.surfaces(), poses[1], 1.0);
                }
                break;
            }
        }
        return;
    }
    let chair = StackingChair { padded: true, ..StackingChair::random(&mut f.rng) };
    let size = chair.size();
    for count in [5, 4, 3, 2] {
        for _ in 0..2 {
            let pitch = size.x + 0.04;
            let parts: Vec<Part> = (0..count)
                .map(|k| Part::new(&chair, [pitch * (k as f32 - 0.5 * (count - 1) as f32), 0.5 * size.y + 0.06], 0.0).reached(0.4))
                .collect();
            let spots = f.floor.along_walls(pitch * count as f32);
            f.once(spots, &parts, |floor, s| floor.to_corner(s) + 0.2 * s.origin.distance(center));
        }
    }
    f.perhaps(0.7, "side_table", centred);
}
