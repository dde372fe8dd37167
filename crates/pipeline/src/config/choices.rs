//! Choices about rendering, and the ranges of those numbers, wherever they are given.

use super::SceneConfig;
use crate::error::Error;
use enfilade_render::RenderConfig;

/// Choices about rendering that win over those of the configuration; `None` and `false` leave it as it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RenderChoices {
    /// Samples per pixel, or the most of them where there is a noise target.
    pub samples: Option<u32>,
    /// Noise target, see [`enfilade_render::RenderConfig::noise`].
    pub noise: Option<f32>,
    /// Longest path.
    pub max_bounces: Option<u32>,
    /// Largest radiance of an indirect sample.
    pub clamp: Option<f32>,
    /// Seconds that a frame may take.
    pub time_limit_s: Option<f64>,
    /// Asks for layers of light by way and by source.
    pub splits: bool,
    /// Asks for the further layers of geometry and material.
    pub extra: bool,
    /// Asks for denoised layers.
    pub denoise: bool,
}

impl RenderChoices {
    /// What is out of its range, if anything.
    pub(super) fn problem(&self) -> Option<String> {
        let samples = self.samples.and_then(|v| check_samples(v).err());
        let noise = || self.noise.and_then(|v| check_noise(v).err());
        let clamp = || self.clamp.and_then(|v| check_positive("clamp", f64::from(v)).err());
        let limit = || self.time_limit_s.and_then(|v| check_positive("the time limit", v).err());
        samples.or_else(noise).or_else(clamp).or_else(limit)
    }

    /// # Errors
    /// When a number is out of its range.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let refuse = |message| Error::usage(format!("the command line: {message}"), "the flags are explained by: enfilade render --help");
        self.problem().map_or(Ok(()), |message| Err(refuse(message)))
    }

    /// Makes these choices for a scene.
    pub(crate) fn apply(&self, scene: &mut SceneConfig) {
        let render = &mut scene.render;
        render.samples = self.samples.unwrap_or(render.samples);
        render.noise = self.noise.or(render.noise);
        render.max_bounces = self.max_bounces.or(render.max_bounces);
        render.clamp = self.clamp.or(render.clamp);
        render.splits |= self.splits;
        render.extra |= self.extra;
        scene.time_limit_s = self.time_limit_s.or(scene.time_limit_s);
        scene.denoise |= self.denoise;
    }
}

pub(super) fn check_samples(samples: u32) -> Result<(), String> {
    if samples == 0 { Err("samples must be at least 1".into()) } else { Ok(()) }
}

pub(super) fn check_noise(noise: f32) -> Result<(), String> {
    if noise > 0.0 && noise < 1.0 { Ok(()) } else { Err(format!("noise must lie between 0 and 1, found {noise}")) }
}

pub(super) fn check_positive(what: &str, value: f64) -> Result<(), String> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(format!("{what} must be above 0, found {value}")) }
}

pub(super) fn check_filter_radius(radius: f32) -> Result<(), String> {
    let most = RenderConfig::LARGEST_FILTER_RADIUS;
    if (0.0..=most).contains(&radius) { Ok(()) } else { Err(format!("filter_radius must lie between 0 and {most} pixels, found {radius}")) }
}

pub(super) fn check_save_interval(seconds: f64) -> Result<(), String> {
    if seconds >= 0.0 && seconds.is_finite() { Ok(()) } else { Err(format!("save_every_s must be at least 0, found {seconds}")) }
}
