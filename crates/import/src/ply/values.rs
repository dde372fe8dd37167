//! The body of a PLY file: numbers, row by row.

use super::header::{Element, Encoding, Kind, Problem};

/// The numbers of the body, one after the other.
pub(super) struct Values<'b> {
    pub encoding: Encoding,
    pub bytes: &'b [u8],
    pub at: usize,
}

impl Values<'_> {
    fn next(&mut self, kind: Kind) -> Result<f64, Problem> {
        if self.encoding == Encoding::Text {
            return self.next_word();
        }
        let place = self.at;
        let bytes = self.bytes.get(place..place + kind.size());
        let bytes =
            bytes.ok_or_else(|| (format!("byte {place} of the body"), "the file is cut short; copy or export it again".to_string()))?;
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

    fn next_word(&mut self) -> Result<f64, Problem> {
        let rest = &self.bytes[self.at..];
        let start = rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(rest.len());
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        let word = String::from_utf8_lossy(&rest[start..start + length]);
        let place = || format!("byte {} of the body", self.at + start);
        let value = match word.as_ref() {
            "" => Err((place(), "the file is cut short; copy or export it again".to_string())),
            word => word.parse().map_err(|_| (place(), format!("{word:?} is not a number; export the file again"))),
        };
        self.at += start + length;
        value
    }
}

impl Element {
    /// Reads one row and hands every value over with the index of its property. List items come one by one.
    pub(super) fn row(&self, values: &mut Values, take: &mut dyn FnMut(usize, f64)) -> Result<(), Problem> {
        for (i, property) in self.properties.iter().enumerate() {
            let count = property.list.map_or(Ok(1.0), |kind| values.next(kind))?;
            if !(0.0..=f64::from(u32::MAX)).contains(&count) {
                let problem = format!("a list of {count} items in property {}; the file is damaged", property.name);
                return Err((format!("byte {} of the body", values.at), problem));
            }
            for _ in 0..count as u64 {
                take(i, values.next(property.kind)?);
            }
        }
        Ok(())
    }
}
