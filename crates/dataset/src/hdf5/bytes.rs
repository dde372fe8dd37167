//! Bytes and little-endian numbers at offsets of a file, which a damaged file may not have.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Bytes that are read at once from the beginning of a file. In Hypersim's files only the tables of chunks are further on.
const HEAD: usize = 4096;

/// A file and its first bytes.
pub(super) struct FileBytes {
    file: File,
    /// Bytes in the file.
    pub length: u64,
    head: Vec<u8>,
    /// Position from which addresses in the file count, in bytes.
    base: u64,
    /// Nodes of trees that were walked.
    walked: BTreeSet<u64>,
}

impl FileBytes {
    /// `None` when the file cannot be read.
    pub fn open(path: &Path) -> Option<Self> {
        let mut file = File::open(path).ok()?;
        let length = file.metadata().ok()?.len();
        let mut head = Vec::with_capacity(HEAD);
        file.by_ref().take(HEAD as u64).read_to_end(&mut head).ok()?;
        Some(Self { file, length, head, base: 0, walked: BTreeSet::new() })
    }

    /// Lets addresses count from `base`, where an HDF5 file begins behind something else.
    pub fn based_at(self, base: u64) -> Self {
        Self { base, ..self }
    }

    /// The `length` bytes from `offset`; `None` when the file has fewer.
    pub fn bytes(&mut self, offset: u64, length: usize) -> Option<Vec<u8>> {
        let start = offset.checked_add(self.base)?;
        let end = start.checked_add(length as u64)?;
        if let (Ok(from), Ok(to)) = (usize::try_from(start), usize::try_from(end))
            && let Some(known) = self.head.get(from..to)
        {
            return Some(known.to_vec());
        }
        if end > self.length {
            return None;
        }
        let mut bytes = vec![0; length];
        self.read(offset, &mut bytes)?;
        Some(bytes)
    }

    /// [`max_inflated`] of the whole file.
    pub fn max_inflated(&self) -> u64 {
        max_inflated(self.length)
    }

    /// `None` when the node of a tree at `offset` was walked before: such a file is damaged, and might be walked for ever.
    pub fn walk(&mut self, offset: u64) -> Option<()> {
        self.walked.insert(offset).then_some(())
    }

    /// Fills `out` from `offset`; `None` when the file has fewer bytes.
    pub fn read(&mut self, offset: u64, out: &mut [u8]) -> Option<()> {
        self.file.seek(SeekFrom::Start(offset.checked_add(self.base)?)).ok()?;
        self.file.read_exact(out).ok()
    }
}

/// Bytes that `length` bytes can inflate to: no codec here shrinks by more than a factor of 1032. No damaged size may ask for more memory.
pub(super) fn max_inflated(length: u64) -> u64 {
    length.saturating_mul(1032)
}

/// Chunks that an array in a file of `length` bytes may have: those that were never written take no room in it, but some memory.
pub(super) fn max_chunks(length: u64) -> u64 {
    length.saturating_mul(32)
}

/// The unsigned number of `N` bytes at `at`.
fn number<const N: usize>(bytes: &[u8], at: usize) -> Option<u64> {
    let found = bytes.get(at..at.checked_add(N)?)?;
    Some(found.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte)))
}

pub(super) fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    number::<2>(bytes, at).map(|n| n as u16)
}

pub(super) fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    number::<4>(bytes, at).map(|n| n as u32)
}

pub(super) fn u64_at(bytes: &[u8], at: usize) -> Option<u64> {
    number::<8>(bytes, at)
}

/// A number of 8 bytes that counts elements.
pub(super) fn usize_at(bytes: &[u8], at: usize) -> Option<usize> {
    usize::try_from(u64_at(bytes, at)?).ok()
}
