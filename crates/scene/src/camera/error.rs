//! The error of every camera setting: which field is out of its domain, what it holds, and what it must hold.

/// A camera setting out of its domain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the camera's {field} is {found}; expected {expected}")]
pub struct CameraError {
    /// Name of the field.
    pub field: &'static str,
    /// Value of the setting, as it was found.
    pub found: String,
    /// What it must be.
    pub expected: &'static str,
}

impl CameraError {
    pub(super) fn new(field: &'static str, found: String, expected: &'static str) -> Self {
        Self { field, found, expected }
    }
}
