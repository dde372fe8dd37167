//! A floor plan as rooms, wall faces and openings: exactly as a dataset of a generated home states them.

use super::FloorPlan;
use crate::room::{Face, Filling, Opening, Room};
use enfilade_furniture::Leaf;
use enfilade_math::{DVec3, Vec2};
use enfilade_scene::{CeilingSlope, DoorLeaf, Hinge, OpeningKind, RoomOutline, Rooms, WallOpening};
use std::collections::BTreeMap;

/// Two rooms state the same opening within this, metres: the rounding of single precision, and walls that are not quite parallel.
const SAME: f32 = 0.02;
/// Cosine of the angle between walls that are the two faces of one, at most.
const OPPOSITE: f32 = -0.999;

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
            let edges: Vec<(f64, bool)> =
                room.faces.iter().flat_map(|face| &face.backs).map(|back| (f64::from(back.thickness), back.outer)).collect();
            rooms.push_room(outline(room, *number), &edges);
        }
        for (room, number) in self.rooms.iter().zip(0..) {
            rooms.slopes.extend(room.slopes.iter().map(|incline| CeilingSlope { room: number, slope: incline.slope }));
        }
        for face in (0..rooms.walls.len()).filter(|_| !rooms.slopes.is_empty()) {
            let highest = rooms.face_outline(face).iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
            rooms.walls[face].ceiling_z_m = highest;
        }
        let leading = self.rooms.iter().enumerate().flat_map(|(number, room)| room.openings.iter().map(move |o| (number, room, o)));
        let leading = leading.filter(|(_, _, opening)| !is_other_side(opening));
        rooms.openings = leading.map(|(number, room, opening)| self.opening(number, room, opening, &rooms)).collect();
        rooms
    }

    fn opening(&self, number: usize, room: &Room, opening: &Opening, rooms: &Rooms) -> WallOpening {
        let first = self.piece(number, opening);
        let face = &rooms.walls[first];
        let back = room.face(opening.wall).back(opening.center_x());
        let along = opening.x.map(|x| 0.5 * face.length_m() + f64::from(x) - f64::from(0.5 * (back.x[0] + back.x[1])));
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

    /// The number of the piece of wall that an opening of a room is in: walls with several things behind them are several.
    fn piece(&self, number: usize, opening: &Opening) -> usize {
        let pieces = |room: &Room| room.faces.iter().map(|face| face.backs.len()).sum::<usize>();
        let faces = &self.rooms[number].faces;
        let face = &faces[opening.wall.0];
        let before =
            self.rooms[..number].iter().map(pieces).sum::<usize>() + faces[..opening.wall.0].iter().map(|f| f.backs.len()).sum::<usize>();
        before + face.backs.iter().position(|back| opening.center_x() <= back.x[1]).unwrap_or(face.backs.len() - 1)
    }

    /// The face beyond an opening, if there is a room beyond it.
    fn other_side(&self, room: &Room, opening: &Opening) -> Option<usize> {
        let ends = |room: &Room, o: &Opening| o.x.map(|x| room.before(o.wall, x, 0.0));
        let (here, inward) = (ends(room, opening), room.inward(opening.wall));
        let beyond = -inward * room.thickness(opening);
        let meets = |there: [Vec2; 2]| (here[0] + beyond).distance(there[1]) < SAME && (here[1] + beyond).distance(there[0]) < SAME;
        self.rooms.iter().enumerate().find_map(|(number, other)| {
            let is_twin = |o: &&Opening| is_other_side(o) && other.inward(o.wall).dot(inward) < OPPOSITE && meets(ends(other, o));
            let twin = other.openings.iter().find(is_twin)?;
            Some(self.piece(number, twin))
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
    RoomOutline {
        name: format!("{}_{number}", room.kind.name()),
        kind: room.kind.name().into(),
        polygon: room.faces.iter().enumerate().flat_map(|(i, face)| corners(room, i, face)).collect(),
        floor_z_m: 0.0,
        ceiling_z_m: room.size.z.into(),
    }
}

/// Where the pieces of a wall begin.
fn corners(room: &Room, i: usize, face: &Face) -> impl Iterator<Item = [f64; 2]> {
    let corner = |i: usize| room.outline.corners[i % room.outline.count()];
    let (from, to) = (corner(i), corner(i + 1));
    let along = (to - from).normalize_or_zero();
    let later = face.backs.iter().skip(1).map(move |back| from + along * f64::from(back.x[0] + 0.5 * face.length));
    std::iter::once(from).chain(later).map(|p| p.to_array())
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
