//! A room: its place in the home, its walls and what opens in them.

mod footprint;
pub mod kind;

use enfilade_furniture::{Leaf, RoomKind, WallOpening, pose};
use enfilade_math::{DAffine3, Vec2, Vec3};
pub use footprint::Footprint;
use std::f64::consts::{FRAC_PI_2, PI};

/// A wall of a room, by its side. North is +y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Wall {
    South,
    East,
    North,
    West,
}

impl Wall {
    /// All, counter-clockwise from the south.
    pub const ALL: [Self; 4] = [Self::South, Self::East, Self::North, Self::West];

    /// The wall `steps` further, counter-clockwise.
    pub fn turned(self, steps: usize) -> Self {
        Self::ALL[(self as usize + steps) % 4]
    }

    /// Unit vector into the room.
    pub fn inward(self) -> Vec2 {
        [Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y, Vec2::X][self as usize]
    }

    /// Unit vector along the wall: a wall's own x axis, to the left for someone who faces it.
    pub fn along(self) -> Vec2 {
        let n = self.inward();
        Vec2::new(n.y, -n.x)
    }

    /// Rotation that takes +y to [`Wall::inward`].
    pub fn yaw(self) -> f64 {
        [0.0, FRAC_PI_2, PI, -FRAC_PI_2][self as usize]
    }
}

/// A hole in a wall, in the wall's own coordinates: x along it from its middle, z up from the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    /// The wall of the opening.
    pub wall: Wall,
    /// From and to along the wall.
    pub x: [f32; 2],
    /// From and to above the floor.
    pub z: [f32; 2],
    /// The window or door in it.
    pub filling: Filling,
}

/// The window or door in an opening.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filling {
    /// Sashes beside each other.
    Window {
        /// Number of sashes.
        sashes: usize,
    },
    /// A door whose leaf swings into this room.
    Door(Leaf),
    /// A door whose leaf swings into the room beyond.
    DoorBack,
    /// An open way, without a door.
    Passage {
        /// True in one of the two rooms that have the opening, which builds its lining.
        lined: bool,
    },
}

impl Opening {
    /// Width and height.
    pub fn size(&self) -> Vec2 {
        Vec2::new(self.x[1] - self.x[0], self.z[1] - self.z[0])
    }

    /// Middle along the wall.
    pub fn center_x(&self) -> f32 {
        0.5 * (self.x[0] + self.x[1])
    }

    /// True where people walk through.
    pub fn is_way(&self) -> bool {
        !matches!(self.filling, Filling::Window { .. })
    }
}

/// A rectangular room.
#[derive(Clone, Debug)]
pub struct Room {
    /// The use of the room.
    pub kind: RoomKind,
    /// The middle of its floor in the home.
    pub center: Vec2,
    /// Inner size: x, y, z.
    pub size: Vec3,
    /// Whether each of its walls is an outer wall of the home, in the order of [`Wall::ALL`].
    pub outer: [bool; 4],
    /// Thickness of walls between rooms.
    pub inner_wall: f32,
    /// Thickness of outer walls.
    pub outer_wall: f32,
    /// Doors, passages and windows.
    pub openings: Vec<Opening>,
}

/// Width of a way's casing, and of the handle of an open leaf, metres.
const BESIDE_WAY: f32 = 0.08;
/// Free space that a way needs before it where no leaf swings.
const WAY_DEPTH: f32 = 0.65;

impl Room {
    /// Inner length of a wall.
    pub fn length(&self, wall: Wall) -> f32 {
        if wall.along().x == 0.0 { self.size.y } else { self.size.x }
    }

    /// Thickness of a wall, from this room to the next or to the outside.
    pub fn thickness(&self, wall: Wall) -> f32 {
        if self.outer[wall as usize] { self.outer_wall } else { self.inner_wall }
    }

    /// Half the thickness of the walls between rooms: this room's part of them.
    pub fn inner_half(&self) -> f32 {
        0.5 * self.inner_wall
    }

    /// A wall's own space: origin on the floor at the middle of its inner face, x along it, y into the room.
    pub fn wall_pose(&self, wall: Wall) -> DAffine3 {
        let p = self.center - wall.inward() * 0.5 * self.size.truncate();
        pose(f64::from(p.x), f64::from(p.y), 0.0, wall.yaw())
    }

    /// An opening of the room in the form that its window or door needs.
    pub fn wall_opening(&self, opening: &Opening) -> WallOpening {
        let wall = opening.wall;
        let (pose, thickness) = (self.wall_pose(wall), self.thickness(wall));
        WallOpening { wall: pose, x: opening.x, z: opening.z, thickness, outer: self.outer[wall as usize] }
    }

    /// From a range of the home's x or y, whichever the wall runs along, to the wall's own x.
    pub fn along_wall(&self, wall: Wall, span: [f32; 2]) -> [f32; 2] {
        let along = wall.along();
        let x = span.map(|s| (s - self.center.dot(along.abs())) * (along.x + along.y));
        [x[0].min(x[1]), x[0].max(x[1])]
    }

    /// The point of the floor at `x` along a wall and `out` before it, in the home.
    pub fn before(&self, wall: Wall, x: f32, out: f32) -> Vec2 {
        self.center - wall.inward() * (0.5 * self.size.truncate() - out) + wall.along() * x
    }

    /// Windows of the room.
    pub fn windows(&self) -> impl Iterator<Item = &Opening> {
        self.openings.iter().filter(|o| !o.is_way())
    }

    /// Doors and passages of the room.
    pub fn ways(&self) -> impl Iterator<Item = &Opening> {
        self.openings.iter().filter(|o| o.is_way())
    }

    /// The floor before a way that must stay free: where the leaf swings and people step.
    pub fn way_zone(&self, way: &Opening) -> Footprint {
        let width = way.size().x;
        let depth = match way.filling {
            Filling::Door(_) => width.max(WAY_DEPTH),
            _ => WAY_DEPTH,
        };
        let half = Vec2::new(0.5 * width + BESIDE_WAY, 0.5 * depth);
        Footprint { center: self.before(way.wall, way.center_x(), 0.5 * depth), half, yaw: way.wall.yaw() as f32 }
    }

    /// Number of other ways that a way at `way` would conflict with; those that it would overlap on its wall count ten each.
    pub fn conflicts(&self, way: &Opening) -> f32 {
        let zone = self.way_zone(way);
        let swings = |o: &Opening| matches!(o.filling, Filling::Door(_));
        let on_wall = |o: &Opening| o.wall == way.wall && o.x[0] < way.x[1] + 0.15 && way.x[0] < o.x[1] + 0.15;
        let meets = |o: &&Opening| on_wall(o) || ((swings(o) || swings(way)) && self.way_zone(o).meets(&zone, 0.0));
        self.ways().filter(meets).map(|o| if on_wall(o) { 10.0 } else { 1.0 }).sum()
    }
}
