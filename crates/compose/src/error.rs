//! Why objects cannot be placed.

/// Why a scene cannot get its objects. The messages name the group by its number in the file, counted from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ComposeError {
    /// A value that cannot be.
    #[error("[[object]] {group}: {key}: {problem}")]
    Key {
        /// Number of the group.
        group: usize,
        /// The key.
        key: &'static str,
        /// The value found and what was expected.
        problem: String,
    },
    /// A motion that cannot be.
    #[error("[[motion]] {group}: {key}: {problem}")]
    Motion {
        /// Number of the group.
        group: usize,
        /// The key.
        key: &'static str,
        /// The value found and what was expected.
        problem: String,
    },
    /// A model that cannot be used or placed, in a group with `missing = "refuse"`.
    #[error("[[object]] {group}: {model}: {reason}; with missing = \"skip\" the scene is made without it")]
    Missing {
        /// Number of the group.
        group: usize,
        /// The model's file.
        model: String,
        /// Why.
        reason: String,
    },
    /// An edit of the scene that failed.
    #[error("[[object]] {group}: {model}: {error}")]
    Edit {
        /// Number of the group.
        group: usize,
        /// The model's file.
        model: String,
        /// The problem.
        error: enfilade_scene::EditError,
    },
}
