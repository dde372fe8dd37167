//! Relation of a word to the things around it: a piece of some (*leg*, *drawer*), a place that contains them (*kitchen*), or a filler
//! (*Cube*, *left*, *wood*).
//!
//! `roles.csv` has the columns `word` and `role`. A word may be a phrase of up to three words, all written in the form of split names. A
//! role is `place`, `filler`, `side` (a filler that distinguishes things of one kind: *left*, *small*, *black*), `piece of anything`, or
//! `piece of` and the classes of the wholes.

use crate::lexicon::{Lexicon, MAX_PHRASE};
use crate::table::{TableError, class_number, read};
use crate::words::words;
use std::collections::HashMap;

const FILE: &str = "roles.csv";
const BUILTIN: &str = include_str!("../roles.csv");
/// Letters that the end of a compound needs to count, as in the word list.
const MIN_END: usize = 4;

/// The role of a name in a hierarchy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Role {
    /// The name of a thing of this class.
    Thing(i16),
    /// The name of a piece of things of these classes, or of anything where there are none; and its class when alone.
    Piece {
        /// Classes of the wholes; none where it may be of anything.
        wholes: Vec<i16>,
        /// Class of the piece by itself, if it has one.
        alone: Option<i16>,
    },
    /// A form, a material or a program's word, of an unknown thing.
    Filler,
    /// A side, a size or a colour: the same, but it may distinguish things of one kind.
    Side,
    /// A place or a collection, which gives no information about its contents.
    Place,
    /// Words of no list.
    Unlisted,
}

/// Words and phrases with their roles.
#[derive(Clone, Debug)]
pub(crate) struct Roles {
    listed: HashMap<String, Role>,
}

impl Roles {
    /// The list that comes with the crate.
    pub(crate) fn builtin() -> Result<Self, TableError> {
        Self::parse(BUILTIN, FILE)
    }

    /// Reads a list. `file` is its name in errors.
    ///
    /// # Errors
    /// The first row that is not a word and a role, is not written in the form of split names, or is a duplicate.
    fn parse(text: &str, file: &str) -> Result<Self, TableError> {
        let mut listed = HashMap::new();
        for (line, [word, role]) in read(text, file, ["word", "role"])? {
            let error = |problem: String| TableError { file: file.into(), line, problem };
            let written = words(&word).join(" ");
            if written != word || word.is_empty() || word.split(' ').count() > MAX_PHRASE {
                return Err(error(format!(
                    "{word:?} is no word or phrase as names are taken apart; expected up to {MAX_PHRASE} words like {written:?}"
                )));
            }
            if listed.insert(word.clone(), role_of(&role).map_err(error)?).is_some() {
                return Err(error(format!("{word:?} comes twice; remove one of the rows")));
            }
        }
        Ok(Self { listed })
    }

    /// The role of a name, by the last of its words that is no filler: the *leg* of `leg_02 wood`, the *table* of `table left`. A piece
    /// that names its whole is that whole: the *chair* of `chair leg`.
    pub(crate) fn of(&self, words: &[String], lexicon: &Lexicon) -> Role {
        let phrases = self.phrases(words, lexicon);
        let Some(last) = phrases.iter().rev().find(|role| !matches!(role, Role::Filler | Role::Side)) else {
            return if phrases.is_empty() { Role::Unlisted } else { Role::Filler };
        };
        let whole = phrases.iter().rev().find(|role| matches!(role, Role::Thing(_)));
        match (last, whole) {
            (Role::Piece { .. }, Some(whole)) => whole.clone(),
            _ => last.clone(),
        }
    }

    /// True for a name that states both the piece and its whole: `chair leg`, `table_wood`. Others of its kind may be of the same thing.
    pub(crate) fn is_piece_of_named(&self, words: &[String], lexicon: &Lexicon) -> bool {
        let phrases = self.phrases(words, lexicon);
        let piece = matches!(phrases.last(), Some(Role::Piece { .. } | Role::Filler));
        piece && phrases.iter().any(|role| matches!(role, Role::Thing(_)))
    }

    /// Whether the list has exactly this phrase.
    pub(crate) fn lists(&self, phrase: &str) -> bool {
        self.listed.contains_key(phrase)
    }

    /// The roles of a name's phrases in order, the longest at each place; words of no list are left out.
    fn phrases(&self, words: &[String], lexicon: &Lexicon) -> Vec<Role> {
        let mut found = Vec::new();
        let mut at = 0;
        while at < words.len() {
            let role = (1..=MAX_PHRASE.min(words.len() - at)).rev().find_map(|n| {
                let phrase = words[at..at + n].join(" ");
                Some((n, self.phrase(&phrase, lexicon)?))
            });
            let role = role.or_else(|| Some((1, self.of_compound(&words[at], lexicon)?)));
            at += role.as_ref().map_or(1, |(n, _)| *n);
            found.extend(role.map(|(_, role)| role));
        }
        found
    }

    /// The role of one phrase: from this list, else the thing that it is in the word list.
    fn phrase(&self, phrase: &str, lexicon: &Lexicon) -> Option<Role> {
        let thing = lexicon.class(phrase);
        match self.listed.get(phrase) {
            Some(Role::Piece { wholes, .. }) => Some(Role::Piece { wholes: wholes.clone(), alone: thing }),
            Some(role) => Some(role.clone()),
            None => thing.map(Role::Thing),
        }
    }

    /// The role of the longest end of a word that has one: `Schranktuer` is a *tuer*.
    fn of_compound(&self, word: &str, lexicon: &Lexicon) -> Option<Role> {
        let ends = word.char_indices().skip(1).map(|(i, _)| &word[i..]);
        ends.filter(|end| !end.is_ascii() || end.len() >= MIN_END).find_map(|end| self.phrase(end, lexicon))
    }
}

/// The role that a row states.
fn role_of(text: &str) -> Result<Role, String> {
    match text.strip_prefix("piece of ") {
        Some("anything") => Ok(Role::Piece { wholes: Vec::new(), alone: None }),
        Some(classes) => {
            let wholes = classes.split(' ').map(class_number).collect::<Result<_, _>>()?;
            Ok(Role::Piece { wholes, alone: None })
        }
        None if text == "place" => Ok(Role::Place),
        None if text == "filler" => Ok(Role::Filler),
        None if text == "side" => Ok(Role::Side),
        None => Err(format!("unknown role {text:?}; expected place, filler, side, piece of anything, or piece of and names of classes")),
    }
}

/// The halves of a name whose first half names a thing: what is around, and what is in it.
pub(crate) fn halves<'a>(words: &'a [String], lexicon: &Lexicon, roles: &Roles) -> Option<(&'a [String], &'a [String])> {
    let listed = |n: &usize| {
        roles.of(&words[words.len() - n..], lexicon) != Role::Unlisted && *n > 1 && {
            let phrase = words[words.len() - n..].join(" ");
            roles.lists(&phrase) || lexicon.class(&phrase).is_some()
        }
    };
    let longest = (1..words.len().min(MAX_PHRASE + 1)).rev().find(listed).unwrap_or(1);
    let (outer, inner) = words.split_at_checked(words.len().checked_sub(longest)?)?;
    matches!(roles.of(outer, lexicon), Role::Thing(_)).then_some((outer, inner))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn role(name: &str) -> Role {
        Roles::builtin().unwrap().of(&words(name), &Lexicon::builtin().unwrap())
    }

    fn piece(name: &str) -> bool {
        matches!(role(name), Role::Piece { .. })
    }

    #[test]
    fn names_are_things_pieces_fillers_or_places() {
        for name in ["legs", "leg_02_wood", "Door.001", "left drawer", "Griff", "Schranktür", "tiroir", "ручка", "seat cushion", "把手"]
        {
            assert!(piece(name), "{name}: {:?}", role(name));
        }
        for (name, class) in [("Chair 1", 5), ("chair leg", 5), ("table_left", 7), ("Nachttisch", 32), ("wine glass", 40), ("Bed.fbx", 4)] {
            assert_eq!(role(name), Role::Thing(class), "{name}");
        }
        for name in ["Cube.003", "left", "Cylinder Metal"] {
            assert_eq!(role(name), Role::Filler, "{name}");
        }
        for name in ["Living room", "Kitchen_grp", "Wohnzimmer", "chambre", "bed room 2", "гостиная", "House"] {
            assert_eq!(role(name), Role::Place, "{name}");
        }
        for name in ["", "Mesh.012", "xqzw", "Aalto_301"] {
            assert_eq!(role(name), Role::Unlisted, "{name}");
        }
    }

    #[test]
    fn a_piece_knows_its_wholes_and_what_it_is_alone() {
        let Role::Piece { wholes, alone } = role("door") else { panic!("{:?}", role("door")) };
        assert!(wholes.contains(&32) && !wholes.contains(&1) && alone == Some(8), "{wholes:?} {alone:?}");
        assert_eq!(role("leg"), Role::Piece { wholes: Vec::new(), alone: None });
    }

    #[test]
    fn damage_is_told_with_its_line() {
        let message = |text: &str| Roles::parse(text, "roles.csv").unwrap_err().to_string();
        assert_eq!(message("word,role\nleg,filler\nleg,place\n"), "roles.csv:3: \"leg\" comes twice; remove one of the rows");
        assert!(message("word,role\nLegs,filler\n").contains("roles.csv:2: \"Legs\" is no word"));
        assert!(message("word,role\nleg,arm\n").contains("roles.csv:2: unknown role \"arm\""));
        assert!(message("word,role\nleg,piece of divan\n").contains("unknown class \"divan\""));
    }
}
