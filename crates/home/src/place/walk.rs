//! Walkability of a room: a grid of the places where the middle of a body can be.

use crate::room::{Footprint, Room};
use enfilade_math::Vec2;

/// Half the width of a person who walks through, metres: 0.6 m is the narrowest way between furniture that people accept.
pub const BODY: f32 = 0.30;
/// Edge of a grid cell, metres.
const CELL: f32 = 0.05;
/// Height of a body that walks upright under a sloping ceiling, metres.
const UPRIGHT: f32 = 1.9;
/// Reduction of half the width of a body, metres, because cells are tested at their centres.
const TOLERANCE: f32 = 0.02;
/// Largest area, of places for the middle of a body, that furniture may cut off, m².
const CUT_OFF: f32 = 0.12;

/// The free places of a room.
#[derive(Clone, Debug)]
pub struct Walk {
    min: Vec2,
    columns: usize,
    blocked: Vec<bool>,
    /// The cells behind the ways into the room.
    starts: Vec<usize>,
}

impl Walk {
    /// The empty room.
    pub fn new(room: &Room) -> Self {
        let half = 0.5 * room.size.truncate();
        let min = room.box_center - half;
        let columns = (room.size.x / CELL).ceil() as usize;
        let rows = (room.size.y / CELL).ceil() as usize;
        let mut walk = Self { min, columns, blocked: vec![false; columns * rows], starts: Vec::new() };
        for cell in 0..walk.blocked.len() {
            let p = walk.place(cell);
            walk.blocked[cell] = !room.contains(p, TOLERANCE - BODY) || !room.has_headroom(p, BODY - TOLERANCE, UPRIGHT);
        }
        walk.starts = room.ways().filter_map(|way| walk.cell(room.before(way.wall, way.center_x(), BODY + 0.06))).collect();
        walk
    }

    fn place(&self, cell: usize) -> Vec2 {
        self.min + CELL * Vec2::new((cell % self.columns) as f32 + 0.5, (cell / self.columns) as f32 + 0.5)
    }

    fn cell(&self, p: Vec2) -> Option<usize> {
        let q = (p - self.min) / CELL;
        let rows = self.blocked.len() / self.columns;
        let inside = q.cmpge(Vec2::ZERO).all() && (q.x as usize) < self.columns && (q.y as usize) < rows;
        inside.then(|| q.y as usize * self.columns + q.x as usize)
    }

    /// Something that people cannot walk through.
    pub fn block(&mut self, thing: &Footprint) {
        let reach = thing.half.length() + BODY;
        for cell in 0..self.blocked.len() {
            let p = self.place(cell);
            self.blocked[cell] |= (p - thing.center).abs().max_element() < reach && thing.distance(p) < BODY - TOLERANCE;
        }
    }

    /// The cells that can be reached from the first way.
    fn reached(&self) -> Vec<bool> {
        let mut seen = vec![false; self.blocked.len()];
        let mut stack: Vec<usize> = self.starts.first().copied().filter(|&s| !self.blocked[s]).into_iter().collect();
        stack.iter().for_each(|&s| seen[s] = true);
        while let Some(cell) = stack.pop() {
            let column = cell % self.columns;
            let beside = [(column > 0).then(|| cell - 1), (column + 1 < self.columns).then_some(cell + 1)];
            let behind = [cell.checked_sub(self.columns), (cell + self.columns < seen.len()).then_some(cell + self.columns)];
            for next in beside.into_iter().chain(behind).flatten() {
                if !self.blocked[next] && !seen[next] {
                    seen[next] = true;
                    stack.push(next);
                }
            }
        }
        seen
    }

    /// True when all ways into the room are joined, no floor that matters is cut off, and a person can step up to each of `fronts`.
    pub fn is_open(&self, fronts: &[Footprint]) -> bool {
        let seen = self.reached();
        let joined = self.starts.iter().all(|&s| seen[s]);
        let cut_off = (0..seen.len()).filter(|&c| !self.blocked[c] && !seen[c]).count() as f32 * CELL * CELL;
        joined && cut_off <= CUT_OFF && fronts.iter().all(|f| self.touches(&seen, f))
    }

    fn touches(&self, seen: &[bool], front: &Footprint) -> bool {
        let reach = front.half.length() + BODY;
        (0..seen.len()).any(|c| {
            let p = self.place(c);
            seen[c] && (p - front.center).abs().max_element() < reach && front.distance(p) < BODY
        })
    }
}
