//! Reasons why something cannot be rendered, in words for the person who can change it.

/// Why a scene or frame cannot be rendered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RenderError {
    /// Nothing emits.
    #[error(
        "the scene has no light: no emissive material, no light source and no environment, so every picture would be black; \
         light it by `environment = \"sky\"` or `lamps = \"ceiling\"`, or add lights to the scene file"
    )]
    NoLight,
    /// More parts than `render_entity_id` (int16) can distinguish.
    #[error("the scene has {found} parts, but render_entity_id (int16) can tell apart {limit}; merge small parts before importing", limit = i16::MAX)]
    TooManyParts {
        /// Number of parts.
        found: usize,
    },
    /// A camera that is not one.
    #[error("frame {frame}: the camera is not usable: {problem}")]
    Camera {
        /// Frame number.
        frame: u32,
        /// The problem.
        problem: String,
    },
    /// Settings out of their domain.
    #[error("{field} must {expected}, found {found}")]
    Config {
        /// Name of the field.
        field: &'static str,
        /// Value found.
        found: String,
        /// Requirement, as in "lie between 0 and 1".
        expected: &'static str,
    },
}
