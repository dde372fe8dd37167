//! The families that a model may replace, by the English words of its name.

/// Phrases of a name, in singular and lower case, and the families that such a thing may replace; size decides among them. None for things
/// that do not belong in our homes, or are built in.
const PHRASES: &[(&str, &[&str])] = &[
    // Seats.
    ("sofa", SOFAS),
    ("couch", SOFAS),
    ("settee", SOFAS),
    ("loveseat", SOFAS),
    ("corner sofa", &["corner_sofa"]),
    ("armchair", EASY),
    ("arm chair", EASY),
    ("easy chair", EASY),
    ("lounge chair", EASY),
    ("relax chair", EASY),
    ("club chair", EASY),
    ("chair", CHAIRS),
    ("dining chair", CHAIRS),
    ("office chair", &["office_chair"]),
    ("desk chair", &["office_chair"]),
    ("swivel chair", &["office_chair"]),
    ("child chair", &["toy_chair"]),
    ("children chair", &["toy_chair"]),
    ("bar chair", &["bar_stool"]),
    ("bar stool", &["bar_stool"]),
    ("stool", &["bar_stool", "pouf", "side_table"]),
    ("pouf", &["pouf"]),
    ("puff", &["pouf"]),
    ("ottoman", &["pouf", "bench"]),
    ("footstool", &["pouf"]),
    ("bench", &["bench", "dining_bench"]),
    ("day bed", &["day_bed"]),
    // Tables.
    ("table", &["dining_table", "long_table", "coffee_table", "side_table"]),
    ("round table", &["dining_table", "coffee_table", "side_table"]),
    ("dining table", &["dining_table", "long_table"]),
    ("coffee table", &["coffee_table"]),
    ("side table", &["side_table"]),
    ("end table", &["side_table"]),
    ("bedside table", &["nightstand"]),
    ("nightstand", &["nightstand"]),
    ("night stand", &["nightstand"]),
    ("desk", &["desk"]),
    ("desk table", &["desk"]),
    ("writing table", &["desk"]),
    ("dressing table", &["dressing_table"]),
    ("console", &["console"]),
    ("console table", &["console"]),
    ("children table", &["play_table"]),
    // Beds.
    ("bed", &["bed"]),
    ("crib", &["crib"]),
    ("baby bed", &["crib"]),
    // Cupboards and shelves.
    ("wardrobe", &["wardrobe"]),
    ("closet", &["wardrobe"]),
    ("armoire", &["wardrobe"]),
    ("dresser", &["dresser"]),
    ("commode", &["dresser"]),
    ("chest of drawer", &["dresser"]),
    ("drawer cabinet", &["dresser", "nightstand"]),
    ("cabinet", CABINETS),
    ("cupboard", CABINETS),
    ("high cabinet", &["wardrobe", "glass_cabinet"]),
    ("sideboard", &["sideboard"]),
    ("buffet", &["sideboard"]),
    ("glass door cabinet", &["glass_cabinet"]),
    ("display cabinet", &["glass_cabinet"]),
    ("vitrine", &["glass_cabinet"]),
    ("filing cabinet", &["filing_cabinet"]),
    ("shoe cabinet", &["shoe_cabinet"]),
    ("bookcase", &["bookshelf"]),
    ("bookshelf", &["bookshelf"]),
    ("shelf", &["bookshelf", "cube_shelf", "wall_shelf"]),
    ("shelve", &["bookshelf", "cube_shelf", "wall_shelf"]),
    ("wall shelf", &["wall_shelf"]),
    // Bathroom, laundry.
    ("bath", &["bathtub"]),
    ("bathtub", &["bathtub"]),
    ("shower stall", &["shower"]),
    ("washbasin", &["washbasin"]),
    ("vanity", &["washbasin", "dressing_table"]),
    ("lavatory", &["washbasin"]),
    ("toilet", &["toilet"]),
    ("toilet unit", &["toilet"]),
    ("toilet brush", &["toilet_brush"]),
    ("toilet paper dispenser", &["paper_holder"]),
    ("towel rack", &["towel_rail"]),
    ("towel", &["towel"]),
    ("bathmat", &["bath_mat"]),
    ("washing machine", &["washing_machine"]),
    ("dryer machine", &["washing_machine"]),
    ("clothe horse", &["drying_rack"]),
    ("drying rack", &["drying_rack"]),
    ("ironing board", &["ironing_board"]),
    ("vacuum cleaner", &["vacuum_cleaner"]),
    ("bucket", &["bucket"]),
    ("clothe basket", &["laundry_basket"]),
    ("laundry basket", &["laundry_basket"]),
    ("basket", &["basket", "laundry_basket", "storage_basket"]),
    ("dustbin", BINS),
    ("trash can", BINS),
    ("trashcan", BINS),
    ("waste bin", BINS),
    ("recycling bin", BINS),
    // Kitchen and table.
    ("refrigerator", &["refrigerator"]),
    ("fridge", &["refrigerator"]),
    ("large fridge", &["refrigerator"]),
    ("toaster", &["kitchen_machine"]),
    ("blender", &["kitchen_machine"]),
    ("mixer", &["kitchen_machine"]),
    ("coffee maker", &["kitchen_machine"]),
    ("coffee machine", &["kitchen_machine"]),
    ("coffee brewer", &["kitchen_machine"]),
    ("kettle", &["kitchen_machine", "cookware"]),
    ("kitchen scale", &["kitchen_machine"]),
    ("pan", &["cookware"]),
    ("pot", &["cookware"]),
    ("chopping board", &["cutting_board"]),
    ("cutting board", &["cutting_board"]),
    ("knife stand", &["knife_block"]),
    ("knife block", &["knife_block"]),
    ("utensil pot", &["utensil_jar"]),
    ("spice rack", &["spice_rack"]),
    ("bread", &["bread"]),
    ("jar", &["jar", "vase"]),
    ("paper towel holder", &["kitchen_roll"]),
    ("plate", &["crockery"]),
    ("teapot", &["crockery"]),
    ("mug", &["mug"]),
    ("cup", &["mug"]),
    ("glass", &["glass"]),
    ("bottle", &["drink_bottle", "bottle"]),
    ("flacon", &["bottle"]),
    ("bowl", &["bowl"]),
    ("tray", &["tray"]),
    // Hall, bags, boxes, clothes.
    ("coat stand", &["coat_stand"]),
    ("clothe rack", &["coat_stand"]),
    ("wall hanger", &["coat_hooks"]),
    ("umbrella stand", &["umbrella_stand"]),
    ("backpack", &["backpack"]),
    ("handbag", &["handbag"]),
    ("briefcase", &["handbag", "suitcase"]),
    ("suitcase", &["suitcase"]),
    ("box", &["cardboard_box", "storage_box"]),
    ("cardboard box", &["cardboard_box", "storage_box"]),
    ("crate", &["cardboard_box", "storage_box"]),
    ("chest", &["toy_chest"]),
    ("shoe", &["shoes"]),
    ("sneaker", &["shoes"]),
    ("slipper", &["shoes"]),
    ("folded clothe", &["clothes"]),
    // Lamps.
    ("lamp", &["table_lamp", "floor_lamp", "desk_lamp", "pendant"]),
    ("little lamp", &["table_lamp", "desk_lamp"]),
    ("table lamp", &["table_lamp"]),
    ("vase lamp", &["table_lamp"]),
    ("desk lamp", &["desk_lamp"]),
    ("floor lamp", &["floor_lamp"]),
    ("ceiling lamp", &["ceiling_lamp"]),
    ("ceiling light", &["ceiling_lamp"]),
    ("pendant", &["pendant"]),
    ("pendant lamp", &["pendant"]),
    ("hanging light", &["pendant"]),
    ("chandelier", &["pendant"]),
    ("chandelier lamp", &["pendant"]),
    ("wall lamp", &["wall_lamp"]),
    ("wall light", &["wall_lamp"]),
    // Decoration.
    ("plant", &["plant", "foliage", "small_plant"]),
    ("potted plant", &["plant", "foliage", "small_plant"]),
    ("little plant", &["small_plant"]),
    ("hanging plant", &["hanging_plant"]),
    ("yucca", &["plant"]),
    ("ficus", &["plant", "foliage"]),
    ("spathiphyllum", &["plant", "small_plant"]),
    ("cactus", &["small_plant", "plant"]),
    ("orchid", &["small_plant"]),
    ("bonsai", &["small_plant"]),
    ("bonsai tree", &["small_plant"]),
    ("tulip", &["flower_vase"]),
    ("lily", &["flower_vase"]),
    ("flower", &["flower_vase"]),
    ("vase", &["vase"]),
    ("pottery", &["vase"]),
    ("mirror", &["mirror", "tall_mirror"]),
    ("painting", &["picture"]),
    ("picture", &["picture"]),
    ("picture frame", &["photo_frame", "picture"]),
    ("photo frame", &["photo_frame"]),
    ("clock", &["wall_clock"]),
    ("candle", &["candle"]),
    ("candlestick", &["candlestick"]),
    ("statue", &["figurine"]),
    ("figurine", &["figurine"]),
    ("cushion", &["cushion"]),
    ("pillow", &["cushion"]),
    ("book", &["books", "open_book"]),
    ("newspaper", &["magazines"]),
    ("magazine", &["magazines"]),
    ("chessboard", &["board_game"]),
    ("teddy bear", &["plush_toy"]),
    ("car model", &["toy"]),
    ("toy", &["toy"]),
    ("toy train", &["toy"]),
    ("wood toy", &["toy"]),
    ("globe", &["globe"]),
    ("guitar", &["guitar"]),
    ("electric guitar", &["guitar"]),
    // Devices.
    ("laptop", &["laptop"]),
    ("keyboard", &["keyboard"]),
    ("monitor", &["monitor"]),
    ("screen", &["monitor"]),
    ("printer", &["printer"]),
    ("phone", &["phone"]),
    ("mobile phone", &["phone"]),
    ("iphone", &["phone"]),
    ("tablet", &["tablet"]),
    ("remote control", &["remote_control"]),
    ("speaker", &["speaker", "floor_speaker"]),
    ("playstation", &["game_console"]),
    ("penbox", &["pen_cup"]),
    ("pen cup", &["pen_cup"]),
    ("whiteboard", &["whiteboard"]),
    ("white board", &["whiteboard"]),
    // Things of other places, and what is built in.
    ("pool table", &[]),
    ("football table", &[]),
    ("table tennis", &[]),
    ("table fan", &[]),
    ("technical table", &[]),
    ("bar table", &[]),
    ("cafe table", &[]),
    ("table on trestle", &["desk", "long_table"]),
    ("deck chair", &[]),
    ("beach chair", &[]),
    ("baby high chair", &[]),
    ("class seat", &[]),
    ("bunk bed", &[]),
    ("mezzanine bed", &[]),
    ("hospital bed", &[]),
    ("air mattress", &[]),
    ("upper cabinet", &[]),
    ("upper corner cabinet", &[]),
    ("upper shelve cabinet", &[]),
    ("lower cabinet", &[]),
    ("lower corner cabinet", &[]),
    ("sink cabinet", &[]),
    ("bird bath", &[]),
    ("corner bathtub", &[]),
    ("island bath", &[]),
    ("doll house", &[]),
    ("dog house", &[]),
    ("flower box", &[]),
    ("plant box", &[]),
    ("letter box", &[]),
    ("medicine box", &[]),
    ("baby bottle", &[]),
    ("glass door", &[]),
    ("glass table", &["dining_table", "coffee_table", "side_table", "long_table"]),
    ("box spring", &["bed"]),
    ("lamp post", &[]),
    ("lamppost", &[]),
    ("street lamp", &[]),
    ("outdoor lamp", &[]),
    ("camping lamp", &[]),
    ("garden", &[]),
    ("concrete bench", &[]),
    ("piano bench", &[]),
    ("shower curtain", &[]),
    ("screen door", &[]),
    ("toy chest", &["toy_chest"]),
    ("tea set", &[]),
];

/// Families that go by the same words.
const SOFAS: &[&str] = &["sofa", "chesterfield", "day_bed"];
const EASY: &[&str] = &["armchair", "club_chair"];
const CHAIRS: &[&str] = &["chair", "spindle_chair", "upholstered_chair", "shell_chair"];
const CABINETS: &[&str] = &["sideboard", "dresser", "wardrobe", "glass_cabinet", "shoe_cabinet"];
const BINS: &[&str] = &["waste_bin", "bin"];

/// Words after which a name describes what goes with the thing, not what it is.
const ASIDES: [&str; 4] = ["with", "for", "under", "by"];

/// The families that a thing of this name may replace; empty if no phrase is known.
///
/// Of the known phrases in it the longest counts, of equally long ones the last: the head of an English compound is at its end.
/// `sofa_03_1k`, `SofaLeather` and "Sofa 2 seats" are sofas; "Chair with cushion" is a chair.
pub fn families_of(name: &str) -> &'static [&'static str] {
    let words = words(name);
    let aside = words.iter().skip(1).position(|word| ASIDES.contains(&word.as_str())).map_or(words.len(), |at| at + 1);
    let words = &words[..aside];
    let mut best: (usize, &[&str]) = (0, &[]);
    for end in 1..=words.len() {
        for start in 0..end {
            let phrase = words[start..end].join(" ");
            let count = end - start;
            if let Some((_, families)) = PHRASES.iter().find(|(known, _)| *known == phrase).filter(|_| count >= best.0) {
                best = (count, families);
            }
        }
    }
    best.1
}

/// The words of a name in singular and lower case; case, digits and signs divide them.
fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = vec![String::new()];
    let mut lower = false;
    for c in name.chars() {
        if !c.is_alphabetic() || c.is_uppercase() && lower {
            words.push(String::new());
        }
        lower = c.is_lowercase();
        if let Some(word) = words.last_mut().filter(|_| c.is_alphabetic()) {
            word.extend(c.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words.iter().map(|word| singular(word)).collect()
}

fn singular(word: &str) -> String {
    let endings = [("sses", 2), ("xes", 2), ("ches", 2), ("shes", 2), ("ss", 0), ("us", 0), ("is", 0), ("s", 1)];
    let cut = endings.iter().find(|(ending, _)| word.len() > 3 && word.ends_with(ending)).map_or(0, |(_, cut)| *cut);
    word[..word.len() - cut].to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::family_named;
    use std::collections::BTreeSet;

    #[test]
    fn every_phrase_is_there_once_and_names_known_families() {
        let mut seen = BTreeSet::new();
        for (phrase, families) in PHRASES {
            assert!(seen.insert(phrase), "{phrase} is there twice");
            assert_eq!(words(phrase).join(" "), *phrase, "phrases are in singular and lower case");
            assert!(families.iter().all(|family| family_named(family).is_some()), "{phrase}: {families:?}");
        }
    }

    #[test]
    fn the_longest_and_last_phrase_counts() {
        for (name, first) in [
            ("sofa_03_1k", "sofa"),
            ("wooden_bookshelf_worn", "bookshelf"),
            ("WoodenTable02", "dining_table"),
            ("Coffee table", "coffee_table"),
            ("coffee_table_round_01", "coffee_table"),
            ("Chair with cushion", "chair"),
            ("Double-hung lamp", "table_lamp"),
            ("Glasses", "glass"),
            ("Wooden desk", "desk"),
            ("Pedestal vase lamp", "table_lamp"),
        ] {
            assert_eq!(families_of(name).first(), Some(&first), "{name}");
        }
        for name in ["Pool table", "tea_set_01", "Truck", "", "4711", "Upper cabinet"] {
            assert!(families_of(name).is_empty(), "{name}");
        }
    }
}
