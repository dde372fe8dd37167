//! The labels that came with a scene file.

use enfilade_import::{Imported, ImportedLabel};
use enfilade_scene::{LabelledScene, Labels, PartLabel, Scene};

/// The labels of all parts, where a file labels some of them.
pub(crate) fn labels_by_part(scene: &Scene, labels: &[ImportedLabel]) -> Labels {
    let mut parts = vec![PartLabel::NONE; scene.parts.len()];
    for label in labels {
        parts[label.part as usize] = label.label;
    }
    Labels { parts }
}

/// An imported scene with the labels of its file, none where it has none.
pub(crate) fn labelled(imported: Imported) -> LabelledScene {
    let Imported { scene, labels, picture_files, .. } = imported;
    let labels = labels_by_part(&scene, labels.as_deref().unwrap_or_default());
    LabelledScene { scene, labels, picture_files }
}
