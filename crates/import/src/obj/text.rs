//! The text of OBJ files and their libraries: its encoding, its lines, and what counts of them.

use std::borrow::Cow;

/// The bytes as text: UTF-16 where its byte order mark says so, else UTF-8, with or without a mark.
pub(super) fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    let utf16 = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
        Cow::Owned(String::from_utf16_lossy(&units))
    };
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest),
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes),
        _ => String::from_utf8_lossy(bytes),
    }
}

/// The lines of a text, whether they end with a line feed, a carriage return (as on old Macintoshes) or both.
pub(super) fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
}

/// A line without its comment. Behind a keyword that `is_text` knows stands a name or path, which may contain `#`.
pub(super) fn without_comment(line: &str, is_text: fn(&str) -> bool) -> &str {
    let keyword = line.split_whitespace().next().unwrap_or_default();
    if is_text(keyword) { line } else { line.split('#').next().unwrap_or_default() }
}

/// A path without the quotation marks that some programs put around it.
pub(super) fn unquoted(path: &str) -> &str {
    path.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).filter(|inside| !inside.contains('"')).unwrap_or(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_encodings_and_ends_of_lines_of_other_systems_are_understood() {
        let text = "g Küche\r\nf 1 2 3\rf 2 3 4\n";
        let utf16 = |order: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(order).collect::<Vec<u8>>();
        let marked = |mark: &[u8], bytes: &[u8]| [mark, bytes].concat();
        for bytes in [
            text.as_bytes().to_vec(),
            marked(&[0xef, 0xbb, 0xbf], text.as_bytes()),
            marked(&[0xff, 0xfe], &utf16(u16::to_le_bytes)),
            marked(&[0xfe, 0xff], &utf16(u16::to_be_bytes)),
        ] {
            assert_eq!(lines(&decoded(&bytes)).collect::<Vec<_>>(), ["g Küche", "f 1 2 3", "f 2 3 4", ""]);
        }
    }

    #[test]
    fn quotation_marks_go_only_in_pairs() {
        assert_eq!(
            ["\"my wood.png\"", "12\" board.png", "\"a.mtl\" \"b.mtl\""].map(unquoted),
            ["my wood.png", "12\" board.png", "\"a.mtl\" \"b.mtl\""]
        );
    }
}
