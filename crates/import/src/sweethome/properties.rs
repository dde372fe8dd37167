//! Java's `.properties`: `key=value` lines in ISO 8859-1, with `\` escapes.

use std::collections::BTreeMap;

/// The values by their keys; of equal keys the last counts.
pub(super) fn parse(bytes: &[u8]) -> BTreeMap<String, String> {
    let text: String = bytes.iter().map(|&b| char::from(b)).collect();
    let mut values = BTreeMap::new();
    let mut logical = String::new();
    for line in text.lines() {
        let line = line.trim_start();
        if logical.is_empty() && (line.is_empty() || line.starts_with(['#', '!'])) {
            continue;
        }
        logical.push_str(line);
        // A line that ends in an odd number of backslashes continues on the next.
        if line.chars().rev().take_while(|&c| c == '\\').count() % 2 == 1 {
            logical.pop();
            continue;
        }
        let (key, value) = split(&logical);
        values.insert(unescaped(key), unescaped(value));
        logical.clear();
    }
    values
}

/// A key ends at the first `=`, `:` or space without a backslash before it.
fn split(line: &str) -> (&str, &str) {
    let mut escaped = false;
    for (at, c) in line.char_indices() {
        if !escaped && (matches!(c, '=' | ':') || c.is_whitespace()) {
            let rest = line[at..].trim_start();
            let rest = rest.strip_prefix(['=', ':']).unwrap_or(rest);
            return (&line[..at], rest.trim_start());
        }
        escaped = c == '\\' && !escaped;
    }
    (line, "")
}

fn unescaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text.chars();
    while let Some(c) = rest.next() {
        if c != '\\' {
            out.push(c);
            continue;
        }
        match rest.next() {
            Some('u') => {
                let digits: String = rest.by_ref().take(4).collect();
                out.push(u32::from_str_radix(&digits, 16).ok().and_then(char::from_u32).unwrap_or(char::REPLACEMENT_CHARACTER));
            }
            Some('t') => out.push('\t'),
            Some('n') => out.push('\n'),
            Some('r') => out.push('\r'),
            Some(other) => out.push(other),
            None => {}
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_comments_continued_lines_and_escapes_are_as_java_has_them() {
        let text = b"# comment\n! too\nname#1=Wooden table\n  width#1 : 120.5\nlicense=\\u00a9 A \\\n   and B\npath=a\\:b\\\\\nempty=\nlatin=\xe9\n";
        let values = parse(text);
        let of = |key: &str| values.get(key).map(String::as_str);
        assert_eq!((of("name#1"), of("width#1"), of("empty")), (Some("Wooden table"), Some("120.5"), Some("")));
        assert_eq!((of("license"), of("path"), of("latin")), (Some("\u{a9} A and B"), Some("a:b\\"), Some("\u{e9}")));
        assert_eq!(values.len(), 6);
    }
}
