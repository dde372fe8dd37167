//! Words for things: nouns, articles, plurals, lists.

use enfilade_dataset::Classes;
use enfilade_label::class_name;

/// Families that are a part of the building or too small to be mentioned.
const UNSPOKEN: [&str; 8] = ["socket", "switch", "passage", "splashback", "cable", "curtain rod", "worktop", "napkin ring"];
/// Families for which people have another word.
const OTHER_WORDS: [(&str, &str); 15] = [
    ("tv bench", "TV bench"),
    ("built in microwave", "built-in microwave"),
    ("key board", "key rack"),
    ("player", "media player"),
    ("class board", "board"),
    ("student desk", "school desk"),
    ("stacking chair", "chair"),
    ("wall display", "display"),
    ("bottle fridge", "refrigerator"),
    ("book aisle", "bookshelf"),
    ("gondola", "goods shelf"),
    ("goods carton", "cartons"),
    ("goods tin", "tins"),
    ("goods bottle", "bottles"),
    ("goods bag", "bags"),
];
/// Words that are already plural.
const PLURAL: [&str; 21] = [
    "logs",
    "books",
    "magazines",
    "clothes",
    "shoes",
    "scales",
    "keys",
    "herbs",
    "bananas",
    "coat hooks",
    "blinds",
    "shelves",
    "curtains",
    "stairs",
    "binders",
    "lockers",
    "cups",
    "cartons",
    "tins",
    "bottles",
    "bags",
];
/// Words without a plural.
const MASS: [&str; 6] = ["bread", "paper", "toilet paper", "crumpled paper", "sheet music", "kitchen roll"];
/// Classes that do not tell what a thing is: otherstructure, otherfurniture, otherprop.
const VAGUE: [i16; 3] = [38, 39, 40];

/// The word for a family of generated things; empty for families that are never mentioned.
pub fn of_family(family: &str) -> String {
    let words = family.replace('_', " ");
    if UNSPOKEN.contains(&words.as_str()) || words.starts_with("skirting") {
        return String::new();
    }
    OTHER_WORDS.iter().find(|(family, _)| *family == words).map_or(words, |(_, word)| (*word).into())
}

/// The word for a class of NYU40; empty for vague classes.
pub fn of_class(semantic: i16) -> String {
    if semantic < 1 || VAGUE.contains(&semantic) {
        return String::new();
    }
    match class_name(semantic) {
        "floormat" => "rug".into(),
        "showercurtain" => "shower curtain".into(),
        word => word.into(),
    }
}

/// The word for a class of a user's own list; empty for things without a class.
pub fn of_own_class(classes: &Classes, semantic: i16) -> String {
    let name = classes.name(semantic);
    let is_listed = semantic >= 1 && name != semantic.to_string();
    if is_listed { name.replace('_', " ") } else { String::new() }
}

/// Whether two words can mean the same thing: a chair may be an office chair or an armchair.
pub fn may_be(a: &str, b: &str) -> bool {
    let is_kind = |kind: &str, of: &str| kind.strip_suffix(of).is_some_and(|rest| rest.is_empty() || rest.ends_with(' ') || rest == "arm");
    is_kind(a, b) || is_kind(b, a)
}

/// Whether none of these words can mean the same thing as this one.
pub fn is_alone<'n>(noun: &str, mut nouns: impl Iterator<Item = &'n str>) -> bool {
    nouns.all(|other| other == noun || !may_be(other, noun))
}

/// The verb that goes with a word.
pub fn are(noun: &str) -> &'static str {
    if is_plural(noun) { "are" } else { "is" }
}

/// Whether a word is used with "are".
pub fn is_plural(noun: &str) -> bool {
    PLURAL.contains(&noun)
}

/// Whether things of this name can be counted.
pub fn is_countable(noun: &str) -> bool {
    !is_plural(noun) && !MASS.contains(&noun)
}

/// "a sofa", "an armchair", "a blue sofa", "some books".
pub fn a(color: &str, noun: &str) -> String {
    let words = if color.is_empty() { noun.to_string() } else { format!("{color} {noun}") };
    // "a utensil jar": these begin with the sound of "you".
    let is_you = ["uni", "ute", "use"].iter().any(|begin| words.starts_with(begin));
    match (is_countable(noun), words.starts_with(['a', 'e', 'i', 'o', 'u']) && !is_you) {
        (false, _) => format!("some {words}"),
        (true, true) => format!("an {words}"),
        (true, false) => format!("a {words}"),
    }
}

/// The plural of a word.
pub fn plural(noun: &str) -> String {
    if !is_countable(noun) {
        return noun.to_string();
    }
    let stem = |end: &str| noun.strip_suffix(end);
    if let Some(stem) = stem("shelf") {
        return format!("{stem}shelves");
    }
    if let Some(stem) = stem("knife") {
        return format!("{stem}knives");
    }
    if noun == "person" {
        return "people".into();
    }
    if let Some(stem) = stem("mouse") {
        return format!("{stem}mice");
    }
    let before_y = stem("y").filter(|stem| !stem.ends_with(['a', 'e', 'i', 'o', 'u']));
    if let Some(stem) = before_y {
        return format!("{stem}ies");
    }
    let hisses = ["s", "x", "ch", "sh"].iter().any(|end| noun.ends_with(end));
    if hisses { format!("{noun}es") } else { format!("{noun}s") }
}

/// A small number in words.
pub fn number(n: usize) -> String {
    const WORDS: [&str; 11] = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"];
    WORDS.get(n).map_or_else(|| n.to_string(), ToString::to_string)
}

/// "a", "a and b", "a, b and c".
pub fn list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// A kind of room, with its article.
pub fn a_room(kind: &str) -> String {
    let words = match kind {
        "living" => "living room",
        "dining" => "dining room",
        "childrens" => "children's room",
        "laundry" => "laundry room",
        "toilet" => "small room",
        "open_office" => "open office",
        "meeting" => "meeting room",
        "computer_lab" => "computer room",
        "cafe" => "café",
        "hotel_room" => "hotel room",
        other => other,
    };
    a("", words)
}

/// With a capital at its beginning.
pub fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_as_people_write_them() {
        assert_eq!([of_family("coffee_table"), of_family("tv_bench")], ["coffee table", "TV bench"]);
        assert_eq!([a("", "unknown object"), plural("person")], ["an unknown object", "people"]);
        assert_eq!([of_family("skirting_bedroom"), of_family("socket"), of_class(40), of_class(-1)], [""; 4]);
        assert_eq!([of_class(20), of_class(6)], ["rug", "sofa"]);
        assert_eq!(
            [a("", "armchair"), a("orange", "sofa"), a("blue", "armchair"), a("", "books"), a("red", "paper")],
            ["an armchair", "an orange sofa", "a blue armchair", "some books", "some red paper"]
        );
        let plurals = ["chair", "bookshelf", "knife", "bench", "dish", "tray", "laundry", "books", "glass", "box"].map(plural);
        assert_eq!(plurals, ["chairs", "bookshelves", "knives", "benches", "dishes", "trays", "laundries", "books", "glasses", "boxes"]);
        assert_eq!(list(&["a".into(), "b".into(), "c".into()]), "a, b and c");
        assert_eq!(a_room("living"), "a living room");
        assert_eq!([number(2), number(12)], ["two", "12"]);
        assert_eq!(sentence("a sofa."), "A sofa.");
        assert_eq!(
            [a("", "utensil jar"), a("", "umbrella"), a("", "logs"), a("", "bread")],
            ["a utensil jar", "an umbrella", "some logs", "some bread"]
        );
        assert!(may_be("chair", "office chair") && may_be("armchair", "chair") && may_be("lamp", "lamp"));
        assert!(!may_be("table", "tablet") && !may_be("chair", "highchairs") && !may_be("bed", "daybed"));
    }
}
