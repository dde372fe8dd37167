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
    /// On walls, its middle between two heights, for each 10 m² of floor.
    OnWalls([f32; 2]),
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
    things("meal", &["used_plate", "used_plate", "glass", "mug", "crockery", "cutlery"], At::On(TABLES), &[], [3.3, 7.5]),
    things("bottles", &["drink_bottle", "jar", "bread", "fruit_bowl"], At::On(TABLES), HOMELY, [0.75, 1.5]),
    things("snack", &["used_plate", "mug", "mug", "tumbler", "glass", "water_bottle"], At::On(LOW_TABLES), DWELLING, [2.1, 6.25]),
    things("pizza", &["pizza_box"], At::On(&["coffee_table", "dining_table", "worktop"]), &[], [0.08, 0.38]),
    things(
        "dishes",
        &["used_plate", "used_plate", "mug", "glass", "crockery", "cookware", "cutlery", "drink_bottle", "jar"],
        At::On(COUNTERS),
        &[Kitchen, Cafe],
        [3.3, 8.75],
    ),
    things("pots", &["cookware"], At::OnEach(&["hob"]), &[], [0.9, 2.0]),
    things("provisions", &["bread", "jar", "shopping_bag", "herbs", "drink_bottle"], At::On(COUNTERS), &[Kitchen], [0.6, 1.5]),
    things("cup at work", &["mug", "mug", "tumbler", "water_bottle"], At::On(DESKS), &[], [1.05, 2.75]),
    things("cup in a meeting", &["mug", "tumbler", "water_bottle"], At::On(&["conference_table"]), &[], [0.75, 1.75]),
    // Paper, books, post.
    things("post", &["post", "post", "magazines", "paper"], At::On(TABLES), HOMELY, [0.52, 1.5]),
    things("post on the way", &["post", "post", "handbag", "magazines"], At::On(SIDEBOARDS), HOMELY, [0.75, 2.0]),
    things("reading", &["open_book", "books", "magazines", "post"], At::On(LOW_TABLES), DWELLING, [1.35, 3.25]),
    things("papers at work", &["paper", "open_book", "post", "books", "crumpled_paper"], At::On(DESKS), &[], [1.95, 5.0]),
    things("papers in a meeting", &["paper", "laptop", "phone", "tablet"], At::On(&["conference_table"]), &[], [1.05, 2.25]),
    things("school things", &["open_book", "books", "paper", "paper", "water_bottle"], At::OnEach(&["student_desk"]), &[], [1.35, 3.0]),
    things(
        "books on the floor",
        &["books", "open_book", "magazines", "paper"],
        At::Beside(&["bed", "desk", "bookshelf"]),
        DWELLING,
        [0.45, 1.62],
    ),
    things("magazines on the floor", &["magazines", "books", "open_book"], At::Beside(SOFAS), &[], [0.38, 1.12]),
    things("missed the bin", &["crumpled_paper"], At::Beside(&["waste_bin"]), &[], [1.05, 3.12]),
    // Devices and cables.
    things("devices", &["phone", "loose_cable", "tablet", "remote_control"], At::On(LOW_TABLES), DWELLING, [1.35, 2.5]),
    things("devices at work", &["phone", "loose_cable", "loose_cable", "cable"], At::On(DESKS), &[], [0.9, 2.0]),
    things("chargers", &["loose_cable", "phone"], At::On(SIDEBOARDS), HOMELY, [0.45, 1.12]),
    things("power strips", &["power_strip", "loose_cable", "cable"], At::Under(&["desk"]), &[], [0.75, 1.5]),
    things("cables", &["loose_cable", "power_strip", "loose_cable"], At::Beside(&["tv_bench", "desk", "nightstand"]), &[], [0.45, 1.12]),
    // Bags, shoes, boxes.
    things("bag at work", &["backpack", "handbag", "shopping_bag"], At::Under(&["desk", "student_desk"]), &[], [0.38, 0.69]),
    things("bag beside a desk", &["backpack", "backpack", "handbag"], At::Beside(&["desk", "student_desk"]), WORKED_IN, [0.18, 0.44]),
    things("school bags", &["backpack"], At::Beside(&["student_desk"]), SCHOOL, [0.38, 0.75]),
    things("bags", &["backpack", "handbag", "shopping_bag", "shopping_bag", "suitcase"], At::AlongWalls, HOMELY, [0.8, 2.0]),
    things("bag on a seat", &["handbag", "backpack", "shopping_bag", "books", "post"], At::OnEach(SEATS), HOMELY, [0.18, 0.5]),
    things("bag in the café", &["handbag", "backpack"], At::OnEach(SEATS), &[Cafe, Meeting, Library, Reception], [0.12, 0.25]),
    things("shoes at the door", &["shoes"], At::AlongWalls, &[Hall], [3.6, 7.5]),
    things("shoes", &["shoes"], At::Beside(&["bed", "sofa", "armchair", "wardrobe"]), DWELLING, [0.52, 1.25]),
    things(
        "boxes",
        &["cardboard_box", "storage_box", "cardboard_box"],
        At::AlongWalls,
        &[Living, Bedroom, Children, Study, Hall, Laundry],
        [0.5, 1.6],
    ),
    things(
        "boxes at work",
        &["cardboard_box", "cardboard_box", "storage_box"],
        At::AlongWalls,
        &[Office, OpenOffice, Reception, Library],
        [0.18, 0.62],
    ),
    things("deliveries", &["cardboard_box"], At::AlongWalls, &[Shop, Storeroom, Workshop, Corridor], [0.52, 1.5]),
    things("boxes on top", &["cardboard_box", "storage_box", "storage_basket"], At::Above(TALL), &[], [0.75, 2.0]),
    things(
        "on the floor of a workshop",
        &["loose_cable", "bucket", "power_strip", "water_bottle"],
        At::AlongWalls,
        &[Workshop],
        [0.9, 2.0],
    ),
    // Toys.
    things("toys", &["toy", "toy", "plush_toy", "books", "board_game"], At::Anywhere, &[Children], [3.9, 10.0]),
    things("toys of a child that plays here", &["toy", "plush_toy"], At::Anywhere, &[Living], [0.38, 1.5]),
    // Seats and beds.
    things(
        "on the sofa",
        &["open_book", "remote_control", "magazines", "tablet", "folded_blanket", "cushion", "phone"],
        At::OnEach(SOFAS),
        &[],
        [1.35, 3.25],
    ),
    things(
        "on the bed",
        &["open_book", "laptop", "phone", "clothes", "magazines", "plush_toy", "handbag"],
        At::OnEach(&["bed"]),
        &[],
        [0.9, 2.5],
    ),
    things(
        "folded clothes",
        &["clothes", "clothes", "towel"],
        At::OnEach(&["dresser", "armchair", "bench", "washing_machine"]),
        &[Bedroom, Children, Laundry],
        [0.38, 1.0],
    ),
    things("cushion on the floor", &["cushion"], At::Beside(SOFAS), &[], [0.09, 0.5]),
    // Bathrooms.
    things(
        "toiletries",
        &["bottle", "bottle", "soap_dispenser", "toothbrush_mug", "towel"],
        At::OnEach(&["washbasin", "washing_machine"]),
        &[Bathroom, HotelRoom],
        [1.2, 3.25],
    ),
    things("toiletries on the floor", &["bottle", "magazines"], At::Beside(&["bathtub", "toilet"]), &[Bathroom, Toilet], [0.15, 0.62]),
    // Walls.
    things(
        "posters",
        &["poster"],
        At::OnWalls([0.8, 2.0]),
        &[Living, Bedroom, Study, Hall, Kitchen, Office, OpenOffice, Corridor],
        [0.5, 1.6],
    ),
    things("posters of young people", &["poster"], At::OnWalls([0.9, 2.0]), &[Children, Classroom, ComputerLab, Workshop], [1.2, 3.0]),
    things("clothes on hooks", &["hung_clothes"], At::OnWalls([0.8, 2.0]), &[Hall, Bedroom, Children, Office, Study], [0.45, 1.4]),
    // Cloth.
    cloth("clothes over a chair", &[Textiles::Shirt, Textiles::Trousers, Textiles::Shirt], At::Over(BACKS), DRESSED_IN, [0.8, 1.4]),
    cloth("coat over a chair", &[Textiles::Shirt], At::Over(BACKS), &[Living, Dining, Study, Kitchen, Office, OpenOffice], [0.2, 0.45]),
    cloth(
        "coat over a chair in public",
        &[Textiles::Shirt],
        At::Over(BACKS),
        &[Classroom, ComputerLab, Cafe, Library, Meeting],
        [0.07, 0.16],
    ),
    cloth("clothes on the bed", &[Textiles::Shirt, Textiles::Trousers, Textiles::Towel], At::OnEach(&["bed"]), DRESSED_IN, [0.9, 2.2]),
    cloth(
        "clothes on the floor",
        &[Textiles::Shirt, Textiles::Trousers, Textiles::Shirt, Textiles::Towel],
        At::Anywhere,
        &[Bedroom, Children],
        [1.3, 3.4],
    ),
    cloth(
        "laundry",
        &[Textiles::Shirt, Textiles::Trousers, Textiles::Towel],
        At::Beside(&["laundry_basket", "washing_machine"]),
        &[],
        [0.6, 1.8],
    ),
    cloth("towel on the floor", &[Textiles::Towel], At::Anywhere, &[Bathroom, Gym], [0.8, 2.0]),
    cloth(
        "towel over an edge",
        &[Textiles::Towel],
        At::Over(&["bathtub", "washing_machine", "weight_bench", "exercise_bike"]),
        &[],
        [0.45, 0.85],
    ),
    cloth("blanket", &[Textiles::Blanket], At::OnEach(SOFAS), &[], [0.6, 0.95]),
    cloth(
        "blanket over an armchair",
        &[Textiles::Blanket, Textiles::Shirt],
        At::OnEach(&["armchair", "club_chair"]),
        DWELLING,
        [0.35, 0.75],
    ),
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
        assert_eq!([0.0, 0.25, 0.5, 0.75, 1.0].map(|lived_in| interpolated(lived_in, [2.0, 6.0])), [0.0, 1.0, 2.0, 4.0, 6.0]);
        assert!(ROWS.iter().all(|row| row.expected[0] > 0.0 && row.expected[1] > row.expected[0]));
    }
}
