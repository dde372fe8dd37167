//! The inputs and outputs of a run of a stage, by path and content: later runs compare them with the files that they find.

use crate::error::Error;
use crate::workdir::{Hash, read_json};
use enfilade_scene::Warning;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The inputs of a stage, as far as they are known before it has run.
pub(crate) type Inputs = Result<Option<Vec<Input>>, Error>;

/// A file that a stage read, by content.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Input {
    pub path: PathBuf,
    pub content: Hash,
}

impl Input {
    pub fn of(path: &Path) -> Result<Self, Error> {
        Ok(Self { path: path.into(), content: Hash::of_file(path)? })
    }

    /// An input that need not be there.
    pub fn of_any(path: &Path) -> Result<Self, Error> {
        if path.exists() { Self::of(path) } else { Ok(Self { path: path.into(), content: Hash::of(&None::<u8>) }) }
    }
}

/// A file that a stage wrote.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Output {
    /// Relative to the dataset's folder.
    pub path: PathBuf,
    bytes: u64,
    /// `None` for files of frames, which are too many bytes to be read in every run; their checksums are in their commit records. Earlier
    /// versions did not record it for any file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub content: Option<Hash>,
}

impl Output {
    /// The file at `path` in the dataset's folder `out`, only with its length.
    pub fn by_length(out: &Path, path: &Path) -> Result<Self, Error> {
        let bytes = std::fs::metadata(path).map_err(Error::io("read", path))?.len();
        Ok(Self { path: path.strip_prefix(out).unwrap_or(path).into(), bytes, content: None })
    }

    /// An output with its content, unless it is a file of a frame.
    pub fn of(out: &Path, path: &Path) -> Result<Self, Error> {
        let is_of_frame = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("frame."));
        let content = if is_of_frame { None } else { Some(Hash::of_file(path)?) };
        Ok(Self { content, ..Self::by_length(out, path)? })
    }

    /// True for layers of frames and the records that vouch for them: their stages look at these records, and later stages add to them.
    pub fn is_committed(&self) -> bool {
        let is_of_frame = self.path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("frame."));
        let is_record = self.path.parent().is_some_and(|folder| folder.ends_with("frames"));
        is_of_frame && (is_record || self.path.extension().is_some_and(|extension| extension == "hdf5"))
    }

    /// True where the file is there in full length.
    pub fn has_its_length(&self, out: &Path) -> bool {
        std::fs::metadata(out.join(&self.path)).is_ok_and(|data| data.len() == self.bytes)
    }

    /// True where the file is there in full length and, where that was noted, with the same content.
    pub fn is_there(&self, out: &Path) -> bool {
        let is_same = |content: &Hash| Hash::of_file(&out.join(&self.path)).is_ok_and(|found| found == *content);
        self.has_its_length(out) && self.content.as_ref().is_none_or(is_same)
    }
}

/// Result of a stage's function.
#[derive(Default)]
pub(crate) struct Outcome {
    /// One line: what it made.
    pub summary: String,
    /// Files written.
    pub outputs: Vec<PathBuf>,
    /// Files read, for a stage that only knows them afterwards.
    pub inputs: Option<Vec<Input>>,
    /// The report of the stage's function, in any form.
    pub report: serde_json::Value,
}

/// Contents of `STAGE.json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Record {
    /// Hash of settings, inputs and code version.
    pub key: Hash,
    pub summary: String,
    pub warnings: Vec<Warning>,
    pub report: serde_json::Value,
    pub wall_s: f64,
    pub cpu_s: f64,
    pub inputs: Vec<Input>,
    pub outputs: Vec<Output>,
    /// Hash of the stage's row in a table that scenes share, where it writes one. Earlier versions did not note it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub listed: Option<Hash>,
}

/// The key of the record at `path`; `None` where there is none. Its other contents are not kept.
pub(crate) fn record_key(path: &Path) -> Option<Hash> {
    #[derive(Deserialize)]
    struct Key {
        key: Hash,
    }
    read_json::<Key>(path).map(|record| record.key)
}
