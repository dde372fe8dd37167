//! Inputs and results of light sampling: points that receive light, samples of it, and the weight of a sample that another technique could
//! have found too.

use enfilade_geometry::Hit;
use enfilade_math::{Rgb, Vec3};

/// A point that receives light, from which light is sampled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightPoint {
    /// World position.
    pub p: Vec3,
    /// Unit shading normal if only light on its side counts; zero if light may come from anywhere.
    pub n: Vec3,
}

/// Light arriving at a point from a sampled direction.
pub(crate) struct LightSample {
    /// Unit direction to the light.
    pub wi: Vec3,
    /// End of the shadow ray, moved off the emitter's surface; `None` for infinitely far lights.
    pub target: Option<Vec3>,
    /// Unit normal of the emitter's surface there; zero for lights without one.
    pub normal: Vec3,
    /// Radiance (finite lights) or radiance × density (delta lights, whose `pdf` is then only the choice's probability).
    /// `None` for the environment, which is looked up once it is known to be seen: see [`Lights::radiance_of`].
    pub radiance: Option<Rgb>,
    /// Density per solid angle, choice included.
    pub pdf: f32,
    /// True when no other technique can find this light.
    pub is_delta: bool,
    /// The place that reflects the light, if it comes from the sun by way of a glossy surface; its `radiance` is `None`.
    pub glint: Option<Glint>,
    /// The emitter of the light hierarchy that it comes from; `None` for what is far away.
    pub emitter: Option<u32>,
}

/// A place that reflects the sun.
pub(crate) struct Glint {
    /// Hit of the light as the ray from the point that receives it meets it.
    pub hit: Hit,
    /// Uniform on [0,1): what is left of the random number that chose it.
    pub u: f32,
}

/// Kinds of light sources, as distinguished by the layers of parts of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LightKind {
    /// The sky.
    Environment,
    /// Distant lights.
    Distant,
    /// Emissive surfaces.
    Surfaces,
    /// Point, spot and profile lights.
    Points,
}

impl LightSample {
    /// Light that other techniques can find too, from no emitter of the hierarchy.
    #[inline]
    pub fn new(wi: Vec3, target: Option<Vec3>, radiance: Option<Rgb>, pdf: f32) -> Self {
        Self { wi, target, normal: Vec3::ZERO, radiance, pdf, is_delta: false, glint: None, emitter: None }
    }

    /// Kind of the light's source.
    #[inline]
    pub fn kind(&self) -> LightKind {
        match (self.target, self.radiance) {
            _ if self.glint.is_some() => LightKind::Distant,
            (None, None) => LightKind::Environment,
            (None, Some(_)) => LightKind::Distant,
            (Some(_), _) if self.is_delta => LightKind::Points,
            (Some(_), _) => LightKind::Surfaces,
        }
    }
}

/// Radiance from beyond the scene.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Background {
    /// Radiance of the sky.
    pub environment: Rgb,
    /// Radiance of the disks of distant lights.
    pub distant: Rgb,
}

impl Background {
    /// Radiance of both.
    #[inline]
    pub fn total(&self) -> Rgb {
        self.environment + self.distant
    }
}

/// Weight of a sample of density `a` where another technique has density `b` (Veach 1997, β = 2).
#[inline]
pub(crate) fn power_heuristic(a: f32, b: f32) -> f32 {
    // In ratio form, so that large densities do not overflow when squared.
    if a <= 0.0 {
        return 0.0;
    }
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}
