//! Pieces of messages: words of commands that people copy, and counted things.

/// A word as a shell takes it, for commands that people copy: in quotes if it contains characters that a shell would interpret.
pub fn quoted(word: impl std::fmt::Display) -> String {
    let word = word.to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "-_./:,=+@%".contains(c) || c == std::path::MAIN_SEPARATOR;
    if !word.is_empty() && word.chars().all(is_plain) { word } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

/// A number of things: `1 frame`, `2 frames`.
///
/// ```
/// use enfilade_dataset::counted;
/// assert_eq!((counted(1, "frame"), counted(0, "frame")), ("1 frame".into(), "0 frames".into()));
/// ```
pub fn counted(n: usize, thing: &str) -> String {
    counted_as(n, thing, &format!("{thing}s"))
}

/// A number with its noun as [`counted`], where the plural is not made with an s: `1 mesh`, `2 meshes`.
pub fn counted_as(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_with_blanks_and_signs_of_the_shell_are_quoted() {
        assert_eq!(quoted("../out/räume_2"), "../out/räume_2");
        assert_eq!(quoted("my rooms"), "'my rooms'");
        assert_eq!(quoted("a$b; it's"), r"'a$b; it'\''s'");
        assert_eq!(quoted(""), "''");
    }
}
