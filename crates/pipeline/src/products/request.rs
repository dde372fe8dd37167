//! What somebody asks of a product: options, and the frames that it is for. It is recorded with the product, which is made again by it.

use super::choice::FrameChoice;
use super::flow::FlowPairs;
use super::pairs::PairsRequest;
use super::product::Product;
use super::relit::MixRequest;
use enfilade_sensors::Sensor;
use serde::{Deserialize, Serialize};

/// A product with the options that it is asked for by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Request {
    /// Which frames see the same surfaces.
    Covisibility {
        /// Pixels of each frame that are carried into the others, about.
        pixels: u32,
        /// Names of cameras; `None`: all.
        cameras: Option<Vec<String>>,
    },
    /// Pairs of frames; covisibility is made first.
    Pairs(PairsRequest),
    /// Flow between frames.
    Flow {
        /// Which pairs.
        pairs: FlowPairs,
        /// Names of cameras; `None`: all.
        cameras: Option<Vec<String>>,
    },
    /// Tracks of points.
    Tracks {
        /// Points of each camera.
        points: u32,
        /// Decides which points.
        seed: u64,
        /// Frames.
        of: FrameChoice,
    },
    /// Surfaces along rays.
    Surfaces {
        /// Surfaces per pixel at most.
        layers: u32,
        /// Frames.
        of: FrameChoice,
    },
    /// Rooms, and planes of frames.
    Rooms {
        /// Frames.
        of: FrameChoice,
    },
    /// Words.
    Words,
    /// The readings of a sensor.
    Sensor {
        /// The sensor.
        sensor: Sensor,
        /// Frames.
        of: FrameChoice,
    },
    /// Frames as a mix of lamps lights them.
    Mix {
        /// The mix.
        mix: MixRequest,
        /// Frames.
        of: FrameChoice,
    },
    /// The contact sheet of the dataset.
    Sheet {
        /// What stands above it.
        title: String,
        /// Names the pictures of all scenes.
        pictures: String,
    },
    /// The statistics of the dataset.
    Statistics {
        /// Names the pictures of all scenes.
        pictures: String,
    },
}

impl Request {
    /// The product.
    pub fn product(&self) -> Product {
        match self {
            Self::Covisibility { .. } => Product::Covisibility,
            Self::Pairs(_) => Product::Pairs,
            Self::Flow { .. } => Product::Flow,
            Self::Tracks { .. } => Product::Tracks,
            Self::Surfaces { .. } => Product::Surfaces,
            Self::Rooms { .. } => Product::Rooms,
            Self::Words => Product::Words,
            Self::Sensor { .. } => Product::Sensors,
            Self::Mix { .. } => Product::Relit,
            Self::Sheet { .. } => Product::Sheet,
            Self::Statistics { .. } => Product::Statistics,
        }
    }

    /// True when it is made after another product: flow is after the list of pairs where that says which pairs.
    pub(super) fn is_made_after(&self, product: Product) -> bool {
        match self {
            Self::Flow { pairs, .. } => product == Product::Pairs && *pairs == FlowPairs::Listed,
            _ => true,
        }
    }

    /// True when nothing is left of `older`, a request of the same product, once this one is made.
    pub(super) fn replaces(&self, older: &Self) -> bool {
        match (self, older) {
            (Self::Covisibility { .. }, Self::Covisibility { .. })
            | (Self::Pairs(_), Self::Pairs(_))
            | (Self::Words, Self::Words)
            | (Self::Sheet { .. }, Self::Sheet { .. })
            | (Self::Statistics { .. }, Self::Statistics { .. }) => true,
            (Self::Flow { .. }, Self::Flow { .. }) => self == older,
            (Self::Tracks { of, .. }, Self::Tracks { of: old, .. })
            | (Self::Surfaces { of, .. }, Self::Surfaces { of: old, .. })
            | (Self::Rooms { of }, Self::Rooms { of: old }) => of.covers(old),
            (Self::Sensor { sensor, of }, Self::Sensor { sensor: old, of: older }) => {
                sensor.name() == old.name() && (sensor != old || of.covers(older))
            }
            (Self::Mix { mix, of }, Self::Mix { mix: old, of: older }) => mix.name() == old.name() && (mix != old || of.covers(older)),
            _ => false,
        }
    }

    /// The request with the settings of `newer` where both are about one sensor or one mix: its folder holds readings of one setting alone.
    pub(super) fn with_settings_of(&self, newer: &Self) -> Option<Self> {
        match (self, newer) {
            (Self::Sensor { sensor: old, of }, Self::Sensor { sensor, .. }) if old.name() == sensor.name() && old != sensor => {
                Some(Self::Sensor { sensor: sensor.clone(), of: of.clone() })
            }
            (Self::Mix { mix: old, of }, Self::Mix { mix, .. }) if old.name() == mix.name() && old != mix => {
                Some(Self::Mix { mix: mix.clone(), of: of.clone() })
            }
            _ => None,
        }
    }
}
