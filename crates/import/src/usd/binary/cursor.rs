//! A place in the bytes of a crate file: numbers and packed blocks read from there, with every bound checked.

use lz4_flex::block::decompress_into;

/// LZ4 cannot pack more tightly than this; a file that claims more is damaged.
const MAX_RATIO: u64 = 256;

/// A place in a file's bytes.
#[derive(Clone, Copy)]
pub(super) struct Cursor<'a> {
    pub bytes: &'a [u8],
    pub at: u64,
}

/// A result, or the position of a faulty byte and its fault.
pub(super) type Checked<T> = Result<T, (u64, String)>;

impl<'a> Cursor<'a> {
    /// An error here.
    pub(super) fn error<T>(&self, problem: impl Into<String>) -> Checked<T> {
        Err((self.at, problem.into()))
    }

    /// The next `count` bytes.
    pub(super) fn take(&mut self, count: u64) -> Checked<&'a [u8]> {
        let end = self.at.checked_add(count).filter(|end| *end <= self.bytes.len() as u64);
        let Some(end) = end else {
            let left = (self.bytes.len() as u64).saturating_sub(self.at);
            return self.error(format!(
                "{count} bytes were expected, but the file has {left} more: it is cut short or damaged, so export it again"
            ));
        };
        let bytes = &self.bytes[self.at as usize..end as usize];
        self.at = end;
        Ok(bytes)
    }

    fn array<const N: usize>(&mut self) -> Checked<[u8; N]> {
        let mut out = [0; N];
        out.copy_from_slice(self.take(N as u64)?);
        Ok(out)
    }

    pub(super) fn u8(&mut self) -> Checked<u8> {
        self.array::<1>().map(|[b]| b)
    }

    pub(super) fn u32(&mut self) -> Checked<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Checked<u64> {
        self.array().map(u64::from_le_bytes)
    }

    pub(super) fn i64(&mut self) -> Checked<i64> {
        self.array().map(i64::from_le_bytes)
    }

    pub(super) fn f64(&mut self) -> Checked<f64> {
        self.array().map(f64::from_le_bytes)
    }

    /// A count of things that take at least `size` bytes each from here on.
    pub(super) fn count(&mut self, size: u64) -> Checked<usize> {
        let here = *self;
        let count = self.u64()?;
        let left = self.bytes.len() as u64 - self.at;
        if count.checked_mul(size).is_none_or(|bytes| bytes > left) {
            return here.error(format!("found a count of {count}, which is more than the rest of the file holds; the file is damaged"));
        }
        Ok(count as usize)
    }

    /// A place `offset` bytes from here, as values within values have it.
    pub(super) fn jump(&mut self) -> Checked<Self> {
        let here = *self;
        let offset = self.i64()?;
        match here.at.checked_add_signed(offset).filter(|at| *at <= self.bytes.len() as u64) {
            Some(at) => Ok(Self { bytes: self.bytes, at }),
            None => here.error(format!("found an offset of {offset}, which leads out of the file; the file is damaged")),
        }
    }

    /// The next `packed` bytes, unpacked to at most `limit`: LZ4 blocks after a byte that counts them.
    pub(super) fn unpack(&mut self, packed: u64, limit: u64) -> Checked<Vec<u8>> {
        let here = *self;
        let bytes = self.take(packed)?;
        let Some((&chunks, mut rest)) = bytes.split_first() else { return here.error("found an empty packed block; the file is damaged") };
        let limit = limit.min(packed * MAX_RATIO).min(unpacked_limit(self.bytes.len() as u64)) as usize;
        let broken = || here.error("a packed block cannot be unpacked; the file is damaged, so export it again");
        let mut out = vec![0; limit];
        let mut length = 0;
        for _ in 0..chunks.max(1) {
            let block = if chunks == 0 {
                rest
            } else {
                let Some((size, after)) = rest.split_first_chunk::<4>() else { return broken() };
                let Some((block, after)) = after.split_at_checked(u32::from_le_bytes(*size) as usize) else { return broken() };
                rest = after;
                block
            };
            match decompress_into(block, &mut out[length..]) {
                Ok(written) => length += written,
                Err(_) => return broken(),
            }
        }
        out.truncate(length);
        Ok(out)
    }

    /// `count` packed integers of 32 bits, or 64 when `wide`.
    pub(super) fn integers(&mut self, count: usize, wide: bool) -> Checked<Vec<i64>> {
        let here = *self;
        let packed = self.count(1)? as u64;
        if count == 0 {
            self.take(packed)?;
            return Ok(Vec::new());
        }
        if count as u64 > packed.saturating_mul(4 * MAX_RATIO).min(unpacked_limit(self.bytes.len() as u64) / 8) {
            return here.error(format!("found a count of {count} integers in {packed} packed bytes; the file is damaged"));
        }
        let size = if wide { 8 } else { 4 };
        let encoded = self.unpack(packed, size + (count as u64).div_ceil(4) + count as u64 * size)?;
        integers(&encoded, count, wide)
            .map_or_else(|| here.error("packed integers end too early; the file is damaged, so export it again"), Ok)
    }
}

/// Integers as differences: the most common difference, two bits each for the size of the difference in bytes (none for the common one),
/// and the differences.
fn integers(encoded: &[u8], count: usize, wide: bool) -> Option<Vec<i64>> {
    let sizes = if wide { [0, 2, 4, 8] } else { [0, 1, 2, 4] };
    let (common, rest) = encoded.split_at_checked(sizes[3])?;
    let common = signed(common);
    let (codes, mut rest) = rest.split_at_checked(count.div_ceil(4))?;
    let mut value = 0i64;
    let mut out = Vec::with_capacity(count);
    for i in 0..count {
        let size = sizes[usize::from(codes[i / 4] >> (2 * (i % 4)) & 3)];
        let (difference, after) = rest.split_at_checked(size)?;
        rest = after;
        value = value.wrapping_add(if size == 0 { common } else { signed(difference) });
        out.push(value);
    }
    Some(out)
}

/// A signed integer from its bytes, the lowest first.
fn signed(bytes: &[u8]) -> i64 {
    let unsigned = bytes.iter().rev().fold(0u64, |n, b| n << 8 | u64::from(*b));
    let unused = 64 - 8 * bytes.len() as u32;
    if unused >= 64 { 0 } else { (unsigned << unused) as i64 >> unused }
}

/// Element `i` of a table of the file.
pub(super) fn index<'t, T>(table: &'t [T], i: i64, what: &str, at: &Cursor) -> Checked<&'t T> {
    match usize::try_from(i).ok().and_then(|i| table.get(i)) {
        Some(found) => Ok(found),
        None => at.error(format!("found {what} {i}, but there are only {}; the file is damaged, so export it again", table.len())),
    }
}

/// Memory that a binary file may unpack to: far beyond any scene of its size, far below what a few bytes could ask for.
pub(super) fn unpacked_limit(file_bytes: u64) -> u64 {
    (1 << 28) + 64 * file_bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_become_integers() {
        // 123, 124, 125, 100125, 100125, 100126, 100126: the format's own example, with 1 as the common difference.
        let encoded = [1, 0, 0, 0, 0b11_00_00_01, 0b00_01_00_01, 123, 0xa0, 0x86, 0x01, 0x00, 0, 0];
        assert_eq!(integers(&encoded, 7, false), Some(vec![123, 124, 125, 100_125, 100_125, 100_126, 100_126]));
        assert_eq!(integers(&encoded[..12], 7, false), None);
        assert_eq!((signed(&[0xff]), signed(&[0x00, 0x80]), signed(&[])), (-1, -32_768, 0));
    }

    #[test]
    fn impossible_counts_allocate_nothing() {
        let bytes = [0xff; 16];
        assert!(Cursor { bytes: &bytes, at: 0 }.count(1).is_err());
        assert!(Cursor { bytes: &bytes, at: 0 }.jump().is_err());
        assert!(Cursor { bytes: &[8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], at: 0 }.integers(1 << 40, false).is_err());
    }
}
