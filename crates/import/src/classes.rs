//! From the names of categories in collections to classes of NYU40.
//!
//! `classes.csv` has the columns `category` and `class`. Its categories are those of HSSD-200's lexicon, Matterport3D's `mpcat40` and the
//! commonest of HM3D, the categories of 3D-FUTURE, the object types of AI2-THOR and the classes of Replica. The classes are those of the
//! column `nyu40` of Matterport3D's `mpcat40.tsv` where it has one class, and else those of this workspace's word list
//! (`crates/suggest/words.csv`), which a test compares. A name that is not in the table gives no class: the part keeps the name, for
//! `enfilade suggest` and for people.

use enfilade_scene::NYU40;
use std::collections::HashMap;
use std::sync::OnceLock;

const TABLE: &str = include_str!("classes.csv");

/// The class of NYU40 of a category, however it is written: `DiningTable`, `dining_table` and `Dining table` are one.
pub(crate) fn class_of(category: &str) -> Option<i16> {
    static CLASSES: OnceLock<HashMap<String, i16>> = OnceLock::new();
    let classes = CLASSES.get_or_init(|| rows().filter_map(|(category, class)| Some((letters(category), number(class)?))).collect());
    classes.get(&letters(category)).copied().or_else(|| number(&letters(category)))
}

/// The rows of the table.
fn rows() -> impl Iterator<Item = (&'static str, &'static str)> {
    TABLE.lines().skip(1).filter_map(|line| line.split_once(','))
}

/// The number of a class by its name in NYU40.
fn number(class: &str) -> Option<i16> {
    NYU40.iter().find(|c| c.name == class).map(|c| c.id)
}

/// The letters and digits of a name in lower case.
fn letters(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_suggest::{lexicon::Lexicon, words::words};

    #[test]
    fn categories_are_known_however_they_are_written() {
        for (category, class) in [
            ("chest_of_drawers", 17),
            ("DiningTable", 7),
            ("Lounge Chair / Cafe Chair / Office Chair", 5),
            ("tv-screen", 25),
            ("Refridgerator", -1),
            ("night stand", 32),
            ("", -1),
        ] {
            assert_eq!(class_of(category).unwrap_or(-1), class, "{category}");
        }
    }

    #[test]
    fn every_row_names_a_class_and_no_category_comes_twice() {
        let mut seen = std::collections::HashSet::new();
        for (category, class) in rows() {
            assert!(number(class).is_some(), "{category}: {class}");
            assert!(seen.insert(letters(category)), "{category} comes twice");
        }
    }

    /// If the word list has a category as one phrase, both give the same class, except where Matterport3D's own table differs.
    #[test]
    fn classes_are_those_of_the_word_list() {
        let known: HashMap<Vec<String>, i16> = Lexicon::builtin().unwrap().entries().into_iter().collect();
        let mut compared = 0;
        for (category, class) in rows() {
            if let Some(of_words) = known.get(&words(category)) {
                assert_eq!(number(class), Some(*of_words), "{category}");
                compared += 1;
            }
        }
        assert!(compared > 200, "{compared}");
    }
}
