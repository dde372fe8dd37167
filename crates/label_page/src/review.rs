//! Reviews of pieces: to do, done, approved, or a question with a note.
//!
//! Reviews have their own log beside the log of edits, one line of JSON each, flushed before it counts. A review is not a label: undoing an
//! edit does not change it, and programs that do not know reviews can still read the labels. Pieces are identified by name, because numbers
//! change when a split is undone.

use super::json_lines::JsonLines;
use enfilade_dataset::{DatasetError, write_bytes};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Name of the log in the folder of labels.
pub const REVIEW_LOG: &str = "annotation_review.jsonl";
/// The table of the current reviews of all pieces, in the folder of labels.
pub const REVIEW_TABLE: &str = "metadata_object_review.csv";

/// State of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReviewState {
    /// There is no review of it, or it has to be done again.
    ToDo,
    /// The annotator is content with it.
    Done,
    /// Somebody else is content too.
    Approved,
    /// The note asks something.
    Question,
}

impl ReviewState {
    fn name(self) -> &'static str {
        match self {
            Self::ToDo => "to_do",
            Self::Done => "done",
            Self::Approved => "approved",
            Self::Question => "question",
        }
    }
}

/// A line of the log.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Review {
    /// When, in UTC.
    pub time: String,
    /// The client that made it.
    pub client: String,
    /// The name of the person; older logs have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub who: Option<String>,
    /// Names of the pieces.
    pub pieces: Vec<String>,
    /// Their state from now on.
    pub state: ReviewState,
    /// For people; may be empty.
    #[serde(default)]
    pub note: String,
}

/// The current reviews of a scene.
pub struct Reviews {
    folder: PathBuf,
    /// The log, once there is one.
    log: Option<JsonLines>,
    /// The last review of each piece that was reviewed.
    of_piece: BTreeMap<String, Said>,
}

/// What is said of a piece.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    /// The state of the piece.
    pub state: ReviewState,
    /// For people; may be empty.
    pub note: String,
    /// Who said it; empty without a name.
    pub who: String,
}

impl Reviews {
    /// Reads the log in `folder`, if there is one. A last line that was cut short is dropped.
    ///
    /// # Errors
    /// When the log cannot be read, or has an invalid line.
    pub fn open(folder: &Path) -> Result<Self, String> {
        let path = folder.join(REVIEW_LOG);
        let mut reviews = Self { folder: folder.into(), log: None, of_piece: BTreeMap::new() };
        let (log, bytes, _) = match File::options().read(true).write(true).open(&path).and_then(JsonLines::read) {
            Ok(read) => read,
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(reviews),
            Err(e) => return Err(format!("cannot read {}: {e}", path.display())),
        };
        for (i, line) in bytes.split(|&b| b == b'\n').filter(|line| !line.is_empty()).enumerate() {
            let wrong = |e| format!("{}:{}: {e}; fix this line or move the file away", path.display(), i + 1);
            reviews.take(serde_json::from_slice(line).map_err(wrong)?);
        }
        reviews.log = Some(log);
        Ok(reviews)
    }

    /// Appends a review. When this returns it is on the disk.
    ///
    /// # Errors
    /// When the log cannot be written; then nothing has changed.
    pub fn add(&mut self, review: Review) -> Result<(), DatasetError> {
        let path = self.folder.join(REVIEW_LOG);
        let begun = || {
            File::options().create(true).truncate(false).read(true).write(true).open(&path).and_then(JsonLines::read).map(|(log, ..)| log)
        };
        let log = self.log.take().map_or_else(begun, Ok);
        let appended = log.and_then(|log| self.log.insert(log).append(&review));
        appended.map_err(|source| DatasetError::Io { action: "write", path, source })?;
        self.take(review);
        Ok(())
    }

    fn take(&mut self, Review { pieces, state, note, who, .. }: Review) {
        let said = Said { state, note, who: who.unwrap_or_default() };
        for piece in pieces {
            self.of_piece.insert(piece, said.clone());
        }
    }

    /// What is said of a piece; none if it was not reviewed, or is to do without a note.
    pub fn of(&self, piece: &str) -> Option<&Said> {
        self.of_piece.get(piece).filter(|said| said.state != ReviewState::ToDo || !said.note.is_empty())
    }

    /// Writes the table: a row for each of these pieces that was reviewed. Without any review there is no table.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write<'a>(&self, pieces: impl Iterator<Item = &'a str>) -> Result<Option<PathBuf>, DatasetError> {
        if self.of_piece.is_empty() {
            return Ok(None);
        }
        let mut table = csv::Writer::from_writer(Vec::new());
        let mut row = |fields: [&str; 4]| table.write_record(fields).expect("writing to memory cannot fail");
        row(["object_name", "state", "note", "who"]);
        for piece in pieces {
            if let Some(Said { state, note, who }) = self.of(piece) {
                row([piece, state.name(), note, who]);
            }
        }
        let path = self.folder.join(REVIEW_TABLE);
        write_bytes(&path, table.into_inner().expect("flushing memory cannot fail"))?;
        Ok(Some(path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn review(pieces: &[&str], state: ReviewState, note: &str) -> Review {
        let pieces = pieces.iter().map(|&piece| piece.into()).collect();
        Review { time: "2026-01-01T00:00:00Z".into(), client: "test".into(), who: Some("Ada".into()), pieces, state, note: note.into() }
    }

    #[test]
    fn reviews_are_kept_and_the_last_one_counts() {
        let folder = tempfile::tempdir().unwrap();
        let mut reviews = Reviews::open(folder.path()).unwrap();
        assert_eq!(reviews.write(["chair"].into_iter()).unwrap(), None);
        reviews.add(review(&["chair", "table"], ReviewState::Done, "")).unwrap();
        reviews.add(review(&["chair"], ReviewState::Question, "a stool, or not?")).unwrap();
        reviews.add(review(&["table"], ReviewState::ToDo, "")).unwrap();
        let log = folder.path().join(REVIEW_LOG);
        let mut cut = std::fs::read(&log).unwrap();
        cut.extend(b"{\"cut");
        std::fs::write(&log, cut).unwrap();
        let again = Reviews::open(folder.path()).unwrap();
        let said = Said { state: ReviewState::Question, note: "a stool, or not?".into(), who: "Ada".into() };
        assert_eq!(again.of("chair"), Some(&said));
        assert_eq!(again.of("table"), None);
        let table = again.write(["chair", "table", "lamp"].into_iter()).unwrap().unwrap();
        assert_eq!(std::fs::read_to_string(table).unwrap(), "object_name,state,note,who\nchair,question,\"a stool, or not?\",Ada\n");
        std::fs::write(&log, "nonsense\n").unwrap();
        assert!(Reviews::open(folder.path()).err().unwrap().contains("annotation_review.jsonl:1: "));
    }
}
