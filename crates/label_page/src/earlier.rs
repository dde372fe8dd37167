//! The labels of an earlier version of a scene, as its folder of labels has them.

use super::part_shapes::{PartShape, SHAPES};
use enfilade_dataset::{ANNOTATION_LOG, DatasetError, MeshFiles};
use enfilade_label::annotation::{Annotation, AnnotationError, parse};
use enfilade_scene::PartLabel;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Why labels cannot be carried over.
#[derive(Debug, thiserror::Error)]
pub enum CarryError {
    /// The folder has no labels that can be carried over.
    #[error("{}: {problem}; --carry takes the folder of labels of an earlier version of the scene", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// What was found there.
        problem: String,
    },
    /// The scene has edits already.
    #[error("{} has edits already, and --carry begins an annotation; leave it out, or name another folder with --labels", .0.display())]
    Begun(PathBuf),
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] DatasetError),
    /// The log cannot be read.
    #[error(transparent)]
    Log(#[from] AnnotationError),
}

/// A part of the earlier version that had a label.
pub struct Old {
    /// Name of the part.
    pub name: String,
    /// Shape and place, where they are known.
    pub known: Option<PartShape>,
    /// The part's label: of several, the first.
    pub label: PartLabel,
    /// True where its pieces have several labels.
    pub is_mixed: bool,
}

/// The labelled parts of the earlier version: by its log and the table of shapes, else by the tables of labels.
///
/// # Errors
/// When the folder has no labels, or they cannot be read.
pub fn earlier(from: &Path) -> Result<Vec<Old>, CarryError> {
    let wrong = |problem: String| CarryError::Folder { folder: from.to_path_buf(), problem };
    let shapes = PartShape::read(from).map_err(wrong)?;
    let log = from.join(ANNOTATION_LOG);
    let tables = match &shapes {
        Some(shapes) if log.is_file() => {
            let bytes = std::fs::read(&log).map_err(|source| DatasetError::Io { action: "read", path: log.clone(), source })?;
            let at = |problem| AnnotationError::at(&log, problem);
            let (header, entries) = parse(&bytes).map_err(at)?.ok_or_else(|| wrong("its log is empty".into()))?;
            if header.parts != shapes.len() {
                return Err(wrong(format!("its log is about {} parts, and {SHAPES} has {}", header.parts, shapes.len())));
            }
            let faces: Vec<usize> = shapes.iter().map(|part| part.shape.numbers().0).collect();
            let found = Annotation::of_log(&header, entries, &faces).map_err(at)?;
            let pieces = found.pieces.into_iter().map(|(_, part)| part).collect();
            Tables { names: shapes.iter().map(|part| part.name.clone()).collect(), labels: found.labels.parts, pieces }
        }
        _ => of_tables(from, &wrong)?,
    };
    Ok(labelled(&tables, shapes.as_deref()))
}

/// What is labelled.
struct Tables {
    /// Names of the parts.
    names: Vec<String>,
    /// Labels of the parts, then of the pieces that were split off.
    labels: Vec<PartLabel>,
    /// The part of each such piece.
    pieces: Vec<u32>,
}

/// By the tables of labels.
fn of_tables(from: &Path, wrong: &dyn Fn(String) -> CarryError) -> Result<Tables, CarryError> {
    let files = MeshFiles::new(from);
    let labels = match files.read_labels() {
        Err(error) if error.is_not_found() => return Err(wrong("it has no labels".into())),
        labels => labels?.parts,
    };
    let pieces = files.read_pieces()?;
    let mut names = files.read_object_names()?;
    if names.len() != labels.len() || pieces.len() > names.len() {
        return Err(wrong(format!("its tables label {} objects of {}", labels.len(), names.len())));
    }
    names.truncate(names.len() - pieces.len());
    Ok(Tables { names, labels, pieces })
}

/// The parts that have a label, with that of their pieces where all agree.
fn labelled(tables: &Tables, shapes: Option<&[PartShape]>) -> Vec<Old> {
    let Tables { names, labels, pieces } = tables;
    let mut all: HashMap<usize, Vec<PartLabel>> = HashMap::new();
    for (number, label) in labels.iter().enumerate() {
        let part = number.checked_sub(names.len()).map_or(number, |beyond| pieces.get(beyond).map_or(number, |&part| part as usize));
        all.entry(part).or_default().push(*label);
    }
    let old = |(number, name): (usize, &String)| {
        let labels = all.get(&number)?;
        let label = *labels.iter().find(|label| **label != PartLabel::NONE)?;
        let known = shapes.and_then(|shapes| shapes.get(number)).filter(|shape| shape.name == *name).cloned();
        Some(Old { name: name.clone(), known, label, is_mixed: labels.iter().any(|other| *other != label) })
    };
    names.iter().enumerate().filter_map(old).collect()
}
