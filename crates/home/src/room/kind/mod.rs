//! The kinds of rooms, one row each: what building practice asks of them, and how they are entered, lit and finished. `rooms` furnishes
//! them.
//!
//! Widths and areas of bedrooms follow the Nationally Described Space Standard (England, 2015): a double room of at least 11.5 m² and
//! 2.75 m width, a single one of 7.5 m² and 2.15 m. The others follow the furniture plans of Neufert, *Architects' Data* (chapters on
//! living, kitchens and bathrooms): a row of units needs 1.2 m of floor before it, a bath 0.75 m, a toilet a room of at least
//! 0.9 m × 1.4 m. Habitable rooms have windows of at least an eighth of their floor (Musterbauordnung § 47). Rooms of other buildings follow
//! the same book: 9 to 15 m² for an office with one desk, 8 to 12 m² a person in an open office, 2 m² a pupil in a classroom.

mod homes;
mod public;

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
    /// Its windows.
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

const fn norm_of(area: [f32; 2], width: f32, aspect: f32, window: bool) -> Norm {
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
    /// Its door swings out, so that someone who has fallen behind it can be reached.
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
    /// It leaves outer walls to others, at this cost for each metre.
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

/// The row of a kind.
pub fn row(kind: RoomKind) -> &'static Row {
    rows().find(|row| row.kind == kind).unwrap_or(&homes::ROWS[0])
}

/// All rows.
pub fn rows() -> impl Iterator<Item = &'static Row> {
    homes::ROWS.iter().chain(&public::ROWS)
}

/// The floor that building practice asks for in a kind of room.
pub fn norm(kind: RoomKind) -> Norm {
    row(kind).norm
}

/// The cost of a way into a room of kind `into` from a room of kind `from`, see [`Ways`].
pub fn access(into: RoomKind, from: RoomKind) -> f32 {
    let (entered, left) = (&row(into).ways, &row(from).ways);
    if entered.is_way || left.is_way {
        return 0.0;
    }
    entered.from.iter().find(|(kind, _)| *kind == from).map_or(left.through, |(_, cost)| *cost)
}

/// The programme of a home of `count` rooms, in the order in which people would ask for them.
pub fn usual_programme(count: usize) -> Vec<RoomKind> {
    use RoomKind::{Bathroom, Bedroom, Children, Dining, Hall, Kitchen, Living, Study};
    let [l, k, b, a, h] = [Living, Kitchen, Bedroom, Bathroom, Hall];
    match count {
        0 | 1 => vec![l],
        2 => vec![l, a],
        3 => vec![l, b, a],
        4 => vec![l, k, a, h],
        5 => vec![l, k, b, a, h],
        6 => vec![l, k, b, a, h, Study],
        7 => vec![l, k, Dining, b, Children, a, h],
        _ => vec![l, k, Dining, b, Children, Study, a, h],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_furniture::family_named;

    #[test]
    fn every_kind_has_one_row_whose_families_exist() {
        for kind in RoomKind::ALL {
            assert_eq!(rows().filter(|row| row.kind == kind).count(), 1, "{kind:?}");
            let needed = row(kind).needs.iter().flat_map(|(_, any)| *any);
            for family in needed.chain(kind.things()) {
                assert!(family_named(family).is_some(), "{kind:?}: {family}");
            }
        }
    }

    #[test]
    fn walls_that_may_be_open_are_so_for_both_rooms() {
        for row in rows() {
            for (other, often) in row.ways.open_to {
                let back = super::row(*other).ways.open_to.iter().find(|(kind, _)| *kind == row.kind);
                assert_eq!(back.map(|(_, often)| often), Some(often), "{:?} and {other:?}", row.kind);
            }
        }
    }

    #[test]
    fn ways_through_halls_cost_nothing_and_nobody_goes_through_bathrooms() {
        use RoomKind::{Bathroom, Bedroom, Hall, Kitchen, Laundry, Living, Toilet};
        let found = [(Bedroom, Hall), (Hall, Bathroom), (Kitchen, Living), (Toilet, Living), (Bathroom, Bedroom), (Laundry, Kitchen)];
        assert_eq!(found.map(|(into, from)| access(into, from)), [0.0, 0.0, 0.15, 1.6, 0.8, 0.3]);
        assert_eq!([(Bedroom, Kitchen), (Bedroom, Toilet), (Living, Bedroom)].map(|(into, from)| access(into, from)), [3.0, 9.0, 5.0]);
    }
}
