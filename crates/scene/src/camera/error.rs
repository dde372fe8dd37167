//! The error of every camera setting: the field that is out of its domain, its value, and the expected values.

/// A camera setting out of its domain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the camera's {field} is {found}; expected {expected}")]
pub struct CameraError {
    /// Name of the field.
    pub field: &'static str,
    /// Value found.
    pub found: String,
    /// Expected value.
    pub expected: &'static str,
}

impl CameraError {
    pub(super) fn new(field: &'static str, found: String, expected: &'static str) -> Self {
        Self { field, found, expected }
    }
}
