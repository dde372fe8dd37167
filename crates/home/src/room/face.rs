//! The walls of a room: vertical rectangles over the edges of its outline.

use super::Footprint;
use super::outline::Outline;
use enfilade_math::Vec2;
use std::f32::consts::FRAC_PI_2;

/// A wall of a room, by its number: counter-clockwise, as the edges of the outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wall(pub usize);

/// A piece of a wall with one thing behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Back {
    /// From and to along the wall.
    pub x: [f32; 2],
    /// To the next room, or to the outside, metres.
    pub thickness: f32,
    /// Whether the outside is behind it.
    pub outer: bool,
    /// The room behind it whose wall is parallel, so that doors lead there; unknown for rectangles.
    pub beyond: Option<usize>,
}

/// The inner side of a wall. Its own x axis begins at its middle and points to the left for someone who faces it.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// A point before the middle of the wall: of rectangles the room's middle, so that opposite walls agree to the last bit.
    pub anchor: Vec2,
    /// Distance of the wall from there.
    pub offset: f32,
    /// Unit vector into the room.
    pub inward: Vec2,
    /// Rotation that takes +y to `inward`, radians.
    pub yaw: f64,
    /// From end to end, metres.
    pub length: f32,
    /// From its middle to the opposite wall, metres.
    pub across: f32,
    /// The wall that someone faces who leans on its middle.
    pub opposite: Wall,
    /// What is behind it, along x; never empty.
    pub backs: Vec<Back>,
}

impl Face {
    /// The wall over an edge of an outline.
    pub(super) fn over(outline: &Outline, edge: usize, backs: Vec<Back>) -> Self {
        let [from, to] = outline.edge(edge);
        let along = (to - from).normalize_or_zero();
        let (anchor, inward) = (0.5 * (from + to), along.perp());
        let (across, opposite) = outline.cast(anchor, inward).unwrap_or((0.0, edge));
        let yaw = f64::from(along.y).atan2(f64::from(along.x));
        Self { anchor, offset: 0.0, inward, yaw, length: from.distance(to), across, opposite: Wall(opposite), backs }
    }

    /// Unit vector along the wall: its own x axis.
    pub fn along(&self) -> Vec2 {
        Vec2::new(self.inward.y, -self.inward.x)
    }

    /// The piece of the wall at `x`.
    pub fn back(&self, x: f32) -> &Back {
        self.backs.iter().find(|back| x <= back.x[1]).unwrap_or(&self.backs[self.backs.len() - 1])
    }

    /// Whether the outside is behind all of it, or behind a part.
    pub fn has_outside(&self) -> bool {
        self.backs.iter().any(|back| back.outer)
    }

    /// The line on the floor as a rectangle without depth.
    pub fn line(&self) -> Footprint {
        let center = self.anchor - self.inward * self.offset;
        Footprint { center, half: Vec2::new(0.5 * self.length, 0.0), yaw: self.yaw as f32 }
    }
}

/// The turn between the axes and the direction that most metres of walls have, radians within ±π/4.
pub(super) fn grain(faces: &[Face]) -> f32 {
    let turn = |face: &Face| {
        let yaw = face.yaw as f32;
        yaw - FRAC_PI_2 * (yaw / FRAC_PI_2).round()
    };
    let along = |yaw: f32| faces.iter().filter(|face| (turn(face) - yaw).abs() < 0.02).map(|face| face.length).sum::<f32>();
    let best = faces.iter().map(turn).map(|yaw| (along(yaw), yaw)).reduce(|a, b| if b.0 > a.0 + 1e-3 { b } else { a });
    best.map_or(0.0, |(_, yaw)| if yaw.abs() < 1e-4 { 0.0 } else { yaw })
}
