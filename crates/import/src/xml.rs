//! The text of XML files, as lenient as the readers that their programs use.
//!
//! ROS, Gazebo, MuJoCo (TinyXML-2) and Mitsuba 3 (pugixml) read `--` in comments, prefixes that no `xmlns` declares and `&` that begins no
//! entity, all of which the XML specification forbids and files of people have. [`xml_text`] puts them right.

use enfilade_scene::{decoded_text, without_padding};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::ops::Range;

/// The text of an XML file in whatever encoding, well-formed where other readers take it for that, without white space before its
/// declaration and zeros behind its end.
pub(crate) fn xml_text(bytes: &[u8]) -> Cow<'_, str> {
    let plain = |text: &str| -> (usize, usize) {
        let end = without_padding(text).len();
        let start = text.len() - text.trim_start().len();
        if text[start..end.max(start)].starts_with("<?xml") { (start, end) } else { (0, end) }
    };
    match decoded_text(bytes) {
        Cow::Borrowed(text) => {
            let (start, end) = plain(text);
            mended(&text[start..end]).map_or(Cow::Borrowed(&text[start..end]), Cow::Owned)
        }
        Cow::Owned(text) => {
            let (start, end) = plain(&text);
            Cow::Owned(mended(&text[start..end]).unwrap_or_else(|| text[start..end].to_string()))
        }
    }
}

/// The text with its faults put right; `None` where it has none. Lines stay what they are.
fn mended(text: &str) -> Option<String> {
    let mut found = Found::default();
    let mut at = 0;
    while let Some(start) = text[at..].find(['<', '&']).map(|i| at + i) {
        let rest = &text[start..];
        at = start
            + match rest {
                _ if rest.starts_with("<!--") => found.comment(text, start),
                _ if rest.starts_with("<![CDATA[") => rest.find("]]>").map_or(rest.len(), |i| i + 3),
                _ if rest.starts_with("<?") => rest.find("?>").map_or(rest.len(), |i| i + 2),
                _ if rest.starts_with("<!") => doctype_len(rest),
                _ if rest.starts_with('<') => found.tag(text, start),
                _ => found.ampersand(text, start),
            };
    }
    found.applied(text)
}

/// What is wrong with a text.
#[derive(Default)]
struct Found<'t> {
    /// Bytes to replace, in the order of the text, and what replaces them.
    edits: Vec<(Range<usize>, &'static str)>,
    prefixes: BTreeSet<&'t str>,
    declared: BTreeSet<&'t str>,
    /// End of the name of the outermost element.
    root: Option<usize>,
}

impl<'t> Found<'t> {
    /// Looks at a comment, and returns its length.
    fn comment(&mut self, text: &str, start: usize) -> usize {
        let inside = start + "<!--".len();
        let Some(end) = text[inside..].find("-->").map(|i| inside + i) else { return text.len() - start };
        let content = &text[inside..end];
        if content.contains("--") || content.ends_with('-') {
            self.edits.extend(content.match_indices('-').map(|(i, _)| (inside + i..inside + i + 1, " ")));
        }
        end + "-->".len() - start
    }

    /// Looks at the tag of an element, and returns its length.
    fn tag(&mut self, text: &'t str, start: usize) -> usize {
        let name_at = start + 1 + usize::from(text[start + 1..].starts_with('/'));
        let name = name_in(&text[name_at..]);
        self.name(name);
        if !name.is_empty() {
            self.root.get_or_insert(name_at + name.len());
        }
        let mut at = name_at + name.len();
        while let Some(c) = text[at..].chars().next() {
            match c {
                '>' => return at + 1 - start,
                '<' => break, // a tag that does not end, which the parser tells
                '"' | '\'' => {
                    let end = text[at + 1..].find(c).map_or(text.len(), |i| at + 1 + i);
                    let mut from = at;
                    while let Some(i) = text[from..end].find('&').map(|i| from + i) {
                        from = i + self.ampersand(text, i);
                    }
                    at = (end + 1).min(text.len());
                }
                c if c.is_whitespace() || c == '/' || c == '=' => at += c.len_utf8(),
                c => {
                    let name = name_in(&text[at..]);
                    self.name(name);
                    at += name.len().max(c.len_utf8());
                }
            }
        }
        at - start
    }

    fn name(&mut self, name: &'t str) {
        match name.split_once(':') {
            Some(("xmlns", prefix)) => drop(self.declared.insert(prefix)),
            Some((prefix, _)) if !prefix.is_empty() => drop(self.prefixes.insert(prefix)),
            _ => (),
        }
    }

    /// Looks at an `&`, and returns the length of its entity.
    fn ampersand(&mut self, text: &str, start: usize) -> usize {
        let name = &text[start + 1..];
        let len = name.find(|c: char| !c.is_alphanumeric() && !matches!(c, '#' | '_' | '.' | '-')).unwrap_or(name.len());
        if len == 0 || !name[len..].starts_with(';') {
            self.edits.push((start..start + 1, "&amp;"));
        }
        1
    }

    fn applied(self, text: &str) -> Option<String> {
        let unknown: Vec<&str> = self.prefixes.iter().filter(|p| **p != "xml" && !self.declared.contains(*p)).copied().collect();
        let declarations: String = unknown.iter().map(|prefix| format!(" xmlns:{prefix}=\"{prefix}\"")).collect();
        let root = self.root.filter(|_| !declarations.is_empty());
        if self.edits.is_empty() && root.is_none() {
            return None;
        }
        let (mut out, mut at) = (String::with_capacity(text.len() + 64), 0);
        let mut put = |range: Range<usize>, new: &str| {
            out.push_str(&text[at..range.start]);
            out.push_str(new);
            at = range.end;
        };
        let before = root.map_or(0, |root| self.edits.partition_point(|(range, _)| range.start < root));
        self.edits[..before].iter().for_each(|(range, new)| put(range.clone(), new));
        root.into_iter().for_each(|root| put(root..root, &declarations));
        self.edits[before..].iter().for_each(|(range, new)| put(range.clone(), new));
        out.push_str(&text[at..]);
        Some(out)
    }
}

/// The name with which a text begins.
fn name_in(text: &str) -> &str {
    let end = text.find(|c: char| c.is_whitespace() || matches!(c, '<' | '>' | '/' | '=' | '"' | '\'' | '&'));
    &text[..end.unwrap_or(text.len())]
}

/// Length of a document type declaration, which may declare things within brackets.
fn doctype_len(text: &str) -> usize {
    let inner = text.find('[').filter(|open| !text[..*open].contains('>'));
    let from = inner.and_then(|open| text[open..].find(']').map(|i| open + i)).unwrap_or(0);
    text[from..].find('>').map_or(text.len(), |i| from + i + 1)
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

    #[test]
    fn what_other_readers_take_becomes_well_formed_on_the_same_lines() {
        // The XML parser of MuJoCo 4.0 (TinyXML-2) takes each of these.
        let text = "<?xml version=\"1.0\"?>\n<!-- -- a -- b --->\n<a t=\"x & y &amp; z&#65;\">\n<p:c q:d='1 > 0 & 2'/><!---->\n\
                    b & c<![CDATA[ & -- <r:d> ]]>\n<e f=\"--\"/></a><!-------->";
        let mended = xml_text(text.as_bytes());
        let document = roxmltree::Document::parse(&mended).unwrap();
        let root = document.root_element();
        assert_eq!(root.attribute("t"), Some("x & y & zA"));
        let c = root.first_element_child().unwrap();
        assert_eq!((c.tag_name().name(), c.attributes().next().map(|a| (a.name(), a.value()))), ("c", Some(("d", "1 > 0 & 2"))));
        assert_eq!(root.children().filter_map(|n| n.text().filter(|_| n.is_text())).collect::<String>(), "\n\nb & c & -- <r:d> \n");
        let e = root.last_element_child().unwrap();
        assert_eq!((e.attribute("f"), document.text_pos_at(e.range().start).row), (Some("--"), 6));
    }

    #[test]
    fn well_formed_text_stays_as_it_is() {
        let text = "<!DOCTYPE a [<!ENTITY e \"&#38;\">]>\n<!-- a - b --><x:a xmlns:x=\"u\" x:b=\"&e;\" xml:space=\"preserve\">a-b</x:a>";
        assert!(matches!(xml_text(text.as_bytes()), Cow::Borrowed(same) if same == text));
        // What no reader takes is left to the parser, which tells its place.
        for broken in ["<a", "<a b=\"", "<!-- ", "<", "&", "<a b=\"<\"", "<?", "<![CDATA[", "<!D [", "<a></b>", "<!-", "a<é:"] {
            assert!(roxmltree::Document::parse(&xml_text(broken.as_bytes())).is_err(), "{broken}");
        }
    }
}
