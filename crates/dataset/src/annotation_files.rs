//! The log of `enfilade annotate`, as far as others read it: which scene it is about, and whether anything was done.

use crate::{DatasetError, MeshFiles};
use serde::Deserialize;
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind};

/// Name of the log in the folder of labels: a first line about the scene, then a line per edit.
pub const ANNOTATION_LOG: &str = "annotation_log.jsonl";

/// The fields of the first line that are read.
#[derive(Deserialize)]
struct Header {
    scene_hash: String,
}

/// Hash that identifies a scene: of the names of its parts, in order, and the number of faces of each.
///
/// A BLAKE3 hash as hexadecimal text. Blanks at the ends of names do not count, since tables lose them.
pub fn scene_hash<'a>(parts: impl IntoIterator<Item = (&'a str, usize)>) -> String {
    let mut hasher = blake3::Hasher::new();
    for (name, faces) in parts {
        hasher.update(&(name.len() as u64).to_le_bytes()).update(name.as_bytes()).update(&(faces as u64).to_le_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

impl MeshFiles {
    /// The [`scene_hash`] of the scene that people annotated; `None` where they did nothing yet, though they may have looked.
    ///
    /// # Errors
    /// When the log cannot be read, or does not begin like one.
    pub fn annotated_scene(&self) -> Result<Option<String>, DatasetError> {
        let path = self.file(ANNOTATION_LOG);
        let mut log = match File::open(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            file => BufReader::new(file.map_err(DatasetError::at("read", &path))?),
        };
        let mut line = || -> Result<Vec<u8>, DatasetError> {
            let mut line = Vec::new();
            log.read_until(b'\n', &mut line).map_err(DatasetError::at("read", &path))?;
            Ok(line)
        };
        let (header, first_edit) = (line()?, line()?);
        // A last line that was cut short when the machine died does not count.
        if !first_edit.ends_with(b"\n") {
            return Ok(None);
        }
        let wrong = |error: serde_json::Error| {
            let problem = format!("line 1: not the beginning of a log: {error}; restore a copy, or move the log away to start again");
            DatasetError::text(&path, problem)
        };
        let header: Header = serde_json::from_slice(&header).map_err(wrong)?;
        Ok(Some(header.scene_hash))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_counts_from_its_first_whole_edit_on() {
        let folder = tempfile::tempdir().unwrap();
        let files = MeshFiles::new(folder.path());
        assert_eq!(files.annotated_scene().unwrap(), None);
        let header = "{\"format\":\"enfilade annotation log 1\",\"scene_hash\":\"abc\",\"parts\":2}\n";
        for (edits, expected) in [("", None), ("{\"revision\":1", None), ("{\"revision\":1}\n", Some("abc")), ("{}\n{}\n{", Some("abc"))] {
            std::fs::write(files.file(ANNOTATION_LOG), format!("{header}{edits}")).unwrap();
            assert_eq!(files.annotated_scene().unwrap().as_deref(), expected, "{edits}");
        }
        std::fs::write(files.file(ANNOTATION_LOG), "nonsense\n{}\n").unwrap();
        let message = files.annotated_scene().unwrap_err().to_string();
        assert!(message.contains("annotation_log.jsonl: line 1: not the beginning of a log"), "{message}");
    }

    #[test]
    fn scenes_differ_by_names_their_order_and_numbers_of_faces() {
        let hash = |parts: &[(&str, usize)]| scene_hash(parts.iter().copied());
        let scene = hash(&[("chair", 12), ("table", 20)]);
        assert_eq!(scene, hash(&[("chair", 12), ("table", 20)]));
        for other in [&[("table", 20), ("chair", 12)], &[("chair", 20), ("table", 12)], &[("chairt", 12), ("able", 20)]] {
            assert_ne!(scene, hash(other));
        }
    }
}
