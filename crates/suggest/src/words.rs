//! Names taken apart: `AI53_005_armchairMetal_2917` is *armchair, metal*.
//!
//! Words end at anything that is not a letter, and at the capitals of `camelCase`. They are lower case; accents are dropped and Cyrillic
//! letters are written in Latin ones, so that one table serves *étagère*, *etagere*, *лампа* and *lampa*. Numbers and words that only name
//! the program or archive of a thing are left out.

/// Letters of a word that are looked at; longer words were not written by a person.
const MAX_LETTERS: usize = 32;
/// Words of a name that are looked at, from its end: a path ends with the thing itself.
const MAX_WORDS: usize = 12;

/// Words that name no thing: makers of models, programs, and kinds of node.
const EMPTY_WORDS: [&str; 42] = [
    "ae",
    "ai",
    "am",
    "arch",
    "archexterior",
    "archinterior",
    "archmodel",
    "arq",
    "brep",
    "component",
    "copy",
    "default",
    "editable",
    "element",
    "evermotion",
    "geo",
    "geom",
    "geometry",
    "group",
    "grp",
    "id",
    "inst",
    "instance",
    "interior",
    "item",
    "layer",
    "lod",
    "lowpoly",
    "material",
    "max",
    "mesh",
    "model",
    "mtl",
    "node",
    "obj",
    "object",
    "objarch",
    "part",
    "poly",
    "ref",
    "root",
    "scene",
];

/// The words of a name in order, without those that name no thing.
///
/// ```
/// use enfilade_suggest::words::words;
/// assert_eq!(words("AI53_005_armchairMetal_2917"), ["armchair", "metal"]);
/// assert_eq!(words("Étagères.001"), ["etagere"]);
/// ```
pub fn words(name: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut word = String::new();
    let letters: Vec<char> = name.chars().rev().take(MAX_LETTERS * MAX_WORDS).collect();
    let letters = composed(letters.into_iter().rev());
    for (i, &letter) in letters.iter().enumerate() {
        let before = i.checked_sub(1).map(|i| letters[i]);
        let after = letters.get(i + 1);
        // A capital begins a word after a small letter, and before one when it ends an acronym (`TVStand`).
        let begins = letter.is_uppercase()
            && before.is_some_and(|b| b.is_lowercase() || (b.is_uppercase() && after.is_some_and(|a| a.is_lowercase())));
        if begins || !letter.is_alphabetic() {
            keep(&mut found, &mut word);
        }
        if letter.is_alphabetic() {
            fold(letter, &mut word);
        }
    }
    keep(&mut found, &mut word);
    let surplus = found.len().saturating_sub(MAX_WORDS);
    found.drain(..surplus);
    found
}

/// True where the last word of a name is a plural: it names several things.
///
/// ```
/// use enfilade_suggest::words::is_plural;
/// assert!(is_plural("Dining_Chairs.001") && !is_plural("Glass") && !is_plural("Chair group"));
/// ```
pub fn is_plural(name: &str) -> bool {
    let last = words(name).pop().unwrap_or_default();
    let plurals = [format!("{last}s"), format!("{last}es"), format!("{}ves", last.strip_suffix('f').unwrap_or(&last))];
    let lower: String = name.to_lowercase();
    let mut runs = lower.split(|c: char| !c.is_alphabetic()).filter(|run| !run.is_empty());
    !last.is_empty() && runs.any(|run| plurals.iter().any(|plural| run.ends_with(plural.as_str())))
}

/// Ends a word.
fn keep(found: &mut Vec<String>, word: &mut String) {
    let text = singular(&std::mem::take(word));
    let letters = text.chars().count();
    let meant = letters > 1 || !text.is_ascii();
    if meant && letters <= MAX_LETTERS && !EMPTY_WORDS.contains(&text.as_str()) {
        found.push(text);
    }
}

/// The word without an English plural's ending: *chairs* is *chair*, *boxes* are *box*; but *glass* and *glasses* stay two things.
fn singular(word: &str) -> String {
    const IRREGULAR: [(&str, &str); 4] = [("shelves", "shelf"), ("knives", "knife"), ("leaves", "leaf"), ("loaves", "loaf")];
    if let Some((stem, single)) = IRREGULAR.iter().find_map(|(many, one)| Some((word.strip_suffix(many)?, one))) {
        return format!("{stem}{single}");
    }
    if let Some(stem) = word.strip_suffix("es").filter(|stem| ["x", "ch", "sh"].iter().any(|end| stem.ends_with(end))) {
        return stem.to_string();
    }
    let keeps = word.len() < 4 || ["ss", "us", "is", "as", "os", "sses"].iter().any(|end| word.ends_with(end));
    word.strip_suffix('s').filter(|_| !keeps).unwrap_or(word).to_string()
}

/// Letters from names whose accents are separate characters, as in file names of macOS, combined where [`fold`] distinguishes them, and
/// without other accents.
fn composed(letters: impl Iterator<Item = char>) -> Vec<char> {
    let mut composed: Vec<char> = Vec::new();
    for letter in letters {
        match (letter, composed.last_mut()) {
            ('\u{308}', Some(base)) => {
                let umlauts = [('a', 'ä'), ('A', 'Ä'), ('o', 'ö'), ('O', 'Ö'), ('u', 'ü'), ('U', 'Ü')];
                *base = umlauts.iter().find(|(plain, _)| plain == base).map_or(*base, |(_, umlaut)| *umlaut);
            }
            ('\u{306}', Some(base @ 'и')) => *base = 'й',
            ('\u{306}', Some(base @ 'И')) => *base = 'Й',
            ('\u{300}'..='\u{36f}', _) => {}
            _ => composed.push(letter),
        }
    }
    composed
}

/// Adds a letter in lower case, without its accent, in Latin script where we know how.
fn fold(letter: char, word: &mut String) {
    for c in letter.to_lowercase() {
        match c {
            'a'..='z' => word.push(c),
            'à' | 'á' | 'â' | 'ã' | 'å' | 'ā' | 'ă' | 'ą' => word.push('a'),
            'ä' | 'æ' => word.push_str("ae"),
            'ç' | 'ć' | 'č' => word.push('c'),
            'ď' | 'đ' => word.push('d'),
            'è' | 'é' | 'ê' | 'ë' | 'ē' | 'ę' | 'ě' | 'ė' => word.push('e'),
            'ğ' => word.push('g'),
            'ì' | 'í' | 'î' | 'ï' | 'ī' | 'ı' => word.push('i'),
            'ł' | 'ľ' => word.push('l'),
            'ñ' | 'ń' | 'ň' => word.push('n'),
            'ò' | 'ó' | 'ô' | 'õ' | 'ø' | 'ő' => word.push('o'),
            'ö' | 'œ' => word.push_str("oe"),
            'ř' => word.push('r'),
            'ś' | 'š' | 'ş' | 'ș' => word.push('s'),
            'ß' => word.push_str("ss"),
            'ť' | 'ț' => word.push('t'),
            'ù' | 'ú' | 'û' | 'ū' | 'ů' | 'ű' => word.push('u'),
            'ü' => word.push_str("ue"),
            'ý' | 'ÿ' => word.push('y'),
            'ź' | 'ż' | 'ž' => word.push('z'),
            _ => match cyrillic(c) {
                Some(text) => word.push_str(text),
                None => word.push(c),
            },
        }
    }
}

/// The usual transliteration of Russian and Ukrainian letters.
fn cyrillic(c: char) -> Option<&'static str> {
    const LETTERS: [&str; 32] = [
        "a", "b", "v", "g", "d", "e", "zh", "z", "i", "y", "k", "l", "m", "n", "o", "p", "r", "s", "t", "u", "f", "kh", "ts", "ch", "sh",
        "sch", "", "y", "", "e", "yu", "ya",
    ];
    match c {
        'а'..='я' => Some(LETTERS[c as usize - 'а' as usize]),
        'ё' | 'є' => Some("e"),
        'і' | 'ї' => Some("i"),
        'ґ' => Some("g"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_taken_apart_at_signs_digits_and_capitals() {
        for (name, expected) in [
            ("AI53_005_armchair_metal_2917", "armchair metal"),
            ("DiningTable01", "dining table"),
            ("TVStand.003", "tv stand"),
            ("kitchen chairs", "kitchen chair"),
            ("Boxes_BookShelves benches", "box book shelf bench"),
            ("wine glasses / glass", "wine glasses glass"),
            ("Archinteriors8_01_55", ""),
            ("obj_185", ""),
            ("A-B-c", ""),
        ] {
            assert_eq!(words(name).join(" "), expected, "{name}");
        }
    }

    #[test]
    fn scripts_and_accents_are_folded() {
        for (name, expected) in [
            ("Étagère", "etagere"),
            ("Bücherregal", "buecherregal"),
            ("лампа_02", "lampa"),
            ("стул", "stul"),
            ("żyrandol", "zyrandol"),
            ("椅子3", "椅子"),
            ("Ku\u{308}hlschrank", "kuehlschrank"),
            ("E\u{301}tage\u{300}reTu\u{308}r", "etagere tuer"),
            ("чаи\u{306}ник", "chaynik"),
        ] {
            assert_eq!(words(name).join(" "), expected, "{name}");
        }
    }

    #[test]
    fn odd_names_are_no_trouble() {
        assert!(words("").is_empty());
        assert!(words("\u{0}\u{301}🛋️ 42 ___").is_empty());
        assert!(words(&"x".repeat(1_000_000)).is_empty());
        assert_eq!(words(&format!("{}/chair", "room ".repeat(100_000))).len(), MAX_WORDS);
        assert_eq!(words(&format!("{}/chair", "a".repeat(100_000))).last().unwrap(), "chair");
    }
}
