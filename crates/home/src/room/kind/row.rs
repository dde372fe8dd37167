//! What a row of a kind of room says.

use enfilade_furniture::{Class, Finish, RoomKind};

/// The row of a kind of room.
pub struct Row {
    /// The kind.
    pub kind: RoomKind,
    /// What other programs call it: words in lower case without spaces, of which a name contains one.
    pub words: &'static [&'static str],
    /// The floor that it needs.
    pub norm: Norm,
    /// How it is entered, and what is entered from it.
    pub ways: Ways,
    /// Windows of the room.
    pub windows: Windows,
    /// The surfaces of its shell.
    pub shell: Shell,
    /// What belongs to it whoever uses it.
    pub fittings: Fittings,
    /// Number of start cameras.
    pub views: usize,
    /// A class that is more worth seeing here than elsewhere, and its weight in a view.
    pub prized: Option<(Class, f32)>,
    /// What the room is for: names, and the families of which it has one each.
    pub needs: &'static [(&'static str, &'static [&'static str])],
}

/// The floor that building practice asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Norm {
    /// Usual areas, m²: from and to.
    pub area: [f32; 2],
    /// Minimum clear width, metres.
    pub width: f32,
    /// Largest ratio of length to width.
    pub aspect: f32,
    /// Needs daylight.
    pub window: bool,
}

pub(super) const fn norm_of(area: [f32; 2], width: f32, aspect: f32, window: bool) -> Norm {
    Norm { area, width, aspect, window }
}

/// The ways into a room and through it. Costs of ways: 0 is usual, 1 is acceptable, 5 or more is not built in practice.
#[derive(Clone, Copy, Debug)]
pub struct Ways {
    /// A way, not a room: it is as narrow as it may be, its door is in the middle, and it costs nothing to go through it.
    pub is_way: bool,
    /// Cost of going through it into another room.
    pub through: f32,
    /// Costs of entering it from rooms of these kinds, where they differ from those of going through these.
    pub from: &'static [(RoomKind, f32)],
    /// Kinds of rooms to which its wall may be left open, with probabilities; the rows of both say the same.
    pub open_to: &'static [(RoomKind, f32)],
    /// The smallest has the entrance.
    pub entrance: u8,
    /// True if the door swings out, so that someone who has fallen behind it can be reached.
    pub swings_out: bool,
}

/// The windows of a kind of room.
#[derive(Clone, Copy, Debug)]
pub struct Windows {
    /// Heights of sills: from and to, metres.
    pub sill: [f32; 2],
    /// Height of sills in drawn plans that do not say it, metres.
    pub drawn_sill: f32,
    /// Probability that an outer wall has windows.
    pub often: f32,
    /// Widths.
    pub width: WindowWidth,
    /// What the plan does for its daylight.
    pub daylight: Daylight,
    /// Bays are built before them.
    pub bay: bool,
}

/// Widths of windows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindowWidth {
    /// As much as an eighth of the floor needs.
    Usual,
    /// The first one most of its wall.
    Wide,
    /// One sash.
    Small,
    /// All of every wall, with narrow pieces of wall between them.
    Ribbon,
}

/// What a plan does for the daylight of a room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Daylight {
    /// An outer wall of some length.
    Usual,
    /// A long outer wall, and more of them.
    Wide,
    /// The room leaves outer walls to others, at this cost for each metre.
    Shuns(f32),
}

/// The surfaces of a kind of room.
#[derive(Clone, Copy, Debug)]
pub struct Shell {
    /// Probability of a floor of boards.
    pub boards: f32,
    /// The floors otherwise, each equally often.
    pub coverings: &'static [Finish],
    /// Finish of the walls.
    pub walls: Finish,
    /// Walls are pale, whatever the palette of the building is.
    pub pale: bool,
    /// Probability that one wall differs.
    pub accent: f32,
    /// The ceiling.
    pub ceiling: Ceiling,
}

/// Ceilings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ceiling {
    /// Painted plaster.
    Plaster,
    /// Tiles of mineral fibre, 60 cm square, in a grid of white metal.
    Grid,
    /// Bare concrete.
    Concrete,
}

/// What belongs to a room whoever uses it.
#[derive(Clone, Copy, Debug)]
pub struct Fittings {
    /// Probability of curtains at a window.
    pub curtains: f32,
    /// Probability of blinds at all of its windows.
    pub blinds: f32,
    /// The blinds.
    pub blind: Blinds,
    /// Probability of things on a sill; `None` where the sill is a part of something else.
    pub on_sill: Option<f32>,
    /// Radiators are below its windows.
    pub radiators: bool,
    /// Sockets are along its walls.
    pub sockets: bool,
}

/// What blinds of a room are for, which decides their sorts and how far they are let down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blinds {
    /// Slats that let in as much sun as one likes.
    Slats,
    /// Cloth, so that people can sleep.
    Sleeping,
    /// Far down, since people undress.
    Private,
    /// Mostly metal slats.
    Plain,
}
