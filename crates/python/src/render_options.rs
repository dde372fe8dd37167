//! The options of `enfilade.render`.

use crate::arguments::layer;
use crate::errors::IntoPy;
use enfilade_dataset::ColorKind;
use enfilade_frame::{Layer, Pass};
use enfilade_options::{SHARE, options};
use enfilade_pipeline::{Quality, RenderChoices, Shot};
use pyo3::prelude::*;

options! {
    /// How `enfilade.render` makes pictures, and which layers it gives.
    pub struct RenderOptions {
        /// "draft", "normal", "high" or "reference", as of `Config`; normal unless given.
        pub quality: Option<Quality> = None,
        /// Samples per pixel, instead of those of the quality.
        pub samples: Option<u32> = None,
        /// Names of layers; unless given, all that a run writes. Those of `extra` (such as "material_id", "optical_flow") and of `light_parts` (such as
        /// "diffuse_direct") are rendered where they are named; flow leads from one camera to the next.
        pub layers: Option<Vec<String>> = None,
        /// Whether `color`, `diffuse_illumination` and `residual` are denoised, with what was rendered beside them as `*_rendered`; yes, but
        /// for "reference", unless given.
        pub denoise: Option<bool> = None,
        /// Seed of the noise.
        pub seed: u64 = 0,
        /// Noise target: rendering stops once the picture is that clean, such as 0.02.
        pub noise: Option<f32> = None => SHARE,
        /// Longest path, as of `[render]`.
        pub max_bounces: Option<u32> = None,
        /// Largest radiance of one indirect sample, as of `[render]`.
        pub clamp: Option<f32> = None,
        /// Makes rough diffuse surfaces Lambertian, as of `[render]`.
        pub lambertian: bool = false,
    }
}

impl RenderOptions {
    /// The layers of the names.
    pub fn layers(&self) -> PyResult<Option<Vec<Layer>>> {
        self.layers.as_ref().map(|names| names.iter().map(|name| layer(name)).collect()).transpose()
    }

    /// What to render so that there are `layers`.
    pub fn shot(&self, layers: Option<&[Layer]>) -> PyResult<Shot> {
        let wants = |pass: Pass| layers.unwrap_or_default().iter().any(|layer| layer.spec().pass == pass);
        let color = self.denoise.map(|denoise| if denoise { ColorKind::Denoised } else { ColorKind::Rendered });
        let (light_parts, extra) = (wants(Pass::LightParts), wants(Pass::Extra));
        let Self { quality, samples, seed, noise, max_bounces, clamp, lambertian, .. } = *self;
        let choices =
            RenderChoices { samples, noise, max_bounces, clamp, light_parts, extra, lambertian, color, ..RenderChoices::default() };
        Shot::new(quality.unwrap_or(Quality::Normal), &choices, seed).map_err(IntoPy::into_py)
    }
}
