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
mod row;

use enfilade_furniture::RoomKind;

pub use row::{Blinds, Ceiling, Daylight, Fittings, Norm, Row, Shell, Ways, WindowWidth, Windows};

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
