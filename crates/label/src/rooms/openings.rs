//! Doors and windows as rectangles of the wall faces that contain them.

use super::surfaces::{DOOR, LabelledTriangle, WINDOW};
use enfilade_math::{DVec2, DVec3, quantile};
use enfilade_scene::{OpeningKind, WallFace, WallOpening};

/// Largest distance between faces of different rooms that belong to one wall, metres.
pub const WALL_THICKNESS_M: f64 = 0.8;
/// Doors and windows are within these distances of the plane of their face, metres: frames protrude from it, panes are deep in the wall.
const BEFORE_M: f64 = 0.12;
const BEHIND_M: f64 = 0.45;
/// Cosine of the angle between a pane and its face above which they count as parallel.
const PARALLEL: f64 = 0.95;
/// Surfaces that are farther apart along the wall belong to two openings, metres.
const GAP_M: f64 = 0.12;
/// Least width and height of an opening, metres: smaller ones are handles, letter slots and edges of frames.
const LEAST_M: f64 = 0.35;
/// Surfaces fill at least this share of their rectangle: frames alone do, scattered pieces do not.
const LEAST_FILLED: f64 = 0.15;

/// A rectangle of a face: its ranges along the face and in height, metres.
struct Found {
    wall: usize,
    kind: OpeningKind,
    along_m: [f64; 2],
    z_m: [f64; 2],
    /// Mean distance of its surfaces from the face.
    off_m: f64,
}

/// The openings of all faces. One that two faces have between them is listed once, on the face that is nearer to it.
pub fn find(walls: &[WallFace], triangles: &[LabelledTriangle]) -> Vec<WallOpening> {
    let mut found: Vec<Found> = Vec::new();
    for (kind, class) in [(OpeningKind::Door, DOOR), (OpeningKind::Window, WINDOW)] {
        let own: Vec<&LabelledTriangle> = triangles.iter().filter(|t| t.label.semantic == class).collect();
        for (wall, face) in walls.iter().enumerate() {
            found.extend(in_face(wall, face, kind, &own));
        }
    }
    found.sort_by(|a, b| a.off_m.total_cmp(&b.off_m));
    let mut kept: Vec<(Found, Vec<usize>)> = Vec::new();
    for opening in found {
        let twin = kept.iter_mut().find(|(other, _)| is_same(walls, other, &opening));
        match twin {
            None => {
                let wall = opening.wall;
                kept.push((opening, vec![wall]));
            }
            // The other side of the same hole; anything else there is the same thing seen from a more distant face.
            Some((first, through)) => {
                let [a, b] = [&walls[first.wall], &walls[opening.wall]].map(|wall| DVec2::from(wall.inward));
                if through.len() == 1 && a.dot(b) < 0.0 {
                    through.push(opening.wall);
                }
            }
        }
    }
    kept.sort_by(|(a, _), (b, _)| (a.wall, a.along_m[0]).partial_cmp(&(b.wall, b.along_m[0])).expect("lengths are finite"));
    let opening = |(found, through): (Found, Vec<usize>)| {
        let Found { wall, kind, along_m: [from, to], z_m: [low, high], .. } = found;
        // For someone in the room the face runs from right to left.
        let corners = [(to, low), (from, low), (from, high), (to, high)].map(|(along, z)| walls[wall].point(along, z).to_array());
        WallOpening { kind, walls: through, corners, leaf: None }
    };
    kept.into_iter().map(opening).collect()
}

fn in_face(wall: usize, face: &WallFace, kind: OpeningKind, panes: &[&LabelledTriangle]) -> Vec<Found> {
    let inward = DVec3::new(face.inward[0], face.inward[1], 0.0);
    let is_near = |t: &&&LabelledTriangle| {
        let middle = t.center();
        t.normal_and_area().0.dot(inward).abs() >= PARALLEL
            && (-BEHIND_M..=BEFORE_M).contains(&face.distance_m(middle))
            && (0.0..=face.length_m()).contains(&face.along_m(middle))
            && (face.floor_z_m..face.ceiling_z_m).contains(&middle.z)
    };
    let mut near: Vec<([f64; 2], &LabelledTriangle)> = panes
        .iter()
        .filter(is_near)
        .map(|t| {
            let along = t.corners.map(|p| face.along_m(p));
            ([along.into_iter().fold(f64::INFINITY, f64::min), along.into_iter().fold(f64::NEG_INFINITY, f64::max)], *t)
        })
        .collect();
    near.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
    let mut runs: Vec<([f64; 2], Vec<&LabelledTriangle>)> = Vec::new();
    for (along, triangle) in near {
        match runs.last_mut() {
            Some((run, members)) if along[0] - run[1] <= GAP_M => {
                run[1] = run[1].max(along[1]);
                members.push(triangle);
            }
            _ => runs.push((along, vec![triangle])),
        }
    }
    runs.into_iter().filter_map(|(run, members)| rectangle(wall, face, kind, run, &members)).collect()
}

fn rectangle(wall: usize, face: &WallFace, kind: OpeningKind, run: [f64; 2], members: &[&LabelledTriangle]) -> Option<Found> {
    let along_m = [run[0].max(0.0), run[1].min(face.length_m())];
    let mut heights: Vec<f64> = members.iter().flat_map(|t| t.corners).map(|p| p.z).collect();
    let [low, high] = [0.0, 1.0].map(|q| quantile(&mut heights, q));
    let z_m = [low?.max(face.floor_z_m), high?.min(face.ceiling_z_m)];
    let (width, height) = (along_m[1] - along_m[0], z_m[1] - z_m[0]);
    let area: f64 = members.iter().map(|t| t.normal_and_area().1).sum();
    if width.min(height) < LEAST_M || area < LEAST_FILLED * width * height {
        return None;
    }
    let off_m = members.iter().map(|t| face.distance_m(t.center()).abs() * t.normal_and_area().1).sum::<f64>() / area;
    Some(Found { wall, kind, along_m, z_m, off_m })
}

/// Whether two rectangles are the same thing, seen from two faces.
fn is_same(walls: &[WallFace], a: &Found, b: &Found) -> bool {
    let middle = |found: &Found| walls[found.wall].point(0.5 * (found.along_m[0] + found.along_m[1]), 0.5 * (found.z_m[0] + found.z_m[1]));
    a.wall != b.wall && middle(a).distance(middle(b)) <= WALL_THICKNESS_M
}
