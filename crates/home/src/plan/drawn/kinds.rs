//! From what files call rooms to the kinds that are furnished.

use enfilade_furniture::RoomKind;
use enfilade_options::proposal;

/// Words of other programs, in lower case without spaces, and the kind whose furniture is meant; the first that a name contains counts.
const WORDS: [(&str, RoomKind); 52] = [
    ("livingdining", RoomKind::Living),
    ("livingkitchen", RoomKind::Living),
    ("living", RoomKind::Living),
    ("lounge", RoomKind::Living),
    ("wohn", RoomKind::Living),
    ("salon", RoomKind::Living),
    ("sejour", RoomKind::Living),
    ("diningkitchen", RoomKind::Kitchen),
    ("kitchen", RoomKind::Kitchen),
    ("kuche", RoomKind::Kitchen),
    ("kueche", RoomKind::Kitchen),
    ("küche", RoomKind::Kitchen),
    ("cuisine", RoomKind::Kitchen),
    ("dining", RoomKind::Dining),
    ("esszimmer", RoomKind::Dining),
    ("kids", RoomKind::Children),
    ("child", RoomKind::Children),
    ("kinder", RoomKind::Children),
    ("nanny", RoomKind::Bedroom),
    ("elderly", RoomKind::Bedroom),
    ("bedroom", RoomKind::Bedroom),
    ("schlaf", RoomKind::Bedroom),
    ("chambre", RoomKind::Bedroom),
    ("guestroom", RoomKind::Bedroom),
    ("bathroom", RoomKind::Bathroom),
    ("bath", RoomKind::Bathroom),
    ("shower", RoomKind::Bathroom),
    ("bad", RoomKind::Bathroom),
    ("salledebain", RoomKind::Bathroom),
    ("toilet", RoomKind::Toilet),
    ("wc", RoomKind::Toilet),
    ("washroom", RoomKind::Toilet),
    ("restroom", RoomKind::Toilet),
    ("laundry", RoomKind::Laundry),
    ("utility", RoomKind::Laundry),
    ("storage", RoomKind::Laundry),
    ("storeroom", RoomKind::Laundry),
    ("abstell", RoomKind::Laundry),
    ("study", RoomKind::Study),
    ("office", RoomKind::Study),
    ("library", RoomKind::Study),
    ("arbeits", RoomKind::Study),
    ("workroom", RoomKind::Study),
    ("bureau", RoomKind::Study),
    ("hall", RoomKind::Hall),
    ("corridor", RoomKind::Hall),
    ("entr", RoomKind::Hall),
    ("aisle", RoomKind::Hall),
    ("foyer", RoomKind::Hall),
    ("flur", RoomKind::Hall),
    ("diele", RoomKind::Hall),
    ("couloir", RoomKind::Hall),
];

/// The kind of this name; of our own names alone where `strict`, else by the words of other programs.
pub fn kind(word: &str, strict: bool) -> Option<RoomKind> {
    let plain: String = word.to_lowercase().chars().filter(|c| c.is_alphabetic()).collect();
    let guessed = || WORDS.iter().find(|(part, _)| plain.contains(part)).map(|(_, kind)| *kind);
    RoomKind::from_name(word).or_else(|| if strict { None } else { guessed() })
}

/// What is expected in place of an unknown kind, the nearest first.
pub fn expected(word: &str) -> String {
    proposal(word, &RoomKind::ALL.map(RoomKind::name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_other_programs_mean_kinds_and_ours_are_exact() {
        for (word, expected) in [
            ("LivingDiningRoom", RoomKind::Living),
            ("MasterBedroom", RoomKind::Bedroom),
            ("corridor", RoomKind::Hall),
            ("KidsRoom", RoomKind::Children),
            ("Master Bath", RoomKind::Bathroom),
            ("Küche", RoomKind::Kitchen),
        ] {
            assert_eq!(kind(word, false), Some(expected), "{word}");
            assert_eq!(kind(word, true), None, "{word}");
        }
        assert_eq!((kind("study", true), kind("balcony", false)), (Some(RoomKind::Study), None));
        assert!(expected("bedrom").starts_with("did you mean `bedroom`?"));
    }
}
