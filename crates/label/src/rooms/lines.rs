//! Straight lines of walls, seen from above, and the intervals with wall on them.

use super::grid::Grid;
use super::storeys::Storey;
use super::surfaces::LabelledTriangle;
use enfilade_math::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Largest differences between surfaces on one line: in direction (radians), and in distance from it (metres).
const ANGLE: f64 = 0.035;
const OFFSET_M: f64 = 0.04;
/// Directions within this angle of the main direction of walls, or of its perpendicular, are snapped to it, radians.
const SNAP: f64 = 0.026;
/// Least area of wall on a line, square metres; and the largest number of lines.
const LEAST_M2: f64 = 0.3;
const MOST_LINES: usize = 120;
/// Doors and windows count as wall on a line that is this near, metres.
const PANE_M: f64 = 0.4;
/// Distance below which a corner is on a line, metres.
pub const ON_LINE_M: f64 = 1e-3;
/// Squares in which a line looks for wall: along and up, metres; longer where there would be more than `MOST_COLUMNS`.
const STEP: DVec2 = DVec2::new(0.05, 0.1);
const MOST_COLUMNS: f64 = 1e4;
/// There is wall where the share `STANDS` of the height between these is covered, metres above the floor: below a window is enough.
const BAND_M: [f64; 2] = [0.2, 2.2];
const STANDS: f64 = 0.25;
/// Least length of wall in a run of wall, doors and windows, metres, or half of the run.
const LEAST_STANDING_M: f64 = 0.4;
/// Gaps up to here are doorways, which do not make one room of two, metres.
const DOORWAY_M: f64 = 1.3;
/// Range of distances of a wall's back behind its face, metres.
const BEHIND_M: [f64; 2] = [0.03, 0.6];

/// A line: the points p with normal · p = offset.
pub struct WallLine {
    pub normal: DVec2,
    pub offset_m: f64,
    /// Intervals with wall along `normal.perp()`, ascending.
    standing: Vec<[f64; 2]>,
}

/// Upright surface: direction of its normal on [0, π), its middle, its area.
type Piece = (f64, DVec2, f64);

impl WallLine {
    /// The lines of a storey, those with most wall first.
    pub fn find(storey: &Storey<'_>) -> Vec<Self> {
        let mut pieces: Vec<Piece> = storey.walls.iter().filter_map(|triangle| piece(triangle)).collect();
        let main = main_direction(&pieces);
        let mut found: Vec<(f64, DVec2, f64)> = Vec::new();
        while let Some(direction) = richest_direction(&pieces) {
            let quarter = ((direction - main) / FRAC_PI_2).round();
            let on_main = main + quarter * FRAC_PI_2;
            let direction = if (direction - on_main).abs() <= SNAP { on_main } else { direction };
            let own: Vec<Piece>;
            (own, pieces) = pieces.into_iter().partition(|(angle, ..)| between(*angle, direction) <= ANGLE + SNAP);
            let normal = DVec2::from_angle(direction);
            found.extend(offsets(&own, normal).into_iter().map(|(offset_m, area)| (area, normal, offset_m)));
            if own.is_empty() {
                break;
            }
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.truncate(MOST_LINES);
        let line = |(_, normal, offset_m)| Self { normal, offset_m, standing: standing(storey, normal, offset_m) };
        found.into_iter().map(line).collect()
    }

    /// A line without wall.
    pub fn bare(normal: DVec2, offset_m: f64) -> Self {
        Self { normal, offset_m, standing: vec![] }
    }

    /// Signed distance of a point, on the side of the normal positive.
    pub fn distance_m(&self, p: DVec2) -> f64 {
        self.normal.dot(p) - self.offset_m
    }

    /// The share of a piece of this line that has wall.
    pub fn share([a, b]: [DVec2; 2], lines: &[Self]) -> f64 {
        let is_on = |line: &&Self| [a, b].iter().all(|&p| line.distance_m(p).abs() <= 2.0 * ON_LINE_M);
        lines.iter().filter(is_on).map(|line| line.own_share([a, b])).fold(0.0, f64::max)
    }

    fn own_share(&self, ends: [DVec2; 2]) -> f64 {
        let [a, b] = ends.map(|p| self.normal.perp().dot(p));
        let (low, high) = (a.min(b), a.max(b));
        let shared = self.standing.iter().map(|[from, to]| (to.min(high) - from.max(low)).max(0.0)).sum::<f64>();
        shared / (high - low).max(f64::MIN_POSITIVE)
    }
}

/// Thickness of the wall behind an edge of a room, which has the room on its left; 0 if it is not known.
pub fn thickness_behind(lines: &[WallLine], edge: [DVec2; 2]) -> f64 {
    let outward = -(edge[1] - edge[0]).normalize_or_zero().perp();
    let middle = 0.5 * (edge[0] + edge[1]);
    let depth = |line: &WallLine| {
        let facing = line.normal.dot(outward);
        let depth = -line.distance_m(middle) * facing.signum();
        let shift = outward * depth;
        (facing.abs() > 0.999 && line.own_share(edge.map(|p| p + shift)) > 0.5).then_some(depth)
    };
    lines.iter().filter_map(depth).filter(|m| (BEHIND_M[0]..=BEHIND_M[1]).contains(m)).min_by(f64::total_cmp).unwrap_or(0.0)
}

fn piece(triangle: &LabelledTriangle) -> Option<Piece> {
    let (normal, area) = triangle.normal_and_area();
    let across = normal.truncate().try_normalize()?;
    Some((across.to_angle().rem_euclid(PI), triangle.center().truncate(), area))
}

/// The angle between two directions of normals that may point either way.
fn between(a: f64, b: f64) -> f64 {
    let d = (a - b).rem_euclid(PI);
    d.min(PI - d)
}

/// The direction that most wall is parallel or perpendicular to.
fn main_direction(pieces: &[Piece]) -> f64 {
    // The angle of the sum of vectors whose angles are four times as large, so that right angles coincide.
    let sum = pieces.iter().map(|(angle, _, area)| DVec2::from_angle(4.0 * angle) * *area).sum::<DVec2>();
    let rough = sum.to_angle() / 4.0;
    // Again, without surfaces in other directions.
    let near = |angle: f64| (angle - rough + FRAC_PI_2 / 2.0).rem_euclid(FRAC_PI_2) - FRAC_PI_2 / 2.0;
    let (mut total, mut weight) = (0.0, 0.0);
    for (angle, _, area) in pieces.iter().filter(|(angle, ..)| near(*angle).abs() < 2.0 * ANGLE) {
        total += near(*angle) * area;
        weight += area;
    }
    let found = rough + if weight > 0.0 { total / weight } else { 0.0 };
    // Axes of the world are what most rooms are built along.
    if found.sin().abs().min(found.cos().abs()) < 1e-3 { (found / FRAC_PI_2).round() * FRAC_PI_2 } else { found }
}

/// The direction around which there is most wall, if that is enough for a line.
fn richest_direction(pieces: &[Piece]) -> Option<f64> {
    const BINS: usize = 360;
    let mut areas = [0.0; BINS];
    let bin = |angle: f64| ((angle / PI * BINS as f64) as usize).min(BINS - 1);
    pieces.iter().for_each(|(angle, _, area)| areas[bin(*angle)] += area);
    let around = |i: usize| (0..3).map(|d| areas[(i + BINS + d - 1) % BINS]).sum::<f64>();
    let best = (0..BINS).max_by(|&a, &b| around(a).total_cmp(&around(b)).then(b.cmp(&a)))?;
    if around(best) < LEAST_M2 {
        return None;
    }
    let rough = (best as f64 + 0.5) * PI / BINS as f64;
    let signed = |angle: f64| (angle - rough + FRAC_PI_2).rem_euclid(PI) - FRAC_PI_2;
    let near: Vec<(f64, f64)> = pieces.iter().map(|(angle, _, area)| (signed(*angle), *area)).filter(|(d, _)| d.abs() <= ANGLE).collect();
    let weight = near.iter().map(|(_, area)| area).sum::<f64>();
    Some(rough + near.iter().map(|(d, area)| d * area).sum::<f64>() / weight)
}

/// Distances from the origin at which there is most wall, each with its area.
fn offsets(pieces: &[Piece], normal: DVec2) -> Vec<(f64, f64)> {
    let mut open: Vec<(f64, f64)> = pieces.iter().map(|(_, middle, area)| (normal.dot(*middle), *area)).collect();
    open.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut found = Vec::new();
    while let Some((area, range)) = super::storeys::richest(&open, OFFSET_M) {
        if area < LEAST_M2 {
            break;
        }
        let run = &open[range];
        let offset_m = super::storeys::weighted_median(run);
        found.push((offset_m, area));
        open.retain(|(d, _)| (d - offset_m).abs() > OFFSET_M);
    }
    found
}

/// Intervals with wall, doors and windows along a line.
fn standing(storey: &Storey<'_>, normal: DVec2, offset_m: f64) -> Vec<[f64; 2]> {
    let along = normal.perp();
    let near = |reach_m: f64| {
        move |t: &&&LabelledTriangle| {
            let faces = t.normal_and_area().0.truncate().dot(normal).abs();
            faces > 0.98 && t.corners.iter().all(|p| (normal.dot(p.truncate()) - offset_m).abs() <= reach_m)
        }
    };
    let flat = |t: &&LabelledTriangle| t.corners.map(|p: DVec3| DVec2::new(along.dot(p.truncate()), p.z - storey.floor_z_m));
    let walls: Vec<[DVec2; 3]> = storey.walls.iter().filter(near(1.5 * OFFSET_M)).map(flat).collect();
    let panes: Vec<[DVec2; 3]> = storey.panes.iter().filter(near(PANE_M)).map(flat).collect();
    let ends = walls.iter().chain(&panes).flatten().map(|p| p.x);
    let (Some(low), Some(high)) = (ends.clone().reduce(f64::min), ends.reduce(f64::max)) else { return vec![] };
    let step = STEP.x.max((high - low) / MOST_COLUMNS);
    let grid = Grid::new(DVec2::new(low, BAND_M[0]), DVec2::new(high, BAND_M[1]), DVec2::new(step, STEP.y));
    let mut seen = vec![false; grid.count()];
    let columns = |triangles: &[[DVec2; 3]], seen: &mut Vec<bool>| -> Vec<usize> {
        triangles.iter().for_each(|corners| grid.each_in_triangle(*corners, |i| seen[i] = true));
        let covered = |column: &usize| (0..grid.rows).filter(|row| seen[row * grid.columns + column]).count() as f64;
        (0..grid.columns).filter(|column| covered(column) >= STANDS * grid.rows as f64).collect()
    };
    let of_wall = columns(&walls, &mut seen);
    let mut found: Vec<[f64; 2]> = Vec::new();
    for column in columns(&panes, &mut seen) {
        let from = low + step * column as f64;
        match found.last_mut() {
            Some(last) if from - last[1] <= DOORWAY_M => last[1] = from + step,
            _ => found.push([from, from + step]),
        }
    }
    // An open door alone, or with the reveals of others, makes no wall.
    let wall_m = |run: &[f64; 2]| {
        let is_in = |column: &&usize| (run[0]..run[1]).contains(&(low + step * (**column as f64 + 0.5)));
        step * of_wall.iter().filter(is_in).count() as f64
    };
    found.retain(|run| wall_m(run) >= LEAST_STANDING_M.min(0.5 * (run[1] - run[0])));
    found
}
