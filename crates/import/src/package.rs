//! The scene package: read, checked and passed on.

use crate::assembly::Assembly;
use crate::{ImportError, Imported};

/// Reads a scene package. Units and axes are already the world's, so only the environment can be overridden.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let file = assembly.file().to_path_buf();
    let bytes = assembly.read_scene_file()?;
    let (scene, labels) = enfilade_scene::from_bytes_with_labels(&bytes).map_err(|source| ImportError::Package { file, source })?;
    assembly.set_labels(labels);
    assembly.finish_scene(scene)
}
