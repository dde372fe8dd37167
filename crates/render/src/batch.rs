//! Paths of pixels near each other, followed together: their primary vertices, and the light gathered for each camera ray.
//!
//! At the first surface the estimate is kept in three parts: the diffuse reflectance A, the *demodulated* diffuse light E
//! (what the diffuse lobe would send for a reflectance of one) and the rest R, so that a sample's radiance is A·E + R.

use crate::bsdf::Value;
use crate::integrator::Integrator;
use crate::shared_vertex::{Connection, SharedVertex};
use crate::split::{Arriving, Split};
use crate::vertex::Vertex;
use enfilade_math::{Ray, Rgb, Sampler};

/// A camera ray to follow.
pub(crate) struct CameraSample {
    /// With a unit direction; `None` where the picture shows nothing, and is black.
    pub ray: Option<Ray>,
    pub sampler: Sampler,
    /// The sample's number within the pixel.
    pub index: u32,
}

/// One sample of a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PixelSample {
    /// Diffuse reflectance A of the first surface.
    pub reflectance: Rgb,
    /// Demodulated diffuse light E; `None` where this sample did not measure it.
    pub illumination: Option<Rgb>,
    /// Everything else, R.
    pub residual: Rgb,
    /// A·E + R in parts, where they are asked for.
    pub split: Split,
}

/// The first surface of a camera's path, or one that it reaches by way of mirrors and glass alone.
pub(crate) struct PrimaryVertex<'a, 's> {
    pub vertex: Vertex<'a, 's>,
    /// Number of the camera ray.
    pub camera: usize,
    /// Surfaces before it.
    pub bounce: u32,
    /// How many of them might have sent the path elsewhere than by a mirror or glass.
    pub forks: u32,
    /// The mirrors and glass before it; `None` for the first surface.
    pub chain: Option<SpecularChain>,
    /// True when it may use light that other paths found: unless it lies in a medium that absorbs light.
    pub shares_light: bool,
}

/// The mirrors and glass between the first surface and a later primary vertex.
#[derive(Clone, Copy)]
pub(crate) struct SpecularChain {
    pub throughput: Rgb,
    /// True when the path goes through the first surface.
    pub crossed: bool,
}

/// Light gathered for a camera ray: that of the first surface's diffuse lobes for a reflectance of one, and the rest.
#[derive(Clone, Copy, Default)]
pub(crate) struct Gathered {
    pub light: Value,
    pub split: Split,
}

/// The paths of pixels near each other. One batch is reused for many groups of pixels, to spare allocations.
#[derive(Default)]
pub(crate) struct Batch<'a, 's> {
    pub primaries: Vec<PrimaryVertex<'a, 's>>,
    /// What paths found after a primary vertex, whose number it is, and others may use.
    pub shared: Vec<(usize, SharedVertex<'a>)>,
    /// Scratch space of [`Integrator::share_light`].
    pub connections: Vec<Connection>,
    /// Of each camera ray, the number of its first primary vertex.
    pub firsts: Vec<Option<usize>>,
    /// Of each camera ray.
    pub gathered: Vec<Gathered>,
}

impl Batch<'_, '_> {
    /// Empties the batch, for this number of camera rays.
    pub fn clear(&mut self, cameras: usize) {
        self.primaries.clear();
        self.shared.clear();
        self.firsts.clear();
        self.gathered.clear();
        self.gathered.resize(cameras, Gathered::default());
    }
}

impl PrimaryVertex<'_, '_> {
    /// What the mirrors and glass before it let through.
    #[inline]
    pub fn throughput(&self) -> Rgb {
        self.chain.map_or(Rgb::WHITE, |chain| chain.throughput)
    }
}

impl<'a, 's> Integrator<'a, 's> {
    /// Gathers indirect light that arrives at a primary vertex and is scattered there.
    #[inline]
    pub fn gather(&self, gathered: &mut Gathered, primary: &PrimaryVertex<'_, 's>, weight: &Value, light: Arriving, crossed: bool) {
        self.add(gathered, primary, weight, light, crossed, true);
    }

    /// Gathers light that arrives at a primary vertex and is scattered there; where it is `indirect`, no more than
    /// [`crate::RenderConfig::clamp`] allows.
    #[inline]
    pub fn add(
        &self,
        gathered: &mut Gathered,
        primary: &PrimaryVertex<'_, 's>,
        weight: &Value,
        light: Arriving,
        crossed: bool,
        indirect: bool,
    ) {
        let reflectance = primary.vertex.bsdf.reflectance;
        let mirrored = Value { diffuse: Rgb::BLACK, specular: Rgb::WHITE };
        let (reflectance, weight, light, crossed) = match primary.chain {
            None => (reflectance, weight, light, crossed),
            Some(chain) => (Rgb::BLACK, &mirrored, light.dimmed(chain.throughput * weight.total(reflectance)), chain.crossed),
        };
        let light = if indirect { self.clamped(light, weight.total(reflectance)) } else { light };
        gathered.light.diffuse += weight.diffuse * light.total;
        gathered.light.specular += weight.specular * light.total;
        if self.config.splits {
            gathered.split.add_scattered(reflectance, weight, &light, crossed);
        }
    }

    /// Gathers light that a shared vertex sends to primary vertex number `primary`.
    pub fn gather_shared(&self, batch: &mut Batch<'a, 's>, primary: usize, weight: &Value, light: Arriving) {
        let primary = &batch.primaries[primary];
        self.gather(&mut batch.gathered[primary.camera], primary, weight, light, false);
    }
}
