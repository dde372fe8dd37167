//! Packed bytes, read from front to back.

/// The rest of packed data.
pub(super) struct Bytes<'b>(pub &'b [u8]);

/// Why data cannot be unpacked, as the rest of a sentence.
pub(super) const CUT_SHORT: &str = "ends within its packed data; the file is damaged, so export it again";

impl<'b> Bytes<'b> {
    /// The next bytes, as many as given.
    pub(super) fn take(&mut self, count: usize) -> Result<&'b [u8], String> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or(CUT_SHORT)?;
        self.0 = rest;
        Ok(taken)
    }

    pub(super) fn byte(&mut self) -> Result<u8, String> {
        let (byte, rest) = self.0.split_first().ok_or(CUT_SHORT)?;
        self.0 = rest;
        Ok(*byte)
    }

    /// A number of seven bits a byte, the lowest first (LEB128).
    pub(super) fn number(&mut self) -> Result<u32, String> {
        let mut number = 0u32;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            number |= u32::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                break;
            }
        }
        Ok(number)
    }

    /// Refuses data that are longer than what was read of them.
    pub(super) fn end(&self) -> Result<(), String> {
        match self.0.len() {
            0 => Ok(()),
            left => Err(format!("has {left} bytes behind its packed data; the file is damaged, so export it again")),
        }
    }
}

/// Signed numbers from unsigned ones: 0, −1, 1, −2, 2 and so on, modulo 2³².
pub(super) fn signed(v: u32) -> u32 {
    v >> 1 ^ 0u32.wrapping_sub(v & 1)
}
