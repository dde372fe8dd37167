//! The storeys of a building: heights at which there is much floor, each with the surfaces above it and below the next.

use super::outline::{area, edges};
use super::surfaces::{DOOR, LabelledTriangle, WINDOW};
use enfilade_math::{DVec2, quantile};
use enfilade_scene::{CEILING, FLOOR, WALL};
use std::ops::Range;

/// Cosine of the normal's angle to the vertical above which a surface counts as level.
const LEVEL: f64 = 0.95;
/// Cosine of that angle below which a surface counts as upright.
const UPRIGHT: f64 = 0.17;
/// Floors closer together than this belong to one storey, metres.
const STOREY_M: f64 = 1.8;
/// Steps of the search for floors, metres.
const STEP_M: f64 = 0.05;
/// Least area of floor of a storey, square metres, and as a share of the largest storey's.
const LEAST_FLOOR_M2: f64 = 1.0;
const LEAST_SHARE: f64 = 0.1;
/// Height of a room without labelled ceiling whose walls have no upper end, metres.
const USUAL_HEIGHT_M: f64 = 2.5;

/// A storey with its surfaces.
pub struct Storey<'a> {
    /// Height of most of the floor.
    pub floor_z_m: f64,
    /// Upright surfaces of walls.
    pub walls: Vec<&'a LabelledTriangle>,
    /// Upright surfaces of doors and windows.
    pub panes: Vec<&'a LabelledTriangle>,
    /// Surfaces of floors that are not upright.
    pub floors: Vec<&'a LabelledTriangle>,
    /// Triangles of ceilings, likewise.
    pub ceilings: Vec<&'a LabelledTriangle>,
}

/// The storeys, from below.
pub fn find(triangles: &[LabelledTriangle]) -> Vec<Storey<'_>> {
    let heights = floor_heights(triangles);
    let storey = |(i, &floor_z_m): (usize, &f64)| {
        let top = heights.get(i + 1).map_or(f64::INFINITY, |next| next - 0.5 * STEP_M);
        let own = triangles.iter().filter(|t| (floor_z_m - STOREY_M / 2.0..top).contains(&t.center().z));
        let mut found = Storey { floor_z_m, walls: vec![], panes: vec![], floors: vec![], ceilings: vec![] };
        for triangle in own {
            let slope = triangle.normal_and_area().0.z.abs();
            let (is_upright, is_level) = (slope < UPRIGHT, slope >= LEVEL);
            match triangle.label.semantic {
                WALL if is_upright => found.walls.push(triangle),
                DOOR | WINDOW if is_upright => found.panes.push(triangle),
                FLOOR if !is_upright => found.floors.push(triangle),
                CEILING if !is_upright => found.ceilings.push(triangle),
                // Often a room's whole shell is labelled as wall, including its ceiling.
                WALL if is_level && triangle.center().z > floor_z_m + STOREY_M => found.ceilings.push(triangle),
                _ => {}
            }
        }
        found
    };
    heights.iter().enumerate().map(storey).collect()
}

/// Heights with most floor around them, ascending, a storey apart.
fn floor_heights(triangles: &[LabelledTriangle]) -> Vec<f64> {
    let is_level = |t: &&LabelledTriangle| t.normal_and_area().0.z.abs() >= LEVEL;
    // Ground around a house is as good a floor, and larger.
    let of_house = [CEILING, WALL].map(|class| bounds(triangles, class)).into_iter().flatten();
    let Some((low, high)) = of_house.reduce(|a, b| (a.0.max(b.0), a.1.min(b.1))) else { return vec![] };
    let floors = triangles.iter().filter(|t| t.label.semantic == FLOOR).filter(is_level);
    let mut floors: Vec<(f64, f64)> = floors.map(|t| (t.center().z, area_within(t, low, high))).collect();
    floors.retain(|(z, area)| z.is_finite() && area.is_finite());
    floors.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut found: Vec<(f64, f64)> = Vec::new();
    loop {
        let open: Vec<(f64, f64)> =
            floors.iter().copied().filter(|(z, _)| found.iter().all(|(taken, _)| (z - taken).abs() >= STOREY_M)).collect();
        let Some((area, range)) = richest(&open, STEP_M) else { break };
        if area < LEAST_FLOOR_M2 || found.first().is_some_and(|(_, most)| area < LEAST_SHARE * most) {
            break;
        }
        found.push((weighted_median(&open[range]), area));
    }
    let mut heights: Vec<f64> = found.into_iter().map(|(z, _)| z).collect();
    heights.sort_by(f64::total_cmp);
    heights
}

/// Lower and upper bounds of all surfaces of a class, seen from above.
fn bounds(triangles: &[LabelledTriangle], class: i16) -> Option<(DVec2, DVec2)> {
    bounds_of(triangles.iter().filter(|t| t.label.semantic == class).flat_map(|t| t.corners).map(|p| p.truncate()))
}

fn bounds_of(points: impl Iterator<Item = DVec2>) -> Option<(DVec2, DVec2)> {
    points.filter(|p| p.is_finite()).map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// The area of a triangle within bounds, seen from above.
fn area_within(triangle: &LabelledTriangle, low: DVec2, high: DVec2) -> f64 {
    let mut polygon: Vec<DVec2> = triangle.corners.map(|p| p.truncate()).into();
    for (normal, offset) in [(DVec2::X, low.x), (DVec2::NEG_X, -high.x), (DVec2::Y, low.y), (DVec2::NEG_Y, -high.y)] {
        let side = |p: DVec2| normal.dot(p) - offset;
        let clipped = edges(&polygon).flat_map(|[a, b]| {
            let (da, db) = (side(a), side(b));
            let cut = (da * db < 0.0).then(|| a + (b - a) * (da / (da - db)));
            [(da >= 0.0).then_some(a), cut].into_iter().flatten()
        });
        polygon = clipped.collect();
    }
    area(&polygon).abs()
}

/// The run of sorted (value, weight) pairs within one step that has the largest total weight, with that weight.
pub fn richest(sorted: &[(f64, f64)], step: f64) -> Option<(f64, Range<usize>)> {
    let (mut first, mut weight, mut best) = (0, 0.0, None);
    for (i, &(value, own)) in sorted.iter().enumerate() {
        weight += own;
        while value - sorted[first].0 > step {
            weight -= sorted[first].1;
            first += 1;
        }
        if best.as_ref().is_none_or(|(most, _)| weight > *most) {
            best = Some((weight, first..i + 1));
        }
    }
    best
}

/// The value at which half of the weight of sorted (value, weight) is reached.
pub fn weighted_median(sorted: &[(f64, f64)]) -> f64 {
    let half = 0.5 * sorted.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut reached = 0.0;
    let at = sorted.iter().position(|(_, weight)| {
        reached += weight;
        reached >= half
    });
    sorted[at.unwrap_or(0)].0
}

impl Storey<'_> {
    /// The height of the ceiling above an outline, the lower of two: a shell has another side. Where none is labelled, the height of the
    /// walls' upper end.
    pub fn ceiling_z_m(&self, outline: &[DVec2]) -> f64 {
        let Some((low, high)) = bounds_of(outline.iter().copied()) else { return self.floor_z_m + USUAL_HEIGHT_M };
        let above = self.ceilings.iter().filter(|t| t.center().z > self.floor_z_m + STOREY_M);
        let mut level: Vec<(f64, f64)> = above.map(|t| (t.center().z, area_within(t, low, high))).filter(|(_, area)| *area > 0.0).collect();
        level.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((most, richest)) = richest(&level, STEP_M) {
            let from = |i: usize| i..level.partition_point(|(z, _)| *z <= level[i].0 + STEP_M);
            let weighs = |run: &Range<usize>| level[run.clone()].iter().map(|(_, area)| area).sum::<f64>() >= 0.5 * most;
            let lowest = (0..richest.start).map(from).find(weighs).unwrap_or(richest);
            return weighted_median(&level[lowest]);
        }
        let is_near = |t: &&&LabelledTriangle| {
            let own = bounds_of(t.corners.iter().map(|p| p.truncate()));
            own.is_some_and(|own| own.0.cmple(high).all() && low.cmple(own.1).all())
        };
        let tops = self.walls.iter().filter(is_near).map(|t| t.corners.iter().fold(f64::MIN, |z, p| z.max(p.z)));
        let top = quantile(&mut tops.collect::<Vec<_>>(), 0.95);
        top.filter(|z| *z > self.floor_z_m + STOREY_M).unwrap_or(self.floor_z_m + USUAL_HEIGHT_M)
    }
}
