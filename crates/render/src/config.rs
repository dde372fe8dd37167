use serde::{Deserialize, Serialize};

/// How a frame is rendered. Every number that trades time for quality is here.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RenderConfig {
    /// Samples per pixel of the colour layers (geometry layers are one point sample). Default 64.
    pub samples: u32,
    /// Longest path, counted in surfaces that scatter light after the first. Default 64: with roulette, longer paths carry no visible light.
    pub max_bounces: u32,
    /// Bounces before Russian roulette begins. Default 3.
    pub roulette_start: u32,
    /// Radius of the tent reconstruction filter, in pixels. Default 1, as Mitsuba's `tent`.
    pub filter_radius: f32,
    /// Seed of all random numbers; a frame's pixels depend on it, the frame number and nothing else.
    pub seed: u64,
}

impl Default for RenderConfig {
    fn default() -> Self {
        Self { samples: 64, max_bounces: 64, roulette_start: 3, filter_radius: 1.0, seed: 0 }
    }
}
