//! The planes of rooms: floors, ceilings and faces of walls, numbered, and the plane that a point is on.

use crate::{CEILING, CeilingSlope, FLOOR, Rooms, WALL, WallFace};
use enfilade_math::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// Distance from a plane below which a surface counts as on it, metres: plaster, gaps between boards.
pub const PLANE_NEAR_M: f64 = 0.02;

/// The kind of a plane of a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "plain words")]
pub enum PlaneKind {
    Floor,
    Ceiling,
    Wall,
}

impl PlaneKind {
    /// Name of the kind in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Floor => "floor",
            Self::Ceiling => "ceiling",
            Self::Wall => "wall",
        }
    }

    /// The NYU40 class of surfaces on it.
    pub const fn class(self) -> i16 {
        match self {
            Self::Floor => FLOOR,
            Self::Ceiling => CEILING,
            Self::Wall => WALL,
        }
    }
}

/// A plane of a room: the points p with normal · p = offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoomPlane {
    /// Kind of the plane.
    pub kind: PlaneKind,
    /// The room that it bounds, by its place in `Rooms::outlines`.
    pub room: usize,
    /// The face of a wall, by its place in `Rooms::walls`.
    pub wall: Option<usize>,
    /// Unit normal, into the room.
    pub normal: DVec3,
    /// Distance from the origin along the normal, metres.
    pub offset_m: f64,
}

impl Rooms {
    /// All planes: floor and ceiling of each room, then the faces of walls, then the slopes of ceilings.
    pub fn planes(&self) -> Vec<RoomPlane> {
        let level = |(room, of): (usize, &crate::RoomOutline)| {
            let plane = |kind, normal: DVec3, z: f64| RoomPlane { kind, room, wall: None, normal, offset_m: normal.z * z };
            [plane(PlaneKind::Floor, DVec3::Z, of.floor_z_m), plane(PlaneKind::Ceiling, DVec3::NEG_Z, of.ceiling_z_m)]
        };
        let upright = |(i, wall): (usize, &WallFace)| {
            let inward = DVec2::from(wall.inward);
            let offset_m = inward.dot(wall.from.into());
            RoomPlane { kind: PlaneKind::Wall, room: wall.room, wall: Some(i), normal: inward.extend(0.0), offset_m }
        };
        let sloping = |of: &CeilingSlope| {
            let normal = of.slope.normal();
            let offset_m = normal.dot(DVec2::from(of.slope.from).extend(of.slope.low_z_m));
            RoomPlane { kind: PlaneKind::Ceiling, room: of.room, wall: None, normal, offset_m }
        };
        let (levels, walls) = (self.outlines.iter().enumerate().flat_map(level), self.walls.iter().enumerate().map(upright));
        levels.chain(walls).chain(self.slopes.iter().map(sloping)).collect()
    }

    /// The plane, by its place among [`Rooms::planes`], that a point of a surface of this class is on: within 2 cm of it and of its
    /// borders. Where walls and ceiling are labelled as one shell, a point on no wall may be on the ceiling. `None` for other classes and
    /// for points on no plane, such as the reveals of openings.
    pub fn plane_at(&self, class: i16, p: DVec3) -> Option<usize> {
        let nearest = |found: &mut dyn Iterator<Item = (usize, f64)>| {
            found.filter(|(_, off)| *off <= PLANE_NEAR_M).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
        };
        let level = |z: fn(&crate::RoomOutline) -> f64, second: usize| {
            let rooms = self.outlines.iter().enumerate().filter(|(_, room)| room.reaches(p.truncate(), PLANE_NEAR_M));
            nearest(&mut rooms.map(|(i, room)| (2 * i + second, (p.z - z(room)).abs())))
        };
        let ceiling = || {
            let first = 2 * self.outlines.len() + self.walls.len();
            let within = |of: &CeilingSlope| self.outlines[of.room].reaches(p.truncate(), PLANE_NEAR_M);
            let slopes = self.slopes.iter().enumerate().filter(|(_, of)| within(of));
            let sloping = nearest(&mut slopes.map(|(i, of)| (first + i, of.slope.distance_m(p).abs())));
            sloping.or_else(|| level(|room| room.ceiling_z_m, 1))
        };
        match class {
            FLOOR => level(|room| room.floor_z_m, 0),
            CEILING => ceiling(),
            WALL => {
                let first = 2 * self.outlines.len();
                let faces = self.walls.iter().enumerate().map(|(i, wall)| (first + i, wall.off_m(p)));
                nearest(&mut faces.into_iter()).or_else(ceiling)
            }
            _ => None,
        }
    }

    /// How far a point of a wall, floor or ceiling is from the nearest plane of its kind, metres; from the nearest face itself for walls,
    /// or a ceiling if that is nearer.
    /// `None` for other classes, and where there is no plane.
    pub fn off_m(&self, class: i16, p: DVec3) -> Option<f64> {
        let least = |found: &mut dyn Iterator<Item = f64>| found.min_by(f64::total_cmp);
        let slopes = self.slopes.iter().map(|of| of.slope.distance_m(p).abs());
        let mut ceilings = self.outlines.iter().map(|room| (p.z - room.ceiling_z_m).abs()).chain(slopes);
        match class {
            FLOOR => least(&mut self.outlines.iter().map(|room| (p.z - room.floor_z_m).abs())),
            CEILING => least(&mut ceilings),
            WALL => least(&mut self.walls.iter().map(|wall| wall.off_m(p)).chain(ceilings)),
            _ => None,
        }
    }
}

impl WallFace {
    /// The distance of a point from the rectangle of the face, metres.
    pub fn off_m(&self, p: DVec3) -> f64 {
        let beyond = |value: f64, high: f64| (value - high).max(-value).max(0.0);
        let aside = beyond(self.along_m(p), self.length_m());
        let above = beyond(p.z - self.floor_z_m, self.ceiling_z_m - self.floor_z_m);
        DVec3::new(self.distance_m(p), aside, above).length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RoomOutline;

    /// Two rooms side by side, with a wall of 20 cm between them.
    fn two_rooms() -> Rooms {
        let mut rooms = Rooms::default();
        for (x, ceiling_z_m) in [(0.0, 2.5), (4.2, 2.4)] {
            let polygon = vec![[x, 0.0], [x + 4.0, 0.0], [x + 4.0, 3.0], [x, 3.0]];
            let room = RoomOutline { name: "study_1".into(), kind: "study".into(), polygon, floor_z_m: 0.0, ceiling_z_m };
            rooms.push_room(room, &[(0.2, false); 4]);
        }
        rooms
    }

    #[test]
    fn points_on_planes_are_told_which_and_others_are_on_none() {
        let rooms = two_rooms();
        let planes = rooms.planes();
        assert_eq!(planes.len(), 2 * 2 + 8);
        for (class, p, kind, room) in [
            (FLOOR, [1.0, 1.0, 0.01], PlaneKind::Floor, 0),
            (FLOOR, [5.0, 1.0, 0.0], PlaneKind::Floor, 1),
            (CEILING, [5.0, 1.0, 2.4], PlaneKind::Ceiling, 1),
            (WALL, [4.0, 1.0, 1.0], PlaneKind::Wall, 0),
            (WALL, [4.19, 1.0, 1.0], PlaneKind::Wall, 1),
            (WALL, [1.0, 0.0, 2.51], PlaneKind::Wall, 0),
        ] {
            let plane = planes[rooms.plane_at(class, p.into()).unwrap_or_else(|| panic!("{class} {p:?}"))];
            assert_eq!((plane.kind, plane.room, plane.kind.class()), (kind, room, class));
            assert!((plane.normal.dot(p.into()) - plane.offset_m).abs() <= PLANE_NEAR_M, "{plane:?}");
            assert!(plane.normal.dot(DVec3::new(if room == 0 { 2.0 } else { 6.0 }, 1.5, 1.2)) > plane.offset_m, "into the room: {plane:?}");
        }
        // Under the door, in the wall, the wrong class, and another one.
        for (class, p) in [(FLOOR, [4.1, 1.0, 0.0]), (WALL, [4.1, 1.0, 1.0]), (CEILING, [1.0, 1.0, 0.0]), (5, [4.0, 1.0, 1.0])] {
            assert_eq!(rooms.plane_at(class, p.into()), None, "{class} {p:?}");
        }
    }

    #[test]
    fn slopes_are_the_last_planes() {
        let mut rooms = two_rooms();
        // Over the first room, from 1.5 m at x = 0.
        let slope = crate::Slope { from: [0.0, 3.0], to: [0.0, 0.0], low_z_m: 1.5, pitch_deg: 45.0 };
        rooms.slopes.push(CeilingSlope { room: 0, slope });
        let planes = rooms.planes();
        let on = DVec3::new(0.5, 1.0, 2.0);
        assert_eq!(rooms.plane_at(CEILING, on), Some(12));
        assert_eq!((planes[12].kind, planes[12].room), (PlaneKind::Ceiling, 0));
        assert!((planes[12].normal.dot(on) - planes[12].offset_m).abs() < 1e-12);
        assert!(planes[12].normal.dot(DVec3::new(2.0, 1.5, 1.2)) > planes[12].offset_m, "into the room");
        assert!(rooms.off_m(CEILING, on).unwrap() < 1e-12);
        // The level ceiling of the same room, and a point above the slope of the other.
        assert_eq!((rooms.plane_at(CEILING, DVec3::new(3.0, 1.0, 2.5)), rooms.plane_at(CEILING, on + 4.2 * DVec3::X)), (Some(1), None));
    }

    #[test]
    fn distances_are_to_the_nearest_of_a_kind() {
        let rooms = two_rooms();
        let off = |class, p: [f64; 3]| rooms.off_m(class, p.into());
        assert!((off(CEILING, [1.0, 1.0, 2.46]).unwrap() - 0.04).abs() < 1e-12);
        assert!((off(WALL, [-0.3, 3.4, 1.0]).unwrap() - 0.5).abs() < 1e-12);
        assert_eq!((off(5, [0.0; 3]), Rooms::default().off_m(WALL, DVec3::ZERO)), (None, None));
    }
}
