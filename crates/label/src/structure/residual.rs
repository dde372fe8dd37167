//! How well fitted rooms agree with the surfaces that they were fitted to.

use super::surfaces::LabelledTriangle;
use enfilade_math::{DVec3, quantile};
use enfilade_scene::{CEILING, FLOOR, LAYOUT_NEAR_M, Structure, StructureFit, WALL};

/// Surfaces are measured in steps of this length, metres, and each triangle in so many along an edge at most.
const STEP_M: f64 = 0.1;
const STEPS: f64 = 500.0;
/// Surfaces outside of all rooms by more than this are those of other sides, and of what is no room, metres.
const AROUND_M: f64 = 0.05;

/// Distances of points of walls, floors and ceilings, evenly by area and in rooms or close around them, to the planes of their kind.
pub fn of(structure: &Structure, triangles: &[LabelledTriangle]) -> StructureFit {
    let mut distances: Vec<f64> = Vec::new();
    for triangle in triangles.iter().filter(|t| matches!(t.label.semantic, WALL | FLOOR | CEILING)) {
        let near = points(triangle).filter(|&p| structure.room_near(p, AROUND_M).is_some() || is_at_level(structure, p));
        distances.extend(near.filter_map(|p| structure.off_m(triangle.label.semantic, p)));
    }
    let near = distances.iter().filter(|m| **m <= LAYOUT_NEAR_M).count() as f64 / distances.len().max(1) as f64;
    let at = |q: f64, distances: &mut [f64]| (1e4 * quantile(distances, q).unwrap_or_default()).round() / 1e4;
    StructureFit { near_share: (1e4 * near).round() / 1e4, median_m: at(0.5, &mut distances), p95_m: at(0.95, &mut distances) }
}

/// Whether a point lies just below the floor or above the ceiling of a room.
fn is_at_level(structure: &Structure, p: DVec3) -> bool {
    [-AROUND_M, AROUND_M].iter().any(|dz| structure.room_at(p + DVec3::Z * *dz).is_some())
}

/// Points of a triangle, about one for each square of `STEP_M`, none on its edges.
fn points(triangle: &LabelledTriangle) -> impl Iterator<Item = DVec3> + '_ {
    let [a, b, c] = triangle.corners;
    // As many rows as make the number of points that the area asks for.
    let steps = (2.0 * triangle.normal_and_area().1).sqrt() / STEP_M;
    let steps = steps.round().clamp(1.0, STEPS);
    (0..steps as usize).flat_map(move |i| {
        (0..steps as usize - i).map(move |j| {
            let [u, v] = [i, j].map(|k| (k as f64 + 1.0 / 3.0) / steps);
            a + (b - a) * u + (c - a) * v
        })
    })
}
