//! Outlines of drawn rooms: cleaned, checked, and moved apart where they share a wall that has no thickness in the file.

use super::measures::{INNER_WALL, THICKEST};
use crate::room::outline::{Outline, distance};
use enfilade_math::{DVec2, Vec2};
use enfilade_scene::DrawnRoom;

/// Corners nearer to each other, or to the line between their neighbours, are left out, metres.
const SAME: f64 = 0.004;
/// Most corners of a room.
const CORNERS: usize = 200;
/// Smallest floor area, m², and smallest width of the widest part, metres.
const SMALLEST: [f32; 2] = [0.8, 0.75];
/// Largest extent of a plan, metres.
const LARGEST: f64 = 200.0;
/// Rooms may reach this far into each other, metres.
const SLACK: f32 = 0.03;
/// Distance between places on outlines that are looked at, metres.
const STEP: f32 = 0.05;
/// Walls thinner than this in the file get a thickness, metres.
const THIN: f32 = 0.05;
/// Two walls are the faces of one if they run side by side for at least this, metres.
const SIDE_BY_SIDE: f32 = 0.3;
/// Cosine of the angle between the normals of the two faces of a wall, at most.
pub const OPPOSITE: f32 = -0.9995;

/// The outline of each room, counter-clockwise, without corners on straight walls.
///
/// # Errors
/// What is wrong with a room, and what was expected.
pub fn cleaned(rooms: &[DrawnRoom]) -> Result<Vec<Outline>, String> {
    let outlines: Vec<Outline> = rooms.iter().map(one).collect::<Result<_, _>>()?;
    let all = outlines.iter().flat_map(|outline| &outline.corners);
    let (low, high) = all.fold((DVec2::MAX, DVec2::MIN), |(low, high), p| (low.min(*p), high.max(*p)));
    if (high - low).max_element() > LARGEST {
        let size = high - low;
        return Err(format!("the plan is {:.0} m x {:.0} m, expected at most {LARGEST} m: lengths are in metres", size.x, size.y));
    }
    Ok(outlines)
}

/// Leaves out the rooms that are too small to be any, such as shafts and narrow balconies, and makes a note of each.
pub fn without_slivers(rooms: &mut Vec<DrawnRoom>, notes: &mut Vec<String>) {
    rooms.retain(|room| {
        let corners = room.polygon.clone();
        if corners.len() < 3 || !corners.iter().all(|p| p.is_finite()) {
            return true;
        }
        let outline = Outline::new(corners);
        let area = outline.area().abs();
        if area < SMALLEST[0] {
            notes.push(format!("room {:?} has {area:.2} m2; it is left out", room.name));
            return false;
        }
        let width = 2.0 * outline.depth(outline.middle());
        if width < SMALLEST[1] {
            notes.push(format!("room {:?} is {width:.2} m wide; it is left out", room.name));
        }
        width >= SMALLEST[1]
    });
}

fn one(room: &DrawnRoom) -> Result<Outline, String> {
    let name = &room.name;
    if let Some(corner) = room.polygon.iter().find(|p| !p.is_finite()) {
        return Err(format!("room {name:?} has the corner [{}, {}], expected finite numbers", corner.x, corner.y));
    }
    let mut corners = room.polygon.clone();
    while let Some(i) = superfluous(&corners) {
        corners.remove(i);
    }
    if corners.len() < 3 {
        return Err(format!("room {name:?} has {} corners that differ, expected at least 3", corners.len()));
    }
    if corners.len() > CORNERS {
        return Err(format!("room {name:?} has {} corners, expected at most {CORNERS}", corners.len()));
    }
    if let Some([a, b]) = crossing(&corners) {
        return Err(format!(
            "the outline of room {name:?} crosses itself near [{:.2}, {:.2}] and [{:.2}, {:.2}]; list its corners once around",
            a.x, a.y, b.x, b.y
        ));
    }
    let twice: f64 = (0..corners.len()).map(|i| corners[i].perp_dot(corners[(i + 1) % corners.len()])).sum();
    if twice < 0.0 {
        corners.reverse();
    }
    let outline = Outline::new(corners);
    let width = 2.0 * outline.depth(outline.middle());
    if outline.area() < SMALLEST[0] || width < SMALLEST[1] {
        let [area, least] = SMALLEST;
        return Err(format!(
            "room {name:?} has {:.2} m2 and is {width:.2} m wide, expected at least {area} m2 and {least} m: lengths are in metres",
            outline.area()
        ));
    }
    Ok(outline)
}

/// A corner that is at another, or on the straight line between its neighbours.
fn superfluous(corners: &[DVec2]) -> Option<usize> {
    let n = corners.len();
    (0..n).filter(|_| n > 2).find(|&i| {
        let (a, p, b) = (corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n]);
        let along = b - a;
        let between = (p - a).dot(along) > 0.0 && (p - b).dot(along) < 0.0;
        p.distance(b) < SAME || (between && (along.perp_dot(p - a) / along.length()).abs() < SAME)
    })
}

/// Beginnings of two edges that cross or touch each other.
fn crossing(corners: &[DVec2]) -> Option<[DVec2; 2]> {
    let n = corners.len();
    let edge = |i: usize| [corners[i], corners[(i + 1) % n]];
    let meet = |[a, b]: [DVec2; 2], [c, d]: [DVec2; 2]| {
        let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
        let touches = |p: DVec2| distance([a.as_vec2(), b.as_vec2()], p.as_vec2()) < 1e-3;
        side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0 || touches(c) || touches(d)
    };
    let pairs = (0..n).flat_map(|i| (i + 2..n).filter(move |j| (j + 1) % n != i).map(move |j| (i, j)));
    pairs.map(|(i, j)| (edge(i), edge(j))).find(|&(e, f)| meet(e, f)).map(|(e, f)| [e[0], f[0]])
}

/// Refuses rooms that reach into each other.
///
/// # Errors
/// The rooms, and where.
pub fn check_apart(outlines: &[Outline], rooms: &[DrawnRoom]) -> Result<(), String> {
    for (i, a) in outlines.iter().enumerate() {
        for (j, b) in outlines.iter().enumerate().filter(|(j, _)| *j != i) {
            let [low, high] = b.bounds();
            let within = |p: &Vec2| p.cmpgt(low + SLACK).all() && p.cmplt(high - SLACK).all() && b.depth(*p) > SLACK;
            let places = a.edges().flat_map(|[from, to]| {
                let steps = (from.distance(to) / STEP).ceil().max(1.0) as usize;
                (0..steps).map(move |k| from.lerp(to, k as f32 / steps as f32))
            });
            if let Some(p) = std::iter::once(a.middle()).chain(places).find(within) {
                let (first, second) = (&rooms[i.min(j)].name, &rooms[i.max(j)].name);
                return Err(format!(
                    "rooms {first:?} and {second:?} overlap at [{:.2}, {:.2}]; move a corner so that they share a wall at most",
                    p.x, p.y
                ));
            }
        }
    }
    Ok(())
}

/// Moves walls apart that two rooms share and that have no thickness in the file, half of it each; whether there were any.
pub fn thickened(outlines: &mut [Outline]) -> bool {
    let insets: Vec<Vec<f32>> = (0..outlines.len()).map(|room| insets(outlines, room)).collect();
    let any = insets.iter().flatten().any(|inset| *inset > 0.0);
    for (outline, insets) in outlines.iter_mut().zip(insets) {
        if insets.iter().any(|inset| *inset > 0.0) {
            *outline = moved(outline, &insets);
        }
    }
    any
}

/// How far each wall of a room is to be moved inwards.
fn insets(outlines: &[Outline], room: usize) -> Vec<f32> {
    let own = &outlines[room];
    let inset = |i: usize| {
        let [a, b] = own.edge(i);
        let along = (b - a).normalize_or_zero();
        let gaps =
            outlines.iter().enumerate().filter(|(other, _)| *other != room).flat_map(|(_, other)| other.edges()).filter_map(|[c, d]| {
                let opposite = (d - c).normalize_or_zero().dot(along) < OPPOSITE;
                let shared = (c - a).dot(along).min(a.distance(b)) - (d - a).dot(along).max(0.0);
                let gap = -along.perp().dot(0.5 * (c + d) - a);
                (opposite && shared > SIDE_BY_SIDE && (-SLACK..THIN).contains(&gap)).then_some(gap)
            });
        gaps.reduce(f32::min).map_or(0.0, |gap| 0.5 * (INNER_WALL - gap))
    };
    (0..own.count()).map(inset).collect()
}

/// The outline with each edge moved inwards by its own length.
fn moved(outline: &Outline, insets: &[f32]) -> Outline {
    let n = outline.count();
    let corner = |i: usize| outline.corners[i % n];
    let line = |i: usize| {
        let along = (corner(i + 1) - corner(i)).normalize_or_zero();
        (corner(i) + along.perp() * f64::from(insets[i % n]), along)
    };
    let meet = |i: usize| {
        let ((p, u), (q, v)) = (line((i + n - 1) % n), line(i));
        let across = u.perp_dot(v);
        // Walls that are almost in line keep their corner, moved straight inwards.
        if across.abs() < 0.05 { q } else { p + u * ((q - p).perp_dot(v) / across) }
    };
    Outline::new((0..n).map(meet).collect())
}

/// What is behind a point of a wall, going outwards: the distance, the room, and its edge.
pub fn behind(outlines: &[Outline], from: Vec2, outward: Vec2) -> Option<(f32, usize, usize)> {
    let hits = outlines.iter().enumerate().filter_map(|(room, outline)| outline.cast(from, outward).map(|(t, edge)| (t, room, edge)));
    hits.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(t, ..)| *t <= THICKEST)
}
