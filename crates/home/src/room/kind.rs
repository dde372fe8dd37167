//! The kinds of rooms, and what building practice asks of each.
//!
//! Widths and areas of bedrooms follow the Nationally Described Space Standard (England, 2015): a double room of at least 11.5 m² and
//! 2.75 m width, a single one of 7.5 m² and 2.15 m. The others follow the furniture plans of Neufert, *Architects' Data* (chapters on
//! living, kitchens and bathrooms): a row of units needs 1.2 m of floor before it, a bath 0.75 m, a toilet a room of at least
//! 0.9 m × 1.4 m. Habitable rooms have windows of at least an eighth of their floor (Musterbauordnung § 47).

use enfilade_options::words;
use serde::{Deserialize, Serialize};

words! {
    /// What a room is for.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    #[allow(missing_docs, reason = "plain words")]
    pub enum RoomKind {
        Living = "living",
        Kitchen = "kitchen",
        Dining = "dining",
        Bedroom = "bedroom",
        #[serde(rename = "childrens")]
        Children = "childrens",
        Study = "study",
        Bathroom = "bathroom",
        Toilet = "toilet",
        Hall = "hall",
        Laundry = "laundry",
    }
}

/// What a kind of room asks of its floor.
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

impl RoomKind {
    /// The kind of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// What it asks of its floor.
    pub fn norm(self) -> Norm {
        let norm = |area: [f32; 2], width: f32, aspect: f32, window: bool| Norm { area, width, aspect, window };
        match self {
            Self::Living => norm([18.0, 27.0], 3.6, 1.6, true),
            Self::Kitchen => norm([7.5, 12.0], 2.2, 1.8, true),
            Self::Dining => norm([9.0, 13.5], 2.7, 1.7, true),
            Self::Bedroom => norm([12.0, 16.5], 2.75, 1.6, true),
            Self::Children => norm([9.5, 13.5], 2.45, 1.7, true),
            Self::Study => norm([7.5, 11.5], 2.25, 1.8, true),
            Self::Bathroom => norm([4.6, 7.5], 1.75, 2.2, false),
            Self::Toilet => norm([1.6, 2.4], 0.95, 2.2, false),
            Self::Hall => norm([3.6, 9.5], 1.2, 7.0, false),
            Self::Laundry => norm([3.0, 5.0], 1.5, 2.2, false),
        }
    }

    /// Has water and tiles.
    pub fn wet(self) -> bool {
        matches!(self, Self::Bathroom | Self::Toilet | Self::Laundry)
    }

    /// One way into a room of this kind from a room of kind `from`: 0 is usual, 1 is done, from 5 on nobody would build it.
    pub fn access_from(self, from: Self) -> f32 {
        use RoomKind::{Bathroom, Bedroom, Dining, Hall, Kitchen, Laundry, Living, Toilet};
        match (self, from) {
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
