//! Places in a configuration file, and the TOML reader's errors in our words, with a proposal.

use crate::error::{ConfigError, Place};
use enfilade_options::closest;
use std::ops::Range;
use std::path::Path;

/// Keys of earlier versions, and what to do with them.
const GONE: [(&str, &str); 4] = [
    ("reuse", "pixels no longer share light, which is what `reuse = false` asked for: delete this line"),
    (
        "denoise",
        "`color` is denoised unless `color = \"rendered\"` asks for what was rendered, which stays beside it as `color_rendered`: write \
         that instead of `denoise = false`, or delete this line",
    ),
    ("denoise_library", OWN_DENOISER),
    ("denoiser", OWN_DENOISER),
];

/// What to do with keys that named a library.
const OWN_DENOISER: &str = "the program has a denoiser of its own, the network that the library has: delete this line";

/// A configuration text, to turn byte ranges into places.
pub(super) struct Source<'a> {
    pub file: &'a Path,
    pub text: &'a str,
}

impl Source<'_> {
    /// An error about the bytes `span` of the text.
    pub fn error(&self, span: Option<Range<usize>>, message: impl Into<String>) -> ConfigError {
        let place = span.filter(|s| s.start <= self.text.len()).map(|span| Box::new(self.place(&span)));
        ConfigError { file: self.file.into(), place, message: message.into(), help: None }
    }

    fn place(&self, span: &Range<usize>) -> Place {
        let start = floor_char_boundary(self.text, span.start);
        let line_start = self.text[..start].rfind('\n').map_or(0, |i| i + 1);
        let text = self.text[line_start..].lines().next().unwrap_or("");
        let on_line = self.text.get(start..span.end.min(line_start + text.len())).unwrap_or("");
        Place {
            line: self.text[..line_start].matches('\n').count() + 1,
            column: self.text[line_start..start].chars().count() + 1,
            text: text.to_string(),
            width: on_line.chars().count(),
        }
    }

    /// The error of the TOML reader in our words: unknown keys get the closest known key as a proposal, keys of earlier versions what
    /// to do.
    pub fn toml_error(&self, error: &toml::de::Error) -> ConfigError {
        let span = error.span();
        let names = quoted(error.message());
        if let (true, Some((found, known))) = (error.message().starts_with("unknown field"), names.split_first()) {
            if let Some((_, instead)) = GONE.iter().find(|(key, _)| key == found) {
                return ConfigError { help: Some((*instead).into()), ..self.error(span, format!("the key `{found}` is gone")) };
            }
            let mut located = self.error(span, format!("unknown key `{found}`"));
            let proposal = closest(found, known).map(|k| format!("did you mean `{k}`? "));
            located.help = Some(format!("{}known keys here: {}", proposal.unwrap_or_default(), known.join(", ")));
            return located;
        }
        let (message, value) = in_words(&error.message().trim().replace('\n', "; "));
        let key = span.as_ref().and_then(|span| self.key_of_text(span)).unwrap_or("");
        let help = value.map(|value| format!("write {key}{value}"));
        ConfigError { help, ..self.error(span, message) }
    }

    /// The key before the text at `span`, with its sign; `None` where no text stands there, but a table that holds it.
    fn key_of_text(&self, span: &Range<usize>) -> Option<&str> {
        self.text.get(span.clone()).filter(|value| value.starts_with(['"', '\'']))?;
        let before = self.text[..span.start].rsplit(['\n', '{', ',', '[']).next()?;
        Some(before.trim_start())
    }
}

/// The TOML reader's message about a value of a wrong type, with the types in words, and what to write instead of a text.
pub(super) fn in_words(message: &str) -> (String, Option<String>) {
    let Some((found, expected)) = message.rsplit_once(", expected ") else { return (message.into(), None) };
    let text = found.strip_prefix("invalid type: string \"").and_then(|text| text.strip_suffix('"'));
    let is_too_large = found.strip_prefix("invalid value: integer `").is_some_and(|number| !number.starts_with('-'));
    let (expected, instead) = match expected {
        "f32" | "f64" => ("a number", text.and_then(number)),
        "u8" | "u16" | "u32" | "u64" | "usize" if is_too_large => ("a smaller number", None),
        "u8" | "u16" | "u32" | "u64" | "usize" => {
            ("a whole number of at least 0", text.filter(|text| text.parse::<u64>().is_ok()).map(str::to_string))
        }
        "a boolean" => ("true or false", text.map(str::to_lowercase).filter(|text| matches!(text.as_str(), "true" | "false"))),
        _ if expected == "a map" || expected.starts_with("struct ") => ("a table, as in { key = value }", None),
        _ if expected.starts_with("internally tagged enum ") => {
            ("a table with its kind, as in { kind = \"...\" }", text.map(|kind| format!("{{ kind = \"{kind}\" }}")))
        }
        _ => return (message.into(), None),
    };
    (format!("{found}, expected {expected}"), instead)
}

/// The number that a text says, which may be in per cent.
fn number(text: &str) -> Option<String> {
    let (digits, unit) = text.trim().strip_suffix('%').map_or((text.trim(), 1.0), |percent| (percent.trim_end(), 100.0));
    digits.parse::<f64>().ok().filter(|v| v.is_finite()).map(|v| (v / unit).to_string())
}

/// The names between backticks, in order.
fn quoted(message: &str) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).collect()
}

fn floor_char_boundary(text: &str, mut index: usize) -> usize {
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::LONGEST_LINE;

    #[test]
    fn places_are_lines_and_columns_in_characters() {
        let source = Source { file: Path::new("a.toml"), text: "x = 1\n  ä = wrong # no\n" };
        let error = source.error(Some(13..18), "not a value");
        assert_eq!(error.to_string(), "a.toml:2:7: not a value\n  2 |   ä = wrong # no\n    |       ^^^^^");
        assert_eq!(source.error(None, "empty").to_string(), "a.toml: empty");
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let text = format!("{}x = wrong{}", "ä".repeat(1000), " ".repeat(1000));
        let source = Source { file: Path::new("a.toml"), text: &text };
        let shown = source.error(Some(2004..2009), "not a value").to_string();
        assert!(shown.starts_with("a.toml:1:1005: not a value\n  1 | …ää") && shown.chars().count() < 320, "{shown}");
        let [line, marks] = [1, 2].map(|i| shown.lines().nth(i).unwrap().chars().collect::<Vec<_>>());
        let marked: String = line.iter().zip(&marks).filter(|(_, mark)| **mark == '^').map(|(c, _)| c).collect();
        assert_eq!(marked, "wrong", "{shown}");
        // A mark as long as the line is cut with it.
        let shown = source.error(Some(0..text.len()), "no").to_string();
        assert!(shown.matches('^').count() == LONGEST_LINE && shown.contains("…\n"), "{shown}");
    }

    #[test]
    fn types_are_told_in_words_with_what_to_write() {
        for (message, words, instead) in [
            ("invalid type: string \"2%\", expected f32", "string \"2%\", expected a number", Some("0.02")),
            ("invalid type: string \"1\", expected u32", "expected a whole number of at least 0", Some("1")),
            ("invalid type: string \"many\", expected u32", "expected a whole number of at least 0", None),
            ("invalid value: integer `-1`, expected u64", "integer `-1`, expected a whole number of at least 0", None),
            ("invalid value: integer `9999999999`, expected u32", "expected a smaller number", None),
            ("invalid type: string \"True\", expected a boolean", "expected true or false", Some("true")),
            ("invalid type: string \"walk\", expected internally tagged enum Mode", "with its kind", Some("{ kind = \"walk\" }")),
            ("invalid type: string \"fisheye\", expected struct CameraConfig", "expected a table", None),
            ("unknown variant `vidio`, expected one of `walk`, `video`", "unknown variant `vidio`, expected one of `walk`", None),
        ] {
            let (found, value) = in_words(message);
            assert!(found.contains(words) && value.as_deref() == instead, "{found}: {value:?}");
        }
    }
}
