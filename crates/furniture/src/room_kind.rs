//! The kinds of rooms, one row each: name, whether it has water and tiles, and what of the catalogue people have there.
//!
//! Rows of the catalogue name the rooms of homes that a family belongs to; rooms of other buildings name the families.

use enfilade_options::words;
use serde::{Deserialize, Serialize};

macro_rules! kinds {
    ($($kind:ident = $name:literal, wet: $wet:literal, things: [$($thing:literal),* $(,)?];)*) => {
        words! {
            /// What a room is for.
            #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
            #[allow(missing_docs, reason = "plain words")]
            pub enum RoomKind {
                $(#[serde(rename = $name)] $kind = $name,)*
            }
        }

        impl RoomKind {
            /// Has water and tiles.
            pub const fn wet(self) -> bool {
                match self {
                    $(Self::$kind => $wet,)*
                }
            }

            /// Names of families that people have in it, besides those whose own rows name it.
            pub const fn things(self) -> &'static [&'static str] {
                match self {
                    $(Self::$kind => &[$($thing),*],)*
                }
            }
        }
    };
}

kinds! {
    Living = "living", wet: false, things: [];
    Kitchen = "kitchen", wet: false, things: [];
    Dining = "dining", wet: false, things: [];
    Bedroom = "bedroom", wet: false, things: [];
    Children = "childrens", wet: false, things: [];
    Study = "study", wet: false, things: [];
    Bathroom = "bathroom", wet: true, things: [];
    Toilet = "toilet", wet: true, things: [];
    Hall = "hall", wet: false, things: [];
    Laundry = "laundry", wet: true, things: [];
    Office = "office", wet: false, things: [
        "books", "mug", "paper", "pen_cup", "phone", "cable", "tissue_box", "small_plant", "photo_frame", "open_book", "storage_box",
        "wall_clock", "cardboard_box", "coat_stand", "foliage", "backpack",
    ];
    OpenOffice = "open_office", wet: false, things: [
        "books", "mug", "paper", "pen_cup", "phone", "cable", "tissue_box", "small_plant", "photo_frame", "wall_clock", "cardboard_box",
        "backpack", "foliage",
    ];
    Meeting = "meeting", wet: false, things: ["paper", "mug", "laptop", "pen_cup", "tablet", "phone", "wall_clock"];
    Classroom = "classroom", wet: false, things: ["books", "paper", "pen_cup", "open_book", "wall_clock", "backpack"];
    ComputerLab = "computer_lab", wet: false, things: ["paper", "pen_cup", "cable", "mug", "wall_clock", "backpack"];
    Corridor = "corridor", wet: false, things: ["foliage"];
    Cafe = "cafe", wet: false, things: [
        "mug", "glass", "crockery", "flower_vase", "tray", "magazines", "small_plant", "phone", "wall_clock", "foliage",
    ];
    Library = "library", wet: false, things: ["books", "open_book", "paper", "pen_cup", "laptop", "wall_clock"];
    Bookshop = "bookshop", wet: false, things: [
        "books", "book_row", "open_book", "magazines", "small_plant", "paper", "wall_clock", "foliage",
    ];
    Shop = "shop", wet: false, things: ["cardboard_box", "paper", "pen_cup", "phone", "storage_box", "wall_clock"];
    Reception = "reception", wet: false, things: [
        "magazines", "phone", "paper", "pen_cup", "small_plant", "flower_vase", "wall_clock", "foliage",
    ];
    HotelRoom = "hotel_room", wet: false, things: [
        "phone", "glass", "tissue_box", "magazines", "suitcase", "tray", "drink_bottle", "tall_mirror",
    ];
    Gym = "gym", wet: false, things: ["towel", "drink_bottle", "wall_clock", "foliage"];
    Storeroom = "storeroom", wet: false, things: ["storage_box", "bucket", "cardboard_box", "storage_basket", "vacuum_cleaner"];
    Workshop = "workshop", wet: false, things: ["paper", "pen_cup", "storage_box", "cable", "mug", "wall_clock", "bucket"];
}

impl RoomKind {
    /// The kind of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}
