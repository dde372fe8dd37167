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
    pub const ON_REQUEST: [Self; 8] =
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

    /// Names of its options that `dataset.toml` has as well, in a table of the product.
    pub const fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Pairs => &["overlap", "baseline_m", "angle_deg", "pixels"],
            Self::Flow => &["step"],
            Self::Tracks => &["points", "seed"],
            Self::Surfaces => &["layers"],
            _ => &[],
        }
    }

    /// Names of its options, which are fields of [`ProductOptions`](super::ProductOptions).
    pub fn options(self) -> impl Iterator<Item = &'static str> {
        let of_calls: &[&str] = match self {
            Self::Pairs => &["pairs"],
            Self::Flow => &["pairs", "between"],
            Self::Sensors => &["sensors"],
            Self::Relit => &["mixes"],
            _ => &[],
        };
        of_calls.iter().chain(self.keys()).copied()
    }

    /// Scope of its parts.
    pub const fn scope(self) -> Scope {
        match self {
            Self::Covisibility | Self::Words => Scope::Scene,
            Self::Tracks => Scope::Camera,
            Self::Flow | Self::Surfaces | Self::Rooms | Self::Sensors | Self::Relit => Scope::Frame,
            Self::Pairs | Self::Sheet | Self::Statistics => Scope::Dataset,
        }
    }
}

/// The unit that a part of a product belongs to.
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
