//! The table of what lies about where people live and work: a row for each kind of trace.
//!
//! A row names things, where they lie, in which rooms, and how many are expected for each measure of that place where
//! [`HomeConfig::lived_in`](crate::HomeConfig::lived_in) is ½ and 1; between 0, ½ and 1 the number is interpolated.

use super::textiles::Textiles;
use enfilade_furniture::RoomKind;
use enfilade_furniture::RoomKind::{
    Bathroom, Bedroom, Cafe, Children, Classroom, ComputerLab, Corridor, Dining, Gym, Hall, HotelRoom, Kitchen, Laundry, Library, Living,
    Meeting, Office, OpenOffice, Reception, Shop, Storeroom, Study, Toilet, Workshop,
};

/// A kind of trace that people leave.
#[derive(Debug)]
pub struct Row {
    /// Name of the row, which chooses its random numbers.
    pub name: &'static str,
    /// What lies there.
    pub what: What,
    /// Where it lies.
    pub at: At,
    /// The rooms; all where it is empty.
    pub rooms: &'static [RoomKind],
    /// Expected number for each measure of the place at ½ and at 1.
    pub expected: [f32; 2],
}

/// What lies about.
#[derive(Clone, Copy, Debug)]
pub enum What {
    /// One of these families, each equally likely; named twice, a family is twice as likely.
    Things(&'static [&'static str]),
    /// Cloth of one of these sorts.
    Cloth(&'static [Textiles]),
}

/// Where it lies.
#[derive(Clone, Copy, Debug)]
pub enum At {
    /// On a piece of one of these families, for each square metre of its rectangle.
    On(&'static [&'static str]),
    /// On a piece of one of these families, for each piece.
    OnEach(&'static [&'static str]),
    /// On top of tall pieces, for each piece.
    Above(&'static [&'static str]),
    /// Over the back or the highest edge of a piece, for each piece.
    Over(&'static [&'static str]),
    /// On the floor under a piece, for each piece.
    Under(&'static [&'static str]),
    /// On the floor beside a piece, for each piece.
    Beside(&'static [&'static str]),
    /// On the floor along the walls, for each 10 m².
    AlongWalls,
    /// Anywhere on the floor, for each 10 m².
    Anywhere,
}

impl Row {
    /// True in rooms of this kind.
    pub fn is_in(&self, kind: RoomKind) -> bool {
        self.rooms.is_empty() || self.rooms.contains(&kind)
    }

    /// Expected number for each measure of the place.
    pub fn rate(&self, lived_in: f32) -> f32 {
        interpolated(lived_in, self.expected)
    }
}

/// The value between 0, without life, and the two values at ½ and at 1.
pub fn interpolated(lived_in: f32, [usual, most]: [f32; 2]) -> f32 {
    if lived_in < 0.5 { 2.0 * lived_in * usual } else { usual + (2.0 * lived_in - 1.0) * (most - usual) }
}

const fn things(name: &'static str, what: &'static [&'static str], at: At, rooms: &'static [RoomKind], expected: [f32; 2]) -> Row {
    Row { name, what: What::Things(what), at, rooms, expected }
}

const fn cloth(name: &'static str, what: &'static [Textiles], at: At, rooms: &'static [RoomKind], expected: [f32; 2]) -> Row {
    Row { name, what: What::Cloth(what), at, rooms, expected }
}

const TABLES: &[&str] = &["dining_table", "long_table", "bistro_table"];
const LOW_TABLES: &[&str] = &["coffee_table", "side_table", "nightstand", "pouf"];
const DESKS: &[&str] = &["desk", "workbench"];
const COUNTERS: &[&str] = &["worktop", "counter"];
const SIDEBOARDS: &[&str] =
    &["sideboard", "dresser", "console", "tv_bench", "dressing_table", "shoe_cabinet", "cube_shelf", "filing_cabinet"];
const SOFAS: &[&str] = &["sofa", "corner_sofa", "chesterfield", "day_bed"];
const SEATS: &[&str] = &[
    "chair",
    "armchair",
    "club_chair",
    "spindle_chair",
    "upholstered_chair",
    "shell_chair",
    "stacking_chair",
    "bench",
    "dining_bench",
    "office_chair",
];
const BACKS: &[&str] = &["chair", "spindle_chair", "upholstered_chair", "shell_chair", "office_chair", "stacking_chair", "armchair"];
const TALL: &[&str] = &["wardrobe", "refrigerator", "bookshelf", "office_cabinet", "binder_shelf"];
const DWELLING: &[RoomKind] = &[Living, Dining, Bedroom, Children, Study, HotelRoom];
const HOMELY: &[RoomKind] = &[Living, Dining, Kitchen, Bedroom, Children, Study, Hall];
const WORKED_IN: &[RoomKind] = &[Office, OpenOffice, Study, ComputerLab, Library, Reception, Meeting];
const SCHOOL: &[RoomKind] = &[Classroom, ComputerLab];
const DRESSED_IN: &[RoomKind] = &[Bedroom, Children, HotelRoom];

/// All rows.
pub static ROWS: &[Row] = &[
    // Meals and drinks.
    things("meal", &["used_plate", "used_plate", "glass", "mug", "crockery", "cutlery"], At::On(TABLES), &[], [2.2, 6.0]),
    things("bottles", &["drink_bottle", "jar", "bread", "fruit_bowl"], At::On(TABLES), HOMELY, [0.5, 1.2]),
    things("snack", &["used_plate", "mug", "mug", "tumbler", "glass", "water_bottle"], At::On(LOW_TABLES), DWELLING, [1.4, 5.0]),
    things("pizza", &["pizza_box"], At::On(&["coffee_table", "dining_table", "worktop"]), &[], [0.05, 0.3]),
    things(
        "dishes",
        &["used_plate", "used_plate", "mug", "glass", "crockery", "cookware", "cutlery", "drink_bottle", "jar"],
        At::On(COUNTERS),
        &[Kitchen, Cafe],
        [2.2, 7.0],
    ),
    things("pots", &["cookware"], At::OnEach(&["hob"]), &[], [0.6, 1.6]),
    things("provisions", &["bread", "jar", "shopping_bag", "herbs", "drink_bottle"], At::On(COUNTERS), &[Kitchen], [0.4, 1.2]),
    things("cup at work", &["mug", "mug", "tumbler", "water_bottle"], At::On(DESKS), &[], [0.7, 2.2]),
    things("cup in a meeting", &["mug", "tumbler", "water_bottle"], At::On(&["conference_table"]), &[], [0.5, 1.4]),
    // Paper, books, post.
    things("post", &["post", "post", "magazines", "paper"], At::On(TABLES), HOMELY, [0.35, 1.2]),
    things("post on the way", &["post", "post", "handbag", "magazines"], At::On(SIDEBOARDS), HOMELY, [0.5, 1.6]),
    things("reading", &["open_book", "books", "magazines", "post"], At::On(LOW_TABLES), DWELLING, [0.9, 2.6]),
    things("papers at work", &["paper", "open_book", "post", "books", "crumpled_paper"], At::On(DESKS), &[], [1.3, 4.0]),
    things("papers in a meeting", &["paper", "laptop", "phone", "tablet"], At::On(&["conference_table"]), &[], [0.7, 1.8]),
    things("school things", &["open_book", "books", "paper", "paper", "water_bottle"], At::OnEach(&["student_desk"]), &[], [0.9, 2.4]),
    things(
        "books on the floor",
        &["books", "open_book", "magazines", "paper"],
        At::Beside(&["bed", "desk", "bookshelf"]),
        DWELLING,
        [0.3, 1.3],
    ),
    things("magazines on the floor", &["magazines", "books", "open_book"], At::Beside(SOFAS), &[], [0.25, 0.9]),
    things("missed the bin", &["crumpled_paper"], At::Beside(&["waste_bin"]), &[], [0.7, 2.5]),
    // Devices and cables.
    things("devices", &["phone", "loose_cable", "tablet", "remote_control"], At::On(LOW_TABLES), DWELLING, [0.9, 2.0]),
    things("devices at work", &["phone", "loose_cable", "loose_cable", "cable"], At::On(DESKS), &[], [0.6, 1.6]),
    things("chargers", &["loose_cable", "phone"], At::On(SIDEBOARDS), HOMELY, [0.3, 0.9]),
    things("power strips", &["power_strip", "loose_cable", "cable"], At::Under(&["desk"]), &[], [0.5, 1.2]),
    things("cables", &["loose_cable", "power_strip", "loose_cable"], At::Beside(&["tv_bench", "desk", "nightstand"]), &[], [0.3, 0.9]),
    // Bags, shoes, boxes.
    things("bag at work", &["backpack", "handbag", "shopping_bag"], At::Under(&["desk", "student_desk"]), &[], [0.25, 0.55]),
    things("bag beside a desk", &["backpack", "backpack", "handbag"], At::Beside(&["desk", "student_desk"]), WORKED_IN, [0.12, 0.35]),
    things("school bags", &["backpack"], At::Beside(&["student_desk"]), SCHOOL, [0.25, 0.6]),
    things("bags", &["backpack", "handbag", "shopping_bag", "shopping_bag", "suitcase"], At::AlongWalls, HOMELY, [0.3, 1.1]),
    things("bag on a seat", &["handbag", "backpack", "shopping_bag", "books", "post"], At::OnEach(SEATS), HOMELY, [0.12, 0.4]),
    things("bag in the café", &["handbag", "backpack"], At::OnEach(SEATS), &[Cafe, Meeting, Library, Reception], [0.08, 0.2]),
    things("shoes at the door", &["shoes"], At::AlongWalls, &[Hall], [2.4, 6.0]),
    things("shoes", &["shoes"], At::Beside(&["bed", "sofa", "armchair", "wardrobe"]), DWELLING, [0.35, 1.0]),
    things(
        "boxes",
        &["cardboard_box", "storage_box", "cardboard_box"],
        At::AlongWalls,
        &[Living, Bedroom, Children, Study, Hall, Laundry],
        [0.12, 0.7],
    ),
    things(
        "boxes at work",
        &["cardboard_box", "cardboard_box", "storage_box"],
        At::AlongWalls,
        &[Office, OpenOffice, Reception, Library],
        [0.12, 0.5],
    ),
    things("deliveries", &["cardboard_box"], At::AlongWalls, &[Shop, Storeroom, Workshop, Corridor], [0.35, 1.2]),
    things("boxes on top", &["cardboard_box", "storage_box", "suitcase", "storage_basket"], At::Above(TALL), &[], [0.5, 1.6]),
    things(
        "on the floor of a workshop",
        &["loose_cable", "bucket", "power_strip", "water_bottle"],
        At::AlongWalls,
        &[Workshop],
        [0.6, 1.6],
    ),
    // Toys.
    things("toys", &["toy", "toy", "plush_toy", "books", "board_game"], At::Anywhere, &[Children], [2.6, 8.0]),
    things("toys of a child that plays here", &["toy", "plush_toy"], At::Anywhere, &[Living], [0.25, 1.2]),
    // Seats and beds.
    things(
        "on the sofa",
        &["open_book", "remote_control", "magazines", "tablet", "folded_blanket", "cushion", "phone"],
        At::OnEach(SOFAS),
        &[],
        [0.9, 2.6],
    ),
    things(
        "on the bed",
        &["open_book", "laptop", "phone", "clothes", "magazines", "plush_toy", "handbag"],
        At::OnEach(&["bed"]),
        &[],
        [0.6, 2.0],
    ),
    things(
        "folded clothes",
        &["clothes", "clothes", "towel"],
        At::OnEach(&["dresser", "armchair", "bench", "washing_machine"]),
        &[Bedroom, Children, Laundry],
        [0.25, 0.8],
    ),
    things("cushion on the floor", &["cushion"], At::Beside(SOFAS), &[], [0.06, 0.4]),
    // Bathrooms.
    things(
        "toiletries",
        &["bottle", "bottle", "soap_dispenser", "toothbrush_mug", "towel"],
        At::OnEach(&["washbasin", "washing_machine"]),
        &[Bathroom, HotelRoom],
        [0.8, 2.6],
    ),
    things("toiletries on the floor", &["bottle", "magazines"], At::Beside(&["bathtub", "toilet"]), &[Bathroom, Toilet], [0.1, 0.5]),
    // Cloth.
    cloth("clothes over a chair", &[Textiles::Shirt, Textiles::Trousers, Textiles::Shirt], At::Over(BACKS), DRESSED_IN, [0.6, 1.3]),
    cloth("coat over a chair", &[Textiles::Shirt], At::Over(BACKS), &[Living, Dining, Study, Kitchen, Office, OpenOffice], [0.13, 0.35]),
    cloth(
        "coat over a chair in public",
        &[Textiles::Shirt],
        At::Over(BACKS),
        &[Classroom, ComputerLab, Cafe, Library, Meeting],
        [0.07, 0.16],
    ),
    cloth("clothes on the bed", &[Textiles::Shirt, Textiles::Trousers, Textiles::Towel], At::OnEach(&["bed"]), DRESSED_IN, [0.45, 1.6]),
    cloth(
        "clothes on the floor",
        &[Textiles::Shirt, Textiles::Trousers, Textiles::Shirt, Textiles::Towel],
        At::Anywhere,
        &[Bedroom, Children],
        [0.6, 2.6],
    ),
    cloth(
        "laundry",
        &[Textiles::Shirt, Textiles::Trousers, Textiles::Towel],
        At::Beside(&["laundry_basket", "washing_machine"]),
        &[],
        [0.35, 1.4],
    ),
    cloth("towel on the floor", &[Textiles::Towel], At::Anywhere, &[Bathroom, Gym], [0.5, 1.6]),
    cloth(
        "towel over an edge",
        &[Textiles::Towel],
        At::Over(&["bathtub", "washing_machine", "weight_bench", "exercise_bike"]),
        &[],
        [0.3, 0.7],
    ),
    cloth("blanket", &[Textiles::Blanket], At::OnEach(SOFAS), &[], [0.4, 0.85]),
    cloth("blanket over an armchair", &[Textiles::Blanket, Textiles::Shirt], At::OnEach(&["armchair", "club_chair"]), DWELLING, [0.2, 0.6]),
];

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_furniture::{FAMILIES, left_thing};
    use enfilade_math::Rng;
    use std::collections::BTreeSet;

    #[test]
    fn rows_name_families_that_there_are_and_grow_with_life() {
        let names: BTreeSet<&str> = ROWS.iter().map(|row| row.name).collect();
        assert_eq!(names.len(), ROWS.len());
        for row in ROWS {
            if let What::Things(families) = row.what {
                assert!(families.iter().all(|family| left_thing(family, &mut Rng::new(1)).is_some()), "{}", row.name);
            }
            let (At::On(hosts) | At::OnEach(hosts) | At::Above(hosts) | At::Over(hosts) | At::Under(hosts) | At::Beside(hosts)) = row.at
            else {
                continue;
            };
            // Parts of fitted kitchens are objects of their own.
            let known = |host: &str| FAMILIES.iter().any(|family| family.name == host) || ["worktop", "hob"].contains(&host);
            assert!(hosts.iter().all(|host| known(host)), "{}", row.name);
        }
        let row = &ROWS[0];
        assert_eq!([0.0, 0.25, 0.5, 0.75, 1.0].map(|lived_in| row.rate(lived_in)), [0.0, 1.1, 2.2, 4.1, 6.0]);
        assert!(ROWS.iter().all(|row| row.expected[0] > 0.0 && row.expected[1] > row.expected[0]));
    }
}
