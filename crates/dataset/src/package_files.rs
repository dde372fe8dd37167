//! Scene packages in the work folder. A variation's has only what the package of the first scene lacks; that one lies in the same folder
//! under a second name (a hard link where the file system has them).

use enfilade_scene::{PackageError, Scene, from_bytes_beside};
use std::path::Path;

/// The scene of the package at `path`, whose bytes are `bytes`, with what the package beside it has.
///
/// # Errors
/// When they are no package, or the file beside it cannot be read or is another one.
pub fn read_package(path: &Path, bytes: &[u8]) -> Result<Scene, PackageError> {
    let beside = |name: &str| std::fs::read(path.with_file_name(name)).map_err(|error| format!("which cannot be read ({error})"));
    Ok(from_bytes_beside(bytes, beside)?.0)
}
