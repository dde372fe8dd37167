//! The body of a PLY file: numbers, row by row.

use super::header::{Element, Encoding, Header, Kind, Problem};

/// The numbers of the body, one after the other.
///
/// In text files a row is a line. One that continues in the next line is read, as many programs do, but a row that does not end where its
/// line does is refused: its file and its header disagree, and all rows behind it would shift.
pub(super) struct Values<'b> {
    encoding: Encoding,
    line_end: u8,
    bytes: &'b [u8],
    at: usize,
    /// Number of lines of the header.
    header_lines: usize,
    /// Values of the current row so far.
    in_row: usize,
    /// Place of the first row that went on in the next line, and what was found there.
    continued: Option<Problem>,
}

impl<'b> Values<'b> {
    /// The body that follows a header.
    pub(super) fn new(header: &Header, bytes: &'b [u8]) -> Self {
        let Header { encoding, line_end, lines, .. } = *header;
        Self { encoding, line_end, bytes, at: 0, header_lines: lines, in_row: 0, continued: None }
    }

    /// Description of the data after the last row, for a warning; `None` if there are only blanks.
    pub(super) fn trailing(&mut self) -> Option<String> {
        if self.encoding == Encoding::Text {
            self.skip_comments();
        }
        let rest = &self.bytes[self.at..];
        let is_something = |b: &u8| !b.is_ascii_whitespace() && *b != 0;
        rest.iter().any(is_something).then(|| match self.encoding {
            Encoding::Text => {
                let lines = rest.split(|b| *b == self.line_end).filter(|line| line.iter().any(is_something)).count();
                format!("{lines} lines follow the last row that the header announces; they were left out")
            }
            Encoding::Little | Encoding::Big => {
                format!("{} bytes follow the last row that the header announces; they were left out", rest.len())
            }
        })
    }

    /// The place of a byte of the body, for messages.
    fn place(&self, at: usize) -> String {
        match self.encoding {
            Encoding::Text => format!("line {}", self.header_lines + 1 + self.bytes[..at].iter().filter(|b| **b == self.line_end).count()),
            Encoding::Little | Encoding::Big => format!("byte {at} of the body"),
        }
    }

    fn begin_row(&mut self) {
        self.in_row = 0;
    }

    /// Checks that a row ends where its line does.
    fn end_row(&mut self, element: &str) -> Result<(), Problem> {
        if self.encoding != Encoding::Text || self.in_row == 0 {
            return Ok(());
        }
        let rest = &self.bytes[self.at..];
        let line = &rest[..rest.iter().position(|b| *b == self.line_end).unwrap_or(rest.len())];
        if line.iter().all(u8::is_ascii_whitespace) {
            return Ok(());
        }
        let more = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count();
        Err(self.continued.take().unwrap_or_else(|| {
            let problem = format!(
                "found {} values in a row of {element:?}, expected {} by the header and the lengths of its lists; correct the header or export \
                 the file again",
                self.in_row + more,
                self.in_row
            );
            (self.place(self.at), problem)
        }))
    }

    fn next(&mut self, kind: Kind) -> Result<f64, Problem> {
        if self.encoding == Encoding::Text {
            return self.next_word();
        }
        let bytes = self.bytes.get(self.at..self.at + kind.size());
        let bytes = bytes.ok_or_else(|| (self.place(self.at), "the file is cut short; copy or export it again".to_string()))?;
        self.at += kind.size();
        let mut le = [0u8; 8];
        le[..kind.size()].copy_from_slice(bytes);
        if self.encoding == Encoding::Big {
            le[..kind.size()].reverse();
        }
        let word = u32::from_le_bytes([le[0], le[1], le[2], le[3]]);
        Ok(match kind {
            Kind::I8 => f64::from(le[0] as i8),
            Kind::U8 => f64::from(le[0]),
            Kind::I16 => f64::from(word as u16 as i16),
            Kind::U16 => f64::from(word as u16),
            Kind::I32 => f64::from(word as i32),
            Kind::U32 => f64::from(word),
            Kind::F32 => f64::from(f32::from_bits(word)),
            Kind::F64 => f64::from_le_bytes(le),
        })
    }

    /// Passes over lines of comments before a row; some programs write them among rows as well as in the header.
    fn skip_comments(&mut self) {
        loop {
            let rest = &self.bytes[self.at..];
            let start = rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(rest.len());
            let is_comment = rest[start..].strip_prefix(b"comment").is_some_and(|text| text.first().is_none_or(u8::is_ascii_whitespace));
            if !is_comment {
                return;
            }
            let end = rest[start..].iter().position(|b| *b == self.line_end).unwrap_or(rest.len() - start);
            self.at += start + end;
        }
    }

    fn next_word(&mut self) -> Result<f64, Problem> {
        if self.in_row == 0 {
            self.skip_comments();
        }
        let rest = &self.bytes[self.at..];
        let start = rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(rest.len());
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        if self.in_row > 0 && self.continued.is_none() && rest[..start].contains(&self.line_end) {
            let problem = format!("found {} values in the row, expected more by the header; export the file again", self.in_row);
            self.continued = Some((self.place(self.at), problem));
        }
        let word = String::from_utf8_lossy(&rest[start..start + length]);
        let place = || self.place(self.at + start);
        let value = match word.as_ref() {
            "" => {
                let cut = || (place(), "the file is cut short; copy or export it again".to_string());
                Err(self.continued.clone().unwrap_or_else(cut))
            }
            word => word.parse().map_err(|_| (place(), format!("{word:?} is not a number; export the file again"))),
        };
        self.at += start + length;
        self.in_row += 1;
        value
    }
}

impl Element {
    /// Reads one row and hands every value over with the index of its property. List items come one by one.
    pub(super) fn row(&self, values: &mut Values, take: &mut dyn FnMut(usize, f64)) -> Result<(), Problem> {
        values.begin_row();
        for (i, property) in self.properties.iter().enumerate() {
            let count = property.list.map_or(Ok(1.0), |kind| values.next(kind))?;
            if !(0.0..=f64::from(u32::MAX)).contains(&count) {
                let problem = format!("a list of {count} items in property {}; the file is damaged", property.name);
                return Err((values.place(values.at), problem));
            }
            for _ in 0..count as u64 {
                take(i, values.next(property.kind)?);
            }
        }
        values.end_row(&self.name)
    }
}
