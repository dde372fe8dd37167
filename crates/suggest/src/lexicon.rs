//! The word list: what words of several languages mean in NYU40's terms, whether or not Hypersim has them.
//!
//! `words.csv` has the columns `word` and `class`. A word may be a phrase of up to three words, all written as names are taken apart.

use crate::table::{TableError, class_number, read};
use crate::words::words;
use std::collections::{BTreeMap, HashMap};

const FILE: &str = "words.csv";
const BUILTIN: &str = include_str!("../words.csv");
/// Words of the longest phrase.
pub(crate) const MAX_PHRASE: usize = 3;
/// Letters that the end of a compound needs to count: `Esstisch` is a *tisch*. Words of other scripts need only be in the list.
const MIN_END: usize = 4;

/// Words and phrases with their classes.
///
/// ```
/// use enfilade_suggest::{lexicon::Lexicon, words::words};
/// let lexicon = Lexicon::builtin()?;
/// assert_eq!(lexicon.meanings(&words("Gartentisch_02")), [7]); // table, by the end of the compound
/// # Ok::<(), enfilade_suggest::TableError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Lexicon {
    classes: HashMap<String, i16>,
}

impl Lexicon {
    /// The list that comes with the crate.
    ///
    /// # Errors
    /// When the list is damaged.
    pub fn builtin() -> Result<Self, TableError> {
        Self::parse(BUILTIN, FILE)
    }

    /// Reads a list. `file` is its name in errors.
    ///
    /// # Errors
    /// The first row that is not a word and a class, is not written in the form of split names, or is a duplicate.
    pub fn parse(text: &str, file: &str) -> Result<Self, TableError> {
        let mut classes = HashMap::new();
        for (line, [word, class]) in read(text, file, ["word", "class"])? {
            let error = |problem: String| TableError { file: file.into(), line, problem };
            let class = class_number(&class).map_err(error)?;
            let written = words(&word).join(" ");
            if written != word || word.split(' ').count() > MAX_PHRASE {
                return Err(error(format!(
                    "{word:?} is no word or phrase as names are taken apart; expected up to {MAX_PHRASE} words like {written:?}"
                )));
            }
            if classes.insert(word.clone(), class).is_some() {
                return Err(error(format!("{word:?} comes twice; remove one of the rows")));
            }
        }
        Ok(Self { classes })
    }

    /// The classes that the words of a name mean, in order; the longest phrase at each place counts, and where nothing else is known
    /// the end of a compound.
    pub fn meanings(&self, words: &[String]) -> Vec<i16> {
        let mut found = Vec::new();
        let mut at = 0;
        while at < words.len() {
            let lengths = (1..=MAX_PHRASE.min(words.len() - at)).rev();
            let phrase = lengths.clone().find_map(|n| Some((n, *self.classes.get(&words[at..at + n].join(" "))?)));
            let meaning = phrase.or_else(|| Some((1, self.of_compound(&words[at])?)));
            found.extend(meaning.map(|(_, class)| class));
            at += meaning.map_or(1, |(n, _)| n);
        }
        found
    }

    /// The class of a word or phrase that is in the list exactly.
    pub(crate) fn class(&self, phrase: &str) -> Option<i16> {
        self.classes.get(phrase).copied()
    }

    /// Every word or phrase with its class, sorted.
    pub fn entries(&self) -> Vec<(Vec<String>, i16)> {
        let sorted: BTreeMap<&String, i16> = self.classes.iter().map(|(word, &class)| (word, class)).collect();
        sorted.into_iter().map(|(word, class)| (words(word), class)).collect()
    }

    /// The class of the longest ending of a word that is in the list.
    fn of_compound(&self, word: &str) -> Option<i16> {
        let ends = word.char_indices().skip(1).map(|(i, _)| &word[i..]);
        let long_enough = |end: &&str| !end.is_ascii() || end.len() >= MIN_END;
        ends.filter(long_enough).find_map(|end| self.classes.get(end).copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meanings(name: &str) -> Vec<i16> {
        Lexicon::builtin().unwrap().meanings(&words(name))
    }

    #[test]
    fn words_of_several_languages_are_known() {
        for (name, class) in
            [("Couch", 6), ("Tisch_02", 7), ("lampa", 35), ("кресло", 5), ("Fauteuil", 5), ("椅子", 5), ("specchio", 19), ("okno", 9)]
        {
            assert_eq!(meanings(name), [class], "{name}");
        }
    }

    #[test]
    fn phrases_come_before_words_and_compounds_count_by_their_end() {
        assert_eq!(meanings("shower_curtain"), [28]);
        assert_eq!(meanings("Table Lamp 3"), [35]);
        assert_eq!(meanings("lamp table"), [35, 7]);
        assert_eq!(meanings("Gartentisch"), [7]);
        assert_eq!(meanings("Plane001"), Vec::<i16>::new());
    }

    #[test]
    fn damage_is_told_with_its_line() {
        let message = |text: &str| Lexicon::parse(text, "words.csv").unwrap_err().to_string();
        assert_eq!(message("word,class\nsofa,sofa\nsofa,bed\n"), "words.csv:3: \"sofa\" comes twice; remove one of the rows");
        assert!(message("word,class\nSofas,sofa\n").contains("words.csv:2: \"Sofas\" is no word"));
        assert!(message("word,class\nsofa,divan\n").contains("words.csv:2: unknown class \"divan\""));
        assert!(message("word\nsofa\n").contains("words.csv:1: expected the columns word, class"));
    }
}
