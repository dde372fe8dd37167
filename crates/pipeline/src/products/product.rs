//! The names of the products, in the order in which they are made.

use serde::{Deserialize, Serialize};

/// A product by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs, reason = "PRODUCTS describes each one")]
pub enum Product {
    Covisibility,
    Pairs,
    Flow,
    Tracks,
    Surfaces,
    Rooms,
    Words,
    Sensors,
    Relit,
    Sheet,
    Statistics,
}

impl Product {
    /// The word for it on the command line and in `dataset.toml`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Covisibility => "covisibility",
            Self::Pairs => "pairs",
            Self::Flow => "flow",
            Self::Tracks => "tracks",
            Self::Surfaces => "surfaces",
            Self::Rooms => "rooms",
            Self::Words => "words",
            Self::Sensors => "sensors",
            Self::Relit => "relit",
            Self::Sheet => "sheet",
            Self::Statistics => "statistics",
        }
    }
}
