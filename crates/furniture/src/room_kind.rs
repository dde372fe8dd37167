//! The kinds of rooms: the catalogue says in which of them people expect a thing.

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

impl RoomKind {
    /// The kind of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Has water and tiles.
    pub fn wet(self) -> bool {
        matches!(self, Self::Bathroom | Self::Toilet | Self::Laundry)
    }
}
