//! The text of XML files, as lenient as the readers that their programs use.

use enfilade_scene::{decoded_text, without_padding};
use std::borrow::Cow;

/// The text of an XML file in whatever encoding, without white space before its declaration and zeros behind its end.
pub(crate) fn xml_text(bytes: &[u8]) -> Cow<'_, str> {
    let plain = |text: &str| -> (usize, usize) {
        let end = without_padding(text).len();
        let start = text.len() - text.trim_start().len();
        if text[start..end.max(start)].starts_with("<?xml") { (start, end) } else { (0, end) }
    };
    match decoded_text(bytes) {
        Cow::Borrowed(text) => {
            let (start, end) = plain(text);
            Cow::Borrowed(&text[start..end])
        }
        Cow::Owned(text) => {
            let (start, end) = plain(&text);
            Cow::Owned(text[start..end].to_string())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_may_come_late_and_state_any_encoding() {
        let utf16: Vec<u8> =
            "\u{feff}<?xml version=\"1.0\" encoding=\"utf-16\"?><a b=\"ü\"/>".encode_utf16().flat_map(u16::to_le_bytes).collect();
        let latin = b"\n <?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><a b=\"\xfc\"/>\0\0";
        for bytes in [&utf16[..], latin, "\u{feff}<a b=\"ü\"/>".as_bytes(), "\n<a b=\"ü\"/>".as_bytes()] {
            let text = xml_text(bytes);
            let document = roxmltree::Document::parse(&text).unwrap();
            assert_eq!(document.root_element().attribute("b"), Some("ü"));
        }
        assert_eq!([&b""[..], b"\0", b" \0 "].map(xml_text), ["", "", ""]);
    }
}
