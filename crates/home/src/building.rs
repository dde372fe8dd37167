//! The kinds of buildings, one row each: the rooms that they have, how these are laid out, how high and how bright they are, and what is
//! outside.

use crate::light::Outside;
use enfilade_furniture::RoomKind;
use enfilade_options::words;
use serde::{Deserialize, Serialize};

words! {
    /// A kind of building.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Building {
        /// A flat.
        #[default]
        Home = "home",
        /// Offices and meeting rooms along a corridor, or one open office.
        Office = "office",
        /// Classrooms along a corridor.
        School = "school",
        /// A shop.
        Shop = "shop",
        /// A café.
        Cafe = "cafe",
        /// A library or bookshop.
        Library = "library",
        /// A hotel room with its bathroom, or a reception.
        Hotel = "hotel",
        /// A gym.
        Gym = "gym",
        /// A workshop or storeroom.
        Workshop = "workshop",
    }
}

/// How rooms are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// A rectangle that is cut in two again and again.
    Slicing,
    /// Rooms on both sides of a corridor, if there is one; else as [`Layout::Slicing`].
    Corridor,
}

/// The row of a kind of building.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The kind.
    pub building: Building,
    /// Kinds of rooms that it has.
    pub kinds: &'static [RoomKind],
    /// Rooms where none are named: one of these lists, each equally often. Homes have the usual programmes of `room::kind`.
    pub programmes: &'static [&'static [RoomKind]],
    /// How rooms are laid out.
    pub layout: Layout,
    /// Heights of rooms: from and to, metres.
    pub height: [f32; 2],
    /// The building's light, where it differs from that of homes.
    pub light: Option<Light>,
}

/// The light of a building that is lit by day too.
#[derive(Clone, Copy, Debug)]
pub struct Light {
    /// Share of the lamps that are lit by day: one of these.
    pub by_day: &'static [f32],
    /// Illuminance of the walls by all lamps, kilo-lux. EN 12464-1 asks for 0.5 on desks and 0.3 in classrooms and shops; walls have half.
    pub lamps_klx: f32,
    /// What is outside: one of these.
    pub outside: &'static [Outside],
}

use RoomKind::{
    Bathroom, Bedroom, Bookshop, Cafe, Children, Classroom, ComputerLab, Corridor, Dining, Gym, Hall, HotelRoom, Kitchen, Laundry, Library,
    Living, Meeting, Office, OpenOffice, Reception, Shop, Storeroom, Study, Toilet, Workshop,
};

/// Lamps that are lit on most days.
const MOSTLY_LIT: &[f32] = &[1.0, 1.0, 1.0, 0.0];
const TOWN: &[Outside] = &[Outside::Street, Outside::Skyline, Outside::Suburb];

static ROWS: [Row; 9] = [
    Row {
        building: Building::Home,
        kinds: &[Living, Kitchen, Dining, Bedroom, Children, Study, Bathroom, Toilet, Hall, Laundry],
        programmes: &[],
        layout: Layout::Slicing,
        height: [2.5, 2.75],
        light: None,
    },
    Row {
        building: Building::Office,
        kinds: &[Office, OpenOffice, Meeting, Corridor, Reception, Toilet, Kitchen],
        programmes: &[
            &[Corridor, Office, Office, Office, Meeting],
            &[Corridor, Office, Office, Office, Office, Meeting, OpenOffice],
            &[OpenOffice],
            &[OpenOffice, Meeting],
            &[Corridor, OpenOffice, Office, Office, Reception],
        ],
        layout: Layout::Corridor,
        height: [2.6, 3.0],
        light: Some(Light { by_day: MOSTLY_LIT, lamps_klx: 0.26, outside: TOWN }),
    },
    Row {
        building: Building::School,
        kinds: &[Classroom, ComputerLab, Corridor, Library, Office, Meeting, Toilet],
        programmes: &[
            &[Corridor, Classroom, Classroom],
            &[Corridor, Classroom, ComputerLab],
            &[Corridor, Office, Office, Meeting, Library],
            &[Classroom],
            &[ComputerLab],
        ],
        layout: Layout::Corridor,
        height: [2.8, 3.3],
        light: Some(Light { by_day: MOSTLY_LIT, lamps_klx: 0.24, outside: &[Outside::Garden, Outside::Suburb, Outside::Street] }),
    },
    Row {
        building: Building::Shop,
        kinds: &[Shop, Bookshop, Office, Toilet, Corridor],
        programmes: &[&[Shop], &[Shop, Office], &[Bookshop]],
        layout: Layout::Slicing,
        height: [2.9, 3.5],
        light: Some(Light { by_day: &[1.0], lamps_klx: 0.25, outside: &[Outside::Street] }),
    },
    Row {
        building: Building::Cafe,
        kinds: &[Cafe, Toilet, Kitchen],
        programmes: &[&[Cafe], &[Cafe, Toilet]],
        layout: Layout::Slicing,
        height: [2.8, 3.5],
        light: Some(Light { by_day: &[1.0, 1.0, 0.4], lamps_klx: 0.09, outside: &[Outside::Street, Outside::Street, Outside::Garden] }),
    },
    Row {
        building: Building::Library,
        kinds: &[Library, Bookshop, Corridor, Office, Toilet],
        programmes: &[&[Library], &[Bookshop], &[Library, Office]],
        layout: Layout::Slicing,
        height: [2.8, 3.4],
        light: Some(Light { by_day: MOSTLY_LIT, lamps_klx: 0.2, outside: TOWN }),
    },
    Row {
        building: Building::Hotel,
        kinds: &[HotelRoom, Bathroom, Hall, Corridor, Reception],
        programmes: &[&[HotelRoom, Bathroom], &[HotelRoom, Bathroom, Hall], &[Reception]],
        layout: Layout::Slicing,
        height: [2.5, 2.8],
        light: Some(Light { by_day: &[0.0, 0.5, 1.0], lamps_klx: 0.09, outside: TOWN }),
    },
    Row {
        building: Building::Gym,
        kinds: &[Gym, Toilet, Reception],
        programmes: &[&[Gym]],
        layout: Layout::Slicing,
        height: [2.7, 3.4],
        light: Some(Light { by_day: MOSTLY_LIT, lamps_klx: 0.2, outside: TOWN }),
    },
    Row {
        building: Building::Workshop,
        kinds: &[Workshop, Storeroom, Office, Toilet, Corridor],
        programmes: &[&[Workshop], &[Storeroom], &[Workshop, Storeroom]],
        layout: Layout::Slicing,
        height: [2.6, 3.2],
        light: Some(Light { by_day: &[1.0, 1.0, 0.0], lamps_klx: 0.2, outside: &[Outside::Suburb, Outside::Street, Outside::Garden] }),
    },
];

impl Building {
    /// The row of the kind.
    pub fn row(self) -> &'static Row {
        ROWS.iter().find(|row| row.building == self).unwrap_or(&ROWS[0])
    }
}

impl Row {
    /// Whether the building has rooms of this kind.
    pub fn has(&self, kind: RoomKind) -> bool {
        self.kinds.contains(&kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_building_has_one_row_with_rooms_of_its_own() {
        for building in Building::ALL {
            let row = building.row();
            assert_eq!(row.building, building);
            assert!(row.programmes.iter().flat_map(|rooms| *rooms).all(|kind| row.has(*kind)), "{building:?}");
            assert_eq!(row.programmes.is_empty(), building == Building::Home);
        }
    }
}
