//! Plans that are no longer rectangles: of a plan of rectangles some rooms get a bay, a niche, a column in a corner, a cut corner, or a part
//! of the room beside them, so that both go around a corner.
//!
//! Each change is tried on the outlines as if somebody had drawn them, and kept if a plan can be built ([`FloorPlan::drawn`]) in which all
//! openings are where they were and rooms keep their widths.

use super::FloorPlan;
use crate::room::kind::{norm, row};
use enfilade_furniture::RoomKind;
use enfilade_math::{DVec2, Rng};
use enfilade_scene::{DrawnOpening, DrawnPlan, DrawnRoom, OpeningKind};

/// Distance that changes keep from openings and corners, metres.
const CLEAR: f64 = 0.35;
/// Rooms with less floor stay as they are, m².
const SMALLEST: f64 = 7.0;
/// Depths of bays, metres, and how much narrower their fronts are than their mouths on each side.
const BAY: [f64; 2] = [0.6, 0.95];
const SPLAY: [f64; 2] = [0.25, 0.75];
/// Sides of columns, metres.
const COLUMN: [f64; 2] = [0.3, 0.5];
/// Depths and widths of niches, metres.
const NICHE: [[f64; 2]; 2] = [[0.25, 0.5], [0.9, 1.6]];
/// Lengths that are cut off corners on the outside, metres.
const CUT: [f64; 2] = [0.6, 1.1];
/// Depths and lengths of what a room takes of the one beside it, metres.
const TAKEN: [[f64; 2]; 2] = [[0.7, 1.3], [1.1, 1.9]];

/// A change of outlines, and its probability in a room where it is possible.
type Change = fn(&mut DrawnPlan, &Walls, usize, &mut Rng) -> Option<()>;
const CHANGES: [(f32, Change); 5] = [(0.5, around_corner), (0.5, bay), (0.3, column), (0.35, niche), (0.3, cut_corner)];

impl FloorPlan {
    /// The plan with some rooms of other shapes, perhaps under a roof; the same plan where nothing can be changed.
    #[must_use]
    pub fn varied(self, rng: &Rng) -> Self {
        let whole = self.whole;
        let mut best = self;
        let mut draw = rng.fork(77);
        for room in 0..best.rooms.len() {
            for (often, change) in CHANGES {
                // Every change has random numbers of its own, whether it is tried or not.
                let mut own = draw.fork(room as u64);
                if draw.next_f32() >= often {
                    continue;
                }
                if let Some(changed) = best.changed(room, change, &mut own, rng) {
                    best = changed;
                    break;
                }
            }
        }
        best.under_roof(&whole, &rng.fork(78))
    }

    fn changed(&self, room: usize, change: Change, own: &mut Rng, rng: &Rng) -> Option<Self> {
        let mut drawn = DrawnPlan::from(&self.to_rooms());
        let walls = Walls::of(self);
        if self.rooms[room].outline.count() != 4 || f64::from(self.rooms[room].area) < SMALLEST {
            return None;
        }
        change(&mut drawn, &walls, room, own)?;
        let (plan, notes) = Self::drawn(&drawn, rng).ok()?;
        let wide = |room: &crate::room::Room| 2.0 * room.outline.depth(room.outline.middle()) > norm(room.kind).width - 0.1;
        (notes.is_empty() && plan.rooms.iter().all(wide)).then_some(plan)
    }
}

/// What is behind the walls of the rooms, edge by edge of the drawn outlines.
struct Walls {
    /// Whether all of a wall is outside.
    outer: Vec<Vec<bool>>,
    /// The one room behind all of a wall.
    beyond: Vec<Vec<Option<usize>>>,
}

impl Walls {
    fn of(plan: &FloorPlan) -> Self {
        // The layout has an edge for every piece of wall.
        let drawn = DrawnPlan::from(&plan.to_rooms());
        let pieces = |of: &dyn Fn(&crate::room::Back) -> bool| -> Vec<Vec<bool>> {
            plan.rooms.iter().map(|room| room.faces.iter().flat_map(|face| &face.backs).map(of).collect()).collect()
        };
        let outer = pieces(&|back| back.outer);
        let beyond = (0..drawn.rooms.len()).map(|room| {
            let edges = drawn.rooms[room].polygon.len();
            (0..edges).map(|edge| opposite(&drawn, room, edge)).collect()
        });
        Self { beyond: beyond.collect(), outer }
    }
}

/// The room whose wall runs along all of an edge, close behind it.
fn opposite(drawn: &DrawnPlan, room: usize, edge: usize) -> Option<usize> {
    let [a, b] = ends(&drawn.rooms[room], edge);
    let along = (b - a).normalize_or_zero();
    (0..drawn.rooms.len()).filter(|other| *other != room).find(|&other| {
        let polygon = &drawn.rooms[other].polygon;
        (0..polygon.len()).any(|i| {
            let [c, d] = ends(&drawn.rooms[other], i);
            let gap = -along.perp().dot(c - a);
            let span = [(d - a).dot(along), (c - a).dot(along)];
            along.dot((d - c).normalize_or_zero()) < -0.999 && (0.0..0.3).contains(&gap) && span[1] - span[0] > 2.0 && {
                let shared = span[1].min(a.distance(b)) - span[0].max(0.0);
                shared > 2.0
            }
        })
    })
}

fn ends(room: &DrawnRoom, edge: usize) -> [DVec2; 2] {
    let n = room.polygon.len();
    [room.polygon[edge % n], room.polygon[(edge + 1) % n]]
}

/// The edges of a room that satisfy a condition, in random order.
fn edges(room: &DrawnRoom, rng: &mut Rng, is_one: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut all: Vec<usize> = (0..room.polygon.len()).filter(|&edge| is_one(edge)).collect();
    rng.shuffle(&mut all);
    all
}

/// The spans that openings take of an edge, with what is kept clear around them.
fn taken(drawn: &DrawnPlan, [a, b]: [DVec2; 2]) -> Vec<[f64; 2]> {
    let along = (b - a).normalize_or_zero();
    let of = |opening: &DrawnOpening| {
        let p = opening.at - a;
        let (x, off) = (p.dot(along), p.dot(along.perp()));
        let half = 0.5 * opening.width_m.unwrap_or(0.9) + CLEAR;
        (off.abs() < 0.5 && x > -half && x < a.distance(b) + half).then_some([x - half, x + half])
    };
    drawn.openings.iter().filter_map(of).collect()
}

/// A free span of this length on an edge, away from its ends.
fn free_span(drawn: &DrawnPlan, edge: [DVec2; 2], length: f64, rng: &mut Rng) -> Option<[f64; 2]> {
    let (whole, taken) = (edge[0].distance(edge[1]), taken(drawn, edge));
    let room = whole - 2.0 * CLEAR - length;
    let starts = (0..12).map(|_| CLEAR + room * f64::from(rng.next_f32())).collect::<Vec<f64>>();
    if room < 0.0 {
        return None;
    }
    starts.into_iter().map(|start| [start, start + length]).find(|span| taken.iter().all(|t| t[1] < span[0] || span[1] < t[0]))
}

fn between([low, high]: [f64; 2], rng: &mut Rng) -> f64 {
    low + (high - low) * f64::from(rng.next_f32())
}

/// A room takes a rectangle of the one beside it, at an end of the wall between them.
fn around_corner(drawn: &mut DrawnPlan, walls: &Walls, room: usize, rng: &mut Rng) -> Option<()> {
    let candidates = edges(&drawn.rooms[room], rng, |edge| walls.beyond[room].get(edge).is_some_and(Option::is_some));
    let (depth, length) = (between(TAKEN[0], rng), between(TAKEN[1], rng));
    let first_end = rng.below(2) == 0;
    for edge in candidates {
        let other = walls.beyond[room][edge]?;
        let [a, b] = ends(&drawn.rooms[room], edge);
        let outward = -(b - a).normalize_or_zero().perp();
        let theirs = (0..drawn.rooms[other].polygon.len()).find(|&i| {
            let [c, d] = ends(&drawn.rooms[other], i);
            (d - c).normalize_or_zero().dot((b - a).normalize_or_zero()) < -0.999 && (0.0..0.3).contains(&outward.dot(c - a))
        })?;
        let [c, d] = ends(&drawn.rooms[other], theirs);
        let along = (b - a).normalize_or_zero();
        // Both walls end at the same line where they are beside the same third room or the outside.
        let (low, high) = ((d - a).dot(along).abs(), (c - b).dot(along).abs());
        let gap = outward.dot(c - a);
        let frees = |edge: [DVec2; 2], span: [f64; 2]| taken(drawn, edge).iter().all(|t| t[1] < span[0] || span[1] < t[0]);
        let is_free = |span: [f64; 2]| frees([a, b], span);
        // What opens in the walls beside, which change hands, stays theirs.
        let n = drawn.rooms[other].polygon.len();
        let (before, after) = (ends(&drawn.rooms[other], theirs + n - 1), ends(&drawn.rooms[other], theirs + 1));
        let before_is_free = frees([before[1], before[0]], [0.0, depth + CLEAR]);
        let after_is_free = frees(after, [0.0, depth + CLEAR]);
        let whole = a.distance(b);
        if first_end && after_is_free && low < 1e-3 && whole > length + 1.5 && is_free([-0.1, length + CLEAR]) {
            let (p, q) = (a + along * length, a + outward * depth);
            let deep = p + outward * depth;
            insert(&mut drawn.rooms[room], edge, vec![q, deep, p], true);
            let (inner, side) = (along * gap, outward * gap);
            insert(&mut drawn.rooms[other], theirs, vec![p + inner + side, deep + inner + side, d + outward * depth], false);
            return Some(());
        }
        if !first_end && before_is_free && high < 1e-3 && whole > length + 1.5 && is_free([whole - length - CLEAR, whole + 0.1]) {
            let (p, q) = (b - along * length, b + outward * depth);
            let deep = p + outward * depth;
            insert(&mut drawn.rooms[room], edge, vec![p, deep, q], false);
            let (inner, side) = (-along * gap, outward * gap);
            insert(&mut drawn.rooms[other], theirs, vec![c + outward * depth, deep + inner + side, p + inner + side], true);
            return Some(());
        }
    }
    None
}

/// Puts corners into an edge; they replace its beginning, or its end.
fn insert(room: &mut DrawnRoom, edge: usize, corners: Vec<DVec2>, replaces_start: bool) {
    let n = room.polygon.len();
    let at = if replaces_start { edge % n } else { (edge + 1) % n };
    room.polygon.splice(at..=at, corners);
}

/// A bay before an outer wall, with the wall's window in its front if there is one.
fn bay(drawn: &mut DrawnPlan, walls: &Walls, room: usize, rng: &mut Rng) -> Option<()> {
    if !RoomKind::from_name(&drawn.rooms[room].kind).is_some_and(|kind| row(kind).windows.bay) {
        return None;
    }
    let (depth, splay) = (between(BAY, rng), between(SPLAY, rng));
    for edge in edges(&drawn.rooms[room], rng, |edge| walls.outer[room].get(edge) == Some(&true)) {
        let [a, b] = ends(&drawn.rooms[room], edge);
        let (along, outward) = ((b - a).normalize_or_zero(), -(b - a).normalize_or_zero().perp());
        let on = |o: &DrawnOpening| (o.at - a).dot(along.perp()).abs() < 0.5 && (0.0..a.distance(b)).contains(&(o.at - a).dot(along));
        let windows: Vec<usize> = (0..drawn.openings.len()).filter(|&i| on(&drawn.openings[i])).collect();
        let &[window] = &windows[..] else { continue };
        if drawn.openings[window].kind != OpeningKind::Window {
            continue;
        }
        let (x, half) = ((drawn.openings[window].at - a).dot(along), 0.5 * drawn.openings[window].width_m? + 0.12);
        let (low, high) = (x - half - splay, x + half + splay);
        if low < CLEAR || high > a.distance(b) - CLEAR {
            continue;
        }
        let at = |x: f64, out: f64| a + along * x + outward * out;
        drawn.openings[window].at = at(x, depth);
        let corners = vec![at(low, 0.0), at(x - half, depth), at(x + half, depth), at(high, 0.0)];
        drawn.rooms[room].polygon.splice(edge + 1..edge + 1, corners);
        return Some(());
    }
    None
}

/// A square column in a corner.
fn column(drawn: &mut DrawnPlan, _: &Walls, room: usize, rng: &mut Rng) -> Option<()> {
    let side = between(COLUMN, rng);
    let mut corners: Vec<usize> = (0..drawn.rooms[room].polygon.len()).collect();
    rng.shuffle(&mut corners);
    for corner in corners {
        let n = drawn.rooms[room].polygon.len();
        let (before, after) = (ends(&drawn.rooms[room], (corner + n - 1) % n), ends(&drawn.rooms[room], corner));
        let (u, v) = ((before[0] - before[1]).normalize_or_zero(), (after[1] - after[0]).normalize_or_zero());
        let length = before[0].distance(before[1]);
        let is_free = |edge: [DVec2; 2], span: [f64; 2]| taken(drawn, edge).iter().all(|t| t[1] < span[0] || span[1] < t[0]);
        if u.dot(v).abs() < 1e-3 && is_free(before, [length - side, length]) && is_free(after, [0.0, side]) {
            let at = before[1];
            drawn.rooms[room].polygon.splice(corner..=corner, [at + u * side, at + u * side + v * side, at + v * side]);
            return Some(());
        }
    }
    None
}

/// A niche in an outer wall.
fn niche(drawn: &mut DrawnPlan, walls: &Walls, room: usize, rng: &mut Rng) -> Option<()> {
    let (depth, width) = (between(NICHE[0], rng), between(NICHE[1], rng));
    for edge in edges(&drawn.rooms[room], rng, |edge| walls.outer[room].get(edge) == Some(&true)) {
        let [a, b] = ends(&drawn.rooms[room], edge);
        let Some([low, high]) = free_span(drawn, [a, b], width, rng) else { continue };
        let (along, outward) = ((b - a).normalize_or_zero(), -(b - a).normalize_or_zero().perp());
        let at = |x: f64, out: f64| a + along * x + outward * out;
        let corners = vec![at(low, 0.0), at(low, depth), at(high, depth), at(high, 0.0)];
        drawn.rooms[room].polygon.splice(edge + 1..edge + 1, corners);
        return Some(());
    }
    None
}

/// A slanted wall in place of an outer corner.
fn cut_corner(drawn: &mut DrawnPlan, walls: &Walls, room: usize, rng: &mut Rng) -> Option<()> {
    let cut = [between(CUT, rng), between(CUT, rng)];
    let n = drawn.rooms[room].polygon.len();
    let is_outer = |edge: usize| walls.outer[room].get(edge % n) == Some(&true);
    for corner in edges(&drawn.rooms[room], rng, |corner| is_outer(corner) && is_outer(corner + n - 1)) {
        let (before, after) = (ends(&drawn.rooms[room], (corner + n - 1) % n), ends(&drawn.rooms[room], corner));
        let length = before[0].distance(before[1]);
        let is_free = |edge: [DVec2; 2], span: [f64; 2]| taken(drawn, edge).iter().all(|t| t[1] < span[0] || span[1] < t[0]);
        let (u, v) = ((before[0] - before[1]).normalize_or_zero(), (after[1] - after[0]).normalize_or_zero());
        if u.dot(v).abs() < 1e-3 && is_free(before, [length - cut[0], length]) && is_free(after, [0.0, cut[1]]) {
            let at = before[1];
            drawn.rooms[room].polygon.splice(corner..=corner, [at + u * cut[0], at + v * cut[1]]);
            return Some(());
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::room::kind::usual_programme;

    #[test]
    fn half_of_the_homes_and_more_have_rooms_of_other_shapes_and_all_are_whole() {
        let mut other = 0;
        for seed in 0..40 {
            let kinds = usual_programme(3 + seed as usize % 6);
            let rectangles = FloorPlan::new(&kinds, &Rng::new(seed));
            let varied = rectangles.clone().varied(&Rng::new(seed));
            assert_eq!(varied.rooms.len(), kinds.len());
            assert_eq!(varied.doorways.len(), rectangles.doorways.len(), "seed {seed}");
            let windows = |plan: &FloorPlan| plan.rooms.iter().flat_map(crate::room::Room::windows).count();
            let is_under_roof = varied.rooms.iter().any(|room| !room.slopes.is_empty());
            assert!(windows(&varied) == windows(&rectangles) || is_under_roof, "seed {seed}");
            other += usize::from(varied.rooms.iter().any(|room| room.outline.count() != 4));
            // All together rooms have about the floor that they had.
            let area = |plan: &FloorPlan| plan.rooms.iter().map(|room| room.area).sum::<f32>();
            assert!((area(&varied) - area(&rectangles)).abs() < 0.12 * area(&rectangles), "seed {seed}");
        }
        assert!(other >= 24, "{other} of 40");
    }
}
