//! The lines of the log of edits: which scene it is about and which labels it began with, then one edit each.

use super::edit::{Edit, numbers};
use enfilade_dataset::{ANNOTATION_LOG, MeshFiles};
use serde::{Deserialize, Serialize};

/// The first line names its own format.
pub const FORMAT: &str = "enfilade annotation log 1";

/// What the first lines of logs of every form have.
#[derive(Deserialize)]
pub struct Form {
    pub format: String,
}

/// The first line: which scene the log is about, and the labels of its parts before the first edit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    pub format: String,
    pub scene: String,
    /// The hash of the scene, by [`enfilade_dataset::scene_hash`].
    pub scene_hash: String,
    pub parts: usize,
    pub faces: usize,
    pub initial_semantic: Vec<i16>,
    pub initial_instance: Vec<i16>,
}

/// A line after the first: one edit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// From 1, one more with each line.
    pub revision: u64,
    /// When, in UTC.
    pub time: String,
    /// Who asked for it.
    pub client: String,
    /// The client's name for it, by which a repeated request is recognised. Edits that came without one have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// What was done.
    pub edit: Edit,
}

/// How many objects a mesh folder had before any was split, and the object of every face then. `None` if none was split, or if the
/// folder's log cannot be read.
///
/// The folder's tables say the same, but they are written one after the other and disagree if the program is killed in between.
pub fn unsplit(files: &MeshFiles) -> Option<(usize, Vec<u32>)> {
    let bytes = std::fs::read(files.file(ANNOTATION_LOG)).ok()?;
    let mut lines = bytes.split(|&b| b == b'\n');
    let whole = serde_json::from_slice::<Header>(lines.next()?).ok()?.parts;
    let split = |line: &[u8]| match serde_json::from_slice::<Entry>(line).ok()?.edit {
        Edit::Split { piece, faces, .. } => Some((piece, faces)),
        _ => None,
    };
    let splits: Vec<_> = lines.filter_map(split).collect();
    if splits.is_empty() {
        return None;
    }
    let mut object_of_face = files.read_objects_of_faces().ok()?;
    let end = object_of_face.len();
    // Splitting a piece again moves faces that already left their object, so only splits of whole objects matter.
    for (object, groups) in splits.iter().filter(|(piece, _)| (*piece as usize) < whole) {
        for face in groups.iter().filter_map(|runs| numbers(runs, end)).flatten() {
            let now = &mut object_of_face[face as usize];
            *now = if *now as usize >= whole { *object } else { *now };
        }
    }
    object_of_face.iter().all(|&object| (object as usize) < whole).then_some((whole, object_of_face))
}
