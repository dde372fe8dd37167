//! Loops of line segments, and boxes of openings: what the readers of plans share.

use enfilade_math::DVec2;
use enfilade_scene::{DrawnOpening, OpeningKind};
use std::collections::BTreeMap;

/// Directions in which the width of an opening is sought.
const DIRECTIONS: usize = 180;

/// The closed loops of undirected segments, and the number of segments that belong to none. From each end the segment is followed whose
/// own beginning is there, so that loops which touch each other stay apart as the file has them.
pub(super) fn loops(segments: &[[DVec2; 2]], same: f64) -> (Vec<Vec<DVec2>>, usize) {
    let mut left: Vec<Option<[DVec2; 2]>> = segments.iter().copied().map(Some).collect();
    let (mut found, mut lost) = (Vec::new(), 0);
    for first in 0..left.len() {
        let Some([start, mut end]) = left[first].take() else { continue };
        let mut corners = vec![start];
        while end.distance(start) > same {
            let begins = |s: &Option<[DVec2; 2]>| s.is_some_and(|[a, _]| a.distance(end) <= same);
            let ends = |s: &Option<[DVec2; 2]>| s.is_some_and(|[_, b]| b.distance(end) <= same);
            let forward = left.iter().position(begins);
            let next = forward.or_else(|| left.iter().position(ends));
            let Some([a, b]) = next.and_then(|next| left[next].take()) else { break };
            corners.push(if forward.is_some() { a } else { b });
            end = if forward.is_some() { b } else { a };
        }
        if end.distance(start) <= same && corners.len() > 2 {
            found.push(corners);
        } else {
            lost += corners.len();
        }
    }
    (found, lost)
}

/// The outlines of triangles in the plane: edges that only one triangle has, as loops, the largest first.
pub(super) fn outlines(triangles: &[[DVec2; 3]]) -> Vec<Vec<DVec2>> {
    let key = |p: DVec2| [(p.x * 1000.0).round() as i64, (p.y * 1000.0).round() as i64];
    let mut edges: BTreeMap<[[i64; 2]; 2], (usize, [DVec2; 2])> = BTreeMap::new();
    for [a, b, c] in triangles.iter().filter(|[a, b, c]| (*b - *a).perp_dot(*c - *a).abs() > 1e-9) {
        let turned = (*b - *a).perp_dot(*c - *a) < 0.0;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let edge = if turned { [*to, *from] } else { [*from, *to] };
            let ends = [key(edge[0]), key(edge[1])];
            let known = edges.entry([ends[0].min(ends[1]), ends[0].max(ends[1])]).or_insert((0, edge));
            known.0 += 1;
        }
    }
    let single: Vec<[DVec2; 2]> =
        edges.into_values().filter(|(count, [a, b])| count % 2 == 1 && a.distance(*b) > 1e-4).map(|(_, edge)| edge).collect();
    let (mut found, _) = loops(&single, 0.002);
    found.sort_by(|a, b| area(b).abs().total_cmp(&area(a).abs()));
    found
}

/// Area of a polygon, positive where its corners run counter-clockwise.
pub(super) fn area(corners: &[DVec2]) -> f64 {
    0.5 * (0..corners.len()).map(|i| corners[i].perp_dot(corners[(i + 1) % corners.len()])).sum::<f64>()
}

/// Whether a point is in a polygon.
pub(super) fn contains(corners: &[DVec2], p: DVec2) -> bool {
    let edge = |i: usize| (corners[i], corners[(i + 1) % corners.len()]);
    let crosses = |&i: &usize| {
        let (a, b) = edge(i);
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    };
    (0..corners.len()).filter(crosses).count() % 2 == 1
}

/// An opening around points: as wide as they reach along the direction across which they are thinnest; `None` where they are no points.
pub(super) fn around(kind: OpeningKind, points: &[DVec2], z_m: Option<[f64; 2]>) -> Option<DrawnOpening> {
    let span = |way: DVec2| {
        let along = || points.iter().map(|p| p.dot(way));
        (along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max))
    };
    let direction = |k: usize| DVec2::from_angle(std::f64::consts::PI * k as f64 / DIRECTIONS as f64);
    let thickness = |way: &DVec2| {
        let (low, high) = span(way.perp());
        high - low
    };
    let along = (0..DIRECTIONS).map(direction).min_by(|a, b| thickness(a).total_cmp(&thickness(b)))?;
    let ((x0, x1), (y0, y1)) = (span(along), span(along.perp()));
    let at = along * (0.5 * (x0 + x1)) + along.perp() * (0.5 * (y0 + y1));
    (at.is_finite() && x1 > x0).then(|| DrawnOpening { width_m: Some(x1 - x0), z_m, ..DrawnOpening::new(kind, at) })
}
