//! An unfinished frame as bytes, so that it can continue in another process.
//!
//! All numbers are little-endian: eight bytes of signature, the version of this form, width, height, passes done and in all, 1 if light is
//! kept in parts, the number of fixtures that light is separated by, the length of the key and the key; per pixel its final number of
//! samples, row by row; per pixel its sums, tile by tile; a checksum of all that. Sums are stored exactly, so a continued frame has the
//! same bytes as one that was never interrupted.

use enfilade_math::hash_u64;

const SIGNATURE: [u8; 8] = *b"enfilpar";
/// Version of this form, and of what the sums mean.
const VERSION: u32 = 5;
/// Words before the key.
const HEADER: usize = 7;

/// Why a frame cannot continue from bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PartialError {
    /// Another kind of file, or written by another version.
    #[error("it is no frame in the making, or one of another version")]
    Foreign,
    /// Cut short or changed.
    #[error("it is damaged: its length or its checksum is not right")]
    Damaged,
    /// A file of another size, or with another key.
    #[error("it belongs to another frame or to other settings")]
    OtherFrame,
}

/// The header before the pixels.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Header<'a> {
    pub size: [u32; 2],
    pub done: u32,
    /// Passes in all, as far as is known.
    pub passes: u32,
    pub light_parts: bool,
    /// Number of fixtures that light is separated by.
    pub fixtures: u32,
    /// The caller's name for everything that the frame depends on.
    pub key: &'a [u8],
}

/// The bytes of a frame whose pixels are these words.
pub(crate) fn write(header: &Header<'_>, words: impl Iterator<Item = u32>) -> Vec<u8> {
    let mut bytes = SIGNATURE.to_vec();
    let [width, height] = header.size;
    let Header { done, passes, light_parts, fixtures, key, .. } = *header;
    let numbers: [u32; HEADER] = [width, height, done, passes, u32::from(light_parts), fixtures, key.len() as u32];
    std::iter::once(VERSION).chain(numbers).for_each(|number| bytes.extend(number.to_le_bytes()));
    bytes.extend(key);
    words.for_each(|word| bytes.extend(word.to_le_bytes()));
    let sum = checksum(&bytes);
    bytes.extend(sum.to_le_bytes());
    bytes
}

/// Header and words of what [`write`] wrote.
pub(crate) fn read(bytes: &[u8]) -> Result<(Header<'_>, impl ExactSizeIterator<Item = u32>), PartialError> {
    let rest = bytes.strip_prefix(&SIGNATURE).ok_or(PartialError::Foreign)?;
    let (version, rest) = word(rest)?;
    if version != VERSION {
        return Err(PartialError::Foreign);
    }
    let (content, sum) = bytes.split_last_chunk::<8>().ok_or(PartialError::Damaged)?;
    if checksum(content) != u64::from_le_bytes(*sum) {
        return Err(PartialError::Damaged);
    }
    let (width, rest) = word(rest)?;
    let (height, rest) = word(rest)?;
    let (done, rest) = word(rest)?;
    let (passes, rest) = word(rest)?;
    let (light_parts, rest) = word(rest)?;
    let (fixtures, rest) = word(rest)?;
    let (length, rest) = word(rest)?;
    let (key, rest) = rest.split_at_checked(length as usize).ok_or(PartialError::Damaged)?;
    let (words, checksum) = rest.as_chunks::<4>();
    // The checksum is two words.
    if !checksum.is_empty() || words.len() < 2 {
        return Err(PartialError::Damaged);
    }
    let header = Header { size: [width, height], done, passes, light_parts: light_parts != 0, fixtures, key };
    Ok((header, words[..words.len() - 2].iter().map(|word| u32::from_le_bytes(*word))))
}

fn word(bytes: &[u8]) -> Result<(u32, &[u8]), PartialError> {
    let (word, rest) = bytes.split_first_chunk::<4>().ok_or(PartialError::Damaged)?;
    Ok((u32::from_le_bytes(*word), rest))
}

/// Finds damage; it is no protection against forgery.
fn checksum(bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks::<8>();
    let mut last = [0; 8];
    last[..rest.len()].copy_from_slice(rest);
    let words = words.iter().chain([&last]).map(|word| u64::from_le_bytes(*word));
    words.fold(bytes.len() as u64, |sum, word| hash_u64(sum ^ word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_written_is_read_and_every_damaged_byte_is_found() {
        let header = Header { size: [3, 2], done: 4, passes: 6, light_parts: true, fixtures: 2, key: b"key" };
        let bytes = write(&header, 10..20);
        let (found, words) = read(&bytes).unwrap();
        assert_eq!((found, words.collect::<Vec<_>>()), (header, (10..20).collect()));
        for i in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[i] ^= 16;
            assert!(read(&damaged).is_err(), "byte {i}");
            assert!(read(&bytes[..i]).is_err(), "cut at {i}");
        }
        assert_eq!(read(b"scene").err(), Some(PartialError::Foreign));
        assert_eq!(read(&[bytes.as_slice(), &[0]].concat()).err(), Some(PartialError::Damaged));
    }
}
