//! Scattering at a surface point: `eval`, `sample`, `pdf` over a lobe or a mixture of lobes.
//!
//! Directions are unit vectors in shading space (z = shading normal, facing `wo`), pointing away from the surface. The
//! diffuse part is kept apart and *demodulated* (its value is for a reflectance of one), because the ground truth splits
//! radiance into reflectance × illumination + residual.
//!
//! `resolve` turns a material of the scene into a [`Bsdf`] at a point. A `Bsdf` is for one viewing direction: request values, densities and
//! samples only for the `wo` that it was made with. Paths are followed from the camera, so `wo` is known and `wi` is sampled; values are
//! for radiance, not for importance.

mod beckmann;
pub mod coat;
mod coated;
mod disney;
mod disney_model;
mod energy;
pub mod fresnel;
pub mod ggx;
mod inputs;
mod layers;
mod lobe;
mod mixture;
mod resolve;
mod rough_diffuse;
mod sample;
mod sharp;
mod sheen;
mod tables;

pub use inputs::Inputs;
pub use layers::Layers;
pub use lobe::{Fresnel, Lobe, thin_reflectance};
pub use resolve::{Border, border, straight_transmittance};
pub use sample::{Event, Sample, Value};
pub use sharp::Sharp;
pub use tables::{TableMaker, Tables};

use enfilade_math::{Rgb, Vec3};
use mixture::Mixture;

/// The scattering of one surface point towards one viewing direction.
#[derive(Clone, Debug)]
pub struct Bsdf<'a> {
    /// Diffuse reflectance on [0,1]: what the reflectance layer shows.
    pub reflectance: Rgb,
    model: Model<'a>,
}

/// How the lobes of a BSDF are kept: most materials have one, which needs no allocation.
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

    /// Value × cosine for light from `wi`, and the density per solid angle with which [`Bsdf::sample`] finds it. Smooth lobes, which have
    /// no density, are left out.
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

    /// Estimates of the hemispherical albedo towards a viewer at this cosine, of reflection and transmission; cheap, for choosing samples.
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
        // With what is added for further bounces between facets, some of these estimates exceed one.
        let rest = |part: Rgb, others: Rgb| Rgb::new(part.r.min(1.0 - others.r), part.g.min(1.0 - others.g), part.b.min(1.0 - others.b));
        let diffuse = rest(self.reflectance * rough.diffuse, Rgb::BLACK);
        let glossy = rest(rough.specular, diffuse);
        Albedo { diffuse, glossy, sharp: rest(sharp.specular, diffuse + glossy) }
    }

    /// What a viewer at `wo` sees sharply in the surface.
    pub fn sharp(&self, wo: Vec3) -> Sharp {
        match &self.model {
            Model::Black => Sharp::default(),
            Model::One(lobe) => lobe.sharp(wo),
            Model::Mixture(mixture) => mixture.sharp(wo),
        }
    }
}

/// The albedo of a surface, by how much its lobes blur what they reflect.
#[derive(Clone, Copy, Debug)]
pub struct Albedo {
    /// Albedo of the diffuse lobes.
    pub diffuse: Rgb,
    /// Albedo of the other lobes that are nearly as blurred.
    pub glossy: Rgb,
    /// Albedo of the sharp lobes.
    pub sharp: Rgb,
}

impl Albedo {
    /// Albedo of what is blurred.
    pub fn blurred(&self) -> Rgb {
        self.diffuse + self.glossy
    }

    /// Fraction on [0,1] of what is blurred.
    pub fn blurred_fraction(&self) -> f32 {
        fraction(self.blurred(), self.sharp)
    }

    /// Fraction on [0,1] of what is sharp in all that is not diffuse.
    pub fn sharp_fraction(&self) -> f32 {
        fraction(self.sharp, self.glossy)
    }
}

/// The part that `a` is of `a` + `b`.
fn fraction(a: Rgb, b: Rgb) -> f32 {
    let (a, b) = (a.luminance(), b.luminance());
    if a + b > 0.0 { a / (a + b) } else { 0.0 }
}

#[cfg(test)]
mod mitsuba;
#[cfg(test)]
mod published;
#[cfg(test)]
mod tests;
