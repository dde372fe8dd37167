//! The rooms of a building: their outlines, the faces of their walls, the doors and windows in them, and the names of its things.
//!
//! World coordinates in metres, z up. Every wall face is a vertical rectangle that bounds one room, and ends below a sloping ceiling; a wall
//! between two rooms has two faces, `thickness_m` apart. It is stored as `_detail/layout.json`.

use crate::slope::CeilingSlope;
use enfilade_math::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// First key of the file, and its version.
const FORMAT: &str = "enfilade layout 1";

/// Outlines of rooms, wall faces and openings; they refer to each other by their places in these lists.
///
/// ```
/// use enfilade_scene::{Rooms, RoomOutline};
/// let kitchen = RoomOutline {
///     name: "kitchen_1".into(),
///     kind: "kitchen".into(),
///     polygon: vec![[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]],
///     floor_z_m: 0.0,
///     ceiling_z_m: 2.6,
/// };
/// let mut rooms = Rooms::default();
/// rooms.push_room(kitchen, &[(0.12, false), (0.35, true), (0.35, true), (0.12, false)]);
/// assert_eq!(rooms.outlines[0].area_m2(), 6.0);
/// assert_eq!((rooms.walls[1].from, rooms.walls[1].inward), ([3.0, 0.0], [-1.0, 0.0]));
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rooms {
    /// Kind and version of the file.
    pub format: String,
    /// Kind and outline of each room; `rooms` in the file.
    #[serde(rename = "rooms")]
    pub outlines: Vec<RoomOutline>,
    /// Faces of walls, room after room, along each room's polygon.
    pub walls: Vec<WallFace>,
    /// Doors, passages and windows.
    pub openings: Vec<WallOpening>,
    /// Sloping parts of ceilings, under a roof.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub slopes: Vec<CeilingSlope>,
    /// The labelled instances, in ascending order.
    #[serde(default)]
    pub things: Vec<RoomThing>,
    /// What can be opened; empty where things have no joints.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<RoomJoint>,
    /// How well it agrees with the scene's surfaces, where it was fitted to them; `None` where the building was made after it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fit: Option<RoomsFit>,
}

/// How far the surfaces of walls, floors and ceilings are from the planes of rooms that were fitted to them, evenly by area.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoomsFit {
    /// Share of them within 2 cm; the reveals of openings are not.
    pub near_share: f64,
    /// Half of them are nearer than this.
    pub median_m: f64,
    /// 95 % of them are.
    pub p95_m: f64,
}

/// A labelled instance, described more finely than by its class.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoomThing {
    /// Number of the thing, as in the images.
    pub instance: i16,
    /// Family and number: `coffee_table_1`.
    pub name: String,
    /// Common name: `coffee_table`.
    pub family: String,
    /// Unit vector in the direction of its front, seen from above; `None` for things that lie on their back.
    pub front: Option<[f64; 2]>,
}

/// What can be opened of a thing: a door, a drawer, a lid. Its body in `metadata_bodies.csv` has the same name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoomJoint {
    /// Name of the thing, `/`, and the name of what moves: `dresser_1/drawer_2`.
    pub name: String,
    /// The thing that moves: `door`, `window`, `cupboard`, `drawer`, `flap`, `lid`, `tap` or `chair`.
    pub kind: String,
    /// Number of the instance that moves, as in the images.
    pub instance: i16,
    /// `hinge` or `slide`.
    pub joint: String,
    /// Unit vector: a hinge opens counter-clockwise seen against it, a slide in its direction.
    pub axis: [f64; 3],
    /// A point on the axis of a hinge, metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point_m: Option<[f64; 3]>,
    /// States closed and open as far as it goes, radians or metres from how it is.
    pub limits: [f64; 2],
    /// The share of that range by which it is open.
    pub state: f64,
    /// The thing that stops it before it is wide open, or before it is closed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limited_by: Option<String>,
}

/// A room between floor and ceiling, both level; where [`Rooms::slopes`] are lower, they are the ceiling.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoomOutline {
    /// Kind and number: `bedroom_2`.
    pub name: String,
    /// Kind of the room: `bedroom`.
    pub kind: String,
    /// Outline of the room seen from above, counter-clockwise; edge i begins at corner i.
    pub polygon: Vec<[f64; 2]>,
    /// Height of the floor.
    pub floor_z_m: f64,
    /// Height of the ceiling, where it is level.
    pub ceiling_z_m: f64,
}

/// The side of a wall that a room has: the vertical rectangle over an edge of its polygon.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WallFace {
    /// The room that it bounds.
    pub room: usize,
    /// Start of the face. For someone in the room who faces it, `to` is its left end.
    pub from: [f64; 2],
    /// End of the face.
    pub to: [f64; 2],
    /// Height of its lower edge.
    pub floor_z_m: f64,
    /// Height of its upper edge, or of that edge's highest point under a slope.
    pub ceiling_z_m: f64,
    /// Unit normal of its plane, into the room.
    pub inward: [f64; 2],
    /// To the next room, or to the outside.
    pub thickness_m: f64,
    /// Whether the outside is behind it.
    pub outer: bool,
}

/// The kind of an opening.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "plain words")]
pub enum OpeningKind {
    Door,
    Passage,
    Window,
}

impl OpeningKind {
    /// Name of the kind in the file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Door => "door",
            Self::Passage => "passage",
            Self::Window => "window",
        }
    }
}

/// A rectangular hole through a wall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WallOpening {
    /// The kind of the opening.
    pub kind: OpeningKind,
    /// The wall faces that it goes through: one if the outside is behind it, else two, starting with the room into which the door swings.
    pub walls: Vec<usize>,
    /// Corners of the opening on the first face: lower left for someone in that room, then counter-clockwise.
    pub corners: [[f64; 3]; 4],
    /// How its door is hinged; `None` without a door.
    pub leaf: Option<DoorLeaf>,
}

/// How a door is hinged, for someone in the room into which it swings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DoorLeaf {
    /// The edge of the opening with the hinges.
    pub hinge: Hinge,
    /// Angle by which it is open, degrees; 0 is shut.
    pub open_deg: f64,
}

/// The edge of an opening that a door turns about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "plain words")]
pub enum Hinge {
    Left,
    Right,
}

impl Default for Rooms {
    fn default() -> Self {
        Self {
            format: FORMAT.into(),
            outlines: Vec::new(),
            walls: Vec::new(),
            openings: Vec::new(),
            slopes: Vec::new(),
            joints: Vec::new(),
            things: Vec::new(),
            fit: None,
        }
    }
}

impl Rooms {
    /// Checks the version, and that the lists refer to each other.
    ///
    /// # Errors
    /// The problem found, and what was expected.
    pub fn check(&self) -> Result<(), String> {
        if self.format != FORMAT {
            return Err(format!("found the format {:?}, expected {FORMAT:?}", self.format));
        }
        let short = self.outlines.iter().find(|room| room.polygon.len() < 3);
        if let Some(room) = short {
            return Err(format!("the polygon of {:?} has {} corners, expected at least 3", room.name, room.polygon.len()));
        }
        if let Some(wall) = self.walls.iter().find(|wall| wall.room >= self.outlines.len()) {
            return Err(format!("a wall is of room {}, but there are {}", wall.room, self.outlines.len()));
        }
        if let Some(slope) = self.slopes.iter().find(|slope| slope.room >= self.outlines.len()) {
            return Err(format!("a sloping ceiling is of room {}, but there are {}", slope.room, self.outlines.len()));
        }
        let is_wrong = |o: &&WallOpening| o.walls.is_empty() || o.walls.iter().any(|&wall| wall >= self.walls.len());
        if let Some(opening) = self.openings.iter().find(is_wrong) {
            return Err(format!("a {} is in walls {:?}, but there are {}", opening.kind.name(), opening.walls, self.walls.len()));
        }
        Ok(())
    }

    /// Adds a room and the faces of its walls, whose thickness and being outer walls are given edge by edge; gives its place.
    pub fn push_room(&mut self, room: RoomOutline, edges: &[(f64, bool)]) -> usize {
        let number = self.outlines.len();
        let corners = room.polygon.len();
        for (i, &(thickness_m, outer)) in edges.iter().enumerate().take(corners) {
            let (from, to) = (room.polygon[i], room.polygon[(i + 1) % corners]);
            // A quotient, not a product with the reciprocal: along an axis it is 1, not almost.
            let along = DVec2::from(to) - DVec2::from(from);
            let along = along / along.length().max(f64::MIN_POSITIVE);
            self.walls.push(WallFace {
                room: number,
                from,
                to,
                floor_z_m: room.floor_z_m,
                ceiling_z_m: room.ceiling_z_m,
                inward: along.perp().to_array(),
                thickness_m,
                outer,
            });
        }
        self.outlines.push(room);
        number
    }

    /// The rooms that an opening connects: one, or two.
    pub fn rooms_of<'a>(&'a self, opening: &'a WallOpening) -> impl Iterator<Item = usize> + 'a {
        opening.walls.iter().map(|&wall| self.walls[wall].room)
    }

    /// The room that contains a point: above its polygon, between floor and ceiling.
    pub fn room_at(&self, point: DVec3) -> Option<usize> {
        self.outlines.iter().position(|room| room.contains(point))
    }

    /// The room that a point is in or, in a wall or its openings, the one whose wall is nearest, up to `reach_m` away.
    pub fn room_near(&self, point: DVec3, reach_m: f64) -> Option<usize> {
        let within = |wall: &&WallFace| (0.0..=wall.length_m()).contains(&wall.along_m(point)) && wall.distance_m(point).abs() <= reach_m;
        let nearest = |a: &&WallFace, b: &&WallFace| a.distance_m(point).abs().total_cmp(&b.distance_m(point).abs());
        self.room_at(point).or_else(|| self.walls.iter().filter(within).min_by(nearest).map(|wall| wall.room))
    }
}

impl RoomOutline {
    /// Area of the floor.
    pub fn area_m2(&self) -> f64 {
        0.5 * self.edges().map(|(a, b)| a.perp_dot(b)).sum::<f64>()
    }

    /// Whether a point is within the room.
    pub fn contains(&self, point: DVec3) -> bool {
        (self.floor_z_m..=self.ceiling_z_m).contains(&point.z) && self.is_above(point.truncate())
    }

    /// Whether a point, seen from above, is in its outline or this near to it.
    pub fn reaches(&self, p: DVec2, near_m: f64) -> bool {
        let off = |(a, b): (DVec2, DVec2)| {
            let along = (b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE);
            (a + (b - a) * along.dot(p - a).clamp(0.0, 1.0)).distance(p)
        };
        self.is_above(p) || self.edges().any(|edge| off(edge) <= near_m)
    }

    fn is_above(&self, p: DVec2) -> bool {
        let crosses = |(a, b): &(DVec2, DVec2)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
        self.edges().filter(crosses).count() % 2 == 1
    }

    fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> {
        let corner = |i: usize| DVec2::from(self.polygon[i % self.polygon.len()]);
        (0..self.polygon.len()).map(move |i| (corner(i), corner(i + 1)))
    }
}

impl WallFace {
    /// Signed distance of a point from the face's plane, positive on the room's side.
    pub fn distance_m(&self, point: DVec3) -> f64 {
        (point.truncate() - DVec2::from(self.from)).dot(self.inward.into())
    }

    /// From one end to the other.
    pub fn length_m(&self) -> f64 {
        DVec2::from(self.from).distance(self.to.into())
    }

    /// A point of the plane by the way along the face from its beginning, and its height.
    pub fn point(&self, along_m: f64, z_m: f64) -> DVec3 {
        (DVec2::from(self.from) + self.direction() * along_m).extend(z_m)
    }

    /// Distance along the face from its start to the foot of a point; [`WallFace::point`] is the inverse.
    pub fn along_m(&self, point: DVec3) -> f64 {
        (point.truncate() - DVec2::from(self.from)).dot(self.direction())
    }

    /// Unit vector from its beginning to its end.
    fn direction(&self) -> DVec2 {
        (DVec2::from(self.to) - DVec2::from(self.from)).normalize_or_zero()
    }
}

impl WallOpening {
    /// The middle of its rectangle on the first face.
    pub fn center(&self) -> DVec3 {
        self.corners.iter().map(|&corner| DVec3::from(corner)).sum::<DVec3>() / 4.0
    }

    /// Width and height.
    pub fn size_m(&self) -> [f64; 2] {
        let [a, b, c, _] = self.corners.map(DVec3::from);
        [a.distance(b), b.distance(c)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn l_shaped() -> Rooms {
        let polygon = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let room = RoomOutline { name: "hall_1".into(), kind: "hall".into(), polygon, floor_z_m: 0.0, ceiling_z_m: 2.5 };
        let mut rooms = Rooms::default();
        rooms.push_room(room, &[(0.1, true); 6]);
        rooms
    }

    #[test]
    fn points_are_in_the_room_within_its_outline_and_height() {
        let rooms = l_shaped();
        assert_eq!(rooms.outlines[0].area_m2(), 6.0);
        for (point, inside) in [
            ([0.5, 2.0, 1.0], true),
            ([3.0, 0.5, 2.4], true),
            ([3.0, 2.0, 1.0], false),
            ([0.5, 2.0, 2.6], false),
            ([-0.1, 1.0, 1.0], false),
        ] {
            assert_eq!(rooms.room_at(point.into()), inside.then_some(0), "{point:?}");
        }
    }

    #[test]
    fn faces_look_into_the_room_and_measure_from_their_planes() {
        let rooms = l_shaped();
        let inside = DVec3::new(0.5, 0.5, 1.0);
        for wall in &rooms.walls {
            assert!(wall.distance_m(inside) > 0.0, "{wall:?}");
            assert!(wall.distance_m(wall.point(0.3 * wall.length_m(), 1.0)).abs() < 1e-12);
        }
        assert_eq!(rooms.walls[4].length_m(), 1.0);
    }

    #[test]
    fn it_survives_being_written_and_what_is_wrong_is_told() {
        let rooms = l_shaped();
        let text = serde_json::to_string(&rooms).unwrap();
        assert!(text.starts_with("{\"format\":\"enfilade layout 1\""), "{text}");
        assert_eq!(serde_json::from_str::<Rooms>(&text).unwrap(), rooms);
        assert_eq!(rooms.check(), Ok(()));
        let newer = Rooms { format: "enfilade layout 2".into(), ..rooms.clone() };
        assert_eq!(newer.check().unwrap_err(), "found the format \"enfilade layout 2\", expected \"enfilade layout 1\"");
        let opening = WallOpening { kind: OpeningKind::Window, walls: vec![6], corners: [[0.0; 3]; 4], leaf: None };
        let torn = Rooms { openings: vec![opening], ..rooms };
        assert_eq!(torn.check().unwrap_err(), "a window is in walls [6], but there are 6");
    }
}
