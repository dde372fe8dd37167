//! Convex cells of the plan between all lines of walls, and the rooms that they form together.

use super::cover::Cover;
use super::lines::{ON_LINE_M, WallLine};
use super::outline::{area, edges};
use enfilade_math::DVec2;
use std::collections::HashMap;

/// Share of a cell that floor and ceiling cover, above which it is inside.
const INSIDE: f64 = 0.5;
/// Share of an edge with wall on it, above which the edge separates two rooms.
const PARTED: f64 = 0.5;
/// An outline that is smaller (square metres) or narrower (metres, twice the area by the length of the outline) is no room but the inside
/// of a wall or a shaft, and what has less of its outline along walls is a terrace.
const LEAST_M2: f64 = 1.0;
const LEAST_WIDTH_M: f64 = 0.5;
const LEAST_WALLED: f64 = 0.6;

/// Convex polygons, counter-clockwise, that fill the plan; those side by side have corners of the same bits.
pub struct Cells(Vec<Vec<DVec2>>);

/// An edge by the bits of its ends.
type Key = [[u64; 2]; 2];

impl Cells {
    /// The cells between lines, and between the bounds of what floor and ceiling cover.
    pub fn new(lines: &[WallLine], cover: &Cover) -> Self {
        let [low, high] = cover.bounds();
        let (low, high) = (low - DVec2::ONE, high + DVec2::ONE);
        let mut cells = vec![vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]];
        let main = lines.first().map_or(DVec2::X, |line| line.normal);
        let bounds = [main, main.perp()].into_iter();
        let bounds = bounds.flat_map(|normal| cover.extent(normal).map(|offset_m| WallLine::bare(normal, offset_m)));
        for line in lines.iter().chain(&bounds.collect::<Vec<_>>()) {
            cells = cells.into_iter().flat_map(|cell| split(cell, line)).collect();
        }
        Self(cells)
    }

    /// The outlines of rooms, counter-clockwise, from left to right.
    pub fn rooms(&self, lines: &[WallLine], cover: &Cover) -> Vec<Vec<DVec2>> {
        let inside: Vec<bool> = self.0.iter().map(|cell| cover.share(cell) > INSIDE).collect();
        let owners: HashMap<Key, usize> =
            self.0.iter().enumerate().flat_map(|(i, cell)| edges(cell).map(move |edge| (key(edge), i))).collect();
        let beyond = |[a, b]: [DVec2; 2]| owners.get(&key([b, a])).copied();
        let mut room_of: Vec<Option<usize>> = vec![None; self.0.len()];
        let mut outlines: Vec<Vec<DVec2>> = Vec::new();
        for first in 0..self.0.len() {
            if !inside[first] || room_of[first].is_some() {
                continue;
            }
            let (mut members, mut done) = (vec![first], 0);
            room_of[first] = Some(first);
            while let Some(&cell) = members.get(done) {
                done += 1;
                for edge in edges(&self.0[cell]) {
                    let Some(next) = beyond(edge).filter(|&next| inside[next] && room_of[next].is_none()) else { continue };
                    if WallLine::share(edge, lines) <= PARTED {
                        room_of[next] = Some(first);
                        members.push(next);
                    }
                }
            }
            let is_border = |edge: &[DVec2; 2]| beyond(*edge).and_then(|other| room_of[other]) != Some(first);
            let border: Vec<[DVec2; 2]> = members.iter().flat_map(|&cell| edges(&self.0[cell])).filter(is_border).collect();
            let length = |edge: &[DVec2; 2]| edge[0].distance(edge[1]);
            let around_m: f64 = border.iter().map(length).sum();
            let walled_m: f64 = border.iter().map(|edge| length(edge) * WallLine::share(*edge, lines)).sum();
            let area_m2: f64 = members.iter().map(|&cell| area(&self.0[cell])).sum();
            if area_m2 >= LEAST_M2 && 2.0 * area_m2 >= LEAST_WIDTH_M * around_m && walled_m >= LEAST_WALLED * around_m {
                outlines.extend(outline(&border));
            }
        }
        let left = |outline: &Vec<DVec2>| outline.iter().copied().reduce(|a, b| if (b.x, b.y) < (a.x, a.y) { b } else { a });
        outlines.sort_by(|a, b| left(a).map(|p| p.to_array()).partial_cmp(&left(b).map(|p| p.to_array())).expect("corners are finite"));
        outlines
    }
}

fn key(edge: [DVec2; 2]) -> Key {
    // Zero has two signs.
    edge.map(|p| p.to_array().map(|v| (v + 0.0).to_bits()))
}

/// The parts of a cell on both sides of a line. Where two cells share an edge, both are cut in the same point.
fn split(cell: Vec<DVec2>, line: &WallLine) -> Vec<Vec<DVec2>> {
    let side = |p: DVec2| {
        let d = line.distance_m(p);
        if d.abs() < ON_LINE_M { 0.0 } else { d }
    };
    let sides: Vec<f64> = cell.iter().map(|&p| side(p)).collect();
    if sides.iter().all(|d| *d >= 0.0) || sides.iter().all(|d| *d <= 0.0) {
        return vec![cell];
    }
    let (mut front, mut back) = (Vec::new(), Vec::new());
    for (i, [a, b]) in edges(&cell).enumerate() {
        let (da, db) = (sides[i], sides[(i + 1) % cell.len()]);
        if da >= 0.0 {
            front.push(a);
        }
        if da <= 0.0 {
            back.push(a);
        }
        if da * db < 0.0 {
            // From the same end for both cells.
            let (p, q, dp, dq) = if a.to_array() < b.to_array() { (a, b, da, db) } else { (b, a, db, da) };
            let cut = p + (q - p) * (dp / (dp - dq));
            front.push(cut);
            back.push(cut);
        }
    }
    vec![front, back]
}

/// The outline around all of the edges of a border, which has the room on its left, without corners on straight pieces.
fn outline(border: &[[DVec2; 2]]) -> Option<Vec<DVec2>> {
    let bits = |p: DVec2| key([p, p])[0];
    let mut from: HashMap<[u64; 2], Vec<usize>> = HashMap::new();
    border.iter().enumerate().for_each(|(i, edge)| from.entry(bits(edge[0])).or_default().push(i));
    let mut is_open = vec![true; border.len()];
    let mut best: Option<Vec<DVec2>> = None;
    for first in 0..border.len() {
        let (mut ring, mut at) = (Vec::new(), first);
        while is_open[at] {
            is_open[at] = false;
            let [a, b] = border[at];
            ring.push(a);
            // Where the room touches itself in a corner, the way that stays at the same cell.
            let turn = |&i: &usize| (b - a).angle_to(border[i][1] - border[i][0]);
            let next = from.get(&bits(b)).into_iter().flatten().copied().filter(|&i| is_open[i]);
            let Some(next) = next.max_by(|i, j| turn(i).total_cmp(&turn(j))) else { break };
            at = next;
        }
        if ring.len() >= 3 && area(&ring) > best.as_ref().map_or(0.0, |best| area(best)) {
            best = Some(ring);
        }
    }
    let ring = best?;
    let n = ring.len();
    let is_corner = |&i: &usize| {
        let (before, p, after) = (ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
        let along = (after - before).normalize_or_zero();
        along.perp_dot(p - before).abs() > 2.0 * ON_LINE_M || (p - before).dot(after - p) < 0.0
    };
    let corners: Vec<DVec2> = (0..n).filter(is_corner).map(|i| ring[i]).collect();
    (corners.len() >= 3).then_some(corners)
}
