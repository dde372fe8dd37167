//! How well fitted rooms agree with the surfaces that they were fitted to.

use super::surfaces::LabelledTriangle;
use enfilade_math::{DVec3, quantile};
use enfilade_scene::{CEILING, FLOOR, PLANE_NEAR_M, Rooms, RoomsFit, WALL};

/// Surfaces are sampled in steps of this length, metres, and each triangle in at most `STEPS` steps along an edge.
const STEP_M: f64 = 0.1;
const STEPS: f64 = 500.0;
/// Surfaces farther outside of all rooms than this are outer sides of walls, or of what is no room, metres.
const AROUND_M: f64 = 0.05;

/// Distances of points on walls, floors and ceilings, evenly by area and in rooms or close around them, to the planes of their kind.
pub fn of(rooms: &Rooms, triangles: &[LabelledTriangle]) -> RoomsFit {
    let mut distances: Vec<f64> = Vec::new();
    for triangle in triangles.iter().filter(|t| matches!(t.label.semantic, WALL | FLOOR | CEILING)) {
        let near = points(triangle).filter(|&p| rooms.room_near(p, AROUND_M).is_some() || is_at_level(rooms, p));
        distances.extend(near.filter_map(|p| rooms.off_m(triangle.label.semantic, p)));
    }
    let near = distances.iter().filter(|m| **m <= PLANE_NEAR_M).count() as f64 / distances.len().max(1) as f64;
    let at = |q: f64, distances: &mut [f64]| (1e4 * quantile(distances, q).unwrap_or_default()).round() / 1e4;
    RoomsFit { near_share: (1e4 * near).round() / 1e4, median_m: at(0.5, &mut distances), p95_m: at(0.95, &mut distances) }
}

/// Whether a point lies just below the floor or above the ceiling of a room.
fn is_at_level(rooms: &Rooms, p: DVec3) -> bool {
    [-AROUND_M, AROUND_M].iter().any(|dz| rooms.room_at(p + DVec3::Z * *dz).is_some())
}

/// Points of a triangle, about one for each square of `STEP_M`, none on its edges.
fn points(triangle: &LabelledTriangle) -> impl Iterator<Item = DVec3> + '_ {
    let [a, b, c] = triangle.corners;
    // The number of rows that gives about one point per square.
    let steps = (2.0 * triangle.normal_and_area().1).sqrt() / STEP_M;
    let steps = steps.round().clamp(1.0, STEPS);
    (0..steps as usize).flat_map(move |i| {
        (0..steps as usize - i).map(move |j| {
            let [u, v] = [i, j].map(|k| (k as f64 + 1.0 / 3.0) / steps);
            a + (b - a) * u + (c - a) * v
        })
    })
}
