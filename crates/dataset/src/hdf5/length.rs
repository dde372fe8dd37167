//! The length that a file must have by its header, to find files that were cut short without decoding them.

use super::bytes::FileBytes;
use std::path::Path;

/// First bytes of HDF5 files.
const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Bytes that an HDF5 file has and those that its superblock counts, where it has fewer: it was cut short. `None` for whole files, for
/// what is no HDF5 file, and for files that cannot be read.
pub fn missing_bytes(path: &Path) -> Option<[u64; 2]> {
    let mut file = FileBytes::open(path)?;
    if file.bytes(0, SIGNATURE.len())? != SIGNATURE {
        return None;
    }
    // HDF5 File Format Specification, version 3: base address and end of file in superblocks of versions 0 to 3, with addresses of
    // eight bytes.
    let [base, end] = match file.bytes(8, 6)?[..] {
        [0, _, _, _, _, 8] => [24, 40],
        [1, _, _, _, _, 8] => [28, 44],
        [2 | 3, 8, ..] => [12, 28],
        _ => return None,
    };
    let mut number = |at: u64| Some(u64::from_le_bytes(file.bytes(at, 8)?.try_into().ok()?));
    let expected = number(base)?.checked_add(number(end)?)?;
    (file.length < expected).then_some([file.length, expected])
}

#[cfg(test)]
mod tests {
    use super::super::{Array, Storage, write_array};
    use super::*;

    #[test]
    fn files_that_are_cut_short_say_how_long_they_should_be() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.hdf5");
        write_array(&path, &Array::f64(&[100], vec![0.5; 100]), Storage::Contiguous, &[]).unwrap();
        assert_eq!(missing_bytes(&path), None);
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() - 300]).unwrap();
        assert_eq!(missing_bytes(&path), Some([bytes.len() as u64 - 300, bytes.len() as u64]));
        std::fs::write(&path, "no HDF5").unwrap();
        assert_eq!(missing_bytes(&path), None);
    }
}
