//! A camera ray and what its path finds.
//!
//! At the first surface the estimate is kept in three parts: the diffuse reflectance A, the *demodulated* diffuse light E
//! (what the diffuse lobe would send for a reflectance of one) and the rest R, so that a sample's radiance is A·E + R.

use crate::beyond::Beyond;
use crate::light_parts::LightParts;
use enfilade_math::{Ray, Rgb, Sampler, Vec3};

/// A camera ray to follow.
pub(crate) struct CameraSample {
    /// With a unit direction; `None` where the picture shows nothing, and is black.
    pub ray: Option<Ray>,
    pub sampler: Sampler,
    /// The sample's number within the pixel.
    pub index: u32,
}

/// One sample of a pixel.
#[derive(Clone, Debug)]
pub(crate) struct PixelSample {
    /// Diffuse reflectance A of the first surface.
    pub reflectance: Rgb,
    /// Expected value of A, where the first surface is drawn by opacity.
    pub expected_reflectance: Option<Rgb>,
    /// Demodulated diffuse light E; `None` where this sample did not measure it.
    pub illumination: Option<Rgb>,
    /// Everything else, R.
    pub residual: Rgb,
    /// A·E + R in parts, if requested.
    pub parts: LightParts,
    /// A·E + R by fixture, if requested; a fixture may occur several times.
    pub fixtures: Vec<FixtureLight>,
    /// Shading normal of the first surface, with bump; 0 for the background.
    pub normal: Vec3,
    /// What is mirrored in that surface or seen through it; of the first [`FOLLOWED`] samples of a pixel.
    pub beyond: Beyond,
}

/// Samples of a pixel that are followed into mirrors and glass.
pub(crate) const FOLLOWED: u32 = 16;

impl Default for PixelSample {
    /// Without light; the background.
    fn default() -> Self {
        Self {
            reflectance: Rgb::BLACK,
            expected_reflectance: None,
            illumination: None,
            residual: Rgb::BLACK,
            parts: LightParts::default(),
            fixtures: Vec::new(),
            normal: Vec3::ZERO,
            beyond: Beyond::NOTHING,
        }
    }
}

/// Light that a fixture adds to a sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FixtureLight {
    pub fixture: u16,
    /// The fixture's part of E.
    pub illumination: Rgb,
    /// The fixture's part of R.
    pub residual: Rgb,
}
