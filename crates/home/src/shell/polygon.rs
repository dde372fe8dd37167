//! The shell of a room whose outline is no rectangle, or whose walls have several neighbours.
//!
//! Walls are slabs over each piece with one thing behind it, which reach into each other at the corners. Floors and ceilings are prisms over
//! the outline, a little wider, so that they end within the walls.

use super::boards::planks;
use super::ceiling;
use super::clip::kept_where;
use super::finish::ShellFinish;
use super::measures::{AIR, OVERLAP, SKIRTING, THICKNESS, THIN_OVERLAP, UNDER_WALLS, depth, holes};
use super::slopes;
use crate::room::outline::triangles;
use crate::room::{Room, Wall};
use enfilade_furniture::shape::{Reshape, slab_below, slab_with_openings};
use enfilade_furniture::{Builder, Class, Finish, pose};
use enfilade_geometry::Mesh;
use enfilade_math::{Rng, Vec2, Vec3};
use std::f32::consts::PI;

/// Distance between the ends of slabs and a corner that points into the room, metres, so that no end lies in the plane of a face.
const BACK_OFF: f32 = 0.0005;
/// Longest overlap of slabs at an acute corner, metres.
const LONGEST: f32 = 0.6;
/// Floors and ceilings end at this share of the depth of the thinnest wall.
const WITHIN: f32 = 0.8;

/// The slabs of a wall, in its own space.
pub fn slab(room: &Room, wall: Wall) -> Mesh {
    let face = room.face(wall);
    let half = 0.5 * face.length;
    let last = face.backs.len() - 1;
    let mut mesh = Mesh::default();
    for (i, back) in face.backs.iter().enumerate() {
        let depth = depth(back);
        let low = if i == 0 { -half - overlap(room, wall, 0) } else { back.x[0] };
        let high = if i == last { half + overlap(room, wall, 1) } else { back.x[1] };
        let middle = 0.5 * (low + high);
        let within = |hole: &[f32; 4]| hole[1] + middle > low && hole[0] + middle < high;
        let holes: Vec<[f32; 4]> = holes(room, wall, middle).into_iter().filter(within).collect();
        let height = [-OVERLAP, room.size.z + OVERLAP];
        let piece = if room.slopes.is_empty() {
            slab_with_openings(high - low, height, depth, &holes)
        } else {
            slab_below(high - low, height, depth, &holes, &slopes::top(room, wall, depth, middle))
        };
        append(&mut mesh, piece.moved(Vec3::new(middle, 0.0, 0.0)));
    }
    mesh
}

/// Length by which a wall's slab reaches beyond its end: so far that outer walls meet on the outside; negative where the corner points into
/// the room.
fn overlap(room: &Room, wall: Wall, end: usize) -> f32 {
    let angle = room.angles(wall)[end];
    if angle > PI - 1e-3 {
        return -BACK_OFF;
    }
    let other = room.beside(wall)[end];
    let (own, others) = (&room.face(wall).backs, &room.face(other).backs);
    let (own, other) = if end == 0 { (&own[0], &others[others.len() - 1]) } else { (&own[own.len() - 1], &others[0]) };
    let mitre = (depth(other) + depth(own) * angle.cos()) / angle.sin();
    // The second of two slabs that end in one plane is a little shorter.
    if own.outer && other.outer { mitre.clamp(THIN_OVERLAP, LONGEST) - AIR * (1 + end) as f32 } else { mitre.clamp(0.005, THIN_OVERLAP) }
}

/// Lengths by which the skirting of a wall reaches beyond its ends: around corners that point into the room. In right-angled corners the
/// board of the wall before the corner ends at the other board.
pub fn beyond(room: &Room, wall: Wall) -> [f32; 2] {
    let angles = room.angles(wall);
    [0, 1].map(|end| match angles[end] {
        angle if angle > PI => SKIRTING.x * (0.5 * (angle - PI)).tan() - BACK_OFF * end as f32,
        _ if end == 1 && room.is_square(wall, 1) => -SKIRTING.x - BACK_OFF,
        _ => 0.0,
    })
}

/// Adds floor and ceiling.
pub fn floor_and_ceiling(b: &mut Builder, room: &Room, finish: &ShellFinish, rng: &mut Rng) {
    let at = pose(f64::from(room.box_center.x), f64::from(room.box_center.y), 0.0, f64::from(room.grain));
    let thinnest = room.faces.iter().flat_map(|face| &face.backs).map(depth).fold(f32::INFINITY, f32::min);
    let grown = |by: f32| -> Vec<Vec2> {
        let turn = Vec2::from_angle(-room.grain);
        room.outline.grown(by.min(WITHIN * thinnest)).into_iter().map(|p| turn.rotate(p - room.box_center)).collect()
    };
    let wide = grown(OVERLAP);
    let object = b.object(&format!("ceiling_{}", room.kind.name()), Class::Ceiling, at);
    if room.slopes.is_empty() {
        ceiling::add(b, room, &object, prism(&wide, [room.size.z, room.size.z + THICKNESS]), finish.ceiling);
    } else {
        slopes::ceiling(b, room, &object, at, &wide);
    }
    let floor = b.object(&format!("floor_{}", room.kind.name()), Class::Floor, at);
    let under = grown(UNDER_WALLS);
    if finish.floor == Finish::PlankFloor {
        let fold = |of: fn(Vec2, Vec2) -> Vec2| under.iter().copied().reduce(of).unwrap_or(Vec2::ZERO);
        let boards = planks([fold(Vec2::min), fold(Vec2::max)], rng);
        b.part(&floor, "planks", cut(&boards, &under).smoothed(20.0), finish.floor);
    } else {
        b.part(&floor, "covering", prism(&under, [-0.0195, 0.0]), finish.floor);
    }
    b.part(&floor, "screed", prism(&wide, [-0.3, -0.02]), Finish::CeilingPaint);
}

/// A prism over a counter-clockwise polygon.
fn prism(corners: &[Vec2], [low, high]: [f32; 2]) -> Mesh {
    let mut mesh = Mesh::default();
    for (z, up) in [(high, true), (low, false)] {
        let base = mesh.positions.len() as u32;
        mesh.positions.extend(corners.iter().map(|p| p.extend(z)));
        mesh.uvs.extend(corners);
        let facing = |[a, b, c]: [usize; 3]| if up { [a, b, c] } else { [a, c, b] };
        mesh.triangles.extend(triangles(corners).into_iter().map(|t| facing(t).map(|i| base + i as u32)));
    }
    let mut way = 0.0;
    for (i, &from) in corners.iter().enumerate() {
        let to = corners[(i + 1) % corners.len()];
        let base = mesh.positions.len() as u32;
        let next = way + from.distance(to);
        mesh.positions.extend([from.extend(low), to.extend(low), to.extend(high), from.extend(high)]);
        mesh.uvs.extend([Vec2::new(way, low), Vec2::new(next, low), Vec2::new(next, high), Vec2::new(way, high)]);
        mesh.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
        way = next;
    }
    mesh.smoothed(20.0)
}

/// What of a mesh is above a polygon.
fn cut(mesh: &Mesh, corners: &[Vec2]) -> Mesh {
    let covering: Vec<[Vec2; 3]> = triangles(corners).into_iter().map(|t| t.map(|i| corners[i])).collect();
    let mut kept = Mesh::default();
    for triangle in &mesh.triangles {
        let whole: Vec<(Vec3, Vec2)> = triangle.map(|i| (mesh.positions[i as usize], mesh.uvs[i as usize])).to_vec();
        for window in &covering {
            let piece = (0..3).fold(whole.clone(), |piece, k| clipped(&piece, window[k], window[(k + 1) % 3]));
            let base = kept.positions.len() as u32;
            for k in 1..piece.len().max(2) - 1 {
                let [a, b, c] = [0, k, k + 1].map(|i| piece[i].0);
                if (b - a).cross(c - a).length() > 1e-7 {
                    kept.triangles.push([base, base + k as u32, base + k as u32 + 1]);
                }
            }
            kept.positions.extend(piece.iter().map(|(p, _)| *p));
            kept.uvs.extend(piece.iter().map(|(_, uv)| *uv));
        }
    }
    kept
}

/// What of a convex polygon is to the left of a line, seen from above.
fn clipped(polygon: &[(Vec3, Vec2)], from: Vec2, to: Vec2) -> Vec<(Vec3, Vec2)> {
    let side = |p: &(Vec3, Vec2)| (to - from).perp_dot(p.0.truncate() - from);
    kept_where(polygon, side, |p, q, t| (p.0.lerp(q.0, t), p.1.lerp(q.1, t)))
}

fn append(mesh: &mut Mesh, other: Mesh) {
    let base = mesh.positions.len() as u32;
    mesh.positions.extend(other.positions);
    mesh.normals.extend(other.normals);
    mesh.uvs.extend(other.uvs);
    mesh.triangles.extend(other.triangles.iter().map(|t| t.map(|i| base + i)));
}
