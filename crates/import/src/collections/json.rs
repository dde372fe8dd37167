//! JSON of collections: one file into one description, with errors that name line and column.

use crate::ImportError;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer};
use std::path::Path;

/// The description in the bytes of `file`; `what` says what it should be.
///
/// # Errors
/// When it is not JSON, or not of that form: place, what was found and what was expected.
pub(super) fn parse<T: DeserializeOwned>(bytes: &[u8], file: &Path, what: &str) -> Result<T, ImportError> {
    serde_json::from_slice(without_mark(bytes)).map_err(|error| {
        let message = error.to_string();
        let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(message, _)| message);
        let place = format!("line {}, column {}", error.line(), error.column());
        ImportError::malformed(file, place, format!("{message}; expected {what}, so copy or unpack the file again"))
    })
}

/// A value that may be `null`, which stands for its default.
///
/// # Errors
/// When it is another value of another type.
pub(super) fn or_default<'de, D: Deserializer<'de>, T: Default + Deserialize<'de>>(deserializer: D) -> Result<T, D::Error> {
    Option::<T>::deserialize(deserializer).map(Option::unwrap_or_default)
}

/// The text without a byte order mark.
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}
