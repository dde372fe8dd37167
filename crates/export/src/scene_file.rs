//! A scene with its labels as one file, in the form that the file's name calls for.

use crate::{ExportError, SceneGltf, scene_gltf};
use enfilade_scene::{Labels, PictureFiles, Scene, to_bytes, to_bytes_with_labels};
use std::path::Path;

/// Returns the bytes of a scene with its labels, and notes on what the format cannot represent; pictures whose files are available may be
/// passed on as they are.
pub type SceneEncoder = fn(&Scene, Option<&Labels>, &PictureFiles) -> (Vec<u8>, Vec<String>);

/// The encoder for a file of this name: as a package (`.scene`), or as binary glTF (`.glb`).
///
/// # Errors
/// When the name ends otherwise.
pub fn scene_encoder(output: &Path) -> Result<SceneEncoder, ExportError> {
    let extension = output.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("scene") => {
            Ok(|scene, labels, _| (labels.map_or_else(|| to_bytes(scene), |labels| to_bytes_with_labels(scene, labels)), Vec::new()))
        }
        Some("glb") => Ok(|scene, labels, files| {
            let SceneGltf { glb, notes } = scene_gltf(scene, labels.unwrap_or(&Labels::default()), files);
            (glb, notes)
        }),
        _ => {
            let remedy = "end it with .scene (a package, nothing is lost) or .glb (glTF, for other programs)";
            Err(ExportError::Selection(format!("cannot tell from the name {} how to write the scene; {remedy}", output.display())))
        }
    }
}
