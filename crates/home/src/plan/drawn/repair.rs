//! What drawn plans lack: an entrance, ways into rooms, windows. Each is added by the rules of our own plans, and said.

use super::Site;
use crate::plan::Doorway;
use crate::plan::openings::{DOOR_TOP, Shared, add_windows, door, free_run, hang_entrance};
use crate::room::kind::{access, row};
use crate::room::{Room, Wall};

/// Free outer wall that the entrance needs, with its casing, metres.
const ENTRANCE: f32 = 1.21;
/// Shared wall that a door needs, with its casings, metres: a narrow one fits.
const DOOR: f32 = 0.9;
/// Cost of a door in a wall that is too short for the usual one.
const NARROW: f32 = 4.0;

impl Site {
    /// Makes the entrance the first way; one is added where the plan has none.
    ///
    /// # Errors
    /// If no room has room for one.
    pub fn enter(&mut self) -> Result<(), String> {
        let order = |room: &Room| row(room.kind).ways.entrance;
        let outer = self.doorways.iter().enumerate().filter(|(_, way)| way.from.is_none());
        if let Some((k, _)) = outer.min_by_key(|(_, way)| order(&self.rooms[way.into])) {
            let way = self.doorways.remove(k);
            self.doorways.insert(0, way);
            return Ok(());
        }
        let mut best: Option<((u8, f32), usize, Wall, f32)> = None;
        for (number, room) in self.rooms.iter().enumerate() {
            for wall in room.walls() {
                let Some((low, high)) = free_run(room, wall, DOOR_TOP + 0.12, ENTRANCE).filter(|(low, high)| high - low >= ENTRANCE) else {
                    continue;
                };
                let cost = (order(room), -(high - low));
                if best.is_none_or(|(known, ..)| cost.0 < known.0 || (cost.0 == known.0 && cost.1 < known.1)) {
                    best = Some((cost, number, wall, 0.5 * (low + high)));
                }
            }
        }
        let Some((_, into, wall, x)) = best else {
            return Err(format!("no room has {ENTRANCE} m of outer wall for the entrance: add a door to the outside"));
        };
        hang_entrance(&mut self.rooms[into], wall, x, if x < 0.0 { -1.0 } else { 1.0 });
        self.doorways.insert(0, Doorway { from: None, into, open: false });
        self.notes.push(format!("the plan has no door to the outside: an entrance was added to {:?}", self.names[into]));
        Ok(())
    }

    /// Adds doors until every room can be entered.
    ///
    /// # Errors
    /// If a room shares no wall that is long enough with one that can be entered.
    pub fn join(&mut self) -> Result<(), String> {
        let mut added = Vec::new();
        loop {
            let inside = self.entered();
            let Some(cut_off) = inside.iter().position(|inside| !inside) else { break };
            let mut best: Option<(f32, Shared)> = None;
            for from in (0..inside.len()).filter(|&i| inside[i]) {
                for into in (0..inside.len()).filter(|&i| !inside[i]) {
                    let Some(shared) = self.shared(from, into) else { continue };
                    let length = shared.clear[1] - shared.clear[0];
                    let narrow = if length < 1.2 { NARROW } else { 0.0 };
                    let cost = access(self.rooms[into].kind, self.rooms[from].kind) + narrow;
                    if length >= DOOR && best.as_ref().is_none_or(|(known, _)| cost < *known) {
                        best = Some((cost, shared));
                    }
                }
            }
            let Some((_, shared)) = best else {
                return Err(format!(
                    "room {:?} has no door, and shares no wall of {DOOR} m with a room that can be entered: add a door, or move it beside one",
                    self.names[cut_off]
                ));
            };
            let [from, into] = shared.rooms;
            door(&mut self.rooms, &shared, &mut self.rng);
            self.doorways.push(Doorway { from: Some(from), into, open: false });
            added.push(format!("{:?} to {:?}", self.names[from], self.names[into]));
        }
        if !added.is_empty() {
            self.notes.push(format!("rooms that nobody could enter got doors: from {}", added.join(", from ")));
        }
        Ok(())
    }

    /// Whether each room can be entered from the outside through the doors that there are.
    fn entered(&self) -> Vec<bool> {
        let mut inside = vec![false; self.rooms.len()];
        self.doorways.iter().filter(|way| way.from.is_none()).for_each(|way| inside[way.into] = true);
        for _ in 0..self.rooms.len() {
            for way in &self.doorways {
                let Some(from) = way.from else { continue };
                let any = inside[from] || inside[way.into];
                (inside[from], inside[way.into]) = (any, any);
            }
        }
        inside
    }

    /// Adds windows to the outer walls.
    pub fn light(&mut self) {
        let mut count = 0;
        for room in &mut self.rooms {
            let walls = room.walls().into_iter().filter(|&wall| room.face(wall).has_outside()).collect();
            add_windows(room, walls, &mut self.rng);
            count += room.windows().count();
        }
        self.notes.push(format!("the plan has no windows: {count} were added to outer walls"));
    }
}
