//! An edit as recorded in the log: every decision is made, so that repeating it gives the same labels.

use enfilade_dataset::number_runs;
use serde::{Deserialize, Serialize};

/// An edit, with everything needed to repeat it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum Edit {
    /// Pieces were labelled.
    Label {
        /// For people.
        description: String,
        /// Which pieces.
        pieces: Vec<u32>,
        /// The class of each from now on.
        semantic: Vec<i16>,
        /// The instance of each from now on.
        instance: Vec<i16>,
        /// Instance numbers from here on are free.
        next_instance: i32,
    },
    /// Faces became pieces of their own.
    Split {
        /// For people.
        description: String,
        /// The piece they were taken from.
        piece: u32,
        /// Names of the new ones.
        names: Vec<String>,
        /// Faces of each new piece, as runs of first number and count.
        faces: Vec<Vec<[u32; 2]>>,
    },
    /// The last edit that was not undone was undone.
    Undo,
    /// The last edit that was undone was done again.
    Redo,
    /// An edit that was not the last one was undone: that of one person, below later ones of others.
    UndoOf {
        /// The revision at which it was last done.
        revision: u64,
    },
    /// An edit that was not undone last was done again.
    RedoOf {
        /// The revision at which it was last done.
        revision: u64,
    },
}

impl Edit {
    /// Description of the edit, for people.
    pub fn description(&self) -> &str {
        match self {
            Self::Label { description, .. } | Self::Split { description, .. } => description,
            Self::Undo | Self::UndoOf { .. } => "Undo",
            Self::Redo | Self::RedoOf { .. } => "Redo",
        }
    }
}

impl Edit {
    /// True for edits that only logs of [`FORMAT_OF_PEOPLE`](super::FORMAT_OF_PEOPLE) have.
    pub fn is_of_people(&self) -> bool {
        matches!(self, Self::UndoOf { .. } | Self::RedoOf { .. })
    }
}

/// Ascending numbers as runs of first number and count.
pub fn runs(numbers: &[u32]) -> Vec<[u32; 2]> {
    number_runs(numbers.iter().copied()).iter().map(|run| [*run.start(), run.end() - run.start() + 1]).collect()
}

/// The numbers in runs; `None` when a run goes beyond `end`.
pub fn numbers(runs: &[[u32; 2]], end: usize) -> Option<Vec<u32>> {
    let inside = |[first, count]: &[u32; 2]| u64::from(*first) + u64::from(*count) <= end as u64;
    runs.iter().all(inside).then(|| runs.iter().flat_map(|&[first, count]| first..first + count).collect())
}
