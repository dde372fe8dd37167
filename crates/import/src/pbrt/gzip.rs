//! Files that may be compressed by gzip: scene files (`.pbrt.gz`), included ones and meshes (`.ply.gz`).

use crate::ImportError;
use std::io::Read;
use std::path::Path;

/// A compressed file may unpack to this many bytes.
const MAX_UNPACKED: u64 = 4 << 30;

/// The bytes themselves or, when they are compressed by gzip, unpacked.
pub(super) fn unpacked(bytes: Vec<u8>, path: &Path) -> Result<Vec<u8>, ImportError> {
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes);
    }
    let mut out = Vec::new();
    let read = flate2::read::MultiGzDecoder::new(bytes.as_slice()).take(MAX_UNPACKED + 1).read_to_end(&mut out);
    read.map_err(|e| {
        ImportError::malformed(path, "gzip", format!("cannot be unpacked ({e}); copy the file again or unpack it by gzip -d"))
    })?;
    if out.len() as u64 > MAX_UNPACKED {
        return Err(ImportError::malformed(path, "gzip", "unpacks to more than 4 GiB; split the scene into several files"));
    }
    Ok(out)
}
