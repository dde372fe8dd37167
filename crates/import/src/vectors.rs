//! Numbers within text, which files of collections and robots separate by spaces, commas, or both.

/// The numbers of a text such as `1 0 0`, `1, 0, 0` or `[1,0,0]`; `None` where something else is in it, or nothing.
pub(crate) fn numbers(text: &str) -> Option<Vec<f64>> {
    let text = text.trim();
    let brackets = [('[', ']'), ('(', ')'), ('{', '}')];
    let inside = brackets.iter().find_map(|(open, close)| text.strip_prefix(*open)?.strip_suffix(*close)).unwrap_or(text);
    let words = inside.split(|c: char| c.is_whitespace() || matches!(c, ',' | ';')).filter(|word| !word.is_empty());
    let numbers: Option<Vec<f64>> = words.map(|word| word.parse().ok().filter(|v: &f64| v.is_finite())).collect();
    numbers.filter(|numbers| !numbers.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_between_spaces_commas_or_both() {
        for text in ["1 -2.5 3e1", "1, -2.5, 3e1", "1,-2.5,3e1", " 1 ,-2.5\t30 ", "[1, -2.5, 30]", "(1 -2.5 30)", "1; -2.5; 30,"] {
            assert_eq!(numbers(text), Some(vec![1.0, -2.5, 30.0]), "{text}");
        }
        for text in ["", "  ", "a", "1 b", "nan", "1 inf 2", "[1, 2"] {
            assert_eq!(numbers(text), None, "{text}");
        }
    }
}
