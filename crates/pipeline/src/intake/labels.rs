//! The labels that came with a scene file.

use enfilade_import::ImportedLabel;
use enfilade_scene::{Labels, PartLabel, Scene};

/// The labels of all parts, where a file labels some of them.
pub(crate) fn labels_by_part(scene: &Scene, labels: &[ImportedLabel]) -> Labels {
    let mut parts = vec![PartLabel::NONE; scene.parts.len()];
    for label in labels {
        parts[label.part as usize] = label.label;
    }
    Labels { parts }
}
