//! The requirements of building practice for each kind of room.
//!
//! Widths and areas of bedrooms follow the Nationally Described Space Standard (England, 2015): a double room of at least 11.5 m² and
//! 2.75 m width, a single one of 7.5 m² and 2.15 m. The others follow the furniture plans of Neufert, *Architects' Data* (chapters on
//! living, kitchens and bathrooms): a row of units needs 1.2 m of floor before it, a bath 0.75 m, a toilet a room of at least
//! 0.9 m × 1.4 m. Habitable rooms have windows of at least an eighth of their floor (Musterbauordnung § 47).

use enfilade_furniture::RoomKind;

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

/// The floor that building practice asks for in a kind of room.
pub fn norm(kind: RoomKind) -> Norm {
    let norm = |area: [f32; 2], width: f32, aspect: f32, window: bool| Norm { area, width, aspect, window };
    match kind {
        RoomKind::Living => norm([18.0, 27.0], 3.6, 1.6, true),
        RoomKind::Kitchen => norm([7.5, 12.0], 2.2, 1.8, true),
        RoomKind::Dining => norm([9.0, 13.5], 2.7, 1.7, true),
        RoomKind::Bedroom => norm([12.0, 16.5], 2.75, 1.6, true),
        RoomKind::Children => norm([9.5, 13.5], 2.45, 1.7, true),
        RoomKind::Study => norm([7.5, 11.5], 2.25, 1.8, true),
        RoomKind::Bathroom => norm([4.6, 7.5], 1.75, 2.2, false),
        RoomKind::Toilet => norm([1.6, 2.4], 0.95, 2.2, false),
        RoomKind::Hall => norm([3.6, 9.5], 1.2, 7.0, false),
        RoomKind::Laundry => norm([3.0, 5.0], 1.5, 2.2, false),
    }
}

/// The cost of a way into a room of kind `into` from a room of kind `from`: 0 is usual, 1 is acceptable, 5 or more is not built in
/// practice.
pub fn access(into: RoomKind, from: RoomKind) -> f32 {
    use RoomKind::{Bathroom, Bedroom, Dining, Hall, Kitchen, Laundry, Living, Toilet};
    match (into, from) {
        (_, Hall) | (Hall, _) => 0.0,
        (Kitchen | Dining | Living, Kitchen | Dining | Living) => 0.15,
        (Toilet | Bathroom | Laundry, Living | Dining) => 1.6,
        (_, Living) => 0.5,
        (Bathroom, Bedroom) => 0.8,
        (Laundry, Kitchen | Bathroom) => 0.3,
        (_, Dining) => 0.9,
        (_, Kitchen) => 3.0,
        (_, from) if from.wet() => 9.0,
        _ => 5.0,
    }
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
