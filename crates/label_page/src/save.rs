//! Files written beside the log: a table of labels or the list of classes, and Hypersim's files if no label stage writes them.

use super::pieces::Pieces;
use super::without_log::LIST;
use enfilade_dataset::{Classes, DatasetError, LabelColors, MeshFiles, write_bytes};
use enfilade_label::write_part_table;
use enfilade_scene::{Labels, PartLabel};
use std::path::PathBuf;

/// Everything that is written, copied at one moment, so that editing can continue meanwhile.
pub struct Snapshot {
    labels: Labels,
    instances: usize,
    whole: Vec<String>,
    split: Vec<(String, u32)>,
    piece_of_face: Vec<u32>,
}

impl Snapshot {
    /// Copies the pieces as they are now. `next_instance` is the first instance number that was never given out.
    pub fn new(pieces: &Pieces, next_instance: i32) -> Self {
        let whole = pieces.scene().parts.clone();
        Self {
            labels: Labels { parts: pieces.list().iter().map(|piece| piece.label).collect() },
            instances: next_instance.max(1) as usize - 1,
            split: pieces.list()[whole.len()..].iter().map(|piece| (piece.name.clone(), piece.part)).collect(),
            whole,
            piece_of_face: pieces.of_face().to_vec(),
        }
    }

    /// A hash of the objects and their faces. Their tables are slow to write, and are skipped while the hash stays the same.
    pub fn objects_hash(&self) -> blake3::Hash {
        let mut hasher = blake3::Hasher::new();
        hasher.update(bytemuck::cast_slice(&self.piece_of_face));
        self.split.iter().for_each(|(name, _)| {
            hasher.update(name.as_bytes()).update(b"\n");
        });
        hasher.finalize()
    }

    /// Writes the label tables and colours, with `objects` also the tables of objects, and returns the files. Each is replaced whole.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_tables(&self, files: &MeshFiles, classes: &Classes, objects: bool) -> Result<Vec<PathBuf>, DatasetError> {
        let mut written = Vec::new();
        if objects {
            written.extend(files.write_objects(&self.whole, &self.split, &self.piece_of_face)?);
        }
        let colors = LabelColors { semantic: classes.color_rows(), instances: self.instances };
        written.extend(files.write_labels(&self.labels, &colors)?);
        Ok(written)
    }

    /// Writes a table of labels by the names of parts, or the list of classes that is not NYU40, and returns the file.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_list(&self, files: &MeshFiles, classes: &Classes) -> Result<PathBuf, DatasetError> {
        if classes.are_nyu40() {
            let names: Vec<&str> = self.whole.iter().map(String::as_str).collect();
            let labels: &[PartLabel] = &self.labels.parts[..names.len()];
            let path = files.file(LIST);
            write_bytes(&path, write_part_table(&names, labels)).map(|()| path)
        } else {
            files.write_classes(classes)
        }
    }
}
