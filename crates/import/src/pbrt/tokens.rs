//! The words of a pbrt file, with line and column.

use crate::ImportError;
use std::path::Path;

/// One word of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Token<'t> {
    pub kind: Kind<'t>,
    pub line: u32,
    pub column: u32,
}

/// The kind of a word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind<'t> {
    /// A directive, a number, `true` or `false`.
    Bare(&'t str),
    /// Text between quotation marks, which pbrt never escapes in names of files.
    Quoted(&'t str),
    /// `[`.
    Open,
    /// `]`.
    Close,
}

/// Cuts a file into words; comments go from `#` to the end of the line.
pub(super) struct Tokens<'t> {
    text: &'t str,
    file: &'t Path,
    at: usize,
    line: u32,
    /// A byte of the line and its column, from which columns are counted on: a whole mesh may be one line.
    counted: (usize, u32),
    peeked: Option<Token<'t>>,
    /// Line and column of the word that was taken last.
    last: (u32, u32),
}

impl<'t> Tokens<'t> {
    /// The words of a text without a byte order mark.
    pub(super) fn new(text: &'t str, file: &'t Path) -> Self {
        Self { text, file, at: 0, line: 1, counted: (0, 1), peeked: None, last: (1, 1) }
    }

    /// The next word, left where it is; `None` at the end of the file.
    pub(super) fn peek(&mut self) -> Result<Option<Token<'t>>, ImportError> {
        if self.peeked.is_none() {
            self.peeked = self.cut()?;
        }
        Ok(self.peeked)
    }

    /// The next word; `None` at the end of the file.
    pub(super) fn next(&mut self) -> Result<Option<Token<'t>>, ImportError> {
        let token = self.peek()?;
        self.peeked = None;
        self.last = token.map_or(self.last, |t| (t.line, t.column));
        Ok(token)
    }

    /// An error at the word that was taken last.
    pub(super) fn error(&self, problem: impl Into<String>) -> ImportError {
        ImportError::malformed(self.file, format!("line {}:{}", self.last.0, self.last.1), problem)
    }

    /// Column of the byte `at`, which comes no earlier than the one asked for last.
    fn column(&mut self, at: usize) -> u32 {
        let (from, column) = self.counted;
        let passed = self.text.get(from..at).map_or(0, |t| t.chars().count() as u32);
        self.counted = (at, column.saturating_add(passed));
        self.counted.1
    }

    fn cut(&mut self) -> Result<Option<Token<'t>>, ImportError> {
        let bytes = self.text.as_bytes();
        loop {
            match bytes.get(self.at) {
                None => return Ok(None),
                Some(b'\n') => {
                    self.at += 1;
                    self.line += 1;
                    self.counted = (self.at, 1);
                }
                Some(b'#') => self.at += bytes[self.at..].iter().position(|&b| b == b'\n').unwrap_or(bytes.len() - self.at),
                Some(b) if b.is_ascii_whitespace() => self.at += 1,
                Some(_) => break,
            }
        }
        let (start, line, column) = (self.at, self.line, self.column(self.at));
        let kind = match bytes[start] {
            b'[' => self.one(Kind::Open),
            b']' => self.one(Kind::Close),
            b'"' => self.quoted(start)?,
            _ => {
                let ends = |b: &u8| b.is_ascii_whitespace() || matches!(b, b'[' | b']' | b'"' | b'#');
                let length = bytes[start..].iter().position(ends).unwrap_or(bytes.len() - start);
                self.at += length;
                Kind::Bare(&self.text[start..start + length])
            }
        };
        Ok(Some(Token { kind, line, column }))
    }

    fn one(&mut self, kind: Kind<'t>) -> Kind<'t> {
        self.at += 1;
        kind
    }

    fn quoted(&mut self, start: usize) -> Result<Kind<'t>, ImportError> {
        let rest = &self.text.as_bytes()[start + 1..];
        match rest.iter().position(|&b| b == b'"' || b == b'\n') {
            Some(length) if rest[length] == b'"' => {
                self.at += length + 2;
                Ok(Kind::Quoted(&self.text[start + 1..start + 1 + length]))
            }
            _ => {
                let column = self.column(start);
                let place = format!("line {}:{column}", self.line);
                Err(ImportError::malformed(self.file, place, "the quotation mark has no partner on its line; close it"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_have_their_place_and_comments_are_none() {
        let mut tokens = Tokens::new("Shape \"a b\" # [ \"\n  [1 -2.5e3]é", Path::new("a.pbrt"));
        let mut found = Vec::new();
        while let Some(t) = tokens.next().unwrap() {
            found.push((t.kind, t.line, t.column));
        }
        let expected = [
            (Kind::Bare("Shape"), 1, 1),
            (Kind::Quoted("a b"), 1, 7),
            (Kind::Open, 2, 3),
            (Kind::Bare("1"), 2, 4),
            (Kind::Bare("-2.5e3"), 2, 6),
            (Kind::Close, 2, 12),
            (Kind::Bare("é"), 2, 13),
        ];
        assert_eq!(found, expected);
    }

    /// Counting each column from the line's beginning took minutes.
    #[test]
    fn a_million_words_may_stand_on_one_line() {
        let text = "é ".repeat(1_000_000);
        let mut tokens = Tokens::new(&text, Path::new("a.pbrt"));
        let (mut words, mut column) = (0, 0);
        while let Some(token) = tokens.next().unwrap() {
            (words, column) = (words + 1, token.column);
        }
        assert_eq!((words, column), (1_000_000, 1_999_999));
    }

    #[test]
    fn open_quotation_marks_are_told() {
        let mut tokens = Tokens::new("A\n \"b\n\"", Path::new("a.pbrt"));
        tokens.next().unwrap();
        assert_eq!(tokens.next().unwrap_err().to_string(), "a.pbrt: line 2:2: the quotation mark has no partner on its line; close it");
    }
}
