//! Errors of a configuration file, shown with the line they are about and a proposal.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What is wrong with a configuration file, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfigError {
    /// The file as the user named it.
    pub file: PathBuf,
    /// Where; `None` when the file as a whole is meant.
    pub place: Option<Box<Place>>,
    /// What was found and what was expected.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
}

/// A place in a file, for display.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// From 1.
    pub line: usize,
    /// From 1, in characters.
    pub column: usize,
    /// The line itself.
    pub text: String,
    /// Number of characters that the problem spans on its line.
    pub width: usize,
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        let Some(place) = &self.place else { return write!(f, ": {}", self.message) };
        let Place { line, column, text, width } = &**place;
        let gutter = line.to_string().len();
        let marker = "^".repeat((*width).max(1));
        write!(f, ":{line}:{column}: {}\n  {line} | {text}\n  {:gutter$} | {:indent$}{marker}", self.message, "", "", indent = column - 1)
    }
}

impl std::error::Error for ConfigError {}

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

    /// The error of the TOML reader in our words: unknown keys get the closest known key as a proposal.
    pub fn toml_error(&self, error: &toml::de::Error) -> ConfigError {
        let span = error.span();
        let names = quoted(error.message());
        if let (true, Some((found, known))) = (error.message().starts_with("unknown field"), names.split_first()) {
            let mut located = self.error(span, format!("unknown key `{found}`"));
            let proposal = closest(found, known).map(|k| format!("did you mean `{k}`? "));
            located.help = Some(format!("{}known keys here: {}", proposal.unwrap_or_default(), known.join(", ")));
            return located;
        }
        self.error(span, error.message().trim().replace('\n', "; "))
    }
}

/// The names between backticks, in order.
fn quoted(message: &str) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).collect()
}

/// The candidate most like `found`, when one is near enough to be what was meant.
pub(crate) fn closest<'a>(found: &str, candidates: &[&'a str]) -> Option<&'a str> {
    let similarity = |c: &str| strsim::jaro_winkler(&found.to_lowercase(), &c.to_lowercase());
    candidates.iter().copied().map(|c| (similarity(c), c)).filter(|(s, _)| *s > 0.75).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, c)| c)
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

    #[test]
    fn places_are_lines_and_columns_in_characters() {
        let source = Source { file: Path::new("a.toml"), text: "x = 1\n  ä = wrong # no\n" };
        let error = source.error(Some(13..18), "not a value");
        assert_eq!(error.to_string(), "a.toml:2:7: not a value\n  2 |   ä = wrong # no\n    |       ^^^^^");
        assert_eq!(source.error(None, "empty").to_string(), "a.toml: empty");
    }

    #[test]
    fn proposals_are_near_or_none() {
        assert_eq!(closest("sampels", &["size", "samples", "seed"]), Some("samples"));
        assert_eq!(closest("zzz", &["size", "samples"]), None);
    }
}
