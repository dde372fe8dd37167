//! The lines of OBJ files and their libraries, without comments.

/// The lines of a text, whether they end with a line feed, a carriage return (as on old Macintoshes) or both.
pub(super) fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
}

/// A line without its comment. A keyword for which `is_text` is true is followed by a name or path, which may contain `#`.
pub(super) fn without_comment(line: &str, is_text: fn(&str) -> bool) -> &str {
    let keyword = line.split_whitespace().next().unwrap_or_default();
    if is_text(keyword) { line } else { line.split('#').next().unwrap_or_default() }
}

/// A number; a comma is the decimal point of programs that write numbers as the language of their user does.
pub(super) fn number(word: &str) -> Option<f64> {
    word.parse().ok().or_else(|| word.replacen(',', ".", 1).parse().ok())
}

/// A whole number, which numpy writes as `3.0` or `3.000e+00`.
pub(super) fn whole(word: &str) -> Option<i64> {
    let float = || word.parse::<f64>().ok().filter(|v| v.fract() == 0.0 && v.abs() < 1e15).map(|v| v as i64);
    word.parse().ok().or_else(float)
}

/// A path without the quotation marks that some programs put around it.
pub(super) fn unquoted(path: &str) -> &str {
    path.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).filter(|inside| !inside.contains('"')).unwrap_or(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_of_lines_of_other_systems_are_understood() {
        let text = "g Küche\r\nf 1 2 3\rf 2 3 4\n";
        assert_eq!(lines(text).collect::<Vec<_>>(), ["g Küche", "f 1 2 3", "f 2 3 4", ""]);
    }

    #[test]
    fn numbers_are_read_as_other_programs_write_them() {
        assert_eq!(
            ["0.5", "0,5", "-1,5e-3", ".5", "1e3", "1,2,3", "a", ""].map(number),
            [Some(0.5), Some(0.5), Some(-0.0015), Some(0.5), Some(1000.0), None, None, None]
        );
        assert_eq!(
            ["3", "3.0", "-1.00", "3.000000000000000000e+00", "2.5", "x"].map(whole),
            [Some(3), Some(3), Some(-1), Some(3), None, None]
        );
    }

    #[test]
    fn quotation_marks_go_only_in_pairs() {
        assert_eq!(
            ["\"my wood.png\"", "12\" board.png", "\"a.mtl\" \"b.mtl\""].map(unquoted),
            ["my wood.png", "12\" board.png", "\"a.mtl\" \"b.mtl\""]
        );
    }
}
