//! Errors of text: the place, what was expected there, and what was found.

use std::fmt;

/// A place in a file: line and column from 1, the column counted in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Line from 1.
    pub line: usize,
    /// Byte of the line from 1.
    pub column: usize,
}

impl Place {
    /// The place of byte `at` of `text`.
    pub(crate) fn of(text: &[u8], at: usize) -> Self {
        let before = &text[..at.min(text.len())];
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        let column = before.iter().rev().take_while(|&&b| b != b'\n').count() + 1;
        Self { line, column }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

/// Text that is not a scene description, or a value that is not of its stated type.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: expected {expected}, found {found}")]
pub struct SceneTextError {
    /// Place of the error.
    pub place: Place,
    /// What was expected there.
    pub expected: String,
    /// The text found there, shortened.
    pub found: String,
}

impl SceneTextError {
    /// The error in a text that begins at `origin` of its file.
    pub(crate) fn moved_to(mut self, origin: Place) -> Self {
        if self.place.line == 1 {
            self.place.column += origin.column - 1;
        }
        self.place.line += origin.line - 1;
        self
    }
}

/// The text found at byte `at`, for people: a few bytes of it.
pub(crate) fn shown(text: &[u8], at: usize) -> String {
    const SHOWN_BYTES: usize = 24;
    match text.get(at..) {
        None | Some([]) => "the end of the text".into(),
        Some(rest) => {
            let line = rest.split(|&b| b == b'\n').next().unwrap_or(rest);
            let cut = &line[..line.len().min(SHOWN_BYTES)];
            let dots = if cut.len() < line.len() { "…" } else { "" };
            if cut.is_empty() { "the end of the line".into() } else { format!("`{}{dots}`", String::from_utf8_lossy(cut)) }
        }
    }
}
