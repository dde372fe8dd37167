//! The labels that came with a scene file.

use crate::error::Error;
use enfilade_import::{Imported, ImportedLabel};
use enfilade_label::LabelTable;
use enfilade_scene::{LabelledScene, Labels, PartLabel, Scene};
use std::path::Path;

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

/// Reads a table of labels.
///
/// # Errors
/// When it cannot be read, or is no such table.
pub(crate) fn read_table(path: &Path) -> Result<LabelTable, Error> {
    let bytes = std::fs::read(path).map_err(Error::io("read the label table", path))?;
    LabelTable::parse(&bytes, &path.display().to_string()).map_err(Error::stage)
}
