//! The names of the stages, in the order in which they run, and the versions of what they make.

use serde::{Deserialize, Serialize};

/// Part of the hashes that decide whether outputs are up to date, in place of the program's version, which was part of them until 0.1.0: a
/// new release makes only those outputs again whose stages have new versions.
pub(crate) const HASHED_AS: &str = "0.1.0";

/// A stage by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs, reason = "STAGES describes each one")]
pub enum Stage {
    Import,
    Carve,
    Plan,
    Gate,
    Render,
    Denoise,
    Label,
    Boxes,
    Preview,
    Verify,
}

impl Stage {
    /// The name, as `run --only` takes it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Import => "import",
            Self::Carve => "carve",
            Self::Plan => "plan",
            Self::Gate => "gate",
            Self::Render => "render",
            Self::Denoise => "denoise",
            Self::Label => "label",
            Self::Boxes => "boxes",
            Self::Preview => "preview",
            Self::Verify => "verify",
        }
    }

    /// Changes whenever the stage's outputs change for the same inputs, so that old outputs are made again.
    pub const fn version(self) -> u32 {
        match self {
            Self::Import => 24,
            Self::Carve => 5,
            Self::Plan => 7,
            Self::Gate => 2,
            Self::Render => 22,
            Self::Denoise => 4,
            Self::Label => 3,
            Self::Boxes => 1,
            Self::Preview => 6,
            Self::Verify => 11,
        }
    }

    /// Name of the stage's record in the work folder of a scene.
    pub(crate) fn record(self) -> String {
        format!("{}.json", self.name())
    }
}
