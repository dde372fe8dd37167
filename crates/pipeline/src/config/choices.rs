//! What the command line, or a program, says otherwise than the configuration.

use super::checks::{Section, check_rendering};
use super::settings::{SceneConfig, save_every_s};
use crate::error::Error;
use enfilade_dataset::ColorKind;
use enfilade_options::{SHARE, TIME, named, options, words};
use enfilade_render::{RenderConfig, RenderError};
use serde::{Deserialize, Serialize};

words! {
    /// How good pictures become, by one word. `docs/benchmarks.md` tells the error that each leaves.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Quality {
        /// 8 samples, for a look: small things are smeared.
        Draft = "draft",
        /// 32 samples, for use.
        Normal = "normal",
        /// 128 samples, for publication.
        High = "high",
        /// For comparison with others' pictures: unbiased, so not denoised, with as many samples as a noise of 2 % takes.
        Reference = "reference",
    }
}

/// Noise of a reference, see [`RenderConfig::noise`].
const REFERENCE_NOISE: f32 = 0.02;
/// The most samples per pixel that a noise target may take where nobody says: thirty times what a reference takes in most rooms.
pub(super) const MOST_SAMPLES: u32 = 65_536;

impl Quality {
    /// Samples per pixel; of a reference the most of them.
    pub const fn samples(self) -> u32 {
        match self {
            Self::Draft => 8,
            Self::Normal => 32,
            Self::High => 128,
            Self::Reference => MOST_SAMPLES,
        }
    }

    /// What a scene as it was stored is a reference of, or not: only a reference is more than a number of samples.
    fn of_stored(scene: &SceneConfig) -> Self {
        let is_reference = scene.render.noise == Some(REFERENCE_NOISE) && scene.color == ColorKind::Rendered;
        if is_reference { Self::Reference } else { Self::Normal }
    }

    /// Lays this over a scene whose quality was `below`, with the choices that a reference leaves no other way.
    pub(super) fn lay_over(self, scene: &mut SceneConfig, below: Self) {
        self.lay_over_settings(&mut scene.render, &mut scene.color, below);
    }

    /// Lays the quality over the settings alone.
    fn lay_over_settings(self, render: &mut RenderConfig, color: &mut ColorKind, below: Self) {
        render.samples = self.samples();
        if self == Self::Reference {
            (render.noise, *color) = (Some(REFERENCE_NOISE), ColorKind::Rendered);
            (render.max_bounces, render.clamp) = (None, None);
        } else if below == Self::Reference {
            (render.noise, *color) = (None, ColorKind::Denoised);
        }
    }

    /// What a scene of this quality is rendered with where nothing else is said but `choices`, which have no time limit here: transport with
    /// seed 0, and what its colour layers hold.
    ///
    /// # Errors
    /// When a number is out of its range.
    pub(crate) fn settings(self, choices: &RenderChoices) -> Result<(RenderConfig, ColorKind), Error> {
        let (mut render, mut color) = (RenderConfig::default(), ColorKind::Denoised);
        self.lay_over_settings(&mut render, &mut color, self);
        choices.apply_to_transport(&mut render);
        let wrong = |error: RenderError| Error::usage(error.to_string(), "give another number, or leave it out");
        render.validate().map_err(wrong)?;
        Ok((render, choices.color.unwrap_or(color)))
    }
}

options! {
    /// Choices that win over those of the configuration.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Overrides {
        /// Everything else about rendering; its samples win over `quality`.
        pub render: RenderChoices = RenderChoices::default() => fixed,
        /// Seed of everything random; homes with a seed of their own keep it.
        pub seed: Option<u64> = None,
        /// Frames per trajectory.
        pub frames: Option<u32> = None,
        /// Width and height of the images in pixels.
        pub size: Option<[u32; 2]> = None,
        /// How good the pictures become, in one word.
        pub quality: Option<Quality> = None,
    }
}

impl Overrides {
    /// Lays these over a scene whose quality was `below`; the seed decides more than a scene's settings, and is not among them here.
    pub(super) fn lay_over(&self, scene: &mut SceneConfig, below: Quality) {
        scene.plan.frames = self.frames.unwrap_or(scene.plan.frames);
        scene.size = self.size.unwrap_or(scene.size);
        if let Some(quality) = self.quality {
            quality.lay_over(scene, below);
        }
        self.render.apply(scene);
    }

    /// Lays these over a scene as it was stored, which keeps its seed.
    ///
    /// # Errors
    /// When a number is out of its range.
    pub(crate) fn lay_over_stored(&self, scene: &mut SceneConfig) -> Result<(), Error> {
        if *self == Self::default() {
            return Ok(());
        }
        self.render.check()?;
        self.lay_over(scene, Quality::of_stored(scene));
        scene.validate().map_err(|wrong| Error::usage(format!("the command line: {}", wrong.message), wrong.help))
    }

    /// Whether a key's value is one of these.
    pub(super) fn say(&self, section: Section, key: &str) -> bool {
        let render = &self.render;
        match (section, key) {
            (Section::Scene, "frames") => self.frames.is_some(),
            (Section::Render, "size") => self.size.is_some(),
            (Section::Render, "samples") => render.samples.is_some() || self.quality.is_some(),
            (Section::Render, "noise") => render.noise.is_some(),
            (Section::Render, "clamp") => render.clamp.is_some(),
            (Section::Render, "time_limit_s") => render.time_limit_s.is_some(),
            _ => false,
        }
    }
}

options! {
    /// Choices about rendering that win over those of the configuration; `None` and `false` leave it as it is.
    #[derive(Clone, Debug, PartialEq)]
    pub struct RenderChoices {
        /// Samples per pixel: the mean over the image, or with a noise target the maximum; those of the quality unless given, with a noise
        /// target 65536.
        pub samples: Option<u32> = None,
        /// Noise target, a share of the brightness: rendering stops where the noise is this small, as 0.02.
        ///
        /// See [`enfilade_render::RenderConfig::noise`].
        pub noise: Option<f32> = None => SHARE,
        /// Longest path, in surfaces that scatter light after the first; no limit, which is unbiased, unless given.
        pub max_bounces: Option<u32> = None,
        /// Largest radiance of one indirect sample; no limit, which is unbiased, unless given.
        pub clamp: Option<f32> = None,
        /// Wall-clock seconds after which a frame ends with the samples it has; two such runs differ.
        pub time_limit_s: Option<f64> = None => TIME,
        /// Also write the light of color by its path (diffuse_direct, ...) and by its source (light_environment, ...).
        pub light_parts: bool = false,
        /// Also write the light of each lamp and window, the sun and the sky by itself, for `enfilade make OUT relit`.
        pub fixtures: bool = false,
        /// Also write material, flow to the next frame, what is behind glass, occlusion boundaries and more, pixel by pixel.
        pub extra: bool = false,
        /// Make rough diffuse surfaces (plaster, cloth) Lambertian: diffuse_illumination of a point is then the same from everywhere.
        pub lambertian: bool = false,
        /// Contents of color, diffuse_illumination and residual; denoised unless given. Changing them renders nothing again.
        pub color: Option<ColorKind> = None => named("KIND"),
    }
}

impl RenderChoices {
    /// # Errors
    /// When a number is out of its range.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let mut render = RenderConfig::default();
        self.apply_to_transport(&mut render);
        check_rendering(&render, self.time_limit_s, save_every_s()).map_err(|wrong| {
            Error::usage(format!("the command line: {}", wrong.message), "the flags are explained by: enfilade run --help")
        })
    }

    /// Makes these choices for a scene.
    pub(crate) fn apply(&self, scene: &mut SceneConfig) {
        self.apply_to_transport(&mut scene.render);
        scene.time_limit_s = self.time_limit_s.or(scene.time_limit_s);
        scene.color = self.color.unwrap_or(scene.color);
    }

    fn apply_to_transport(&self, render: &mut RenderConfig) {
        let below = if self.noise.is_some() { MOST_SAMPLES } else { render.samples };
        render.samples = self.samples.unwrap_or(below);
        render.noise = self.noise.or(render.noise);
        render.max_bounces = self.max_bounces.or(render.max_bounces);
        render.clamp = self.clamp.or(render.clamp);
        render.light_parts |= self.light_parts;
        render.fixtures |= self.fixtures;
        render.extra |= self.extra;
        render.lambertian |= self.lambertian;
    }
}
