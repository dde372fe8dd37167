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
    /// Products that people request by name.
    pub(crate) const ON_REQUEST: [Self; 8] =
        [Self::Pairs, Self::Flow, Self::Tracks, Self::Surfaces, Self::Rooms, Self::Words, Self::Sensors, Self::Relit];

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

    /// What its parts belong to.
    pub const fn scope(self) -> Scope {
        match self {
            Self::Covisibility | Self::Words => Scope::Scene,
            Self::Tracks => Scope::Camera,
            Self::Flow | Self::Surfaces | Self::Rooms | Self::Sensors | Self::Relit => Scope::Frame,
            Self::Pairs | Self::Sheet | Self::Statistics => Scope::Dataset,
        }
    }
}

/// What the parts of a product belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// The dataset as a whole: one part.
    Dataset,
    /// A scene: one part.
    Scene,
    /// A camera: one part for each.
    Camera,
    /// A frame, or a pair of frames: a part for each.
    Frame,
}
