//! Finding where things begin and end, byte by byte.

use crate::error::{Place, SceneTextError, shown};

/// A place in a text from which things are read.
#[derive(Clone, Copy)]
pub struct Scanner<'a> {
    /// The whole text.
    pub text: &'a [u8],
    /// The next byte.
    pub at: usize,
}

impl<'a> Scanner<'a> {
    pub fn new(text: &'a [u8]) -> Self {
        Self { text, at: 0 }
    }

    pub fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    pub fn error(&self, expected: impl Into<String>) -> SceneTextError {
        self.error_at(self.at, expected)
    }

    pub fn error_at(&self, at: usize, expected: impl Into<String>) -> SceneTextError {
        SceneTextError { place: Place::of(self.text, at), expected: expected.into(), found: shown(self.text, at) }
    }

    /// Passes white space and comments: `//` to the end of the line, `/* … */`.
    ///
    /// # Errors
    /// When a comment has no end.
    pub fn skip_blank(&mut self) -> Result<(), SceneTextError> {
        loop {
            match self.text.get(self.at..).unwrap_or_default() {
                [b, ..] if b.is_ascii_whitespace() => self.at += 1,
                [b'/', b'/', rest @ ..] => self.at += 2 + rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len()),
                [b'/', b'*', rest @ ..] => match rest.windows(2).position(|pair| pair == b"*/") {
                    Some(end) => self.at += end + 4,
                    None => return Err(self.error("`*/` at the end of this comment")),
                },
                // The byte order mark, which editors on Windows may put first.
                [0xef, 0xbb, 0xbf, ..] if self.at == 0 => self.at += 3,
                _ => return Ok(()),
            }
        }
    }

    /// Passes `byte`, after blanks.
    ///
    /// # Errors
    /// If there is another byte; `expected` describes the right one.
    pub fn expect(&mut self, byte: u8, expected: &str) -> Result<(), SceneTextError> {
        self.skip_blank()?;
        if self.peek() != Some(byte) {
            return Err(self.error(expected));
        }
        self.at += 1;
        Ok(())
    }

    /// Passes `byte`, after blanks, if it is next.
    ///
    /// # Errors
    /// When a comment has no end.
    pub fn take(&mut self, byte: u8) -> Result<bool, SceneTextError> {
        self.skip_blank()?;
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        Ok(found)
    }

    /// A run of bytes that a name or a number is made of. Names of plugins may contain nearly anything except blanks and brackets.
    ///
    /// # Errors
    /// If there is none; `expected` describes it.
    pub fn word(&mut self, expected: &str) -> Result<&'a [u8], SceneTextError> {
        self.skip_blank()?;
        let rest = &self.text[self.at..];
        let length = rest.iter().position(|&b| !is_word(b)).unwrap_or(rest.len());
        if length == 0 {
            return Err(self.error(expected));
        }
        self.at += length;
        Ok(&rest[..length])
    }

    /// Passes a string and returns the text between its quotes, with escapes as written.
    ///
    /// # Errors
    /// When it does not begin here or has no end.
    pub fn string(&mut self) -> Result<&'a [u8], SceneTextError> {
        let start = self.at;
        self.expect(b'"', "a string")?;
        let from = self.at;
        loop {
            match self.peek() {
                Some(b'\\') if self.text.get(self.at + 1).is_some_and(|&b| b == b'"' || b == b'\\') => self.at += 2,
                Some(b'"') => {
                    self.at += 1;
                    return Ok(&self.text[from..self.at - 1]);
                }
                Some(_) => self.at += 1,
                None => return Err(self.error_at(start, "`\"` at the end of this string")),
            }
        }
    }

    /// Passes a value: everything to the `;` that ends it, strings and brackets as wholes. Returns its bytes without blanks around.
    ///
    /// # Errors
    /// When it is empty, brackets do not match, or there is no `;`.
    pub fn raw_value(&mut self) -> Result<&'a [u8], SceneTextError> {
        self.skip_blank()?;
        let start = self.at;
        let mut end = start;
        let mut open = Vec::new();
        loop {
            self.skip_blank()?;
            match self.peek() {
                Some(b';') if open.is_empty() => break,
                Some(b'"') => drop(self.string()?),
                Some(b'(') => {
                    open.push(self.at);
                    self.at += 1;
                }
                Some(b')') => {
                    if open.pop().is_none() {
                        return Err(self.error("`;` at the end of the value"));
                    }
                    self.at += 1;
                }
                None | Some(b';' | b'{' | b'}' | b'=') => {
                    return Err(match open.last() {
                        Some(&bracket) => self.error_at(bracket, "`)` for this bracket"),
                        None => self.error("`;` at the end of the value"),
                    });
                }
                Some(_) => self.at += 1,
            }
            end = self.at;
        }
        if start == end { Err(self.error("a value")) } else { Ok(&self.text[start..end]) }
    }
}

fn is_word(byte: u8) -> bool {
    !byte.is_ascii_whitespace() && !matches!(byte, b'{' | b'}' | b'(' | b')' | b'=' | b';' | b',' | b'"')
}
