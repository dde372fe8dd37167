//! From what files call rooms to the kinds that are furnished.

use crate::building::Building;
use crate::room::kind::{Row, rows};
use enfilade_furniture::RoomKind;
use enfilade_options::proposal;

/// The kind of this name; of our own names alone where `strict`, else by the words of other programs, those for rooms of the `building`
/// first.
pub fn kind(word: &str, building: Building, strict: bool) -> Option<RoomKind> {
    let plain: String = word.to_lowercase().chars().filter(|c| c.is_alphabetic()).collect();
    let of = |building: Building| rows().filter(move |row| building.row().has(row.kind));
    let is_called = |row: &&Row| row.words.iter().any(|part| plain.contains(part));
    let guessed = || of(building).chain(of(Building::Home)).find(is_called).map(|row| row.kind);
    // In files of other programs a library of a home is a study.
    let is_usual = |kind: &RoomKind| strict || building.row().has(*kind) || Building::Home.row().has(*kind);
    RoomKind::from_name(word).filter(is_usual).or_else(|| if strict { None } else { guessed() })
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
            assert_eq!(kind(word, Building::Home, false), Some(expected), "{word}");
            assert_eq!(kind(word, Building::Home, true), RoomKind::from_name(word), "{word}");
        }
        assert_eq!((kind("study", Building::Home, true), kind("balcony", Building::Home, false)), (Some(RoomKind::Study), None));
        let office = [("Corridor 2", RoomKind::Corridor), ("Conference", RoomKind::Meeting), ("WC", RoomKind::Toilet)];
        for (word, expected) in office {
            assert_eq!(kind(word, Building::Office, false), Some(expected), "{word}");
        }
        assert_eq!(["office", "storage"].map(|word| kind(word, Building::Home, false)), [RoomKind::Study, RoomKind::Laundry].map(Some));
        assert_eq!(kind("office", Building::Home, true), Some(RoomKind::Office));
        assert!(expected("bedrom").starts_with("did you mean `bedroom`?"));
    }
}
