//! The features by which a name is judged: its words, their place, their beginnings and ends, pairs, and their classes in the word list.

use crate::lexicon::Lexicon;
use enfilade_scene::NYU40;
use std::collections::BTreeSet;

/// Letters of beginnings and ends of words.
const AFFIXES: [usize; 2] = [3, 5];

/// The features of a name's words, sorted, each once. None when there are no words.
///
/// `word chair` means a word anywhere, `last chair` the last one, `pair table lamp` two in a row, `starts cha` and `ends hair` parts of
/// words, `means chair` a class that the word list gives to one of the words, and `head chair` the last such class.
pub fn features(words: &[String], lexicon: &Lexicon) -> Vec<String> {
    let mut found = BTreeSet::new();
    for word in words {
        found.insert(format!("word {word}"));
        for length in AFFIXES {
            if let Some((end, _)) = word.char_indices().nth(length) {
                found.insert(format!("starts {}", &word[..end]));
                let start = word.char_indices().rev().nth(length - 1).map_or(0, |(i, _)| i);
                found.insert(format!("ends {}", &word[start..]));
            }
        }
    }
    found.extend(words.last().map(|word| format!("last {word}")));
    found.extend(words.windows(2).map(|pair| format!("pair {} {}", pair[0], pair[1])));
    let meanings = lexicon.meanings(words);
    let name = |class: i16| NYU40[class as usize - 1].name;
    found.extend(meanings.iter().map(|&class| format!("means {}", name(class))));
    found.extend(meanings.last().map(|&class| format!("head {}", name(class))));
    found.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words::words;

    #[test]
    fn a_name_has_the_features_of_its_words() {
        let found = features(&words("Esstisch_Lampe_01"), &Lexicon::builtin().unwrap());
        for feature in
            ["word esstisch", "last lampe", "pair esstisch lampe", "starts ess", "ends tisch", "means table", "means lamp", "head lamp"]
        {
            assert!(found.iter().any(|f| f == feature), "{feature}: {found:?}");
        }
        assert!(found.is_sorted() && !found.contains(&"head table".into()));
        assert!(features(&[], &Lexicon::builtin().unwrap()).is_empty());
    }
}
