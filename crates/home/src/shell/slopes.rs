//! The shell under a roof: walls that end below the slopes, and ceilings of level and sloping panels.
//!
//! Each panel reaches a little beyond its neighbour, above that one's lower side, so that no light comes through the joint.

use super::clip::kept_where;
use super::measures::{OVERLAP, THICKNESS};
use crate::room::outline::triangles;
use crate::room::{Incline, Room, Wall};
use enfilade_furniture::shape::{Reshape, Top};
use enfilade_furniture::{Builder, Finish, Object};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Vec2, Vec3};
use std::collections::BTreeMap;

/// Corners nearer to each other than this are one, metres.
const SAME: f32 = 1e-4;

/// The upper end of a piece of wall that is `depth` deep and has its middle at `middle` of the wall's x axis: within the ceiling.
pub(super) fn top(room: &Room, wall: Wall, depth: f32, middle: f32) -> Top<impl Fn(Vec2) -> f32> {
    let bends = [0.0, -depth].into_iter().flat_map(|out| room.bends(wall, out)).map(|x| x - middle).collect();
    Top { height: move |p: Vec2| room.ceiling_at(room.before(wall, p.x + middle, p.y)) + OVERLAP, bends }
}

/// Adds the panels of a ceiling whose outline, in its own space at `pose`, is `wide`.
pub(super) fn ceiling(b: &mut Builder, room: &Room, object: &Object, pose: DAffine3, wide: &[Vec2]) {
    let home = |p: &Vec2| pose.transform_point3(p.extend(0.0).as_dvec3()).as_vec3().truncate();
    let corners: Vec<Vec2> = wide.iter().map(home).collect();
    let cover: Vec<Vec<Vec2>> = triangles(&corners).into_iter().map(|t| t.map(|i| corners[i]).to_vec()).collect();
    let above_slopes = |slope: &Incline, p: &Vec2| slope.z(*p) - room.size.z + OVERLAP * slope.rise();
    let level = room.slopes.iter().fold(cover.clone(), |kept, slope| cut(&kept, |p| above_slopes(slope, p)));
    if !level.is_empty() {
        let own = pose.inverse();
        let flat = |p: &Vec2| own.transform_point3(p.extend(0.0).as_dvec3()).as_vec3().truncate();
        let mesh = panel(&mapped(&level, flat), [room.size.z, room.size.z + THICKNESS]);
        b.part(object, "plaster", mesh, Finish::CeilingPaint);
    }
    for (number, slope) in room.slopes.iter().enumerate() {
        let below_level = cut(&cover, |p| room.size.z - slope.z(*p) + OVERLAP * slope.rise());
        let others = room.slopes.iter().enumerate().filter(|(other, _)| *other != number);
        let own = others.fold(below_level, |kept, (_, other)| {
            let steepness = slope.rise() + other.rise();
            cut(&kept, |p| other.z(*p) - slope.z(*p) + OVERLAP * steepness)
        });
        let place = slope.pose();
        let plane = place.inverse();
        let within = |p: &Vec2| plane.transform_point3(p.extend(slope.z(*p)).as_dvec3()).as_vec3().truncate();
        if !own.is_empty() {
            let mesh = panel(&mapped(&own, within), [0.0, THICKNESS]);
            b.part_at(object, &format!("slope_{}", number + 1), mesh, pose.inverse() * place, Finish::CeilingPaint);
        }
    }
}

fn mapped(pieces: &[Vec<Vec2>], map: impl Fn(&Vec2) -> Vec2) -> Vec<Vec<Vec2>> {
    pieces.iter().map(|piece| piece.iter().map(&map).collect()).collect()
}

/// What of convex pieces is where a linear function is not negative.
fn cut(pieces: &[Vec<Vec2>], side: impl Fn(&Vec2) -> f32) -> Vec<Vec<Vec2>> {
    let kept = pieces.iter().map(|piece| kept_where(piece, &side, |p, q, t| p.lerp(*q, t)));
    kept.map(without_doubles).filter(|piece| piece.len() > 2).collect()
}

fn without_doubles(mut piece: Vec<Vec2>) -> Vec<Vec2> {
    piece.dedup_by(|a, b| a.distance(*b) < SAME);
    while piece.len() > 1 && piece[0].distance(piece[piece.len() - 1]) < SAME {
        piece.pop();
    }
    piece
}

/// A panel over convex counter-clockwise pieces that lie edge to edge.
fn panel(pieces: &[Vec<Vec2>], [low, high]: [f32; 2]) -> Mesh {
    let mut mesh = Mesh::default();
    for (z, up) in [(high, true), (low, false)] {
        for piece in pieces {
            let base = mesh.positions.len() as u32;
            mesh.positions.extend(piece.iter().map(|p| p.extend(z)));
            mesh.uvs.extend(piece);
            let fan = (1..piece.len() as u32 - 1).map(|k| if up { [0, k, k + 1] } else { [0, k + 1, k] });
            mesh.triangles.extend(fan.map(|t| t.map(|i| base + i)));
        }
    }
    for [from, to] in border(pieces) {
        let base = mesh.positions.len() as u32;
        let length = from.distance(to);
        mesh.positions.extend([from.extend(low), to.extend(low), to.extend(high), from.extend(high)]);
        mesh.uvs.extend([[0.0, low], [length, low], [length, high], [0.0, high]].map(Vec2::from));
        mesh.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
    }
    let area = |t: &[u32; 3]| {
        let [a, b, c]: [Vec3; 3] = t.map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).length()
    };
    let kept: Vec<[u32; 3]> = mesh.triangles.iter().copied().filter(|t| area(t) > SAME * SAME).collect();
    mesh.triangles = kept;
    mesh.smoothed(20.0)
}

/// Edges that only one piece has, in its direction.
fn border(pieces: &[Vec<Vec2>]) -> Vec<[Vec2; 2]> {
    let key = |p: Vec2| [(p.x / SAME).round() as i64, (p.y / SAME).round() as i64];
    let mut edges: BTreeMap<[[i64; 2]; 2], (usize, [Vec2; 2])> = BTreeMap::new();
    for piece in pieces {
        for (i, &from) in piece.iter().enumerate() {
            let to = piece[(i + 1) % piece.len()];
            let ends = [key(from), key(to)];
            edges.entry([ends[0].min(ends[1]), ends[0].max(ends[1])]).or_insert((0, [from, to])).0 += 1;
        }
    }
    edges.into_values().filter(|(count, _)| *count == 1).map(|(_, edge)| edge).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panel_is_closed_and_has_its_volume() {
        let l = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]].map(Vec2::from);
        let cover: Vec<Vec<Vec2>> = triangles(&l).into_iter().map(|t| t.map(|i| l[i]).to_vec()).collect();
        // What of the L is north of y = 0.5: 4 × 0.5 and 1 × 2 metres.
        let mesh = panel(&cut(&cover, |p| p.y - 0.5), [0.0, 0.2]);
        assert_eq!(mesh.validate(), Ok(()));
        let cone = |t: usize| {
            let [a, b, c] = mesh.corners(t);
            a.dot(b.cross(c)) / 6.0
        };
        let volume: f32 = (0..mesh.triangles.len()).map(cone).sum();
        assert!((volume - 0.8).abs() < 1e-3, "{volume}");
    }
}
