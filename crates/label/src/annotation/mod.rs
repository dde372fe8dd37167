//! The labels from `enfilade annotate`, by the log of edits.
//!
//! The log is all that an annotation is: a first line about the scene ([`Header`]), then a line for every edit ([`Entry`]), each decided so
//! that doing it again gives the same labels. [`Annotation::read`] does them again. What is labelled is called a piece: a part of the scene,
//! or a piece of a part that was split.

mod before;
mod edit;
mod labelled;
mod log_lines;
mod replay;
mod steps;

pub use before::Before;
pub use edit::{Edit, numbers, runs};
pub use labelled::Annotation;
pub use log_lines::{Entry, FORMAT, FORMAT_OF_PEOPLE, Header, LogProblem, parse};
pub use steps::{Step, StepProblem, Steps};

use enfilade_dataset::{ANNOTATION_LOG, DatasetError, MeshFiles, scene_hash};
use enfilade_scene::{Labels, PartId, Scene};
use replay::Replay;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Why an annotation cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum AnnotationError {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] DatasetError),
    /// The log is of another form.
    #[error("{}:1: found the format {found:?}, expected {FORMAT:?}; use the enfilade that wrote it, or a newer one", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// The format that it states.
        found: String,
    },
    /// A line is not valid.
    #[error("{}:{line}: {problem}; remove this line and those after it to continue from there, or restore a copy", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// From 1.
        line: usize,
        /// The problem.
        problem: String,
    },
    /// The log belongs to another scene: its labels would go to parts that nobody labelled so.
    #[error(
        "{} is about another scene: its parts have other names, another order or other numbers of faces than those of the scene package",
        path.display()
    )]
    OtherScene {
        /// The file.
        path: PathBuf,
    },
}

impl Annotation {
    /// Reads what people labelled in `scene` from the log beside its mesh; `None` if the log has no edits, though people may have opened
    /// the page.
    ///
    /// # Errors
    /// When the log cannot be read, has an edit that cannot be done, or is about another scene.
    pub fn read(files: &MeshFiles, scene: &Scene) -> Result<Option<Self>, AnnotationError> {
        let path = files.file(ANNOTATION_LOG);
        let bytes = match std::fs::read(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            bytes => bytes.map_err(|source| DatasetError::Io { action: "read", path: path.clone(), source })?,
        };
        let Some((header, entries)) = parse(&bytes).map_err(|problem| AnnotationError::at(&path, problem))? else { return Ok(None) };
        if entries.is_empty() {
            return Ok(None);
        }
        let faces = faces_of_parts(scene);
        let parts = scene.parts.iter().map(|part| part.name.trim()).zip(faces.iter().copied());
        if scene_hash(parts) != header.scene_hash || header.parts != scene.parts.len() {
            return Err(AnnotationError::OtherScene { path });
        }
        Self::of_log(&header, entries, &faces).map(Some).map_err(|problem| AnnotationError::at(&path, problem))
    }

    /// The result of a log, for parts with these numbers of faces.
    ///
    /// # Errors
    /// When an edit cannot be done.
    pub fn of_log(header: &Header, entries: Vec<Entry>, faces: &[usize]) -> Result<Self, LogProblem> {
        let mut replay = Replay::new(header, part_of_face(faces));
        for entry in entries {
            let revision = entry.revision;
            replay.perform(entry).map_err(|problem| LogProblem::of_edit(revision, problem))?;
        }
        Ok(replay.into_annotation())
    }

    /// The pieces of a scene in which nothing was split: its parts, with these labels.
    pub fn of_whole_parts(scene: &Scene, labels: Labels) -> Self {
        let instances = labels.parts.iter().map(|label| label.instance).max().unwrap_or(0).max(0) as usize;
        Self { labels, pieces: Vec::new(), piece_of_face: part_of_face(&faces_of_parts(scene)), instances }
    }
}

impl AnnotationError {
    /// A problem of the log in the file `path`.
    pub fn at(path: &Path, problem: LogProblem) -> Self {
        let path = path.to_path_buf();
        match problem {
            LogProblem::Format { found } => Self::Format { path, found },
            LogProblem::Line { line, problem } => Self::Line { path, line, problem },
        }
    }
}

fn faces_of_parts(scene: &Scene) -> Vec<usize> {
    scene.parts.iter().map(|part| scene.meshes[part.mesh as usize].triangles.len()).collect()
}

fn part_of_face(faces: &[usize]) -> Vec<PartId> {
    (0..).zip(faces).flat_map(|(part, &count)| std::iter::repeat_n(part, count)).collect()
}
