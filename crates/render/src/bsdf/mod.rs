//! Scattering at a surface point: `eval`, `sample`, `pdf` over a lobe or a mixture of lobes.
//!
//! Directions are unit vectors in shading space (z = shading normal, facing `wo`), pointing away from the surface. The
//! diffuse part is kept apart and *demodulated* (its value is for a reflectance of one), because the ground truth splits
//! radiance into reflectance × illumination + residual.

pub mod coat;
mod coated;
mod energy;
pub mod fresnel;
pub mod ggx;
mod layers;
mod lobe;
mod mixture;
mod resolve;
mod rough_diffuse;
mod sheen;
mod tables;

pub use layers::Layers;
pub use lobe::{Fresnel, Lobe, thin_reflectance};
pub use resolve::{Inputs, straight_transmittance};
pub use tables::{TableMaker, Tables};

use enfilade_math::{Rgb, Vec3};
use mixture::Mixture;
use std::ops::Mul;

/// What a surface does to light from one direction, cosine included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Value {
    /// Diffuse part for a reflectance of one.
    pub diffuse: Rgb,
    /// Everything else.
    pub specular: Rgb,
}

impl Value {
    /// The whole, given the diffuse reflectance.
    #[inline]
    pub fn total(&self, reflectance: Rgb) -> Rgb {
        reflectance * self.diffuse + self.specular
    }
}

impl Mul<f32> for Value {
    type Output = Self;
    #[inline]
    fn mul(self, s: f32) -> Self {
        Self { diffuse: self.diffuse * s, specular: self.specular * s }
    }
}

/// How a sampled direction came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// From a density over directions.
    Finite,
    /// One of finitely many directions: light sampling cannot find it.
    Delta,
    /// Straight on through a thin pane: shadow rays take this way too.
    Straight,
}

/// A sampled incident direction.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Incident direction.
    pub wi: Vec3,
    /// Value over density.
    pub weight: Value,
    /// Density per solid angle; zero for [`Event::Delta`] and [`Event::Straight`].
    pub pdf: f32,
    /// What kind of direction it is.
    pub event: Event,
}

impl Sample {
    /// One of finitely many directions, with its value over its probability.
    #[inline]
    fn delta(wi: Vec3, weight: Rgb) -> Self {
        Self { wi, weight: Value { diffuse: Rgb::BLACK, specular: weight }, pdf: 0.0, event: Event::Delta }
    }
}

/// The scattering of one surface point towards one viewing direction.
#[derive(Clone, Debug)]
pub struct Bsdf<'a> {
    /// Diffuse reflectance on [0,1]: what the reflectance layer shows.
    pub reflectance: Rgb,
    model: Model<'a>,
}

#[derive(Clone, Debug)]
enum Model<'a> {
    Black,
    One(Lobe<'a>),
    Mixture(Mixture<'a>),
}

impl<'a> Bsdf<'a> {
    /// Absorbs all light.
    pub fn black() -> Self {
        Self { reflectance: Rgb::BLACK, model: Model::Black }
    }

    /// Lambert's law.
    #[inline]
    pub fn lambert(reflectance: Rgb) -> Self {
        let model = if reflectance.is_black() { Model::Black } else { Model::One(Lobe::Lambert) };
        Self { reflectance, model }
    }

    /// True when light is never scattered.
    #[inline]
    pub fn is_black(&self) -> bool {
        matches!(self.model, Model::Black)
    }

    /// True when light is scattered in single directions alone, by mirrors and clear glass.
    #[inline]
    pub fn is_sharp(&self) -> bool {
        match &self.model {
            Model::Black => true,
            Model::One(lobe) => lobe.is_sharp(),
            Model::Mixture(mixture) => mixture.is_sharp(),
        }
    }

    /// How the light that the diffuse lobes reflect depends on the viewer, where that is known apart from where the light comes from.
    #[inline]
    pub fn outgoing(&self) -> Option<Outgoing<'a>> {
        match &self.model {
            Model::One(lobe) => lobe.outgoing(),
            Model::Mixture(mixture) => mixture.outgoing(),
            Model::Black => None,
        }
    }

    /// Value × cosine for light from `wi`.
    #[cfg(test)]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Value {
        self.eval_pdf(wo, wi).0
    }

    /// Density with which [`Bsdf::sample`] finds `wi`.
    #[cfg(test)]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.eval_pdf(wo, wi).1
    }

    /// Value × cosine for light from `wi`, and the density with which [`Bsdf::sample`] finds it; smooth lobes do not take part.
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Value, f32) {
        match &self.model {
            Model::Black => (Value::default(), 0.0),
            Model::One(lobe) => lobe.eval_pdf(wo, wi),
            Model::Mixture(mixture) => mixture.eval_pdf(wo, wi),
        }
    }

    /// Samples an incident direction in rough proportion to the value. `u` is uniform on [0,1)³; `None` absorbs the path.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        match &self.model {
            Model::Black => None,
            Model::One(lobe) => lobe.sample(wo, u),
            Model::Mixture(mixture) => mixture.sample(wo, u),
        }
    }

    /// Shares of light from all around that are sent to a viewer at this cosine, reflected or transmitted: cheap estimates.
    pub fn albedo(&self, cos_o: f32) -> Albedo {
        let (rough, sharp) = match &self.model {
            Model::Black => (Value::default(), Value::default()),
            Model::One(lobe) => {
                let albedo = lobe.albedo(cos_o);
                if lobe.is_rough() {
                    (albedo, Value::default())
                } else {
                    (Value { specular: Rgb::BLACK, ..albedo }, Value { diffuse: Rgb::BLACK, ..albedo })
                }
            }
            Model::Mixture(mixture) => mixture.albedo(cos_o),
        };
        // What is added for light between facets lets some estimates of one bounce exceed all light.
        let rest = |part: Rgb, others: Rgb| Rgb::new(part.r.min(1.0 - others.r), part.g.min(1.0 - others.g), part.b.min(1.0 - others.b));
        let diffuse = rest(self.reflectance * rough.diffuse, Rgb::BLACK);
        let glossy = rest(rough.specular, diffuse);
        Albedo { diffuse, glossy, sharp: rest(sharp.specular, diffuse + glossy) }
    }
}

/// How diffusely reflected light depends on the viewer.
#[derive(Clone, Copy, Debug)]
pub struct Outgoing<'a> {
    /// What it must pass on its way out.
    coat: Option<coat::Coat<'a>>,
    layers: Option<Layers>,
}

impl Outgoing<'_> {
    /// The same to all sides.
    const EVEN: Self = Self { coat: None, layers: None };

    /// Radiance towards a viewer at this cosine, in proportion to that towards others.
    #[inline]
    pub fn share(&self, cos_o: f32) -> f32 {
        let coat = self.coat.map_or(1.0, |coat| coat.transmittance(cos_o));
        coat * self.layers.map_or(1.0, |layers| layers.passes(cos_o, 1.0))
    }
}

/// What a surface reflects of light from all around.
#[derive(Clone, Copy, Debug)]
pub struct Albedo {
    /// By the diffuse lobes.
    pub diffuse: Rgb,
    /// By others that are nearly as blurred.
    pub glossy: Rgb,
    /// By the rest.
    pub sharp: Rgb,
}

impl Albedo {
    /// Of what is blurred.
    pub fn blurred(&self) -> Rgb {
        self.diffuse + self.glossy
    }

    /// Share on [0,1] of what is blurred.
    pub fn blurred_share(&self) -> f32 {
        share(self.blurred(), self.sharp)
    }

    /// Share on [0,1] of what is sharp in all that is not diffuse.
    pub fn sharp_share(&self) -> f32 {
        share(self.sharp, self.glossy)
    }
}

/// The part that `a` is of `a` + `b`.
fn share(a: Rgb, b: Rgb) -> f32 {
    let (a, b) = (a.luminance(), b.luminance());
    if a + b > 0.0 { a / (a + b) } else { 0.0 }
}

#[cfg(test)]
mod tests;
