//! The request for a product: options, and the frames that it is for. It is recorded with the product and used to make it again.

use super::choice::FrameChoice;
use super::product::Product;
use crate::relight::Mix;
use enfilade_dataset::FramePair;
use enfilade_multiview::{CovisibilityConfig, PairFilter};
use enfilade_sensors::Sensor;
use serde::{Deserialize, Serialize};

/// A product with the options of the request.
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
        /// The sheet's title.
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

    /// True when it is made after another product: flow is after the list of pairs if that list selects its pairs.
    pub(crate) fn is_made_after(&self, product: Product) -> bool {
        match self {
            Self::Flow { pairs, .. } => product == Product::Pairs && *pairs == FlowPairs::Listed,
            _ => true,
        }
    }

    /// True when nothing is left of `older`, a request of the same product, once this one is made.
    pub(crate) fn replaces(&self, older: &Self) -> bool {
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

    /// The request with the settings of `newer` where both are about one sensor or one mix: its folder has readings of only one setting.
    pub(crate) fn with_settings_of(&self, newer: &Self) -> Option<Self> {
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

/// Which pairs of frames are chosen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PairsRequest {
    /// Pixels of each frame that are carried into the others, about.
    pub pixels: u32,
    /// Shares that each frame sees of the other, at least and at most; without them any at all.
    pub overlap: Option<[f32; 2]>,
    /// Least distance between the cameras, metres.
    pub min_baseline_m: f64,
    /// Largest distance between the cameras, metres.
    pub max_baseline_m: Option<f64>,
    /// Angles between the viewing axes, at least and at most, degrees.
    pub angle_deg: [f64; 2],
    /// Names of scenes; `None`: all.
    pub scenes: Option<Vec<String>>,
    /// Names of cameras; `None`: all.
    pub cameras: Option<Vec<String>>,
}

impl Default for PairsRequest {
    fn default() -> Self {
        let pixels = CovisibilityConfig::default().grid_pixels;
        Self { pixels, overlap: None, min_baseline_m: 0.0, max_baseline_m: None, angle_deg: [0.0, 180.0], scenes: None, cameras: None }
    }
}

impl PairsRequest {
    /// The filter of pairs.
    pub(crate) fn filter(&self) -> PairFilter {
        PairFilter {
            overlap: self.overlap.unwrap_or(PairFilter::default().overlap),
            baseline_m: [self.min_baseline_m, self.max_baseline_m.unwrap_or(f64::INFINITY)],
            angle_deg: self.angle_deg,
        }
    }

    /// The request for each scene.
    pub(crate) fn covisibility(&self) -> Request {
        Request::Covisibility { pixels: self.pixels, cameras: self.cameras.clone() }
    }
}

/// Which frames flow leads from and to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FlowPairs {
    /// From each frame to the one N later in its trajectory; -1 is the one before.
    Step(i64),
    /// The pairs of the dataset's own list, there and back.
    Listed,
    /// From the first frame to the second of each of these.
    Between(Vec<FramePair>),
}

/// A mix of lamps: which are on, how bright, and in which colour.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct MixRequest(pub(crate) Mix);

impl MixRequest {
    /// The name of the mix.
    pub fn name(&self) -> &str {
        &self.0.name
    }
}
