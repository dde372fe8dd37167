//! A floor plan as rooms, wall faces and openings: exactly as a dataset of a generated home states them.

use super::FloorPlan;
use crate::room::{Filling, Opening, Room, Wall};
use enfilade_furniture::Leaf;
use enfilade_math::{DVec2, DVec3, Vec2};
use enfilade_scene::{DoorLeaf, Hinge, OpeningKind, RoomOutline, Rooms, WallOpening};
use std::collections::BTreeMap;

/// Rooms have four walls, in the order of [`Wall::ALL`].
const SIDES: usize = 4;
/// Two rooms state the same opening and wall within this, metres: the rounding of single precision.
const SAME: f32 = 1e-3;

impl FloorPlan {
    /// Rooms in the order of the programme, the faces of their walls, and what opens in them.
    ///
    /// ```
    /// use enfilade_home::{FloorPlan, RoomKind};
    /// use enfilade_math::Rng;
    /// let rooms = FloorPlan::new(&[RoomKind::Hall, RoomKind::Bedroom], &Rng::new(7)).to_rooms();
    /// assert_eq!(rooms.outlines[1].name, "bedroom_1");
    /// assert_eq!(rooms.walls.len(), 8);
    /// ```
    pub fn to_rooms(&self) -> Rooms {
        let mut rooms = Rooms::default();
        let mut numbers: BTreeMap<&str, u32> = BTreeMap::new();
        for room in &self.rooms {
            let number = numbers.entry(room.kind.name()).or_default();
            *number += 1;
            let edges = Wall::ALL.map(|wall| (f64::from(room.thickness(wall)), room.outer[wall as usize]));
            rooms.push_room(outline(room, *number), &edges);
        }
        let leading = self.rooms.iter().enumerate().flat_map(|(number, room)| room.openings.iter().map(move |o| (number, room, o)));
        let leading = leading.filter(|(_, _, opening)| !is_other_side(opening));
        rooms.openings = leading.map(|(number, room, opening)| self.opening(number, room, opening, &rooms)).collect();
        rooms
    }

    fn opening(&self, number: usize, room: &Room, opening: &Opening, rooms: &Rooms) -> WallOpening {
        let first = SIDES * number + opening.wall as usize;
        let face = &rooms.walls[first];
        let along = opening.x.map(|x| 0.5 * face.length_m() + f64::from(x));
        let [low, high] = opening.z.map(f64::from);
        let corner = |along: f64, z: f64| DVec3::to_array(&face.point(along, z));
        let kind = match opening.filling {
            Filling::Window { .. } => OpeningKind::Window,
            Filling::Door(_) | Filling::DoorBack => OpeningKind::Door,
            Filling::Passage { .. } => OpeningKind::Passage,
        };
        WallOpening {
            kind,
            walls: std::iter::once(first).chain(self.other_side(room, opening)).collect(),
            corners: [corner(along[1], low), corner(along[0], low), corner(along[0], high), corner(along[1], high)],
            leaf: if let Filling::Door(leaf) = opening.filling { Some(hung(leaf)) } else { None },
        }
    }

    /// The face beyond an opening, if there is a room beyond it.
    fn other_side(&self, room: &Room, opening: &Opening) -> Option<usize> {
        let ends = |room: &Room, o: &Opening| o.x.map(|x| room.before(o.wall, x, 0.0));
        let here = ends(room, opening);
        let beyond = -opening.wall.inward() * room.inner_wall;
        let meets = |there: [Vec2; 2]| (here[0] + beyond).distance(there[1]) < SAME && (here[1] + beyond).distance(there[0]) < SAME;
        self.rooms.iter().enumerate().find_map(|(number, other)| {
            let twin = other.openings.iter().find(|o| is_other_side(o) && o.wall == opening.wall.turned(2) && meets(ends(other, o)))?;
            Some(SIDES * number + twin.wall as usize)
        })
    }
}

/// A wall's x axis points to the left for someone who faces it.
fn hung(leaf: Leaf) -> DoorLeaf {
    DoorLeaf { hinge: if leaf.hinge > 0.0 { Hinge::Left } else { Hinge::Right }, open_deg: f64::from(leaf.open_rad).to_degrees() }
}

/// Whether the room on the other side states the opening in full.
fn is_other_side(opening: &Opening) -> bool {
    matches!(opening.filling, Filling::DoorBack | Filling::Passage { lined: false })
}

fn outline(room: &Room, number: u32) -> RoomOutline {
    let (center, half) = (room.center.as_dvec2(), 0.5 * room.size.truncate().as_dvec2());
    let corner = |x: f64, y: f64| (center + half * DVec2::new(x, y)).to_array();
    RoomOutline {
        name: format!("{}_{number}", room.kind.name()),
        kind: room.kind.name().into(),
        polygon: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        floor_z_m: 0.0,
        ceiling_z_m: room.size.z.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::room::kind::usual_programme;
    use enfilade_math::Rng;

    fn plans() -> impl Iterator<Item = FloorPlan> {
        (0..60).map(|seed| FloorPlan::new(&usual_programme(1 + seed as usize % 8), &Rng::new(seed)))
    }

    #[test]
    fn every_opening_is_there_once_and_leads_where_the_plan_says() {
        for plan in plans() {
            let rooms = plan.to_rooms();
            let windows = plan.rooms.iter().flat_map(Room::windows).count();
            let of = |kind: OpeningKind| rooms.openings.iter().filter(move |o| o.kind == kind);
            assert_eq!(of(OpeningKind::Window).count(), windows);
            assert_eq!(rooms.openings.len() - windows, plan.doorways.len());
            let mut ways: Vec<Vec<usize>> =
                rooms.openings.iter().filter(|o| o.kind != OpeningKind::Window).map(|o| rooms.rooms_of(o).collect()).collect();
            for way in &plan.doorways {
                let mut ends: Vec<usize> = way.from.into_iter().chain([way.into]).collect();
                ends.sort_unstable();
                let found = ways.iter().position(|found| {
                    let mut found = found.clone();
                    found.sort_unstable();
                    found == ends
                });
                ways.swap_remove(found.unwrap_or_else(|| panic!("{way:?} of {rooms:?}")));
            }
            assert!(of(OpeningKind::Window).all(|o| o.walls.len() == 1 && rooms.walls[o.walls[0]].outer));
        }
    }

    #[test]
    fn openings_lie_in_their_faces_and_faces_of_a_wall_are_as_far_apart_as_it_is_thick() {
        for rooms in plans().map(|plan| plan.to_rooms()) {
            for opening in &rooms.openings {
                let face = &rooms.walls[opening.walls[0]];
                for corner in opening.corners.map(DVec3::from) {
                    assert!(face.distance_m(corner).abs() < 1e-6);
                    assert!((face.floor_z_m..=face.ceiling_z_m).contains(&corner.z));
                }
                let [a, b, c, _] = opening.corners.map(DVec3::from);
                // Counter-clockwise for someone in the room.
                assert!((b - a).cross(c - b).truncate().dot(face.inward.into()) > 0.0);
                if let Some(&beyond) = opening.walls.get(1) {
                    let beyond = &rooms.walls[beyond];
                    assert!((beyond.distance_m(opening.center()) + face.thickness_m).abs() < 1e-3);
                    assert_eq!(beyond.inward.map(|x| -x + 0.0), face.inward.map(|x| x + 0.0));
                }
            }
        }
    }
}
