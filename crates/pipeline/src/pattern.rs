//! Patterns of names.

use wildmatch::WildMatchPattern;

/// A pattern in which only `*` has a meaning: no name has the other character.
type Pattern = WildMatchPattern<'*', '\0'>;

/// Whether `name` matches `pattern`, in which `*` matches any run of characters.
pub(crate) fn matches(pattern: &str, name: &str) -> bool {
    Pattern::new(pattern).matches(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_stand_for_any_characters() {
        assert!(matches("a*b*c", "a-b-b-c") && !matches("a*b", "abc") && matches("*", ""));
        assert!(matches("a?", "a?") && !matches("a?", "ab") && matches("*ü*", "grün"));
    }
}
