//! The lines of the log of edits: which scene it is about and which labels it began with, then one edit each.

use super::edit::Edit;
use serde::{Deserialize, Serialize};

/// The first line names its own format.
pub const FORMAT: &str = "enfilade annotation log 1";
/// The format of logs in which a person's edit was undone below later ones of others. It is as long as [`FORMAT`].
pub const FORMAT_OF_PEOPLE: &str = "enfilade annotation log 2";

/// Fields of the first line in logs of every format.
#[derive(Deserialize)]
struct Form {
    format: String,
}

/// The first line: which scene the log is about, and the labels of its parts before the first edit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// [`FORMAT`].
    pub format: String,
    /// The scene's name.
    pub scene: String,
    /// The hash of the scene, by [`enfilade_dataset::scene_hash`].
    pub scene_hash: String,
    /// Number of parts of the scene.
    pub parts: usize,
    /// Number of faces of the scene.
    pub faces: usize,
    /// The class of every part before the first edit.
    pub initial_semantic: Vec<i16>,
    /// The instance of every part before the first edit.
    pub initial_instance: Vec<i16>,
}

/// A line after the first: one edit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// From 1, one more with each line.
    pub revision: u64,
    /// When, in UTC.
    pub time: String,
    /// The client that requested it.
    pub client: String,
    /// The name of the person; logs of programs that knew no names have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub who: Option<String>,
    /// The client's name for it, by which a repeated request is recognised. Edits that came without one have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// The edit.
    pub edit: Edit,
}

/// Why a log cannot be read.
#[derive(Debug)]
pub enum LogProblem {
    /// The log is of another form, which a newer program may have written.
    Format {
        /// The format that it states.
        found: String,
    },
    /// A line is not valid.
    Line {
        /// From 1.
        line: usize,
        /// The problem.
        problem: String,
    },
}

impl LogProblem {
    /// The problem of the line of an edit.
    pub fn of_edit(revision: u64, problem: String) -> Self {
        Self::Line { line: revision as usize + 1, problem }
    }
}

/// Reads the whole lines of a log; of one that does not end with a line break the last does not count. `None` where there is no line.
///
/// # Errors
/// When it is of another form or a line is not valid.
pub fn parse(bytes: &[u8]) -> Result<Option<(Header, Vec<Entry>)>, LogProblem> {
    let Some(end) = bytes.iter().rposition(|&byte| byte == b'\n') else { return Ok(None) };
    let mut lines = bytes[..end].split(|&byte| byte == b'\n');
    let first = lines.next().unwrap_or_default();
    let no_log = |e: serde_json::Error| LogProblem::Line { line: 1, problem: format!("not the beginning of a log: {e}") };
    let Form { format: found } = serde_json::from_slice(first).map_err(no_log)?;
    if found != FORMAT && found != FORMAT_OF_PEOPLE {
        return Err(LogProblem::Format { found });
    }
    let header: Header = serde_json::from_slice(first).map_err(no_log)?;
    let (parts, lengths) = (header.parts, [header.initial_semantic.len(), header.initial_instance.len()]);
    if lengths != [parts; 2] {
        return Err(LogProblem::Line { line: 1, problem: format!("labels of {} parts, expected {parts}", lengths[0]) });
    }
    let mut entries: Vec<Entry> = Vec::new();
    for (expected, line) in (1..).zip(lines) {
        let entry: Entry = serde_json::from_slice(line).map_err(|e| LogProblem::of_edit(expected, e.to_string()))?;
        if entry.revision != expected {
            return Err(LogProblem::of_edit(expected, format!("revision {}, expected {expected}", entry.revision)));
        }
        entries.push(entry);
    }
    Ok(Some((header, entries)))
}
