//! A room: its place in the home, its walls and what opens in them.

pub mod ceiling;
mod face;
mod footprint;
mod incline;
pub mod kind;
pub mod outline;
mod side;

use enfilade_furniture::{Leaf, RoomKind, WallOpening, pose};
use enfilade_math::{DAffine3, DVec2, Vec2, Vec3};
pub use face::{Back, Face, Wall};
pub use footprint::Footprint;
pub use incline::Incline;
use outline::Outline;
pub use side::Side;

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

/// A room between level floor and ceiling, whose outline is a simple polygon; under a roof parts of the ceiling slope.
#[derive(Clone, Debug)]
pub struct Room {
    /// The use of the room.
    pub kind: RoomKind,
    /// The middle of its floor in the home: of a rectangle, or of the widest part of another outline.
    pub center: Vec2,
    /// The middle of the rectangle along the axes around it.
    pub box_center: Vec2,
    /// Size of that rectangle, and the height.
    pub size: Vec3,
    /// Floor area, m².
    pub area: f32,
    /// Turn of the longest walls from the axes, radians.
    pub grain: f32,
    /// True for a rectangle along the axes whose walls have one neighbour, or none, each.
    pub rectangular: bool,
    /// The corners.
    pub outline: Outline,
    /// Walls of the room, counter-clockwise: one over each edge of the outline.
    pub faces: Vec<Face>,
    /// Thickness of walls between rooms.
    pub inner_wall: f32,
    /// Thickness of outer walls.
    pub outer_wall: f32,
    /// Doors, passages and windows.
    pub openings: Vec<Opening>,
    /// Sloping parts of the ceiling, each lower than the level one somewhere in the room.
    pub slopes: Vec<Incline>,
}

/// Width of a way's casing, and of the handle of an open leaf, metres.
const BESIDE_WAY: f32 = 0.08;
/// Free space that a way needs before it where no leaf swings.
pub const WAY_DEPTH: f32 = 0.65;

impl Room {
    /// A rectangular room around `center`, whose walls are outer walls of the home, or not, in the order of [`Side::ALL`].
    pub fn rectangle(kind: RoomKind, center: Vec2, size: Vec3, outer: [bool; 4], [inner_wall, outer_wall]: [f32; 2]) -> Self {
        let half = 0.5 * size.truncate().as_dvec2();
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let outline = Outline::new(corners.iter().map(|&c| center.as_dvec2() + half * DVec2::from(c)).collect());
        let face = |side: Side| {
            let (length, across) = if side.along().x == 0.0 { (size.y, size.x) } else { (size.x, size.y) };
            let outer = outer[side as usize];
            let thickness = if outer { outer_wall } else { inner_wall };
            Face {
                anchor: center,
                offset: 0.5 * across,
                inward: side.inward(),
                yaw: side.yaw(),
                length,
                across,
                opposite: side.turned(2).wall(),
                backs: vec![Back { x: [-0.5 * length, 0.5 * length], thickness, outer, beyond: None }],
            }
        };
        Self {
            kind,
            center,
            box_center: center,
            size,
            area: size.x * size.y,
            grain: 0.0,
            rectangular: true,
            outline,
            faces: Side::ALL.map(face).to_vec(),
            inner_wall,
            outer_wall,
            openings: Vec::new(),
            slopes: Vec::new(),
        }
    }

    /// A room over a simple counter-clockwise polygon; `backs` gives what is behind each of its edges, by their numbers.
    pub fn polygon(kind: RoomKind, outline: Outline, height: f32, thickness: [f32; 2], backs: impl Fn(usize) -> Vec<Back>) -> Self {
        let [low, high] = outline.bounds();
        let faces = (0..outline.count()).map(|i| Face::over(&outline, i, backs(i))).collect();
        let mut room = Self {
            kind,
            center: outline.middle(),
            box_center: 0.5 * (low + high),
            size: (high - low).extend(height),
            area: outline.area(),
            grain: 0.0,
            rectangular: false,
            outline,
            faces,
            inner_wall: thickness[0],
            outer_wall: thickness[1],
            openings: Vec::new(),
            slopes: Vec::new(),
        };
        room.grain = face::grain(&room.faces);
        room
    }

    /// Walls of the room, counter-clockwise.
    pub fn walls(&self) -> Vec<Wall> {
        (0..self.faces.len()).map(Wall).collect()
    }

    /// A wall.
    pub fn face(&self, wall: Wall) -> &Face {
        &self.faces[wall.0]
    }

    /// The walls that meet a wall at its ends: at its smallest x, and at its largest.
    pub fn beside(&self, wall: Wall) -> [Wall; 2] {
        let count = self.faces.len();
        [Wall((wall.0 + count - 1) % count), Wall((wall.0 + 1) % count)]
    }

    /// The angles in the room at the ends of a wall, radians, in the order of [`Room::beside`].
    pub fn angles(&self, wall: Wall) -> [f32; 2] {
        [self.outline.angle(wall.0), self.outline.angle(wall.0 + 1)]
    }

    /// Whether the wall at an end of a wall is at a right angle to it, inwards.
    pub fn is_square(&self, wall: Wall, end: usize) -> bool {
        (self.angles(wall)[end] - std::f32::consts::FRAC_PI_2).abs() < 0.01
    }

    /// Length of a wall.
    pub fn length(&self, wall: Wall) -> f32 {
        self.face(wall).length
    }

    /// Unit vector from a wall into the room.
    pub fn inward(&self, wall: Wall) -> Vec2 {
        self.face(wall).inward
    }

    /// Turn of a wall about the vertical, radians: 0 looks along +y.
    pub fn yaw(&self, wall: Wall) -> f32 {
        self.face(wall).yaw as f32
    }

    /// Thickness of the wall around an opening, from this room to the next or to the outside.
    pub fn thickness(&self, opening: &Opening) -> f32 {
        self.face(opening.wall).back(opening.center_x()).thickness
    }

    /// Whether the outside is behind an opening.
    pub fn is_outer(&self, opening: &Opening) -> bool {
        self.face(opening.wall).back(opening.center_x()).outer
    }

    /// Half the thickness of the walls between rooms: this room's part of them.
    pub fn inner_half(&self) -> f32 {
        0.5 * self.inner_wall
    }

    /// A wall's own space: origin on the floor at the middle of its inner face, x along it, y into the room.
    pub fn wall_pose(&self, wall: Wall) -> DAffine3 {
        let face = self.face(wall);
        let p = face.anchor - face.inward * face.offset;
        pose(f64::from(p.x), f64::from(p.y), 0.0, face.yaw)
    }

    /// An opening of the room in the form that its window or door needs.
    pub fn wall_opening(&self, opening: &Opening) -> WallOpening {
        let (pose, thickness) = (self.wall_pose(opening.wall), self.thickness(opening));
        WallOpening { wall: pose, x: opening.x, z: opening.z, thickness, outer: self.is_outer(opening) }
    }

    /// The point of the floor at `x` along a wall and `out` before it, in the home.
    pub fn before(&self, wall: Wall, x: f32, out: f32) -> Vec2 {
        let face = self.face(wall);
        face.anchor - face.inward * (face.offset - out) + face.along() * x
    }

    /// True for a point of the floor, or one no farther outside of it than `slack`; with a negative slack, for one that is this far from
    /// all walls.
    pub fn contains(&self, p: Vec2, slack: f32) -> bool {
        if self.outline.is_convex() {
            self.faces.iter().all(|face| -(p - face.anchor).dot(face.inward) <= face.offset + slack)
        } else {
            self.outline.depth(p) >= -slack
        }
    }

    /// True where a rectangle is in the room, `inset` metres away from all walls; with a negative inset it may reach so far into them.
    pub fn holds(&self, rectangle: &Footprint, inset: f32) -> bool {
        if self.outline.is_convex() {
            rectangle.corners().iter().all(|corner| self.contains(*corner, -inset))
        } else {
            self.contains(rectangle.center, 0.0) && self.faces.iter().all(|face| !face.line().meets(rectangle, inset))
        }
    }

    /// Distances of a point of the floor from the two walls nearest to it.
    pub fn to_walls(&self, p: Vec2) -> [f32; 2] {
        let mut all: Vec<f32> = self.outline.edges().map(|edge| outline::distance(edge, p)).collect();
        all.sort_by(f32::total_cmp);
        [all[0], all[1]]
    }

    /// Depths of the room before a wall, where another wall is parallel to it; what it has at least, where none is.
    pub fn depths(&self, wall: Wall) -> Vec<f32> {
        let face = self.face(wall);
        if self.rectangular {
            return vec![face.across];
        }
        let at = |k: i32| 0.11 * face.length * k as f32;
        let seen = [0, 1, -1, 2, -2, 3, -3, 4, -4].map(|k| self.outline.cast(self.before(wall, at(k), 0.0), face.inward));
        let parallel = seen.iter().flatten().filter(|(_, other)| self.faces[*other].inward.dot(face.inward) < -0.999);
        let mut depths: Vec<f32> = Vec::new();
        for (depth, _) in parallel {
            if !depths.iter().any(|known| (known - depth).abs() < 0.05) {
                depths.push(*depth);
            }
        }
        if depths.is_empty() {
            depths.extend(seen.iter().flatten().map(|(depth, _)| *depth).reduce(f32::min));
        }
        depths
    }

    /// Where lamps hang: in the middle, and in the middle of a second wide part of an outline that is not convex.
    pub fn middles(&self) -> Vec<Vec2> {
        let second = if self.outline.is_convex() { None } else { self.outline.second_middle(self.center) };
        std::iter::once(self.center).chain(second).collect()
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
        Footprint { center: self.before(way.wall, way.center_x(), 0.5 * depth), half, yaw: self.yaw(way.wall) }
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
