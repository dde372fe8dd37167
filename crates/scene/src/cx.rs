//! How a stage speaks to its caller. Nothing below the pipeline prints, so progress and warnings go through [`Cx`].

use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::{Mutex, PoisonError};

/// Something that was dropped, guessed or fixed: the work went on, and the stage's report shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Warning {
    /// File, and place in it, or the part or frame concerned.
    pub place: String,
    /// What was found and what was done about it.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.message)
    }
}

/// What a stage may tell its caller, from any thread.
pub trait Cx: Sync {
    /// `done` of `total` units of `what` are finished. Cheap enough to call per tile.
    fn progress(&self, what: &str, done: u64, total: u64);

    /// Records a warning for the stage's report.
    fn warn(&self, warning: Warning);
}

/// A [`Cx`] that keeps the warnings, in the order in which they come, for tests.
#[derive(Debug, Default)]
pub struct Heard(Mutex<Vec<Warning>>);

impl Heard {
    /// The warnings so far, each in a line.
    pub fn lines(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).iter().map(Warning::to_string).collect()
    }
}

impl Cx for Heard {
    fn progress(&self, _what: &str, _done: u64, _total: u64) {}

    fn warn(&self, warning: Warning) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(warning);
    }
}

/// A [`Cx`] that hears nothing, for tests and one-off calls.
pub struct Quiet;

impl Cx for Quiet {
    fn progress(&self, _what: &str, _done: u64, _total: u64) {}
    fn warn(&self, _warning: Warning) {}
}
