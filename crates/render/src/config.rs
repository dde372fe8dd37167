//! The settings of a rendering, with the range of each, and the reconstruction filter.

use crate::error::RenderError;
use enfilade_math::warp;
use enfilade_options::{options, words};
use serde::{Deserialize, Serialize};

/// The smallest radius of the filter, in pixels. Whether a ray passes a half transparent surface depends on where it meets it, so the rays
/// of a pixel must differ. A thousandth of a pixel is invisible, and float32 still tells hundreds of directions within it apart.
const MIN_RADIUS: f32 = 1e-3;

words! {
    /// The reconstruction filter: how samples are spread about a pixel's centre.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Filter {
        /// Falls off linearly.
        #[default]
        Tent = "tent",
        /// Weighs all samples alike: with a radius of 0.5, the mean over the pixel's square.
        Box = "box",
    }
}

impl Filter {
    /// Offset from the pixel's centre along one axis, in pixels, distributed as the filter; `u` is uniform on [0,1).
    pub(crate) fn offset(self, u: f32, radius: f32) -> f32 {
        let radius = radius.max(MIN_RADIUS);
        match self {
            Self::Tent => warp::tent(u, radius),
            Self::Box => (2.0 * u - 1.0) * radius,
        }
    }
}

options! {
    /// How a frame is rendered. Every number that trades time for quality is here.
    ///
    /// ```
    /// use enfilade_render::RenderConfig;
    ///
    /// // 16 samples per pixel, the light in parts by its path and its source.
    /// let config = RenderConfig { samples: 16, light_parts: true, ..RenderConfig::default() };
    /// assert!(config.validate().is_ok());
    ///
    /// // Numbers out of their range are refused with what was expected.
    /// let error = RenderConfig { samples: 0, ..config }.validate().unwrap_err();
    /// assert_eq!(error.to_string(), "samples must be at least 1, found 0");
    /// ```
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct RenderConfig keys pub RenderKeys {
        /// Samples per pixel of the colour layers (geometry layers are one point sample): the mean over the image when samples are
        /// spread by need, the most that a noise target may take. At least 1; default 64.
        pub samples: u32 = 64,
        /// Spreads the samples over the pixels in proportion to the error that each one has left. Default true.
        pub adaptive: bool = true,
        /// Stops below `samples` where this noise is reached: the root mean square over the image of each pixel's standard error over
        /// (its luminance + 0.2 × the image's mean). The first samples tell how many it takes, a quarter of `samples` and at most 64; what is
        /// left is measured, and more are taken while it is above. Default none; between 0 and 1, and 0.02 is a clean picture.
        pub noise: Option<f32> = None,
        /// Learns before rendering where indirect light comes from and sends rays there. Changes noise, never the mean. Default true.
        pub guiding: bool = true,
        /// Longest path, counted in surfaces that scatter light after the first, panes among them but those before a source. Default none:
        /// Russian roulette ends paths without bias.
        pub max_bounces: Option<u32> = None,
        /// Largest radiance that one indirect path may add to a pixel. More than 0; default none, because a clamp darkens the picture.
        pub clamp: Option<f32> = None,
        /// Keeps the light of each pixel apart by its way and by its source, as layers of their own. Changes no other layer. Default false.
        #[serde(rename = "splits")]
        pub light_parts: bool = false,
        /// Keeps the light of each pixel apart by what it comes from: the sky, the sun, each window and lamp ([`crate::RenderScene::fixtures`]), each
        /// with its part of the illumination and of the residual. Changes no layer. Takes 24 bytes per pixel and fixture while rendering, 36
        /// when the frame is put together. Default false.
        #[serde(skip_serializing_if = "is_false")]
        pub fixtures: bool = false,
        /// Adds further layers of geometry and material. Changes no other layer: see [`crate::add_extra_layers`]. Default false.
        pub extra: bool = false,
        /// Rough diffuse surfaces (plaster, cloth, unglazed clay) scatter by Lambert's law, as if smooth: `diffuse_illumination` of a point is then
        /// the same from everywhere. What [`crate::RenderScene::settled`] makes of a scene. Default false.
        #[serde(skip_serializing_if = "is_false")]
        pub lambertian: bool = false,
        /// Bounces before Russian roulette begins. Default 1.
        pub roulette_start: u32 = 1,
        /// Shape of the reconstruction filter. Default a tent.
        pub filter: Filter = Filter::Tent,
        /// Radius of the reconstruction filter, in pixels; what is below 0.001 counts as that. Up to
        /// [`RenderConfig::LARGEST_FILTER_RADIUS`]. Default 1, as Mitsuba's `tent`.
        pub filter_radius: f32 = 1.0,
        /// Seed of all random numbers. A frame depends on the scene, the camera, all views that the guide has learned from, the frame's
        /// number and this configuration, and on nothing else.
        pub seed: u64 = 0 => fixed,
    }
}

/// Records and hashes of frames have no word of what is not asked for, as before there was any such choice.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn is_false(value: &bool) -> bool {
    !value
}

impl RenderConfig {
    /// The largest radius of the filter, in pixels. Filters in use reach 4; one of 16 leaves a blur, and a larger number is a mistake.
    pub const LARGEST_FILTER_RADIUS: f32 = 16.0;

    /// Checks the numbers. These are their ranges, wherever they come from.
    ///
    /// ```
    /// use enfilade_render::RenderConfig;
    /// let config = RenderConfig { noise: Some(2.0), ..RenderConfig::default() };
    /// assert_eq!(config.validate().unwrap_err().to_string(), "noise must lie between 0 and 1, found 2");
    /// ```
    ///
    /// # Errors
    /// [`RenderError::Config`] for the first one that is out of its range.
    pub fn validate(&self) -> Result<(), RenderError> {
        require(self.samples >= 1, "samples", self.samples, "be at least 1")?;
        if let Some(noise) = self.noise {
            require(noise > 0.0 && noise < 1.0, "noise", noise, "lie between 0 and 1")?;
        }
        if let Some(clamp) = self.clamp {
            require(clamp > 0.0 && clamp.is_finite(), "clamp", clamp, "be above 0")?;
        }
        let radius = self.filter_radius;
        require((0.0..=Self::LARGEST_FILTER_RADIUS).contains(&radius), "filter_radius", radius, "lie between 0 and 16 pixels")
    }
}

fn require(ok: bool, field: &'static str, found: impl ToString, expected: &'static str) -> Result<(), RenderError> {
    if ok { Ok(()) } else { Err(RenderError::Config { field, found: found.to_string(), expected }) }
}
