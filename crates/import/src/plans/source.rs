//! The file of a plan.

use crate::ImportError;
use serde_json::Value;
use std::path::Path;

/// A file to be recognised and read.
pub(super) struct Source<'s> {
    pub file: &'s Path,
    pub bytes: &'s [u8],
    pub text: &'s str,
    /// The JSON, where it is any.
    pub json: Option<Value>,
}

impl Source<'_> {
    /// Whether it is JSON with all of these keys.
    pub fn has(&self, keys: &[&str]) -> bool {
        self.json.as_ref().is_some_and(|json| keys.iter().all(|key| json.get(key).is_some()))
    }

    /// Whether its JSON states a format that begins so.
    pub fn states(&self, format: &str) -> bool {
        self.json.as_ref().and_then(|json| json.get("format")?.as_str()).is_some_and(|found| found.starts_with(format))
    }

    /// Whether the first room of its JSON has this key.
    pub fn rooms_have(&self, key: &str) -> bool {
        self.json.as_ref().and_then(|json| json.get("rooms")?.get(0)?.get(key)).is_some()
    }

    pub fn error(&self, place: impl Into<String>, problem: impl Into<String>) -> ImportError {
        ImportError::malformed(self.file, place, problem)
    }
}
