//! The table of gates of frames: what is measured, the limit, and whose rule it is.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A condition that a frame must meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "GATES states each one")]
pub enum Gate {
    DepthRange,
    InvalidShare,
    PlaneShare,
    RgbRange,
    Albedo,
    Shading,
    Residual,
    Recomposition,
    Noise,
}

/// On which side of the bound values are good; the bound itself is good.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "plain words")]
pub enum Limit {
    AtLeast,
    AtMost,
}

impl Limit {
    /// In words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::AtLeast => "at least",
            Self::AtMost => "at most",
        }
    }
}

/// The definition of a gate.
#[derive(Clone, Copy, Debug)]
pub struct GateSpec {
    /// Which one.
    pub gate: Gate,
    /// In a few words, as the head of a column.
    pub name: &'static str,
    /// The measure.
    pub measure: &'static str,
    /// Which side of the bound is good.
    pub limit: Limit,
    /// The last good value.
    pub bound: f64,
    /// Unit of value and bound; empty for pure numbers.
    pub unit: &'static str,
    /// Source of the rule.
    pub source: &'static str,
    /// Possible causes of a rejection, and what to do.
    pub meaning: &'static str,
}

macro_rules! gates {
    ($($gate:ident $name:literal $limit:ident $bound:literal $unit:literal, $measure:literal, $source:literal, $meaning:literal;)*) => {
        [$(GateSpec { gate: Gate::$gate, name: $name, measure: $measure, limit: Limit::$limit, bound: $bound, unit: $unit,
            source: $source, meaning: $meaning }),*]
    };
}

/// The table of gates; `GATES[gate as usize].gate == gate`.
pub const GATES: [GateSpec; 9] = gates![
    DepthRange "depth range" AtLeast 0.5 "m", "largest minus smallest planar depth of the pixels that see the scene",
        "Marigold#158 (min_depth_range)", "the view shows a wall from nearby: choose other poses";
    InvalidShare "invalid pixels" AtMost 0.03 "share", "pixels with render_entity_id -1 or a depth that is not a number, where the camera sees",
        "Marigold#158 (max_invalid_ratio)", "the view looks out of the scene: choose other poses, or close the scene";
    PlaneShare "largest plane" AtMost 0.9 "share", "pixels of a lattice over the image, where the camera sees, whose surface points lie in one plane",
        "Hypersim's complaints (walls that fill the view)", "the view shows one bare wall, floor or ceiling: choose other poses";
    RgbRange "RGB range" AtLeast 10.0 "of 255", "largest minus smallest 8-bit value of all channels of the tone-mapped color",
        "Marigold#158 (min_rgb_range)", "the picture is blank: look at the lights and at what is before the camera";
    Albedo "albedo" AtMost 0.0 "", "how far diffuse_reflectance leaves [0,1] at most",
        "Marigold IID (preprocess_hypersim_iid)", "a texture or factor beyond 1: check the material at that place";
    Shading "shading" AtLeast 0.0 "W/(sr m^2)", "smallest value of diffuse_illumination",
        "Marigold IID (preprocess_hypersim_iid)", "a negative light or texture: check the scene";
    Residual "residual" AtLeast 0.0 "W/(sr m^2)", "smallest value of residual",
        "Marigold IID (preprocess_hypersim_iid)", "a negative light or texture: check the scene";
    Recomposition "recomposition" AtLeast 40.0 "dB",
        "PSNR (at most 100) of the tone-mapped 8-bit color against A min(S, p) + min(R, p) with its own tone map; p: 98th percentile of all values of S",
        "Marigold IID (preprocess_hypersim_iid)",
        "much of the picture is brighter than nearly all diffuse shading, as windows, lamps and their reflections are: such frames are of no use for intrinsic images";
    Noise "noise" AtMost 1.0 "of target", "noise of color over the noise that was asked for",
        "the dataset's own configuration", "the limit of samples or time came first: allow more, or ask for less";
];

impl Gate {
    /// The gate's row of the table.
    pub const fn spec(self) -> &'static GateSpec {
        &GATES[self as usize]
    }

    /// Whether a value is good. What is not a number is not.
    pub fn passes(self, value: f64) -> bool {
        match self.spec().limit {
            Limit::AtLeast => value >= self.spec().bound,
            Limit::AtMost => value <= self.spec().bound,
        }
    }

    /// How bad a value is, to sort by: 0 at the bound, greater on the bad side.
    pub fn excess(self, value: f64) -> f64 {
        let beyond = match self.spec().limit {
            Limit::AtLeast => self.spec().bound - value,
            Limit::AtMost => value - self.spec().bound,
        };
        if beyond.is_nan() { f64::INFINITY } else { beyond }
    }
}

/// The measured value of each gate whose layers the frame has. A NaN or an infinity means that it cannot be measured.
pub type GateValues = BTreeMap<Gate, f64>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_enum_and_speaks_ascii() {
        for (i, spec) in GATES.iter().enumerate() {
            assert_eq!(spec.gate as usize, i);
            assert!(spec.measure.is_ascii() && spec.meaning.is_ascii());
        }
    }

    #[test]
    fn the_bound_is_good_and_nan_is_not() {
        for spec in GATES {
            let (good, bad) = match spec.limit {
                Limit::AtLeast => (1.0, -1.0),
                Limit::AtMost => (-1.0, 1.0),
            };
            assert!(spec.gate.passes(spec.bound) && spec.gate.passes(spec.bound + good));
            assert!(!spec.gate.passes(spec.bound + bad) && !spec.gate.passes(f64::NAN));
            assert!(spec.gate.excess(spec.bound + bad) > 0.0 && spec.gate.excess(f64::NAN) > 0.0);
        }
    }
}
