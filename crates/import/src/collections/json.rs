//! JSON of collections: one file into one description, with errors that name line and column.

use super::lenient::{Lenient, nan_as_null};
use crate::ImportError;
use crate::vectors::numbers;
use enfilade_math::DVec3;
use enfilade_scene::{decoded_text, without_padding};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use serde_json::error::Category;
use std::path::Path;

/// The description in the bytes of `file`; `what` names the expected content. Numbers may be text, as [`Lenient`] has it, and `NaN`, which
/// is `null` then.
///
/// # Errors
/// When it is not JSON, or not of that form: place, what was found and what was expected.
pub(crate) fn parse<T: DeserializeOwned>(bytes: &[u8], file: &Path, what: &str) -> Result<T, ImportError> {
    let text = decoded_text(bytes);
    let text = without_padding(&text);
    let lenient = |text: &str| T::deserialize(Lenient(serde_json::from_str::<Value>(text).ok()?)).ok();
    let other = || lenient(text).or_else(|| lenient(&nan_as_null(text)?));
    serde_json::from_str(text).or_else(|error| other().ok_or(error)).map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        let remedy = match error.classify() {
            Category::Data => format!("it is not what {what} has there; correct it, or give the file that belongs to the scene"),
            _ => format!("expected {what}, so copy or unpack the file again"),
        };
        ImportError::malformed(file, place, format!("{}; {remedy}", in_words(&error)))
    })
}

/// A fault in JSON's words, without its place: what was found and what was expected.
pub(super) fn in_words(error: &serde_json::Error) -> String {
    let message = error.to_string();
    let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(message, _)| message);
    let Some((found, expected)) = message.strip_prefix("invalid type: ").and_then(|rest| rest.split_once(", expected ")) else {
        return message.to_string();
    };
    let found = match found {
        "map" => "a table",
        "sequence" => "a list",
        other => other,
    };
    let first = expected.split(' ').find(|word| !matches!(*word, "a" | "an"));
    let numbers = expected.split(' ').find(|word| word.parse::<usize>().is_ok());
    let expected = match (first, numbers) {
        (Some("struct" | "map"), _) => "a table".to_string(),
        (Some("sequence" | "array" | "tuple"), Some(count)) => format!("a list of {count} numbers"),
        (Some("sequence"), None) => "a list".to_string(),
        _ => expected.to_string(),
    };
    format!("found {found}, expected {expected}")
}

/// A value that may be `null`, which means its default.
///
/// # Errors
/// When it is another value of another type.
pub(super) fn or_default<'de, D: Deserializer<'de>, T: Default + Deserialize<'de>>(deserializer: D) -> Result<T, D::Error> {
    Option::<T>::deserialize(deserializer).map(Option::unwrap_or_default)
}

/// The number under the first of these names that has one, also where it is written as text.
pub(super) fn number(object: &Value, names: &[&str]) -> Option<f64> {
    names.iter().find_map(|name| as_number(object.get(name)?))
}

fn as_number(value: &Value) -> Option<f64> {
    value.as_f64().or_else(|| value.as_str()?.trim().parse().ok()).filter(|v| v.is_finite())
}

/// The text under the first of these names that has one.
pub(super) fn text<'v>(object: &'v Value, names: &[&str]) -> Option<&'v str> {
    names.iter().find_map(|name| object.get(name)?.as_str())
}

/// The truth under the first of these names that has one: true, "true", or a number that is not 0.
pub(super) fn flag(object: &Value, names: &[&str]) -> Option<bool> {
    let truth = |value: &Value| {
        let word = value.as_str().and_then(|text| text.trim().to_ascii_lowercase().parse().ok());
        value.as_bool().or(word).or_else(|| Some(as_number(value)? != 0.0))
    };
    names.iter().find_map(|name| truth(object.get(name)?))
}

/// The vector under the first of these names that has three numbers.
pub(super) fn vector(object: &Value, names: &[&str]) -> Option<DVec3> {
    let vector = |value: &Value| {
        if let Some(text) = value.as_str() {
            return numbers(text)?.first_chunk::<3>().copied().map(DVec3::from_array);
        }
        let [x, y, z] = value.as_array()?.as_slice().first_chunk::<3>()?;
        Some(DVec3::new(as_number(x)?, as_number(y)?, as_number(z)?))
    };
    names.iter().find_map(|name| vector(object.get(name)?))
}
