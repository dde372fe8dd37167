//! The outline of a building: the outer sides of its outer walls, as closed lines seen from above.
//!
//! Every room is grown by the thickness of its walls, with mitred corners, so that neighbours overlap in the wall between them. What is left
//! of the grown rooms' edges outside of all others is the outline.

use enfilade_math::DVec2;
use enfilade_scene::Rooms;
use std::collections::BTreeMap;

/// Points nearer to each other are one, metres.
const SAME_M: f64 = 1e-4;

/// Distance beside an edge of the point that is tested, metres: more than rounding, less than any gap between walls.
const BESIDE_M: f64 = 1e-3;

/// The closed lines around the grown rooms of a storey, interior left, that with the largest area first; `None` where they do not close.
pub(super) fn outlines(rooms: &Rooms, storey: &[usize]) -> Option<Vec<Vec<DVec2>>> {
    let grown: Vec<Vec<DVec2>> = storey.iter().map(|&room| grown(rooms, room)).collect();
    let edges: Vec<[DVec2; 2]> = grown.iter().flat_map(|polygon| edges(polygon)).collect();
    let mut outer: BTreeMap<[i64; 4], [DVec2; 2]> = BTreeMap::new();
    for &[a, b] in &edges {
        for piece @ [a, b] in pieces([a, b], &edges) {
            let right = (b - a).normalize_or_zero().perp() * -BESIDE_M;
            let beside = (a + b) * 0.5 + right;
            if !grown.iter().any(|polygon| is_in(beside, polygon)) {
                let ([ax, ay], [bx, by]) = (place(a), place(b));
                outer.insert([ax, ay, bx, by], piece);
            }
        }
    }
    let mut loops = chained(outer.into_values().collect())?;
    loops.iter_mut().for_each(straighten);
    loops.retain(|outline| outline.len() >= 3);
    loops.sort_by(|a, b| area(b).total_cmp(&area(a)));
    (!loops.is_empty()).then_some(loops)
}

/// A room's outline, counter-clockwise, with every edge moved outward by the thickness of its wall.
fn grown(rooms: &Rooms, room: usize) -> Vec<DVec2> {
    let walls: Vec<_> = rooms.walls.iter().filter(|wall| wall.room == room).collect();
    let mut corners = Vec::new();
    for (i, next) in walls.iter().enumerate() {
        let before = walls[(i + walls.len() - 1) % walls.len()];
        let corner = DVec2::from(next.from);
        let moved = [before, next].map(|wall| corner - DVec2::from(wall.inward) * wall.thickness_m);
        let [along_before, along_next] = [before, next].map(|wall| (DVec2::from(wall.to) - DVec2::from(wall.from)).normalize_or_zero());
        let turn = along_before.perp_dot(along_next);
        if turn.abs() < 1e-6 {
            // A wall that goes on straight, perhaps as another thickness.
            corners.extend(moved);
        } else {
            corners.push(moved[0] + along_before * ((moved[1] - moved[0]).perp_dot(along_next) / turn));
        }
    }
    corners.dedup_by(|a, b| a.distance(*b) < SAME_M);
    corners
}

fn edges(polygon: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> + '_ {
    (0..polygon.len()).map(|i| [polygon[i], polygon[(i + 1) % polygon.len()]])
}

/// An edge, cut where others cross it, end on it or begin to run along it.
fn pieces([a, b]: [DVec2; 2], others: &[[DVec2; 2]]) -> Vec<[DVec2; 2]> {
    let (length, along) = ((b - a).length(), (b - a).normalize_or_zero());
    let mut cuts = vec![0.0, length];
    for &[c, d] in others {
        let [off_c, off_d] = [c, d].map(|p| along.perp_dot(p - a));
        for (p, off) in [(c, off_c), (d, off_d)] {
            if off.abs() < SAME_M {
                cuts.push(along.dot(p - a));
            }
        }
        if off_c * off_d < 0.0 {
            cuts.push(along.dot(c + (d - c) * (off_c / (off_c - off_d)) - a));
        }
    }
    cuts.retain(|cut| (0.0..=length).contains(cut));
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|one, other| (*one - *other).abs() < SAME_M);
    cuts.windows(2).map(|pair| [a + along * pair[0], a + along * pair[1]]).collect()
}

/// Whether a point is in a polygon, by the parity of the edges that a ray crosses.
fn is_in(p: DVec2, polygon: &[DVec2]) -> bool {
    let crosses = |[a, b]: &[DVec2; 2]| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
    edges(polygon).filter(crosses).count() % 2 == 1
}

fn place(p: DVec2) -> [i64; 2] {
    (p / SAME_M).round().to_array().map(|v| v as i64)
}

/// Closed lines of pieces that follow on each other.
fn chained(pieces: Vec<[DVec2; 2]>) -> Option<Vec<Vec<DVec2>>> {
    let mut left: Vec<[DVec2; 2]> = pieces;
    let mut loops = Vec::new();
    while let Some([first, mut at]) = left.pop() {
        let mut outline = vec![first];
        while at.distance(first) > 2.0 * SAME_M {
            let next = left.iter().position(|[from, _]| from.distance(at) <= 2.0 * SAME_M)?;
            outline.push(at);
            at = left.swap_remove(next)[1];
        }
        loops.push(outline);
    }
    Some(loops)
}

/// Drops corners at which a line goes on straight.
fn straighten(outline: &mut Vec<DVec2>) {
    let corners = outline.clone();
    let turns = |i: usize| {
        let at = |step: usize| corners[(i + step) % corners.len()];
        let [before, here, after] = [at(corners.len() - 1), at(0), at(1)];
        (here - before).normalize_or_zero().perp_dot((after - here).normalize_or_zero()).abs() > 1e-6
    };
    *outline = (0..corners.len()).filter(|&i| turns(i)).map(|i| corners[i]).collect();
}

/// Half the sum of cross products: positive where the interior is on the left.
fn area(outline: &[DVec2]) -> f64 {
    0.5 * edges(outline).map(|[a, b]| a.perp_dot(b)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::RoomOutline;

    fn room(name: &str, polygon: Vec<[f64; 2]>) -> RoomOutline {
        RoomOutline { name: name.into(), kind: "living".into(), polygon, floor_z_m: 0.0, ceiling_z_m: 2.5 }
    }

    #[test]
    fn two_rooms_have_one_outline_around_their_walls() {
        // 4 x 3 and 2 x 3 metres, 10 cm apart, with 30 cm of wall around them: by hand 6.7 x 3.6.
        let mut rooms = Rooms::default();
        rooms.push_room(
            room("a", vec![[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]),
            &[(0.3, true), (0.1, false), (0.3, true), (0.3, true)],
        );
        rooms.push_room(
            room("b", vec![[4.1, 0.0], [6.1, 0.0], [6.1, 3.0], [4.1, 3.0]]),
            &[(0.3, true), (0.3, true), (0.3, true), (0.1, false)],
        );
        let found = outlines(&rooms, &[0, 1]).unwrap();
        assert_eq!((found.len(), found[0].len()), (1, 4), "{found:?}");
        assert!((area(&found[0]) - 6.7 * 3.6).abs() < 1e-9);
        for corner in [[-0.3, -0.3], [6.4, -0.3], [6.4, 3.3], [-0.3, 3.3]].map(DVec2::from) {
            assert!(found[0].iter().any(|p| p.distance(corner) < 1e-9), "{corner}");
        }
    }

    #[test]
    fn an_angle_and_a_shorter_neighbour_have_their_own_corners() {
        // An L of 3 x 3 without its upper right 2 x 2, walls of 20 cm all around: by hand 3.4 x 1.4 and 1.4 x 2.
        let mut rooms = Rooms::default();
        let polygon = vec![[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        rooms.push_room(room("l", polygon), &[(0.2, true); 6]);
        let found = outlines(&rooms, &[0]).unwrap();
        assert_eq!((found.len(), found[0].len()), (1, 6));
        assert!((area(&found[0]) - (3.4 * 1.4 + 1.4 * 2.0)).abs() < 1e-9, "{}", area(&found[0]));
    }
}
