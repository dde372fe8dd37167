//! Ceilings of rooms under a roof: their heights, pieces, and the faces of walls below them.

use crate::{Rooms, Slope};
use enfilade_math::{DVec2, DVec3};

impl Rooms {
    /// The slopes of a room's ceiling.
    pub fn slopes_of(&self, room: usize) -> impl Iterator<Item = &Slope> {
        self.slopes.iter().filter(move |of| of.room == room).map(|of| &of.slope)
    }

    /// Height of a room's ceiling over a point.
    pub fn ceiling_z_m(&self, room: usize, p: DVec2) -> f64 {
        self.slopes_of(room).map(|slope| slope.z_m(p)).fold(self.outlines[room].ceiling_z_m, f64::min)
    }

    /// Outline of a wall face: from the beginning of its lower edge along that and back along its upper edge, which follows the ceiling.
    pub fn face_outline(&self, face: usize) -> Vec<DVec3> {
        let wall = &self.walls[face];
        let [from, to] = [wall.from, wall.to].map(DVec2::from);
        let lines: Vec<[f64; 2]> = self.slopes_of(wall.room).map(|slope| [from, to].map(|p| slope.z_m(p))).collect();
        let level = [wall.ceiling_z_m; 2];
        let top = |t: f64| lines.iter().map(|[a, b]| a + t * (b - a)).fold(level[0], f64::min);
        let all: Vec<[f64; 2]> = lines.iter().copied().chain([level]).collect();
        // The upper edge bends where the two lowest of these lines cross.
        let crossings = (0..all.len()).flat_map(|i| (i + 1..all.len()).map(move |k| (i, k))).filter_map(|(i, k)| {
            let [a, b] = [all[i][0] - all[k][0], all[i][1] - all[k][1]];
            let t = a / (a - b);
            let z = all[i][0] + t * (all[i][1] - all[i][0]);
            (a * b < 0.0 && (1e-6..1.0 - 1e-6).contains(&t) && (z - top(t)).abs() < 1e-9).then_some(t)
        });
        let mut bends: Vec<f64> = crossings.collect();
        bends.sort_by(|a, b| b.total_cmp(a));
        bends.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
        let upper = std::iter::once(1.0).chain(bends).chain([0.0]).map(|t| from.lerp(to, t).extend(top(t)));
        [from, to].map(|p| p.extend(wall.floor_z_m)).into_iter().chain(upper).collect()
    }

    /// The plane pieces of a room's ceiling: normals into the room, and outlines, counter-clockwise as seen from above. A piece of a room
    /// that is not convex may consist of parts, which edges along the border to the next piece join.
    pub fn ceiling_pieces(&self, room: usize) -> Vec<(DVec3, Vec<DVec3>)> {
        let outline = &self.outlines[room];
        let corners: Vec<DVec2> = outline.polygon.iter().map(|&p| p.into()).collect();
        let slopes: Vec<&Slope> = self.slopes_of(room).collect();
        let height = |k: usize, p: DVec2| slopes.get(k).map_or(outline.ceiling_z_m, |slope| slope.z_m(p));
        let piece = |k: usize| {
            let others = (0..=slopes.len()).filter(|&other| other != k);
            let kept = others.fold(corners.clone(), |kept, other| clipped(&kept, |p| height(other, p) - height(k, p)));
            let normal = slopes.get(k).map_or(DVec3::NEG_Z, |slope| slope.normal());
            (normal, kept.into_iter().map(|p| p.extend(height(k, p))).collect::<Vec<DVec3>>())
        };
        (0..=slopes.len()).rev().map(piece).filter(|(_, corners)| corners.len() > 2).collect()
    }
}

/// What of a polygon is where a linear function is not negative (Sutherland & Hodgman 1974).
fn clipped(polygon: &[DVec2], side: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut kept = Vec::new();
    for (i, &here) in polygon.iter().enumerate() {
        let next = polygon[(i + 1) % polygon.len()];
        let (a, b) = (side(here), side(next));
        if a >= 0.0 {
            kept.push(here);
        }
        if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
            kept.push(here.lerp(next, a / (a - b)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CeilingSlope;
    use crate::RoomOutline;

    /// A room of 4 × 5 metres, 2.5 m high, under slopes of 45° from knee walls of 1.5 m in the south and in the north.
    fn attic() -> Rooms {
        let polygon = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 5.0], [0.0, 5.0]];
        let room = RoomOutline { name: "study_1".into(), kind: "study".into(), polygon, floor_z_m: 0.0, ceiling_z_m: 2.5 };
        let mut rooms = Rooms::default();
        rooms.push_room(room, &[(0.3, true); 4]);
        for (from, to) in [([0.0, 0.0], [4.0, 0.0]), ([4.0, 5.0], [0.0, 5.0])] {
            rooms.slopes.push(CeilingSlope { room: 0, slope: Slope { from, to, low_z_m: 1.5, pitch_deg: 45.0 } });
        }
        rooms
    }

    fn close(found: &[DVec3], expected: &[[f64; 3]]) -> bool {
        found.len() == expected.len() && found.iter().zip(expected).all(|(p, &q)| p.distance(q.into()) < 1e-9)
    }

    #[test]
    fn gables_follow_the_roof_and_knee_walls_are_low() {
        let rooms = attic();
        let gable = rooms.face_outline(1);
        let expected = [[4.0, 0.0, 0.0], [4.0, 5.0, 0.0], [4.0, 5.0, 1.5], [4.0, 4.0, 2.5], [4.0, 1.0, 2.5], [4.0, 0.0, 1.5]];
        assert!(close(&gable, &expected), "{gable:?}");
        assert!(close(&rooms.face_outline(0), &[[0.0; 3], [4.0, 0.0, 0.0], [4.0, 0.0, 1.5], [0.0, 0.0, 1.5]]));
        for (y, z) in [(0.0, 1.5), (0.4, 1.9), (2.0, 2.5), (4.9, 1.6)] {
            assert!((rooms.ceiling_z_m(0, DVec2::new(1.0, y)) - z).abs() < 1e-12, "{y}");
        }
    }

    #[test]
    fn the_pieces_of_a_ceiling_cover_the_room_once() {
        let pieces = attic().ceiling_pieces(0);
        assert_eq!(pieces.iter().map(|(normal, _)| (10.0 * normal.z).round()).collect::<Vec<_>>(), [-10.0, -7.0, -7.0]);
        let area = |corners: &[DVec3]| {
            0.5 * (0..corners.len()).map(|i| corners[i].truncate().perp_dot(corners[(i + 1) % corners.len()].truncate())).sum::<f64>()
        };
        let areas: Vec<f64> = pieces.iter().map(|(_, corners)| area(corners)).collect();
        assert!(areas.iter().zip([12.0, 4.0, 4.0]).all(|(found, expected)| (found - expected).abs() < 1e-9), "{areas:?}");
    }

    #[test]
    fn slopes_survive_being_written() {
        let text = serde_json::to_string(&attic()).unwrap();
        assert!(text.contains(r#""slopes":[{"room":0,"from":[0.0,0.0],"to":[4.0,0.0],"low_z_m":1.5,"pitch_deg":45.0}"#), "{text}");
        assert_eq!(serde_json::from_str::<Rooms>(&text).unwrap(), attic());
        let torn = Rooms { slopes: vec![CeilingSlope { room: 1, ..attic().slopes[0] }], ..attic() };
        assert_eq!(torn.check().unwrap_err(), "a sloping ceiling is of room 1, but there are 1");
    }
}
