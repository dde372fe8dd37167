//! Serialisable values as Python's dictionaries, lists, numbers and text, and back, by way of JSON.

use enfilade_options::with_nearest;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Dictionaries, lists, numbers and text.
pub fn to_python<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| PyValueError::new_err(error.to_string()))?;
    py.import("json")?.call_method1("loads", (text,))
}

/// The inverse of [`to_python`].
pub fn from_python<T: DeserializeOwned>(value: &Bound<'_, PyAny>) -> PyResult<T> {
    let text: String = value.py().import("json")?.call_method1("dumps", (value,))?.extract()?;
    let wrong = |error: serde_json::Error| PyValueError::new_err(with_nearest(&error.to_string()));
    // Parsed to a value first, so that errors do not name lines of a text that the user has never seen.
    serde_json::from_value(serde_json::from_str(&text).map_err(wrong)?).map_err(wrong)
}
