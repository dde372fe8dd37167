//! Tokens of usda, with their lines.

/// A token.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token<'a> {
    /// A name, with `:` and `.` in it.
    Word(&'a str),
    /// A number.
    Number(f64),
    /// A quoted string, without its quotes and escapes.
    Text(String),
    /// `@asset path@`.
    Asset(&'a str),
    /// `<path>`.
    Path(&'a str),
    /// One of `()[]{}=,;:&`.
    Sign(u8),
    /// A line's end. Between brackets it is left out.
    NewLine,
    /// The file's end.
    End,
}

impl Token<'_> {
    /// Name of the token in messages.
    pub(super) fn named(&self) -> String {
        let short = |t: &str| t.chars().take(40).collect::<String>();
        match self {
            Self::Word(w) => format!("{:?}", short(w)),
            Self::Number(n) => format!("the number {n}"),
            Self::Text(t) => format!("the string {:?}", short(t)),
            Self::Asset(a) => format!("@{}@", short(a)),
            Self::Path(p) => format!("<{}>", short(p)),
            Self::Sign(s) => format!("`{}`", char::from(*s)),
            Self::NewLine => "the end of the line".into(),
            Self::End => "the end of the file".into(),
        }
    }
}

/// Splits a text into tokens.
pub(super) struct Lexer<'a> {
    text: &'a str,
    at: usize,
    /// Line of the token read last, from 1.
    pub line: usize,
}

impl<'a> Lexer<'a> {
    /// A lexer at the beginning of `text`.
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, at: 0, line: 1 }
    }

    fn byte(&self, ahead: usize) -> Option<u8> {
        self.text.as_bytes().get(self.at + ahead).copied()
    }

    /// The text from here to where `end` begins, after which reading continues.
    fn until(&mut self, end: &str, what: &str) -> Result<&'a str, String> {
        let rest = &self.text[self.at..];
        let length = rest.find(end).ok_or_else(|| format!("{what} is never closed by {end}; the file is cut short or damaged"))?;
        self.line += rest.as_bytes()[..length].iter().filter(|b| **b == b'\n').count();
        self.at += length + end.len();
        Ok(&rest[..length])
    }

    /// The next token.
    ///
    /// # Errors
    /// The fault at this line, as a sentence.
    pub(super) fn next(&mut self) -> Result<Token<'a>, String> {
        loop {
            let Some(byte) = self.byte(0) else { return Ok(Token::End) };
            match byte {
                b' ' | b'\t' | b'\r' => self.at += 1,
                b'#' => self.at += self.text[self.at..].find('\n').unwrap_or(self.text.len() - self.at),
                b'/' if self.byte(1) == Some(b'/') => self.at += self.text[self.at..].find('\n').unwrap_or(self.text.len() - self.at),
                b'/' if self.byte(1) == Some(b'*') => {
                    self.until("*/", "a comment")?;
                }
                b'\n' => {
                    self.at += 1;
                    self.line += 1;
                    return Ok(Token::NewLine);
                }
                b'"' | b'\'' => return self.string(byte),
                b'@' => {
                    let fence = if self.text[self.at..].starts_with("@@@") { "@@@" } else { "@" };
                    self.at += fence.len();
                    return self.until(fence, "an asset path").map(Token::Asset);
                }
                b'<' => {
                    self.at += 1;
                    return self.until(">", "a path").map(Token::Path);
                }
                b'(' | b')' | b'[' | b']' | b'{' | b'}' | b'=' | b',' | b';' | b':' | b'&' => {
                    self.at += 1;
                    return Ok(Token::Sign(byte));
                }
                b'0'..=b'9' | b'-' | b'+' | b'.' => return self.number(),
                _ => return self.word(),
            }
        }
    }

    fn number(&mut self) -> Result<Token<'a>, String> {
        let rest = &self.text[self.at..];
        let length = rest.bytes().take_while(|b| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'-' | b'+')).count();
        let text = &rest[..length];
        self.at += length;
        text.parse().map(Token::Number).map_err(|_| format!("found {text:?}, expected a number; correct the file"))
    }

    fn word(&mut self) -> Result<Token<'a>, String> {
        let rest = &self.text[self.at..];
        let length = rest.find(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | ':' | '.' | '|' | '-' | '!'))).unwrap_or(rest.len());
        if length == 0 {
            let found = rest.chars().next().unwrap_or(' ');
            return Err(format!("found {found:?}, which begins nothing in usda; the file is damaged, so export it again"));
        }
        self.at += length;
        match &rest[..length] {
            "inf" => Ok(Token::Number(f64::INFINITY)),
            "nan" => Ok(Token::Number(f64::NAN)),
            word => Ok(Token::Word(word)),
        }
    }

    fn string(&mut self, quote: u8) -> Result<Token<'a>, String> {
        let bytes = self.text.as_bytes();
        let long = self.byte(1) == Some(quote) && self.byte(2) == Some(quote);
        let fence = if long { 3 } else { 1 };
        let start = self.at + fence;
        let mut end = start;
        loop {
            match bytes.get(end) {
                None => return Err("a string is never closed; the file is cut short or damaged".into()),
                Some(b'\\') => end += 2,
                Some(b'\n') if !long => return Err("a string is not closed on its line; close it, or export the file again".into()),
                Some(&b) if b == quote && (!long || (bytes.get(end + 1) == Some(&quote) && bytes.get(end + 2) == Some(&quote))) => break,
                Some(_) => end += 1,
            }
        }
        // A backslash may have led past a character's first byte.
        let text = self.text.get(start..end).ok_or("a string ends inside of a character; the file is damaged")?;
        self.line += text.bytes().filter(|b| *b == b'\n').count();
        self.at = end + fence;
        Ok(Token::Text(unescaped(text)))
    }
}

fn unescaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut chars = text.chars();
    while let Some(c) = chars.next() {
        match c {
            '\\' => match chars.next() {
                Some('n') => out.push('\n'),
                Some('t') => out.push('\t'),
                Some('r') => out.push('\r'),
                Some(other) => out.push(other),
                None => (),
            },
            _ => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_are_told_apart_and_lines_counted() {
        let mut lexer = Lexer::new("#usda 1.0\nfloat3[] primvars:st = (1e-3, -inf) # c\n\"\"\"a\nb\"\"\" @@@x@y@@@ </A.b> 'q\\'q'");
        let mut tokens = Vec::new();
        loop {
            match lexer.next().unwrap() {
                Token::End => break,
                token => tokens.push(token),
            }
        }
        assert!(tokens.contains(&Token::Word("primvars:st")) && tokens.contains(&Token::Number(f64::NEG_INFINITY)));
        assert!(tokens.contains(&Token::Text("a\nb".into())) && tokens.contains(&Token::Asset("x@y")));
        assert_eq!(tokens[tokens.len() - 2..], [Token::Path("/A.b"), Token::Text("q'q".into())]);
        assert_eq!(lexer.line, 4);
        assert!(Lexer::new("\"abc").next().unwrap_err().contains("never closed"));
    }
}
