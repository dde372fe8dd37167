//! The text of files that other programs wrote: with or without byte order mark, in UTF-8, UTF-16 or one byte a letter.

use std::borrow::Cow;

/// Characters of Windows-1252 for the bytes 0x80 to 0x9f, control characters in Latin-1; its five unused bytes are as in Latin-1.
const WINDOWS: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}', '\u{90}', '‘', '’', '“', '”', '•', '–',
    '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

/// The text that `bytes` are, without a byte order mark.
///
/// UTF-16 is recognised by its mark, or by the zeros in its first two letters. What is no UTF-8 is taken for Windows-1252, the Western code page.
///
/// ```
/// use enfilade_scene::decoded_text;
///
/// assert_eq!(decoded_text(b"\xef\xbb\xbfv 0 0 0"), "v 0 0 0");
/// assert_eq!(decoded_text(b"\xff\xfeB\0\xfc\0r\0o\0"), "Büro");
/// assert_eq!(decoded_text(b"B\xfcro"), "Büro");
/// ```
pub fn decoded_text(bytes: &[u8]) -> Cow<'_, str> {
    let utf16 = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.as_chunks::<2>().0.iter().map(|pair| unit(*pair)).collect();
        Cow::Owned(String::from_utf16_lossy(&units))
    };
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => of_bytes(rest),
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes),
        [1..=255, 0, 1..=255, 0, ..] => utf16(bytes, u16::from_le_bytes),
        [0, 1..=255, 0, 1..=255, ..] => utf16(bytes, u16::from_be_bytes),
        _ => of_bytes(bytes),
    }
}

/// The text without the zeros that some programs pad it with, and white space about them.
///
/// ```
/// assert_eq!(enfilade_scene::without_padding("{}\0\0 \n"), "{}");
/// assert_eq!(enfilade_scene::without_padding("{}\n"), "{}\n");
/// ```
pub fn without_padding(text: &str) -> &str {
    let plain = text.trim_end_matches(|c: char| c == '\0' || c.is_ascii_whitespace());
    if text[plain.len()..].contains('\0') { plain } else { text }
}

fn of_bytes(bytes: &[u8]) -> Cow<'_, str> {
    let letter = |&byte: &u8| match byte {
        0x80..=0x9f => WINDOWS[usize::from(byte - 0x80)],
        other => char::from(other),
    };
    std::str::from_utf8(bytes).map_or_else(|_| Cow::Owned(bytes.iter().map(letter).collect()), Cow::Borrowed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_the_same_in_every_encoding() {
        let text = "g Küche – 5 €\r\nf 1 2 3\n";
        let utf16 = |mark: &[u8], order: fn(u16) -> [u8; 2]| [mark.to_vec(), text.encode_utf16().flat_map(order).collect()].concat();
        for bytes in [
            text.as_bytes().to_vec(),
            [&[0xef, 0xbb, 0xbf], text.as_bytes()].concat(),
            utf16(&[0xff, 0xfe], u16::to_le_bytes),
            utf16(&[0xfe, 0xff], u16::to_be_bytes),
            utf16(&[], u16::to_le_bytes),
            utf16(&[], u16::to_be_bytes),
            // Python: "g Küche – 5 €\r\nf 1 2 3\n".encode("cp1252")
            b"g K\xfcche \x96 5 \x80\r\nf 1 2 3\n".to_vec(),
        ] {
            assert_eq!(decoded_text(&bytes), text, "{bytes:?}");
        }
    }

    #[test]
    fn nothing_and_odd_bytes_are_text_too() {
        assert_eq!(decoded_text(b""), "");
        assert_eq!(decoded_text(b"\xef\xbb\xbf"), "");
        assert_eq!(decoded_text(b"\xff\xfea"), "");
        assert_eq!(decoded_text(b"a\0"), "a\0");
    }
}
