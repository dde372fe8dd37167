//! Warnings of readers that speak later than their caller listens.

use enfilade_scene::{Cx, Warning};
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};

/// Notes from reading models, which happens when a home uses them; kept until the home is made.
#[derive(Clone, Debug, Default)]
pub(super) struct Notes(Arc<Mutex<BTreeSet<String>>>);

impl Notes {
    /// Each once, sorted.
    pub fn take(&self) -> Vec<String> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner)).into_iter().collect()
    }
}

impl Cx for Notes {
    fn progress(&self, _what: &str, _done: u64, _total: u64) {}

    fn warn(&self, warning: Warning) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(warning.to_string());
    }
}
