//! Floor plans that people draw: any simple polygons, with doors and windows where they say.
//!
//! Outlines are inner faces of walls. Two rooms whose walls run side by side less than [`measures::THICKEST`] apart share a wall, whatever else is
//! behind its other pieces; where they touch, they were drawn by the middles of walls, and are moved apart. What is missing is added by the
//! rules of our own plans: an entrance, ways into rooms without one, and windows, where the file has none at all. Each is said.

mod backs;
mod kinds;
mod measures;
mod openings;
mod outlines;
mod repair;
mod slopes;
#[cfg(test)]
mod tests;

use super::FloorPlan;
use super::slicing::Cell;
use crate::building::Building;
use crate::room::Room;
use enfilade_furniture::RoomKind;
use enfilade_math::{DVec2, Rng, Vec2};
use enfilade_scene::{DrawnPlan, DrawnRoom};
use measures::{INNER_WALL, OUTER_WALL};
use std::collections::BTreeMap;

/// Height of rooms that have none in the file, metres; and the lowest and highest that can be furnished.
const HEIGHT: f64 = 2.6;
const HEIGHTS: [f64; 2] = [2.2, 6.0];
/// Most rooms of a plan.
const MOST: usize = 64;
/// A plan whose middle is farther from the origin than this is moved there, metres: single precision would show.
const FAR: f64 = 200.0;

impl FloorPlan {
    /// The plan that somebody drew, and what was left out, guessed or added, for people. `rng` decides how far doors are open, and what of
    /// missing windows and doors is random.
    ///
    /// # Errors
    /// What is wrong with the plan, where, and what was expected.
    pub fn drawn(plan: &DrawnPlan, rng: &Rng) -> Result<(Self, Vec<String>), String> {
        Self::drawn_in(plan, Building::Home, rng)
    }

    /// The plan as [`FloorPlan::drawn`] builds it; words of other programs mean rooms of this kind of building.
    ///
    /// # Errors
    /// What is wrong with the plan, where, and what was expected.
    pub fn drawn_in(plan: &DrawnPlan, building: Building, rng: &Rng) -> Result<(Self, Vec<String>), String> {
        if plan.rooms.is_empty() || plan.rooms.len() > MOST {
            return Err(format!("the plan has {} rooms, expected 1 to {MOST}", plan.rooms.len()));
        }
        let mut notes = plan.notes.clone();
        let mut plan = near_origin(plan, &mut notes);
        // In our own words it is an error.
        if !plan.strict && plan.rooms.len() > 1 {
            outlines::without_slivers(&mut plan.rooms, &mut notes);
        }
        let kinds = kinds_of(&plan, building, &mut notes)?;
        let mut outlines = outlines::cleaned(&plan.rooms)?;
        outlines::check_apart(&outlines, &plan.rooms)?;
        if outlines::thickened(&mut outlines) {
            notes.push(format!("rooms that touch were drawn by the middles of walls: those walls are {INNER_WALL} m thick now"));
        }
        let heights: Vec<f32> = plan.rooms.iter().map(height).collect::<Result<_, _>>()?;
        let thickness = [INNER_WALL, OUTER_WALL];
        let room = |i: usize| Room::polygon(kinds[i], outlines[i].clone(), heights[i], thickness, |wall| backs::backs(&outlines, i, wall));
        let mut rooms: Vec<Room> = (0..outlines.len()).map(room).collect();
        let names: Vec<String> = plan.rooms.iter().map(|room| room.name.clone()).collect();
        slopes::put_under(&mut rooms, &names, &plan)?;
        let mut site = Site { rooms, names, doorways: Vec::new(), notes, strict: plan.strict, rng: rng.fork(2) };
        plan.openings.iter().try_for_each(|opening| site.open(opening))?;
        let has_windows = plan.openings.iter().any(|opening| opening.kind == enfilade_scene::OpeningKind::Window);
        site.enter()?;
        site.join()?;
        if !has_windows {
            site.light();
        }
        let bounds: Vec<[Vec2; 2]> = site.rooms.iter().map(|room| room.outline.bounds()).collect();
        let whole = Cell {
            min: bounds.iter().map(|b| b[0]).reduce(Vec2::min).unwrap_or(Vec2::ZERO),
            max: bounds.iter().map(|b| b[1]).reduce(Vec2::max).unwrap_or(Vec2::ZERO),
        };
        Ok((Self { rooms: site.rooms, doorways: site.doorways, whole }, site.notes))
    }
}

/// Rooms whose doors and windows are being made.
struct Site {
    rooms: Vec<Room>,
    /// Names in the file.
    names: Vec<String>,
    doorways: Vec<super::Doorway>,
    notes: Vec<String>,
    strict: bool,
    rng: Rng,
}

/// The plan, moved to the origin if it is so far away that single precision would show.
fn near_origin(plan: &DrawnPlan, notes: &mut Vec<String>) -> DrawnPlan {
    let mut moved = plan.clone();
    let corners = plan.rooms.iter().flat_map(|room| &room.polygon).filter(|p| p.is_finite());
    let (low, high) = corners.fold((DVec2::MAX, DVec2::MIN), |(low, high), p| (low.min(*p), high.max(*p)));
    let middle = (0.5 * (low + high)).round();
    if middle.is_finite() && middle.length() > FAR {
        moved.rooms.iter_mut().flat_map(|room| &mut room.polygon).for_each(|p| *p -= middle);
        moved.openings.iter_mut().for_each(|opening| opening.at -= middle);
        moved.slopes.iter_mut().for_each(|of| of.slope = of.slope.moved((-middle).extend(0.0)));
        notes.push(format!("the plan is far from the origin of its coordinates: it was moved by [{}, {}] m", -middle.x, -middle.y));
    }
    moved
}

fn kinds_of(plan: &DrawnPlan, building: Building, notes: &mut Vec<String>) -> Result<Vec<RoomKind>, String> {
    let mut guessed: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    let mut kinds = Vec::new();
    for DrawnRoom { name, kind, .. } in &plan.rooms {
        match kinds::kind(kind, building, plan.strict) {
            Some(known) => kinds.push(known),
            None if plan.strict => return Err(format!("room {name:?} is of the kind {kind:?}; {}", kinds::expected(kind))),
            None => {
                guessed.entry(kind).or_default().push(name);
                kinds.push(RoomKind::Hall);
            }
        }
    }
    for (kind, names) in guessed {
        notes.push(format!("rooms of the kind {kind:?}, which is none that we furnish, are furnished as halls: {}", names.join(", ")));
    }
    Ok(kinds)
}

fn height(room: &DrawnRoom) -> Result<f32, String> {
    let height = room.height_m.unwrap_or(HEIGHT);
    if (HEIGHTS[0]..=HEIGHTS[1]).contains(&height) {
        Ok(height as f32)
    } else {
        let [low, high] = HEIGHTS;
        Err(format!("room {:?} is {height} m high, expected {low} to {high} m", room.name))
    }
}
