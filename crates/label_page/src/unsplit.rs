//! A mesh folder's objects as they were before any was split.

use enfilade_dataset::{ANNOTATION_LOG, MeshFiles};
use enfilade_label::annotation::{Edit, Entry, Header, numbers};

/// Number of objects of a mesh folder before any was split, and the object of every face then. `None` if none was split, or if the
/// folder's log cannot be read.
///
/// The folder's tables have the same information, but they are written one after the other and disagree if the program is killed in
/// between.
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
