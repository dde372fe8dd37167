//! The part of a building that a point cloud shows. SpatialLM counts all coordinates of a layout from the least ones of its cloud, and
//! moves everything below them there, so walls without points nearby would be learned in wrong positions.

use crate::formats::points::SurfacePoint;
use enfilade_math::{DVec2, OrientedBox};
use enfilade_scene::{RoomOutline, Rooms, WallFace};

/// Greatest distance between a room's points and its walls or floor, metres: two of the steps to which SpatialLM rounds.
const SHORT_M: f64 = 0.05;

/// Greatest distance outside of a room of points that belong to it, metres.
const OUTSIDE_M: f64 = 0.02;

/// Width of the strips of a wall that are looked at, metres.
const STRIP_M: f64 = 0.25;

/// Greatest distance of points that show a strip of wall, metres: furniture at a wall hides the wall but shows where it is.
const NEAR_M: f64 = 0.5;

/// Share of a room's strips that points have to show.
const ENOUGH: f64 = 0.75;

/// Points in a box, with a margin around it: SpatialLM's `Layout.filter_empty_bboxes` drops boxes with no more.
const FEWEST_IN_BOX: usize = 100;
const MARGIN_M: f64 = 0.15;

/// Whether the points show each room: to its outline on all sides, its floor, and most of its walls.
pub(super) fn rooms(rooms: &Rooms, points: &[SurfacePoint]) -> Vec<bool> {
    rooms.outlines.iter().enumerate().map(|(number, room)| is_shown(rooms, number, room, points)).collect()
}

fn is_shown(rooms: &Rooms, number: usize, room: &RoomOutline, points: &[SurfacePoint]) -> bool {
    let heights = room.floor_z_m - OUTSIDE_M..=room.ceiling_z_m + OUTSIDE_M;
    let own = points.iter().map(|point| point.position).filter(|p| heights.contains(&p.z) && room.reaches(p.truncate(), OUTSIDE_M));
    let mut walls: Vec<(&WallFace, Vec<bool>)> = rooms.walls.iter().filter(|wall| wall.room == number).map(strips).collect();
    let (mut low, mut high, mut lowest) = (DVec2::INFINITY, DVec2::NEG_INFINITY, f64::INFINITY);
    for p in own {
        (low, high, lowest) = (low.min(p.truncate()), high.max(p.truncate()), lowest.min(p.z));
        for (wall, shown) in &mut walls {
            let strip = wall.along_m(p) / wall.length_m() * shown.len() as f64;
            if wall.distance_m(p).abs() <= NEAR_M && strip >= 0.0 {
                shown.get_mut(strip as usize).into_iter().for_each(|shown| *shown = true);
            }
        }
    }
    let outline = || room.polygon.iter().map(|&corner| DVec2::from(corner));
    let (first, last) = (outline().fold(DVec2::INFINITY, DVec2::min), outline().fold(DVec2::NEG_INFINITY, DVec2::max));
    let (all, shown) = walls.iter().flat_map(|(_, strips)| strips).fold((0, 0), |(all, shown), &is| (all + 1, shown + usize::from(is)));
    let reaches_ends = (low - first).max_element() <= SHORT_M && (last - high).max_element() <= SHORT_M;
    reaches_ends && lowest - room.floor_z_m <= SHORT_M && f64::from(shown as u32) >= ENOUGH * f64::from(all as u32)
}

/// A wall, no strip of which is shown.
fn strips(wall: &WallFace) -> (&WallFace, Vec<bool>) {
    (wall, vec![false; (wall.length_m() / STRIP_M).ceil().max(1.0) as usize])
}

/// Whether SpatialLM keeps a box for its points.
pub(super) fn has_points(shape: &OrientedBox, points: &[SurfacePoint]) -> bool {
    let half = shape.extents * 0.5 + MARGIN_M;
    let is_in = |point: &&SurfacePoint| (shape.world_from_box.transpose() * (point.position - shape.center)).abs().cmple(half).all();
    points.iter().filter(is_in).take(FEWEST_IN_BOX + 1).count() > FEWEST_IN_BOX
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::{DMat3, DVec3};

    /// Two rooms of 4 × 3 and 2 × 3 metres beside each other.
    fn two_rooms() -> Rooms {
        let room = |name: &str, [left, right]: [f64; 2]| RoomOutline {
            name: name.into(),
            kind: "living".into(),
            polygon: vec![[left, 0.0], [right, 0.0], [right, 3.0], [left, 3.0]],
            floor_z_m: 0.0,
            ceiling_z_m: 2.5,
        };
        let mut rooms = Rooms::default();
        rooms.push_room(room("a", [0.0, 4.0]), &[(0.1, true); 4]);
        rooms.push_room(room("b", [4.1, 6.1]), &[(0.1, true); 4]);
        rooms
    }

    /// Points ten centimetres apart on floor and walls of the box between two corners.
    fn points([low, high]: [[f64; 3]; 2]) -> Vec<SurfacePoint> {
        let (low, high) = (DVec3::from(low), DVec3::from(high));
        let steps = ((high - low) / 0.1).round().as_ivec3();
        let mut points = Vec::new();
        for (i, j, k) in (0..=steps.x).flat_map(|i| (0..=steps.y).flat_map(move |j| (0..=steps.z).map(move |k| (i, j, k)))) {
            if k == 0 || i == 0 || i == steps.x || j == 0 || j == steps.y {
                let position = low + DVec3::new(f64::from(i), f64::from(j), f64::from(k)) * 0.1;
                points.push(SurfacePoint { position, color: [0; 3] });
            }
        }
        points
    }

    #[test]
    fn a_room_is_shown_where_points_reach_its_walls_and_floor() {
        let two = two_rooms();
        let shown = |part| rooms(&two, &points(part));
        assert_eq!(shown([[0.0; 3], [4.0, 3.0, 2.5]]), [true, false], "the first whole, of the second nothing");
        assert_eq!(shown([[0.0; 3], [4.0, 3.0, 1.0]]), [true, false], "the ceiling need not be seen");
        assert_eq!(shown([[1.0, 0.0, 0.0], [4.0, 3.0, 2.5]]), [false, false], "a wall would move by a metre");
        assert_eq!(shown([[0.0, 0.0, 0.5], [4.0, 3.0, 2.5]]), [false, false], "so would the floor");
        // The outermost points alone do not make a room: a diagonal through it reaches all four sides.
        let diagonal = (0..=300).map(|i| DVec3::new(4.0, 3.0, 0.0) * f64::from(i) / 300.0);
        let diagonal: Vec<SurfacePoint> = diagonal.map(|position| SurfacePoint { position, color: [0; 3] }).collect();
        assert_eq!(rooms(&two, &diagonal), [false, false]);
    }

    #[test]
    fn boxes_are_counted_in_their_own_axes() {
        let turned = DMat3::from_rotation_z(0.5);
        let shape = |extents| OrientedBox { center: DVec3::ZERO, extents, world_from_box: turned };
        // A line of 101 points along the box's own x axis.
        let line: Vec<SurfacePoint> =
            (-50..=50).map(|i| SurfacePoint { position: turned.x_axis * 0.02 * f64::from(i), color: [0; 3] }).collect();
        assert!(has_points(&shape(DVec3::new(2.0, 0.01, 0.01)), &line));
        assert!(!has_points(&shape(DVec3::new(0.01, 2.0, 0.01)), &line) && !has_points(&shape(DVec3::new(1.6, 0.01, 0.01)), &line));
    }
}
